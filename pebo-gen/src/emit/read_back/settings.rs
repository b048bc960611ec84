//! The constructor of the observer, read from tokens: the settings that it sets.
//!
//! Its statements bind names to results of the runtime's constructors. Nothing of the emitter is used.

use std::collections::BTreeMap;

use quote::ToTokens;
use syn::{Expr as Syntax, ImplItem, ItemImpl, Pat, Stmt};

use super::value::{self, Value, unreadable};
use crate::emit::error::EmitError;
use pebo_cas::{Arena, Rational};
use pebo_design::plant::settings::{
    Covariance, Estimator, Extension, FiniteTime, Late, Limits, Operator, PATIENCE, Rebase, Settings,
};

/// The constant with the length of a window.
pub(in crate::emit) const WINDOW: &str = "NW";

/// The constant with the number of samples that may be on their way.
pub(in crate::emit) const PAST: &str = "NP";

/// The constant with the number of unknowns of the output form.
pub(in crate::emit) const UNKNOWNS: &str = "NO";

/// Its value.
pub(in crate::emit) fn unknowns(has_instants: bool) -> &'static str {
    if has_instants { "NR - NI + NZ" } else { "NR + NZ" }
}

/// The constant with the indices of the outputs of the rows.
pub(in crate::emit) const ROWS: &str = "ROWS";

/// The regressand of a model.
#[derive(Clone, Debug)]
enum Form {
    /// That of its regression.
    Own,
    /// Its outputs, and the model is evaluated at the expected ones at these indices, if there are any, whose samples have
    /// these standard deviations.
    Outputs(Option<(Vec<usize>, Vec<Rational>)>),
}

/// The value of a name.
#[derive(Clone, Debug)]
enum Made {
    /// The model with its parameters, whether in its output form, and bounds of its states.
    Model(Form, [Option<Vec<Rational>>; 2]),
    /// The indices of the outputs of the rows.
    Rows(Vec<usize>),
    /// The index of an output for each row, or none.
    Outputs(Vec<Option<usize>>),
    Number(Rational),
    List(Vec<Rational>),
    /// A vector of infinities, above or below all numbers.
    Infinite {
        above: bool,
    },
    Estimator(Estimator<Rational>),
    Bounded(Estimator<Rational>, [Option<Vec<Rational>>; 2]),
    Extension(Extension<Rational>),
    /// Samples are joined by straight lines, or not.
    Hold(bool),
    Operator(Operator<Rational>, bool),
    Late(Late<Rational>),
    Observer(Box<Settings<Rational>>),
    Gate(Rational),
    Rebase(Rebase<Rational>),
    Limits(Limits<Rational>),
    /// A vector in which some entries are infinite.
    Open(Vec<Option<Rational>>, bool),
}

/// These are the constructors beside `new`.
pub(in crate::emit) fn is_constructors(item: &ItemImpl) -> bool {
    let named = |entry: &ImplItem| matches!(entry, ImplItem::Fn(function) if ["try_new", "gate", "limits", "observer"].iter().any(|name| function.sig.ident == name));
    item.trait_.is_none() && !item.items.is_empty() && item.items.iter().all(named)
}

/// The settings of the observer's constructor, if there is one; the other checks parameters before it takes them.
pub(in crate::emit) fn read(
    arena: &Arena,
    item: &ItemImpl,
    constants: (Option<&Syntax>, Option<&Syntax>),
    globals: &value::Scope,
) -> Result<Option<Settings<Rational>>, EmitError> {
    let (mut settings, mut gate, mut limits) = (None, None, None);
    for entry in &item.items {
        let ImplItem::Fn(function) = entry else { return Err(unreadable(entry)) };
        if function.sig.ident == "try_new" {
            let body = function.block.stmts.iter().map(compact).collect::<String>();
            let constants = body
                .strip_prefix("parameters.check()?;letmodel=Self::new(parameters);letconstants=[")
                .and_then(|rest| rest.strip_suffix("];Fault::of_constants(constants)?;Ok(model)"));
            let are_fields =
                |list: &str| list.trim_end_matches(',').split(',').all(|value| value.starts_with("model."));
            if body != "parameters.check()?;Ok(Self::new(parameters))" && !constants.is_some_and(are_fields) {
                return Err(unreadable(&function.block));
            }
            continue;
        }
        let mut reader = Reader { arena, globals, constants, made: BTreeMap::new() };
        for statement in &function.block.stmts {
            match statement {
                Stmt::Local(local) => {
                    let (Pat::Ident(name), Some(init)) = (&local.pat, &local.init) else {
                        return Err(unreadable(statement));
                    };
                    let made = reader.expression(&init.expr)?;
                    reader.made.insert(name.ident.to_string(), made);
                }
                Stmt::Expr(last, None) => match reader.expression(last)? {
                    Made::Observer(made) => settings = Some(*made),
                    Made::Gate(limit) if function.sig.ident == "gate" => gate = Some(limit),
                    Made::Limits(made) if function.sig.ident == "limits" => limits = Some(made),
                    _ => return Err(unreadable(last)),
                },
                other => return Err(unreadable(other)),
            }
        }
    }
    Ok(settings.map(|settings| Settings { gate, limits, ..settings }))
}

