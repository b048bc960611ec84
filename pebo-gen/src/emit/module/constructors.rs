//! Constructors beside `new`: of the model with checked parameters, and of the observer with the model's settings.
//!
//! In: the settings, exact. Out: the type `Tuned`, and functions that `tuning` can read. Each list of numbers has a
//! statement of its own, so that every call is short.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::{Module, Scope, doc, permission};
use crate::emit::definition::INSTANTS;
use crate::emit::expression::{ident, number};
use crate::emit::names::camel;
use pebo_cas::Rational;
use pebo_design::plant::settings::{
    Covariance, Estimator, Extension, FiniteTime, Late, Limits, Operator, PATIENCE, Rebase, Settings,
};

impl Module<'_> {
    /// The constructors, with the types that they name.
    pub(in crate::emit) fn constructors(&self, scope: &mut Scope) -> Option<TokenStream> {
        let checked = (!self.asked.is_empty()).then(|| {
            let derived = self.derived_constants(scope);
            let body = if derived.is_empty() {
                quote! {
                    parameters.check()?;
                    Ok(Self::new(parameters))
                }
            } else {
                quote! {
                    parameters.check()?;
                    let model = Self::new(parameters);
                    let constants = [#(model.#derived),*];
                    Fault::of_constants(constants)?;
                    Ok(model)
                }
            };
            let constants = (!derived.is_empty()).then(|| {
                quote! {
                    /// `Fault::Constant` if what `new` computes from the parameters is not finite.
                }
            });
            quote! {
                /// The model with these parameters, if they are as the proofs assume.
                ///
                /// # Errors
                /// `Fault::Parameter` with the place of the first condition that does not hold.
                #constants
                pub fn try_new(parameters: &Parameters) -> Result<Self, Fault> { #body }
            }
        });
        let tuned = self.settings.map(|settings| self.tuned(settings));
        let observer = self.settings.map(|settings| self.observer(settings, scope));
        if checked.is_none() && observer.is_none() {
            return None;
        }
        let type_name = ident(&camel(&self.plant.name));
        let precision = permission::for_numbers(self.scalar, self.tuned_numbers().cloned());
        Some(quote! {
            #tuned
            #precision
            impl #type_name { #checked #observer }
        })
    }

    /// The fields that are no parameters but computed from these. The others were looked at by `check`.
    fn derived_constants(&self, scope: &Scope) -> Vec<Ident> {
        let fields = self.staged.constants.iter().zip(&scope.fields);
        let derived = fields.filter(|((_, value), _)| self.plant.arena.as_symbol(*value).is_none());
        derived.map(|(_, field)| ident(field)).collect()
    }

    /// The items of the runtime that the constructors use.
    pub(in crate::emit) fn constructors_use(&self) -> Vec<&'static str> {
        let Some(settings) = self.settings else { return Vec::new() };
        let mut names = vec!["Fault"];
        names.extend((!matches!(settings.operator, Operator::Sampled(_))).then_some("Hold"));
        names.push(match settings.operator {
            Operator::Filter(_) => "Filter",
            Operator::Window(_) => "WindowedRegression",
            Operator::Sampled(_) => "SampledRegression",
        });
        names.extend(settings.late.is_some().then_some("Late"));
        names.extend(settings.output.then_some("OutputForm"));
        names.extend(matches!(settings.rebase, Some(Rebase::Above(_) | Rebase::Leak(_))).then_some("Drift"));
        names.extend(settings.gate.is_some().then_some("Gate"));
        names.extend(settings.limits.is_some().then_some("Limits"));
        names.extend((settings.lower.is_some() || settings.upper.is_some()).then_some("Bounded"));
        names.extend(is_within(settings).then_some("Within"));
        names.extend_from_slice(match &settings.estimator {
            Estimator::Gradient(_) => &[],
            Estimator::NormalisedGradient { .. } => &["NormalisedGradient"],
            Estimator::LeastSquares(_) => &["LeastSquares"],
            Estimator::AdaptiveLeastSquares(..) => &["AdaptiveLeastSquares", "LeastSquares"],
            Estimator::Drem { extension, .. } => match extension {
                Extension::Kreisselmeier { finite_time: None, .. } => &["Drem", "Kreisselmeier"],
                Extension::Kreisselmeier { finite_time: Some(_), .. } => &["Drem", "FiniteTime", "Kreisselmeier"],
                Extension::Gradient(_) => &["Drem", "Response"],
                Extension::LeastSquares(_) => &["Drem", "LeastSquares", "Response"],
            },
        });
        names
    }

    /// The numbers that the constructors set.
    pub(in crate::emit) fn tuned_numbers(&self) -> impl Iterator<Item = &Rational> {
        self.settings.into_iter().flat_map(numbers)
    }

    /// The type of the observer, and the length of its window.
    fn tuned(&self, settings: &Settings<Rational>) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let unknowns = ident(if settings.output { "NO" } else { "NE" });
        let gradient = quote!(Gradient<#scalar, NE>);
        let squares = quote!(LeastSquares<#scalar, #unknowns>);
        let estimator = match &settings.estimator {
            Estimator::Gradient(_) => gradient,
            Estimator::NormalisedGradient { .. } => quote!(NormalisedGradient<#scalar, NE>),
            Estimator::LeastSquares(_) => squares,
            Estimator::AdaptiveLeastSquares(..) => quote!(AdaptiveLeastSquares<#scalar, NR, #unknowns>),
            Estimator::Drem { extension, .. } => {
                let inner = match extension {
                    Extension::Kreisselmeier { .. } => quote!(Kreisselmeier<#scalar, NE>),
                    Extension::Gradient(_) => quote!(Response<#scalar, #gradient, NR, NE>),
                    Extension::LeastSquares(_) => quote!(Response<#scalar, #squares, NR, NE>),
                };
                if matches!(extension, Extension::Kreisselmeier { finite_time: Some(_), .. }) {
                    quote!(FiniteTime<#scalar, #inner, NE>)
                } else {
                    quote!(Drem<#scalar, #inner, NE>)
                }
            }
        };
        let bounded = settings.lower.is_some() || settings.upper.is_some();
        let estimator = if bounded { quote!(Bounded<#scalar, #estimator, #unknowns>) } else { estimator };
        let summary = doc(&format!("The observer with the settings of the model. {}", self.words(settings)));
        let type_name = ident(&camel(&self.plant.name));
        let model = if settings.output { quote!(OutputForm<#type_name, #scalar, NR, NZ>) } else { quote!(#type_name) };
        let model = if is_within(settings) { quote!(Within<#model, #scalar, NX>) } else { model };
        let rows = settings.expected.as_ref().map(|places| {
            let places = places.iter().map(|place| proc_macro2::Literal::usize_unsuffixed(*place));
            quote! {
                /// The place in `y` of the output of each row of the regression.
                pub const ROWS: [usize; NR] = [#(#places),*];
            }
        });
        let instants = self.definitions.has_instants().then(|| {
            let number = ident(INSTANTS);
            quote!(- #number)
        });
        let past = settings.late.as_ref().map(|late| {
            let instants = proc_macro2::Literal::usize_unsuffixed(late.instants);
            quote! {
                /// The samples that may be on their way.
                pub const NP: usize = #instants;
            }
        });
        let (observer, past_size) = match settings.late {
            Some(_) => (ident("LateObserver"), Some(quote!(, NP))),
            None => (ident("Observer"), None),
        };
        match &settings.operator {
            Operator::Sampled(_) if settings.output => quote! {
                /// The unknowns of the output form: the outputs whose rates are used, and the coordinates.
                pub const NO: usize = NR #instants + NZ;
                #rows
                #past
                #summary
                pub type Tuned = pebo_runtime::#observer<
                    #model, #estimator, NX, NY, NU, NO, NR, NO, SampledRegression<#scalar, NR, NO> #past_size
                >;
            },
            Operator::Sampled(_) => quote! {
                #past
                #summary
                pub type Tuned = pebo_runtime::#observer<
                    #model, #estimator, NX, NY, NU, NZ, NR, NE, SampledRegression<#scalar, NR, NE> #past_size
                >;
            },
            Operator::Filter(_) if is_within(settings) => quote! {
                #summary
                pub type Tuned = pebo_runtime::Observer<#model, #estimator, NX, NY, NU, NZ, NR, NE>;
            },
            Operator::Filter(_) => quote!(#summary pub type Tuned = Observer<#estimator>;),
            Operator::Window(samples) => {
                let samples = syn::LitInt::new(&samples.to_string(), proc_macro2::Span::call_site());
                quote! {
                    /// The samples of the window.
                    pub const NW: usize = #samples;
                    #summary
                    pub type Tuned = pebo_runtime::Observer<
                        #model, #estimator, NX, NY, NU, NZ, NR, NE, WindowedRegression<#scalar, NR, NE, NW>
                    >;
                }
            }
        }
    }

    /// The function that builds it.
    fn observer(&self, settings: &Settings<Rational>, scope: &mut Scope) -> TokenStream {
        let statements = self.statements(settings, scope);
        let hold = ident(if settings.straight { "First" } else { "Zero" });
        let mut one = |value: &Rational| number(value, &mut |ratio| scope.ratio(ratio)).tokens;
        let chi_0 = settings.chi_0.iter().map(&mut one);
        let chi_0 = quote!(let chi_0 = SVector::from([#(#chi_0),*]););
        let (regression, built) = match &settings.operator {
            Operator::Filter(alpha) => {
                let alpha = one(alpha);
                let filter = quote!(let filter = Filter::new(#alpha, Hold::#hold)?;);
                (filter, quote!(Tuned::new(model, estimator, filter, chi_0)))
            }
            Operator::Window(_) => {
                let window = quote!(let window = WindowedRegression::new(Hold::#hold););
                (window, quote!(Tuned::with_regression(model, estimator, window, chi_0)))
            }
            Operator::Sampled(deviations) => {
                // The output form that expects outputs has them already.
                let list = settings.expected.is_none().then(|| list_of_deviations(deviations, &mut one));
                let sampled = quote! {
                    #list
                    let sampled = SampledRegression::new(&deviations)?;
                };
                let observer = if settings.late.is_some() { quote!(pebo_runtime::Observer) } else { quote!(Tuned) };
                (sampled, quote!(#observer::with_regression(model, estimator, sampled, chi_0)))
            }
        };
        let (sensors, built) = match &settings.errors_in_variables {
            Some(sensors) => {
                let sensors = sensors.iter().map(&mut one);
                let before = quote! {
                    let sensors = SVector::from([#(#sensors),*]);
                    let observer = #built?;
                };
                (Some(before), quote!(observer.with_errors_in_variables(&sensors)))
            }
            None => (None, built),
        };
        let (jumps, built) = match &settings.feedthrough {
            Some(outputs) => {
                let place = |output| {
                    let output = proc_macro2::Literal::usize_unsuffixed(output);
                    quote!(Some(#output))
                };
                let outputs = outputs.iter().map(|output| output.map_or_else(|| quote!(None), place));
                (Some(quote!(let observer = #built?;)), quote!(observer.with_feedthrough([#(#outputs),*])))
            }
            None => (None, built),
        };
        let rebased = settings.rebase.as_ref().map(|rebase| match rebase {
            Rebase::Samples(samples) => {
                let samples = syn::LitInt::new(&samples.to_string(), proc_macro2::Span::call_site());
                quote!(rebasing(#samples))
            }
            Rebase::Above(bound) => {
                let bound = one(bound);
                quote!(without_drift(Drift::Above(#bound)))
            }
            Rebase::Leak(rate) => {
                let rate = one(rate);
                quote!(without_drift(Drift::Leak(#rate)))
            }
        });
        let (plain, built) = match rebased {
            Some(rebased) => (Some(quote!(let observer = #built?;)), quote!(observer.#rebased)),
            None => (None, built),
        };
        let built = match &settings.late {
            Some(late) => late_observer(late, &built, &mut one),
            None => built,
        };
        let last = quote!(#regression #chi_0 #sensors #jumps #plain #built);
        let (model, errors) = if self.asked.is_empty() {
            (quote!(Self::new(parameters)), "A fault only where rounding moves a setting out of its range.")
        } else {
            let errors = "`Fault::Parameter` with the place of the first condition that does not hold; another only \
                          where rounding moves a setting out of its range.";
            (quote!(Self::try_new(parameters)?), errors)
        };
        let errors = doc(errors);
        let gate = settings.gate.as_ref().map(|limit| {
            let limit = number(limit, &mut |ratio| scope.ratio(ratio)).tokens;
            let scalar = ident(self.scalar.name());
            let patience = syn::LitInt::new(&PATIENCE.to_string(), proc_macro2::Span::call_site());
            quote! {
                /// What refuses outliers by the observer's innovation: to be asked before each step.
                ///
                /// # Errors
                /// A fault only where rounding moves the limit out of its range.
                pub fn gate() -> Result<Gate<#scalar>, Fault> {
                    Gate::new(#limit, #patience)
                }
            }
        });
        let limits = settings.limits.as_ref().map(|limits| self.limits(limits, scope));
        quote! {
            #gate
            #limits
            /// The observer with the settings of the model, before its first sample.
            ///
            /// # Errors
            #errors
            pub fn observer(parameters: &Parameters) -> Result<Tuned, Fault> {
                let model = #model;
                #statements
                #last
            }
        }
    }

    /// The function with the limits of samples.
    fn limits(&self, limits: &Limits<Rational>, scope: &mut Scope) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let mut one = |value: &Rational| number(value, &mut |ratio| scope.ratio(ratio)).tokens;
        let mut side = |each: &[Option<[Rational; 2]>], side: usize, absent: &str| {
            let absent = ident(absent);
            let value = |limit: &Option<[Rational; 2]>| {
                limit.as_ref().map_or_else(|| quote!(#scalar::#absent), |limit| one(&limit[side]))
            };
            let values = each.iter().map(value).collect::<Vec<_>>();
            quote!(SVector::from([#(#values),*]))
        };
        let mut range = |each: &[Option<[Rational; 2]>], method: &str| {
            (!each.is_empty()).then(|| {
                let (least, greatest) = (side(each, 0, "NEG_INFINITY"), side(each, 1, "INFINITY"));
                let method = ident(method);
                quote! {
                    let least = #least;
                    let greatest = #greatest;
                    let limits = limits.#method(&least, &greatest)?;
                }
            })
        };
        let (outputs, inputs) = (range(&limits.outputs, "outputs"), range(&limits.inputs, "inputs"));
        let last = if let Some(gap) = &limits.gap {
            let gap = one(gap);
            quote!(limits.gap(#gap))
        } else {
            quote!(Ok(limits))
        };
        quote! {
            /// What samples may be: to be asked before each step. After `Fault::Gap` the observer begins anew.
            ///
            /// # Errors
            /// A fault only where rounding moves a limit out of its range.
            pub fn limits() -> Result<Limits<#scalar, NY, NU>, Fault> {
                let limits = Limits::none();
                #outputs
                #inputs
                #last
            }
        }
    }

    /// The statements up to the estimator.
    fn statements(&self, settings: &Settings<Rational>, scope: &mut Scope) -> TokenStream {
        let mut one = |value: &Rational| number(value, &mut |ratio| scope.ratio(ratio)).tokens;
        let mut list = |name: &str, values: &[Rational]| {
            let (name, values) = (ident(name), values.iter().map(&mut one));
            quote!(let #name = SVector::from([#(#values),*]);)
        };
        let lists = lists(&settings.estimator, &mut list);
        let scalar = ident(self.scalar.name());
        let mut bound = |name: &str, values: Option<&Vec<Rational>>, absent: &str| {
            if let Some(values) = values {
                list(name, values)
            } else {
                let (name, absent) = (ident(name), ident(absent));
                quote!(let #name = SVector::repeat(#scalar::#absent);)
            }
        };
        let within = is_within(settings).then(|| {
            let [least, greatest] = &settings.within;
            let least = bound("least", least.as_ref(), "NEG_INFINITY");
            let greatest = bound("greatest", greatest.as_ref(), "INFINITY");
            quote!(#least #greatest let model = Within::new(model, &least, &greatest)?;)
        });
        let bounded = (settings.lower.is_some() || settings.upper.is_some()).then(|| {
            let lower = bound("lower", settings.lower.as_ref(), "NEG_INFINITY");
            let upper = bound("upper", settings.upper.as_ref(), "INFINITY");
            quote!(#lower #upper let estimator = Bounded::new(estimator, &lower, &upper)?;)
        });
        let estimator = match &settings.estimator {
            Estimator::Gradient(_) => quote!(let estimator = Gradient::diagonal(&gain)?;),
            Estimator::NormalisedGradient { mu, .. } => {
                let mu = one(mu);
                quote! {
                    let gradient = Gradient::diagonal(&gain)?;
                    let estimator = NormalisedGradient::new(gradient, #mu)?;
                }
            }
            Estimator::LeastSquares(Covariance { forgetting, process_noise, .. })
            | Estimator::AdaptiveLeastSquares(Covariance { forgetting, process_noise, .. }, _) => {
                let forgetting = one(forgetting);
                let wanders = process_noise
                    .is_some()
                    .then(|| quote!(let estimator = estimator.with_process_noise(&process_noise)?;));
                let adapts = matches!(settings.estimator, Estimator::AdaptiveLeastSquares(..))
                    .then(|| quote!(let estimator = AdaptiveLeastSquares::new(estimator, &guess)?;));
                quote!(let estimator = LeastSquares::diagonal(&covariance, #forgetting)?; #wanders #adapts)
            }
            Estimator::Drem { extension, .. } => match extension {
                Extension::Kreisselmeier { forgetting, finite_time, .. } => {
                    let forgetting = one(forgetting);
                    let finite = finite_time.as_ref().map(|FiniteTime { clip, period }| {
                        let clip = one(clip);
                        match period.as_ref().map(&mut one) {
                            None => quote!(let estimator = FiniteTime::once(estimator, #clip)?;),
                            Some(period) => quote!(let estimator = FiniteTime::tracking(estimator, #clip, #period)?;),
                        }
                    });
                    quote! {
                        let extension = Kreisselmeier::new(&regressor_gain, #forgetting)?;
                        let estimator = Drem::new(extension, &gain)?;
                        #finite
                    }
                }
                Extension::Gradient(_) => quote! {
                    let gradient = Gradient::diagonal(&regressor_gain)?;
                    let extension = Response::new(gradient)?;
                    let estimator = Drem::new(extension, &gain)?;
                },
                Extension::LeastSquares(Covariance { forgetting, .. }) => {
                    let forgetting = one(forgetting);
                    quote! {
                        let squares = LeastSquares::diagonal(&covariance, #forgetting)?;
                        let extension = Response::new(squares)?;
                        let estimator = Drem::new(extension, &gain)?;
                    }
                }
            },
        };
        let output = settings.output.then(|| {
            if let (Some(_), Operator::Sampled(deviations)) = (&settings.expected, &settings.operator) {
                let list = list_of_deviations(deviations, &mut one);
                quote!(#list let model = OutputForm::expecting(model, ROWS, &deviations)?;)
            } else {
                quote!(let model = OutputForm::new(model);)
            }
        });
        quote!(#output #within #lists #estimator #bounded)
    }
}

/// The statement with the standard deviations of the rows of samples.
fn list_of_deviations(deviations: &[Rational], one: &mut impl FnMut(&Rational) -> TokenStream) -> TokenStream {
    let deviations = deviations.iter().map(one);
    quote!(let deviations = SVector::from([#(#deviations),*]);)
}

/// The observer whose outputs arrive late, from one on time.
fn late_observer(
    late: &Late<Rational>,
    on_time: &TokenStream,
    one: &mut impl FnMut(&Rational) -> TokenStream,
) -> TokenStream {
    let delays = late.delays.iter().map(one);
    let rows = late.rows.iter().map(|row| proc_macro2::Literal::usize_unsuffixed(*row));
    let is_expected = late.is_expected.iter().map(|expected| ident(if *expected { "true" } else { "false" }));
    quote! {
        let on_time = #on_time?;
        let delays = SVector::from([#(#delays),*]);
        let late = Late { delays, rows: [#(#rows),*], is_expected: [#(#is_expected),*] };
        Tuned::new(on_time, late)
    }
}

/// The statements with the lists of numbers of an estimator.
fn lists(estimator: &Estimator<Rational>, list: &mut impl FnMut(&str, &[Rational]) -> TokenStream) -> TokenStream {
    match estimator {
        Estimator::Gradient(gain) | Estimator::NormalisedGradient { gain, .. } => list("gain", gain),
        Estimator::LeastSquares(covariance) | Estimator::AdaptiveLeastSquares(covariance, _) => {
            let noise = covariance.process_noise.as_ref().map(|noise| list("process_noise", noise));
            let start = list("covariance", &covariance.start);
            let guess = match estimator {
                Estimator::AdaptiveLeastSquares(_, guess) => Some(list("guess", guess)),
                _ => None,
            };
            quote!(#start #noise #guess)
        }
        Estimator::Drem { gain, extension } => {
            let inner = match extension {
                Extension::Kreisselmeier { gain, .. } | Extension::Gradient(gain) => list("regressor_gain", gain),
                Extension::LeastSquares(covariance) => list("covariance", &covariance.start),
            };
            let gain = list("gain", gain);
            quote!(#inner #gain)
        }
    }
}

/// Estimates of states are kept within bounds.
fn is_within(settings: &Settings<Rational>) -> bool {
    settings.within.iter().any(Option::is_some)
}

/// All numbers of the settings but the length of a window.
fn numbers(settings: &Settings<Rational>) -> Vec<&Rational> {
    let Settings { operator, estimator, lower, upper, within: [least, greatest], chi_0, gate, limits, rebase, .. } =
        settings;
    let lists = [lower, upper, least, greatest, &settings.errors_in_variables].into_iter().flatten();
    let mut numbers: Vec<&Rational> = lists.chain([chi_0]).flatten().chain(gate).collect();
    numbers.extend(settings.late.iter().flat_map(|late| &late.delays));
    if let Some(Limits { outputs, inputs, gap }) = limits {
        numbers.extend(outputs.iter().chain(inputs).flatten().flatten().chain(gap));
    }
    // Samples are counted, not computed with.
    numbers.extend(rebase.iter().filter(|rebase| !matches!(rebase, Rebase::Samples(_))).map(Rebase::number));
    match operator {
        Operator::Filter(alpha) => numbers.push(alpha),
        Operator::Window(_) => {}
        Operator::Sampled(deviations) => numbers.extend(deviations),
    }
    match estimator {
        Estimator::Gradient(gain) => numbers.extend(gain),
        Estimator::NormalisedGradient { gain, mu } => numbers.extend(gain.iter().chain([mu])),
        Estimator::LeastSquares(covariance) => numbers.extend(covariance.numbers()),
        Estimator::AdaptiveLeastSquares(covariance, guess) => numbers.extend(covariance.numbers().chain(guess)),
        Estimator::Drem { gain, extension } => {
            numbers.extend(gain);
            match extension {
                Extension::Kreisselmeier { gain, forgetting, finite_time } => {
                    numbers.extend(gain.iter().chain([forgetting]));
                    let finite = finite_time.iter().flat_map(|finite| [&finite.clip].into_iter().chain(&finite.period));
                    numbers.extend(finite);
                }
                Extension::Gradient(gain) => numbers.extend(gain),
                Extension::LeastSquares(Covariance { start, forgetting, .. }) => {
                    numbers.extend(start.iter().chain([forgetting]));
                }
            }
        }
    }
    numbers
}
