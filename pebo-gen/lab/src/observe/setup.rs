//! The settings of regression and estimator in a run: the section `observer`, completed.

use pebo_runtime::{Drift, Hold};

use crate::settings::{DerivedSettings, KnownNumbers, Prediction, Shown, start};
use pebo_cas::Rational;
use pebo_design::analysis::{Derivation, LeftInverse, Regression};
use pebo_design::model::{self, Decimal, Observer};
use pebo_design::plant::settings;
use pebo_design::source::{Code, Diagnostic, Diagnostics};

use super::request::Request;
use super::sizes::{LONGEST, MOST_MIXED};

/// Settings of an observer, with lists expanded to one value for each unknown.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    /// The operator of the regression.
    pub(crate) operator: Operator,
    /// True in the output form, where the outputs themselves are the regressand.
    pub(crate) output: bool,
    /// The indices of the rows' outputs, where the model is evaluated at the expected outputs.
    pub(crate) expected: Option<Vec<usize>>,
    /// The standard deviations of the sensors, where their noise is in the factor of the unknown too.
    pub(crate) errors_in_variables: Option<Vec<f64>>,
    /// For each row the output that it gives by its value with an input in it, where that drives the cascade too.
    pub(crate) feedthrough: Option<Vec<Option<usize>>>,
    /// The outputs that arrive late, if any does.
    pub(crate) late: Option<settings::Late<f64>>,
    /// The hold between samples.
    pub(crate) hold: Hold,
    pub(crate) estimator: Estimator,
    /// The bounds of each unknown.
    pub(crate) bounds: [Vec<f64>; 2],
    /// The bounds of each recovered state.
    pub(crate) within: [Vec<f64>; 2],
    /// The trigger of re-basing, if there is one.
    pub(crate) rebase: Option<Rebase>,
    /// The extension at the start.
    pub(crate) chi_0: Vec<f64>,
    /// The limit of the gate that refuses outliers.
    pub(crate) gate: Option<f64>,
    /// The ranges of samples.
    pub(crate) limits: Option<Limits>,
    /// The known numbers that the settings were derived from, if the author did not choose them.
    pub(crate) known: Option<KnownNumbers>,
    /// The prediction of the estimates' errors, where the numbers are known.
    pub(crate) prediction: Option<Prediction>,
}

/// The operator of the regression.
#[derive(Clone, Debug)]
pub(crate) enum Operator {
    /// A filter of this bandwidth, in rad/s.
    Filter(f64),
    /// The mean over this number of samples.
    Window(usize),
    /// Each sample by itself, weighted by the standard deviation of each row.
    Sampled(Vec<f64>),
}

/// An estimator of the runtime library.
pub(crate) type Estimator = settings::Estimator<f64>;

/// The trigger of re-basing in the runtime's types.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rebase {
    /// After this number of samples.
    Samples(u32),
    /// In a form without drift.
    Drift(Drift<f64>),
}

impl Rebase {
    /// The trigger of a section, whose numbers the model's own check has admitted.
    fn of(written: settings::Rebase<f64>) -> Option<Self> {
        Some(match written {
            settings::Rebase::Samples(wanted) => Self::Samples(whole(wanted)?),
            settings::Rebase::Above(bound) => Self::Drift(Drift::Above(bound)),
            settings::Rebase::Leak(rate) => Self::Drift(Drift::Leak(rate)),
        })
    }
}

/// The ranges of samples.
pub(crate) type Limits = settings::Limits<f64>;

/// The settings of least squares.
pub(crate) type Covariance = settings::Covariance<f64>;

/// The regressor extension of DREM.
pub(crate) type Extension = settings::Extension<f64>;

/// Exactness after a finite time.
pub(crate) type FiniteTime = settings::FiniteTime<f64>;