struct Reader<'a> {
    arena: &'a Arena,
    globals: &'a value::Scope,
    /// The constants with the length of a window or of the past, and with the indices of the outputs of the rows.
    constants: (Option<&'a Syntax>, Option<&'a Syntax>),
    made: BTreeMap<String, Made>,
}

impl Reader<'_> {
    fn expression(&self, syntax: &Syntax) -> Result<Made, EmitError> {
        let unknown = || unreadable(syntax);
        match syntax {
            Syntax::Try(attempt) => self.expression(&attempt.expr),
            Syntax::Reference(reference) => self.expression(&reference.expr),
            Syntax::Call(call) => match compact(&call.func).as_str() {
                "Self::new" | "Self::try_new" if compact(&call.args) == "parameters" => {
                    Ok(Made::Model(Form::Own, [None, None]))
                }
                "SVector::from" => self.open(call).map_or_else(|| self.list(syntax), Ok),
                "Limits::none" if call.args.is_empty() => {
                    Ok(Made::Limits(Limits { outputs: Vec::new(), inputs: Vec::new(), gap: None }))
                }
                "Ok" if call.args.len() == 1 => self.expression(&call.args[0]),
                "SVector::repeat" => match compact(&call.args).as_str() {
                    "f64::INFINITY" | "f32::INFINITY" => Ok(Made::Infinite { above: true }),
                    "f64::NEG_INFINITY" | "f32::NEG_INFINITY" => Ok(Made::Infinite { above: false }),
                    _ => Err(unknown()),
                },
                function => {
                    let arguments = call.args.iter().map(|argument| self.expression(argument));
                    let arguments = arguments.collect::<Result<Vec<_>, _>>()?;
                    self.call(function, arguments).ok_or_else(unknown)
                }
            },
            Syntax::MethodCall(call) => {
                let receiver = self.expression(&call.receiver)?;
                let arguments = call.args.iter().map(|argument| self.expression(argument));
                let arguments = arguments.collect::<Result<Vec<_>, _>>()?;
                method(&call.method.to_string(), receiver, arguments).ok_or_else(unknown)
            }
            Syntax::Struct(given) if given.path.is_ident("Late") => {
                self.late(given).map(Made::Late).ok_or_else(unknown)
            }
            Syntax::Array(array) => outputs(array).map(Made::Outputs).ok_or_else(unknown),
            // A number of samples; numbers of the scalar have a point.
            Syntax::Lit(syn::ExprLit { lit: syn::Lit::Int(samples), .. }) => {
                Rational::from_decimal(samples.base10_digits()).map(Made::Number).map_err(|_| unknown())
            }
            Syntax::Path(_) => match compact(syntax).as_str() {
                "Hold::First" => Ok(Made::Hold(true)),
                "Hold::Zero" => Ok(Made::Hold(false)),
                ROWS => places(self.constants.1.ok_or_else(unknown)?).map(Made::Rows).ok_or_else(unknown),
                name => self.made.get(name).cloned().map_or_else(|| self.number(syntax), Ok),
            },
            _ => self.number(syntax),
        }
    }

    fn number(&self, syntax: &Syntax) -> Result<Made, EmitError> {
        match value::expression(self.arena, syntax, self.globals)? {
            Value::Scalar(value) => self.arena.as_number(value).map(Made::Number),
            _ => None,
        }
        .ok_or_else(|| unreadable(syntax))
    }

    /// A vector with entries that are infinite, all on one side.
    fn open(&self, call: &syn::ExprCall) -> Option<Made> {
        let Some(Syntax::Array(array)) = call.args.first() else { return None };
        let mut above = None;
        let mut entry = |entry: &Syntax| {
            let side = match compact(entry).as_str() {
                "f64::INFINITY" | "f32::INFINITY" => true,
                "f64::NEG_INFINITY" | "f32::NEG_INFINITY" => false,
                _ => {
                    return match self.number(entry).ok()? {
                        Made::Number(number) => Some(Some(number)),
                        _ => None,
                    };
                }
            };
            (*above.get_or_insert(side) == side).then_some(None)
        };
        let entries = array.elems.iter().map(&mut entry).collect::<Option<Vec<_>>>()?;
        above.map(|above| Made::Open(entries, above))
    }

    fn list(&self, syntax: &Syntax) -> Result<Made, EmitError> {
        let columns = value::expression(self.arena, syntax, self.globals)?.columns();
        let entries = columns.iter().flatten().flatten().map(|&entry| self.arena.as_number(entry));
        let entries = entries.collect::<Option<Vec<Rational>>>().ok_or_else(|| unreadable(syntax))?;
        Ok(Made::List(entries))
    }

    /// The outputs that arrive late.
    fn late(&self, given: &syn::ExprStruct) -> Option<Late<Rational>> {
        let field = |name: &str| {
            let found =
                given.fields.iter().find(|field| matches!(&field.member, syn::Member::Named(own) if own == name));
            found.map(|field| &field.expr)
        };
        let Made::List(delays) = self.expression(field("delays")?).ok()? else { return None };
        let Syntax::Array(is_expected) = field("is_expected")? else { return None };
        Some(Late {
            delays,
            rows: places(field("rows")?)?,
            is_expected: is_expected.elems.iter().map(|flag| compact(flag).parse().ok()).collect::<Option<_>>()?,
            instants: compact(self.constants.0?).parse().ok()?,
        })
    }

    /// The operator of the regression that a constructor gives for its arguments.
    fn operator(&self, function: &str, given: [Option<Made>; 3]) -> Option<Made> {
        use Made::{Hold, List, Number};
        Some(match (function, given) {
            // Samples are joined to no signal: the settings have straight lines then.
            ("SampledRegression::new", [Some(List(deviations)), None, None]) => {
                Made::Operator(Operator::Sampled(deviations), true)
            }
            ("Filter::new", [Some(Number(alpha)), Some(Hold(straight)), None]) => {
                Made::Operator(Operator::Filter(alpha), straight)
            }
            ("WindowedRegression::new", [Some(Hold(straight)), None, None]) => {
                let samples = Rational::from_decimal(&compact(self.constants.0?)).ok()?;
                Made::Operator(Operator::Window(samples), straight)
            }
            _ => return None,
        })
    }

    /// The value that a constructor of the runtime gives for its arguments.
    fn call(&self, function: &str, arguments: Vec<Made>) -> Option<Made> {
        use Made::{Bounded, List, Model, Number};
        let mut arguments = arguments.into_iter();
        let given = [arguments.next(), arguments.next(), arguments.next(), arguments.next()];
        Some(match (function, given) {
            ("Gradient::diagonal", [Some(List(gain)), None, None, None]) => Made::Estimator(Estimator::Gradient(gain)),
            (
                "NormalisedGradient::new",
                [Some(Made::Estimator(Estimator::Gradient(gain))), Some(Number(mu)), None, None],
            ) => Made::Estimator(Estimator::NormalisedGradient { gain, mu }),
            ("LeastSquares::diagonal", [Some(List(start)), Some(Number(forgetting)), None, None]) => {
                Made::Estimator(Estimator::LeastSquares(Covariance { start, forgetting, process_noise: None }))
            }
            (
                "AdaptiveLeastSquares::new",
                [Some(Made::Estimator(Estimator::LeastSquares(covariance))), Some(List(guess)), None, None],
            ) => Made::Estimator(Estimator::AdaptiveLeastSquares(covariance, guess)),
            ("Kreisselmeier::new", [Some(List(gain)), Some(Number(forgetting)), None, None]) => {
                Made::Extension(Extension::Kreisselmeier { gain, forgetting, finite_time: None })
            }
            ("Response::new", [Some(Made::Estimator(estimator)), None, None, None]) => {
                Made::Extension(response(estimator)?)
            }
            ("Drem::new", [Some(Made::Extension(extension)), Some(List(gain)), None, None]) => {
                Made::Estimator(Estimator::Drem { gain, extension })
            }
            ("FiniteTime::once", [Some(Made::Estimator(drem)), Some(Number(clip)), None, None]) => {
                finite(drem, FiniteTime { clip, period: None })?
            }
            ("FiniteTime::tracking", [Some(Made::Estimator(drem)), Some(Number(clip)), Some(Number(period)), None]) => {
                finite(drem, FiniteTime { clip, period: Some(period) })?
            }
            ("Bounded::new", [Some(Made::Estimator(estimator)), Some(lower), Some(upper), None]) => {
                Bounded(estimator, [bound(lower, false).ok()?, bound(upper, true).ok()?])
            }
            ("Gate::new", [Some(Number(limit)), Some(Number(patience)), None, None]) => {
                (patience == Rational::from(i64::from(PATIENCE))).then_some(Made::Gate(limit))?
            }
            ("Drift::Above", [Some(Number(bound)), None, None, None]) => Made::Rebase(Rebase::Above(bound)),
            ("Drift::Leak", [Some(Number(rate)), None, None, None]) => Made::Rebase(Rebase::Leak(rate)),
            ("OutputForm::new", [Some(Model(Form::Own, [None, None])), None, None, None]) => {
                Model(Form::Outputs(None), [None, None])
            }
            (
                "OutputForm::expecting",
                [Some(Model(Form::Own, [None, None])), Some(Made::Rows(rows)), Some(List(deviations)), None],
            ) => Model(Form::Outputs(Some((rows, deviations))), [None, None]),
            ("Within::new", [Some(Model(form, [None, None])), Some(lower), Some(upper), None]) => {
                Model(form, [bound(lower, false).ok()?, bound(upper, true).ok()?])
            }
            ("SampledRegression::new" | "Filter::new" | "WindowedRegression::new", [first, second, third, None]) => {
                self.operator(function, [first, second, third])?
            }
            ("Tuned::new", [Some(Made::Observer(settings)), Some(Made::Late(late)), None, None]) => {
                Made::Observer(Box::new(Settings { late: Some(late), ..*settings }))
            }
            (
                "Tuned::new" | "Tuned::with_regression" | "pebo_runtime::Observer::with_regression",
                [
                    Some(Model(form, within)),
                    Some(estimator),
                    Some(Made::Operator(operator, straight)),
                    Some(List(chi_0)),
                ],
            ) => {
                let (estimator, [lower, upper]) = match estimator {
                    Made::Estimator(estimator) => (estimator, [None, None]),
                    Bounded(estimator, bounds) => (estimator, bounds),
                    _ => return None,
                };
                if matches!(operator, Operator::Filter(_)) != (function == "Tuned::new") {
                    return None;
                }
                let (output, expected) = match form {
                    Form::Own => (false, None),
                    Form::Outputs(None) => (true, None),
                    Form::Outputs(Some((rows, deviations))) => {
                        let is_weight = matches!(&operator, Operator::Sampled(weights) if *weights == deviations);
                        (true, Some(is_weight.then_some(rows)?))
                    }
                };
                Made::Observer(Box::new(Settings {
                    operator,
                    output,
                    expected,
                    errors_in_variables: None,
                    feedthrough: None,
                    late: None,
                    straight,
                    estimator,
                    lower,
                    upper,
                    within,
                    rebase: None,
                    chi_0,
                    gate: None,
                    limits: None,
                }))
            }
            _ => return None,
        })
    }
}

