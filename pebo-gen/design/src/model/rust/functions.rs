//! Calls: methods and functions of floating-point numbers, and functions of the module.
//!
//! One thing with `evaluate`: to run a function is to evaluate its body, in which functions are called.

use syn::{Expr, ExprCall, ExprMethodCall};

use super::evaluate::Reader;
use super::items;
use super::refusal::{self, unsupported};
use super::spans::TokenSpans;
use super::value::{Locals, Value};
use crate::model::formula::{Decimal, Formula, Operator, PI, SizedFormula, Term};
use crate::source::{Code, Diagnostic, Span, listed, nearest};
use pebo_cas::Function;

/// Functions that Rust names differently than formulas do, or that are not analytic, with a replacement.
const REFUSED: &[(&str, &str)] = &[
    ("floor", "rounding is not continuous: leave it out of the formula"),
    ("ceil", "rounding is not continuous: leave it out of the formula"),
    ("round", "rounding is not continuous: leave it out of the formula"),
    ("trunc", "rounding is not continuous: leave it out of the formula"),
    ("rem_euclid", "declare a state that is an angle in the attribute: `angles(q = 2.0 * PI)`"),
    ("cbrt", "write `.powf(1.0 / 3.0)`, and state under `assume` that its base is positive"),
    ("exp_m1", "write `a.exp() - 1.0`"),
    ("ln_1p", "write `(1.0 + a).ln()`"),
];

/// Methods that this module spells out itself.
const OWN: &[&str] = &[
    "powi",
    "powf",
    "recip",
    "mul_add",
    "hypot",
    "clamp",
    "signum",
    "min",
    "max",
    "exp2",
    "log10",
    "log2",
    "sin_cos",
    "clone",
    "to_radians",
    "to_degrees",
];

type Constant = fn(Span) -> Result<SizedFormula, Diagnostic>;

/// The constants of `core::f64::consts` that have an exact meaning.
const CONSTANTS: &[(&str, Constant)] = &[
    ("PI", |at| Ok(pi(at))),
    ("TAU", |at| SizedFormula::binary(Operator::Multiply, decimal("2", at)?, pi(at), at)),
    ("FRAC_PI_2", |at| SizedFormula::binary(Operator::Divide, pi(at), decimal("2", at)?, at)),
    ("FRAC_PI_3", |at| SizedFormula::binary(Operator::Divide, pi(at), decimal("3", at)?, at)),
    ("FRAC_PI_4", |at| SizedFormula::binary(Operator::Divide, pi(at), decimal("4", at)?, at)),
    ("FRAC_PI_6", |at| SizedFormula::binary(Operator::Divide, pi(at), decimal("6", at)?, at)),
    ("FRAC_PI_8", |at| SizedFormula::binary(Operator::Divide, pi(at), decimal("8", at)?, at)),
    ("FRAC_1_PI", |at| SizedFormula::binary(Operator::Divide, decimal("1", at)?, pi(at), at)),
    ("FRAC_2_PI", |at| SizedFormula::binary(Operator::Divide, decimal("2", at)?, pi(at), at)),
    ("SQRT_2", |at| applied(Function::Sqrt, decimal("2", at)?, at)),
    ("FRAC_1_SQRT_2", |at| applied(Function::Sqrt, decimal("0.5", at)?, at)),
    ("LN_2", |at| applied(Function::Log, decimal("2", at)?, at)),
    ("LN_10", |at| applied(Function::Log, decimal("10", at)?, at)),
    ("E", |at| applied(Function::Exp, decimal("1", at)?, at)),
];

/// The constant of that name in `core::f64::consts`.
pub(super) fn mathematical(name: &str) -> Option<Constant> {
    CONSTANTS.iter().find(|(known, _)| *known == name).map(|row| row.1)
}

