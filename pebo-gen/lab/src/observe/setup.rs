//! The section `observer`, complete: what regression and estimator are run with.

use pebo_runtime::{Drift, Hold};

use crate::settings::{Known, Prediction, Tuned, start};
use pebo_cas::Rational;
use pebo_design::analysis::{Derivation, LeftInverse, Regression};
use pebo_design::model::{self, Decimal, Observer};
use pebo_design::plant::settings;
use pebo_design::source::{Code, Diagnostic, Diagnostics};

use super::request::Asked;
use super::sizes::{LONGEST, MOST_MIXED};

/// Settings of an observer, with a value for each unknown where there may be one.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    /// What the regression goes through.
    pub(crate) operator: Operator,
    /// Whether the outputs themselves are the regressand.
    pub(crate) output: bool,
    /// The places of the outputs of the rows, where estimates are made of the outputs that are expected.
    pub(crate) expected: Option<Vec<usize>>,
    /// How samples are joined.
    pub(crate) hold: Hold,
    pub(crate) estimator: Estimator,
    /// Between what each unknown is.
    pub(crate) bounds: [Vec<f64>; 2],
    /// Between what each recovered state is.
    pub(crate) within: [Vec<f64>; 2],
    /// When the extension starts again from the estimate, if it does.
    pub(crate) rebase: Option<Rebase>,
    /// The extension at the start.
    pub(crate) chi_0: Vec<f64>,
    /// The limit of the gate that refuses outliers.
    pub(crate) gate: Option<f64>,
    /// What samples may be.
    pub(crate) limits: Option<Limits>,
    /// What the settings were derived from, if the author did not choose them.
    pub(crate) known: Option<Known>,
    /// How the errors of the estimates are predicted, where the numbers are known.
    pub(crate) prediction: Option<Prediction>,
}

/// What the regression goes through.
#[derive(Clone, Debug)]
pub(crate) enum Operator {
    /// A filter of this bandwidth, in rad/s.
    Filter(f64),
    /// The mean over so many samples.
    Window(usize),
    /// Each sample by itself, weighed by the standard deviation of each row.
    Sampled(Vec<f64>),
}

/// An estimator of the runtime library.
pub(crate) type Estimator = settings::Estimator<f64>;

/// When the extension starts again from the estimate, as the runtime has it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Rebase {
    /// After so many samples.
    Samples(u32),
    /// In another form.
    Drift(Drift<f64>),
}

impl Rebase {
    /// That of a section whose numbers the model's own check has seen to.
    fn of(written: settings::Rebase<f64>) -> Option<Self> {
        Some(match written {
            settings::Rebase::Samples(wanted) => Self::Samples(whole(wanted)?),
            settings::Rebase::Above(bound) => Self::Drift(Drift::Above(bound)),
            settings::Rebase::Leak(rate) => Self::Drift(Drift::Leak(rate)),
        })
    }
}

/// What samples may be.
pub(crate) type Limits = settings::Limits<f64>;

/// What least squares need.
pub(crate) type Covariance = settings::Covariance<f64>;

/// The regressor extension of DREM.
pub(crate) type Extension = settings::Extension<f64>;

/// Exactness after a finite time.
pub(crate) type FiniteTime = settings::FiniteTime<f64>;