/// The value that a method of the runtime's types gives for its receiver and argument.
fn method(name: &str, receiver: Made, arguments: Vec<Made>) -> Option<Made> {
    let mut arguments = arguments.into_iter();
    Some(match (name, receiver, arguments.next(), arguments.next()) {
        ("with_process_noise", Made::Estimator(Estimator::LeastSquares(covariance)), Some(Made::List(noise)), None) => {
            let process_noise = Some(noise);
            Made::Estimator(Estimator::LeastSquares(Covariance { process_noise, ..covariance }))
        }
        ("with_errors_in_variables", Made::Observer(settings), Some(Made::List(sensors)), None) => {
            Made::Observer(Box::new(Settings { errors_in_variables: Some(sensors), ..*settings }))
        }
        ("with_feedthrough", Made::Observer(settings), Some(Made::Outputs(outputs)), None) => {
            Made::Observer(Box::new(Settings { feedthrough: Some(outputs), ..*settings }))
        }
        ("rebasing", Made::Observer(settings), Some(Made::Number(samples)), None) => {
            Made::Observer(Box::new(Settings { rebase: Some(Rebase::Samples(samples)), ..*settings }))
        }
        ("without_drift", Made::Observer(settings), Some(Made::Rebase(rebase)), None) => {
            Made::Observer(Box::new(Settings { rebase: Some(rebase), ..*settings }))
        }
        ("outputs", Made::Limits(limits), Some(least), Some(most)) if limits.outputs.is_empty() => {
            Made::Limits(Limits { outputs: ranges(least, most)?, ..limits })
        }
        ("inputs", Made::Limits(limits), Some(least), Some(most)) if limits.inputs.is_empty() => {
            Made::Limits(Limits { inputs: ranges(least, most)?, ..limits })
        }
        ("gap", Made::Limits(limits), Some(Made::Number(longest)), None) => {
            Made::Limits(Limits { gap: Some(longest), ..limits })
        }
        _ => return None,
    })
}