/// `name(..)` of the module, or `f64::name(a, ..)`.
pub(super) fn call(reader: &mut Reader<'_>, call: &ExprCall, locals: &mut Locals) -> Result<Value, Diagnostic> {
    let function = items::bare(&call.func);
    let Expr::Path(path) = function else {
        if matches!(function, Expr::Closure(_)) {
            return Err(refusal::expression(function, reader.spans));
        }
        return Err(unsupported(reader.spans.of(&call.func), "this function is not known here")
            .help("call a function of the module by its name"));
    };
    let Some(last) = path.path.segments.last() else {
        return Err(unsupported(reader.spans.of(path), "this is not a function"));
    };
    let name = last.ident.to_string();
    let first = path.path.segments.first().map(|segment| segment.ident.to_string()).unwrap_or_default();
    let own = path.path.segments.len() == 1 || first == "self";
    if own {
        let place = reader.spans.of(call);
        let Some(item) = reader.items.function(&name) else {
            return Err(no_such_function(reader, path, &name));
        };
        let arguments: Vec<Value> =
            call.args.iter().map(|argument| reader.value(argument, locals)).collect::<Result<_, _>>()?;
        return reader.run(item, arguments, place);
    }
    // `f64::sin(a)`, or by the name of a trait that floating-point numbers have.
    let of_type = path.path.segments.iter().rev().nth(1).map(|segment| segment.ident.to_string()).unwrap_or_default();
    if !matches!(of_type.as_str(), "f64" | "f32") && !of_type.starts_with(char::is_uppercase) {
        return Err(no_such_function(reader, path, &name));
    }
    if name == "from" && call.args.len() == 1 {
        return reader.converted(&call.args[0], locals);
    }
    let mut arguments = call.args.iter();
    let Some(receiver) = arguments.next() else {
        return Err(no_such_function(reader, path, &name));
    };
    let receiver = reader.number(receiver, locals)?;
    let arguments: Vec<&Expr> = arguments.collect();
    applied_method(reader, &name, &last.ident, receiver, &arguments, &Expr::Call(call.clone()), locals)
}

/// `a.name(..)`.
pub(super) fn method(reader: &mut Reader<'_>, call: &ExprMethodCall, locals: &mut Locals) -> Result<Value, Diagnostic> {
    let name = call.method.to_string();
    if matches!(name.as_str(), "clone" | "into") && call.args.is_empty() {
        return reader.value(&call.receiver, locals);
    }
    let receiver = match reader.value(&call.receiver, locals)? {
        Value::Number(receiver) => receiver,
        other => {
            let message = format!("methods of {} are not known here", other.kind());
            return Err(unsupported(reader.spans.of(&call.method), message)
                .help(format!("write a function of the module, and call it: `{name}(..)`")));
        }
    };
    let arguments: Vec<&Expr> = call.args.iter().collect();
    applied_method(reader, &name, &call.method, receiver, &arguments, &Expr::MethodCall(call.clone()), locals)
}

fn applied_method(
    reader: &mut Reader<'_>,
    name: &str,
    ident: &syn::Ident,
    receiver: SizedFormula,
    arguments: &[&Expr],
    whole: &Expr,
    locals: &mut Locals,
) -> Result<Value, Diagnostic> {
    let at = reader.spans.of(whole);
    let place = reader.spans.of(ident);
    let expected = |count: usize| {
        if arguments.len() == count { Ok(()) } else { Err(wrong_count(name, count, arguments.len(), at)) }
    };
    let binary = |operator, a, b| SizedFormula::binary(operator, a, b, at);
    let logarithm =
        |a, base| binary(Operator::Divide, applied(Function::Log, a, at)?, applied(Function::Log, base, at)?);
    let number = match name {
        "powi" => {
            expected(1)?;
            let exponent = exponent(reader, arguments[0])?;
            binary(Operator::Power, receiver, exponent)?
        }
        "powf" => {
            expected(1)?;
            let exponent = reader.number(arguments[0], locals)?;
            binary(Operator::Power, receiver, exponent)?
        }
        "recip" => {
            expected(0)?;
            binary(Operator::Divide, decimal("1", at)?, receiver)?
        }
        "mul_add" => {
            expected(2)?;
            let (factor, term) = (reader.number(arguments[0], locals)?, reader.number(arguments[1], locals)?);
            binary(Operator::Add, binary(Operator::Multiply, receiver, factor)?, term)?
        }
        "hypot" => {
            expected(1)?;
            let other = reader.number(arguments[0], locals)?;
            let square = |a: SizedFormula| binary(Operator::Power, a, decimal("2", at)?);
            applied(Function::Sqrt, binary(Operator::Add, square(receiver)?, square(other)?)?, at)?
        }
        "exp2" => {
            expected(0)?;
            binary(Operator::Power, decimal("2", at)?, receiver)?
        }
        "log10" | "log2" => {
            expected(0)?;
            let base = decimal(name.trim_start_matches("log"), at)?;
            logarithm(receiver, base)?
        }
        "to_radians" => {
            expected(0)?;
            let degree = binary(Operator::Divide, pi(at), decimal("180", at)?)?;
            binary(Operator::Multiply, receiver, degree)?
        }
        "to_degrees" => {
            expected(0)?;
            let radian = binary(Operator::Divide, decimal("180", at)?, pi(at))?;
            binary(Operator::Multiply, receiver, radian)?
        }
        // Not differentiable where Rust's 1 at zero differs from the 0 of formulas.
        "signum" => {
            expected(0)?;
            applied(Function::Sign, receiver, at)?
        }
        "min" | "max" => {
            expected(1)?;
            let function = if name == "min" { Function::Min } else { Function::Max };
            SizedFormula::call(function, vec![receiver, reader.number(arguments[0], locals)?], at)?
        }
        "clamp" => {
            expected(2)?;
            let (least, most) = (reader.number(arguments[0], locals)?, reader.number(arguments[1], locals)?);
            let above = SizedFormula::call(Function::Max, vec![receiver, least], at)?;
            SizedFormula::call(Function::Min, vec![above, most], at)?
        }
        "sin_cos" => {
            expected(0)?;
            let (sine, cosine) = (applied(Function::Sin, receiver.clone(), at)?, applied(Function::Cos, receiver, at)?);
            return Ok(Value::List(vec![Value::Number(sine), Value::Number(cosine)]));
        }
        "log" => {
            expected(1)?;
            let base = reader.number(arguments[0], locals)?;
            logarithm(receiver, base)?
        }
        _ => {
            if let Some((_, help)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
                return Err(unsupported(place, format!("formulas do not have the function `{name}`")).help(*help));
            }
            let Some(function) = Function::of_method(name) else { return Err(no_such_method(name, place)) };
            expected(function.row().arity - 1)?;
            let mut operands = vec![receiver];
            for argument in arguments {
                operands.push(reader.number(argument, locals)?);
            }
            SizedFormula::call(function, operands, at)?
        }
    };
    Ok(Value::Number(number))
}