impl Settings {
    /// The settings of a model with this regression; missing keys are reported.
    pub(crate) fn resolve(
        request: &Request,
        derivation: &Derivation,
        (regression, inverse): (&Regression, &LeftInverse),
        shown: &Shown,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let (unknowns, states) = (regression.eta.len(), inverse.x.len());
        let written = &request.model.observer;
        if !written.has_gains() {
            return Self::of_known(request, (derivation, states), shown, problems);
        }
        if let Some(refusal) = crate::settings::refused(request.model, request.plant, derivation) {
            problems.push(refusal);
            return None;
        }
        let mut section = Section { request, written, problems };
        section.operator();
        section.estimator(unknowns);
        let sizes = (unknowns, request.plant.phi.len(), states);
        let read = |number: &Decimal| Some(number.to_f64());
        let resolved = settings::Settings::resolve(written, sizes, read, section.problems)?;
        let mixes = matches!(resolved.estimator, Estimator::Drem { .. });
        if mixes && unknowns > MOST_MIXED {
            return None;
        }
        let begun =
            if written.extension.is_empty() { start(request.model, request.plant, derivation, shown) } else { None };
        let begun = begun.map(|z| z.iter().map(Rational::to_f64).collect());
        Some(Self {
            operator: match resolved.operator {
                settings::Operator::Filter(alpha) => Operator::Filter(alpha),
                settings::Operator::Window(wanted) => Operator::Window(samples(wanted)?),
                settings::Operator::Sampled(deviations) => Operator::Sampled(deviations),
            },
            output: resolved.output,
            expected: resolved.expected,
            errors_in_variables: resolved.errors_in_variables,
            feedthrough: resolved.feedthrough,
            late: resolved.late,
            hold: if resolved.straight { Hold::First } else { Hold::Zero },
            estimator: resolved.estimator,
            rebase: match resolved.rebase {
                _ if regression.is_at_estimate() => Some(Rebase::Samples(1)),
                Some(written) => Some(Rebase::of(written)?),
                None => None,
            },
            bounds: bounds([resolved.lower, resolved.upper], unknowns),
            within: bounds(resolved.within, states),
            chi_0: begun.unwrap_or(resolved.chi_0),
            gate: None,
            limits: Limits::of(request.model, read),
            known: None,
            prediction: None,
        })
    }

    /// The settings derived from known numbers: those of the emitted code.
    fn of_known(
        request: &Request,
        (derivation, states): (&Derivation, usize),
        shown: &Shown,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let Some(derived) = DerivedSettings::of(request.model, request.plant, derivation, shown, problems) else {
            if !problems.has_errors() {
                let message = format!("{} needs the observer's numbers", request.who);
                problems.push(Diagnostic::error(Code::SimulationIncomplete, request.section, message).help(
                    "add `observer: {sensors: .., start: .., disturbance: ..}` with standard deviations: docs/estimators.md has examples",
                ));
            }
            return None;
        };
        let settings = derived.settings;
        let all = |values: &[Rational]| values.iter().map(Rational::to_f64).collect::<Vec<f64>>();
        let rounded = |settings::Covariance { start, forgetting, process_noise }: &settings::Covariance<Rational>| {
            let process_noise = process_noise.as_deref().map(all);
            Covariance { start: all(start), forgetting: forgetting.to_f64(), process_noise }
        };
        let estimator = match &settings.estimator {
            settings::Estimator::LeastSquares(covariance) => Estimator::LeastSquares(rounded(covariance)),
            settings::Estimator::AdaptiveLeastSquares(covariance, guess) => {
                Estimator::AdaptiveLeastSquares(rounded(covariance), all(guess))
            }
            settings::Estimator::NormalisedGradient { gain, mu } => {
                Estimator::NormalisedGradient { gain: all(gain), mu: mu.to_f64() }
            }
            // Known numbers lead to no other.
            _ => return None,
        };
        let chi_0 = all(&settings.chi_0);
        Some(Self {
            operator: match &settings.operator {
                settings::Operator::Filter(alpha) => Operator::Filter(alpha.to_f64()),
                settings::Operator::Window(wanted) => Operator::Window(samples(wanted.to_f64())?),
                settings::Operator::Sampled(deviations) => Operator::Sampled(all(deviations)),
            },
            output: settings.output,
            expected: settings.expected,
            errors_in_variables: settings.errors_in_variables.as_deref().map(all),
            feedthrough: settings.feedthrough,
            late: settings.late.as_ref().map(|late| late.map(Rational::to_f64)),
            hold: if settings.straight { Hold::First } else { Hold::Zero },
            rebase: match &settings.rebase {
                Some(written) => Some(Rebase::of(written.map(Rational::to_f64))?),
                None => None,
            },
            bounds: bounds([None, None], estimator.unknowns()),
            within: bounds(settings.within.map(|bound| bound.as_deref().map(all)), states),
            estimator,
            chi_0,
            gate: settings.gate.as_ref().map(Rational::to_f64),
            limits: Limits::of(request.model, |number| Some(number.to_f64())),
            known: derived.known,
            prediction: Some(derived.prediction),
        })
    }
}