/// The least and the greatest sample of each signal, where both are there or none is.
fn ranges(least: Made, greatest: Made) -> Option<Vec<Option<[Rational; 2]>>> {
    let side = |made: Made, above: bool| match made {
        Made::List(values) => Some(values.into_iter().map(Some).collect::<Vec<_>>()),
        Made::Open(values, side) if side == above => Some(values),
        _ => None,
    };
    let (least, greatest) = (side(least, false)?, side(greatest, true)?);
    let pairs = least.into_iter().zip(greatest).map(|pair| match pair {
        (Some(least), Some(greatest)) => Some(Some([least, greatest])),
        (None, None) => Some(None),
        _ => None,
    });
    pairs.collect()
}

/// A bound: a vector, or none where it is infinite on its own side.
fn bound(made: Made, side: bool) -> Result<Option<Vec<Rational>>, ()> {
    match made {
        Made::List(values) => Ok(Some(values)),
        Made::Infinite { above } if above == side => Ok(None),
        _ => Err(()),
    }
}

/// The indices of an array of which some may be none.
fn outputs(array: &syn::ExprArray) -> Option<Vec<Option<usize>>> {
    let output = |entry: &Syntax| match compact(entry).as_str() {
        "None" => Some(None),
        entry => entry.strip_prefix("Some(")?.strip_suffix(')')?.parse().ok().map(Some),
    };
    array.elems.iter().map(output).collect()
}

/// The numbers of an array of indices.
fn places(array: &Syntax) -> Option<Vec<usize>> {
    let Syntax::Array(array) = array else { return None };
    array.elems.iter().map(|place| compact(place).parse().ok()).collect()
}

/// The extension that is the response of an estimator.
fn response(estimator: Estimator<Rational>) -> Option<Extension<Rational>> {
    match estimator {
        Estimator::Gradient(gain) => Some(Extension::Gradient(gain)),
        Estimator::LeastSquares(covariance) => Some(Extension::LeastSquares(covariance)),
        _ => None,
    }
}

/// DREM that is exact after a finite time.
fn finite(drem: Estimator<Rational>, finite_time: FiniteTime<Rational>) -> Option<Made> {
    let Estimator::Drem { gain, extension: Extension::Kreisselmeier { gain: inner, forgetting, finite_time: None } } =
        drem
    else {
        return None;
    };
    let extension = Extension::Kreisselmeier { gain: inner, forgetting, finite_time: Some(finite_time) };
    Some(Made::Estimator(Estimator::Drem { gain, extension }))
}

/// Tokens without spaces.
fn compact(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string().split_whitespace().collect()
}