/// The exponent of `powi`: an integer, which is one in Rust too.
fn exponent(reader: &mut Reader<'_>, expr: &Expr) -> Result<SizedFormula, Diagnostic> {
    if let Some(text) = reader.items.whole(expr) {
        return reader.whole(&text, expr);
    }
    Err(unsupported(reader.spans.of(expr), "this exponent is not known here")
        .help("write an integer, as in `a.powi(2)`; for other powers write `a.powf(0.5)`"))
}

fn no_such_function(reader: &mut Reader<'_>, path: &syn::ExprPath, name: &str) -> Diagnostic {
    let place = reader.spans.of(path);
    let written = TokenSpans::path(&path.path);
    let names = reader.items.functions.iter().map(|item| item.sig.ident.to_string()).collect::<Vec<_>>();
    let diagnostic = unsupported(place, format!("the function `{written}` is not known here"))
        .label("only functions of this module can be read");
    if Function::of_method(name).is_some() || OWN.contains(&name) {
        return diagnostic.help(format!("write it as a method, as in `a.{name}()`"));
    }
    match nearest(name, names.iter().map(String::as_str)) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None => diagnostic.help("move the function into the module"),
    }
}

/// The arguments in parentheses, without the receiver.
fn wrong_count(name: &str, wanted: usize, found: usize, at: Span) -> Diagnostic {
    let found = if found == 0 { "none".to_owned() } else { found.to_string() };
    let arguments = ["", "b", "b, c"].get(wanted).copied().unwrap_or("..");
    Diagnostic::error(Code::ArgumentCount, at, format!("`{name}` takes {wanted} in parentheses and has {found}"))
        .help(format!("write `a.{name}({arguments})`"))
}

fn no_such_method(name: &str, place: Span) -> Diagnostic {
    // Functions that Rust's numbers name differently are among our own.
    let otherwise = [Function::Sign, Function::Min, Function::Max, Function::Sat];
    let methods = || Function::table().iter().filter(|row| !otherwise.contains(&row.function));
    let known = || methods().map(|row| row.rust).chain(OWN.iter().copied());
    let diagnostic =
        Diagnostic::error(Code::UnknownFunction, place, format!("formulas do not have the function `{name}`"));
    match nearest(name, known()) {
        Some(near) => diagnostic.suggest(Some(near)),
        None => diagnostic.help(format!("the functions are {}", listed(known()))),
    }
}

fn pi(at: Span) -> SizedFormula {
    SizedFormula::leaf(Formula { span: at, term: Term::Name(PI.to_owned()) })
}

fn decimal(text: &str, at: Span) -> Result<SizedFormula, Diagnostic> {
    Ok(SizedFormula::leaf(Formula { span: at, term: Term::Number(Decimal::parse(text, at)?) }))
}

fn applied(function: Function, argument: SizedFormula, at: Span) -> Result<SizedFormula, Diagnostic> {
    SizedFormula::call(function, vec![argument], at)
}