/// Bounds from below and from above, infinite where there are none.
fn bounds([lower, upper]: [Option<Vec<f64>>; 2], count: usize) -> [Vec<f64>; 2] {
    let or = |bound: Option<Vec<f64>>, infinite| bound.unwrap_or_else(|| vec![infinite; count]);
    [or(lower, f64::NEG_INFINITY), or(upper, f64::INFINITY)]
}

/// This number of samples, if there is room: the model's own check has admitted a whole number above zero only.
fn samples(wanted: f64) -> Option<usize> {
    let found = (1..=LONGEST).zip(1_u64..).find(|(_, number)| crate::timing::real(*number) >= wanted);
    found.map(|(samples, _)| samples)
}

/// A whole number above zero in `u32`, which the model's own check has admitted.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is tested before")]
fn whole(wanted: f64) -> Option<u32> {
    (wanted >= 1.0 && wanted <= f64::from(u32::MAX)).then_some(wanted as u32)
}

struct Section<'a> {
    request: &'a Request<'a>,
    written: &'a Observer,
    problems: &'a mut Diagnostics,
}

impl Section<'_> {
    fn lacks(&mut self, what: &str, help: String) {
        let message = format!("{} needs {what}", self.request.who);
        self.problems.push(Diagnostic::error(Code::SimulationIncomplete, self.request.section, message).help(help));
    }

    /// Reports that filter and window are both missing, or that the window is too long.
    fn operator(&mut self) {
        let Some(window) = &self.written.window else {
            if self.written.filter.is_none() {
                self.lacks("the observer's filter", "add `observer: {filter: 1}`, in rad/s, or a `window`".to_owned());
            }
            return;
        };
        if samples(window.value.to_f64()).is_none() {
            let message = format!("a window of {} samples is too long to be simulated", window.value.text());
            self.problems.push(
                Diagnostic::error(Code::SimulationUnsupported, window.span, message)
                    .help(format!("the simulator has room for {LONGEST} samples: simulate the emitted code")),
            );
        }
    }

    /// Reports settings of the estimator that the section lacks, and too many unknowns.
    fn estimator(&mut self, unknowns: usize) {
        use model::Estimator as Name;
        let name = self.written.estimator();
        let missing: Vec<&str> =
            name.needs().iter().copied().filter(|key| self.written.span_of(key).is_none()).collect();
        for key in &missing {
            self.lacks(
                &format!("the `{key}` of the estimator `{}`", name.name()),
                format!(
                    "add `{key}` under `observer`: `pebo-gen explain setting-conflict` lists what each estimator has"
                ),
            );
        }
        let mixes = !matches!(name, Name::Gradient | Name::NormalisedGradient | Name::LeastSquares);
        if mixes && unknowns > MOST_MIXED {
            let message = format!("DREM of {unknowns} unknowns is too large to be simulated");
            let place = self.written.estimator.as_ref().map_or(self.request.section, |estimator| estimator.span);
            self.problems.push(Diagnostic::error(Code::SimulationUnsupported, place, message).help(format!(
                "the simulator has room for {MOST_MIXED}: simulate the emitted code, or choose `least-squares`"
            )));
        }
    }
}