impl Settings {
    /// The settings of a model with this regression; what is missing in the section is reported.
    pub(crate) fn resolve(
        asked: &Asked,
        derivation: &Derivation,
        (regression, inverse): (&Regression, &LeftInverse),
        period: Option<f64>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let (unknowns, states) = (regression.eta.len(), inverse.x.len());
        let written = &asked.model.observer;
        if !written.has_gains() {
            return Self::of_known(asked, (derivation, states), period, problems);
        }
        let mut section = Section { asked, written, problems };
        section.operator();
        section.estimator(unknowns);
        let sizes = (unknowns, asked.plant.phi.len(), states);
        let read = |number: &Decimal| Some(number.to_f64());
        let resolved = settings::Settings::resolve(written, sizes, read, section.problems)?;
        let mixes = matches!(resolved.estimator, Estimator::Drem { .. });
        if mixes && unknowns > MOST_MIXED {
            return None;
        }
        let begun = if written.extension.is_empty() { start(asked.model, asked.plant, derivation) } else { None };
        let begun = begun.map(|z| z.iter().map(Rational::to_f64).collect());
        Some(Self {
            operator: match resolved.operator {
                settings::Operator::Filter(alpha) => Operator::Filter(alpha),
                settings::Operator::Window(wanted) => Operator::Window(samples(wanted)?),
                settings::Operator::Sampled(deviations) => Operator::Sampled(deviations),
            },
            output: resolved.output,
            expected: resolved.expected,
            hold: if resolved.straight { Hold::First } else { Hold::Zero },
            estimator: resolved.estimator,
            rebase: match resolved.rebase {
                Some(written) => Some(Rebase::of(written)?),
                None => None,
            },
            bounds: bounds([resolved.lower, resolved.upper], unknowns),
            within: bounds(resolved.within, states),
            chi_0: begun.unwrap_or(resolved.chi_0),
            gate: None,
            limits: Limits::of(asked.model, read),
            known: None,
            prediction: None,
        })
    }

    /// The settings that known numbers come to: those of the emitted code.
    fn of_known(
        asked: &Asked,
        (derivation, states): (&Derivation, usize),
        period: Option<f64>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let before = problems.has_errors();
        let Some(tuned) = Tuned::of(asked.model, asked.plant, derivation, period, problems) else {
            if before || !problems.has_errors() {
                let message = format!("{} needs the observer's numbers", asked.who);
                problems.push(Diagnostic::error(Code::SimulationIncomplete, asked.section, message).help(
                    "add `observer: {sensors: .., start: .., disturbance: ..}` with standard deviations:                      docs/estimators.md has examples",
                ));
            }
            return None;
        };
        let settings = tuned.settings;
        let all = |values: &[Rational]| values.iter().map(Rational::to_f64).collect::<Vec<f64>>();
        let estimator = match &settings.estimator {
            settings::Estimator::LeastSquares(settings::Covariance { start, forgetting, process_noise }) => {
                Estimator::LeastSquares(Covariance {
                    start: all(start),
                    forgetting: forgetting.to_f64(),
                    process_noise: process_noise.as_deref().map(all),
                })
            }
            // Known numbers come to least squares.
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
            limits: Limits::of(asked.model, |number| Some(number.to_f64())),
            known: tuned.known,
            prediction: Some(tuned.prediction),
        })
    }
}

/// Bounds from below and from above, infinite where there are none.
fn bounds([lower, upper]: [Option<Vec<f64>>; 2], count: usize) -> [Vec<f64>; 2] {
    let or = |bound: Option<Vec<f64>>, infinite| bound.unwrap_or_else(|| vec![infinite; count]);
    [or(lower, f64::NEG_INFINITY), or(upper, f64::INFINITY)]
}

/// As many samples, if there is room for them: a whole number above zero, which the model's own check has seen to.
fn samples(wanted: f64) -> Option<usize> {
    let found = (1..=LONGEST).zip(1_u64..).find(|(_, number)| crate::timing::real(*number) >= wanted);
    found.map(|(samples, _)| samples)
}

/// A whole number above zero that `u32` holds, which the model's own check has seen to.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is tested before")]
fn whole(wanted: f64) -> Option<u32> {
    (wanted >= 1.0 && wanted <= f64::from(u32::MAX)).then_some(wanted as u32)
}

struct Section<'a> {
    asked: &'a Asked<'a>,
    written: &'a Observer,
    problems: &'a mut Diagnostics,
}

impl Section<'_> {
    fn lacks(&mut self, what: &str, help: String) {
        let message = format!("{} needs {what}", self.asked.who);
        self.problems.push(Diagnostic::error(Code::SimulationIncomplete, self.asked.section, message).help(help));
    }

    /// Reports that there is neither filter nor window, or no room for the window.
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

    /// Reports what the estimator needs and the section lacks, and more unknowns than there is room for.
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
            let place = self.written.estimator.as_ref().map_or(self.asked.section, |estimator| estimator.span);
            self.problems.push(Diagnostic::error(Code::SimulationUnsupported, place, message).help(format!(
                "the simulator has room for {MOST_MIXED}: simulate the emitted code, or choose `least-squares`"
            )));
        }
    }
}
