//! The section `observer`, complete: what regression and estimator are run with.

use pebo_runtime::Hold;

use crate::analysis::Regression;
use crate::model::{self, Decimal, Observer, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics};

use super::estimator::MOST_MIXED;
use super::scope::Names;
use super::window::LONGEST;

/// Settings of an observer, with a value for each unknown where there may be one.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    /// What the regression goes through.
    pub(super) operator: Operator,
    /// How samples are joined.
    pub(super) hold: Hold,
    pub(super) estimator: Estimator,
    /// Between what each unknown is.
    pub(super) bounds: [Vec<f64>; 2],
    /// The extension at the start.
    pub(super) chi_0: Vec<f64>,
}

/// What the regression goes through.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operator {
    /// A filter of this bandwidth, in rad/s.
    Filter(f64),
    /// The mean over so many samples.
    Window(usize),
}

/// An estimator of the runtime library.
#[derive(Clone, Debug)]
pub(super) enum Estimator {
    Gradient(Vec<f64>),
    NormalisedGradient { gain: Vec<f64>, mu: f64 },
    LeastSquares(Covariance),
    Drem { gain: Vec<f64>, extension: Extension },
}

/// What least squares need.
#[derive(Clone, Debug)]
pub(super) struct Covariance {
    pub(super) start: Vec<f64>,
    pub(super) forgetting: f64,
}

/// The regressor extension of DREM.
#[derive(Clone, Debug)]
pub(super) enum Extension {
    Kreisselmeier { gain: Vec<f64>, forgetting: f64, finite_time: Option<FiniteTime> },
    Gradient(Vec<f64>),
    LeastSquares(Covariance),
}

/// Exactness after a finite time: once, or again and again where there is a period.
#[derive(Clone, Copy, Debug)]
pub(super) struct FiniteTime {
    pub(super) clip: f64,
    pub(super) period: Option<f64>,
}

impl Settings {
    /// The settings of a model with this regression; what is missing in the section is reported.
    pub(super) fn resolve(names: &Names, regression: &Regression, problems: &mut Diagnostics) -> Option<Self> {
        let unknowns = regression.eta.len();
        let written = &names.model.observer;
        let mut section = Section { names, written, unknowns, problems };
        let operator = section.operator();
        let estimator = section.estimator();
        let bounds = section.bounds();
        let chi_0 = section.values(&written.extension, names.plant.phi.len(), 0.0, "a start for each component of phi");
        Some(Self {
            operator: operator?,
            hold: match written.hold.as_ref().map(|hold| hold.value) {
                Some(model::Hold::ZeroOrder) => Hold::Zero,
                Some(model::Hold::FirstOrder) | None => Hold::First,
            },
            estimator: estimator?,
            bounds: bounds?,
            chi_0: chi_0?,
        })
    }
}

struct Section<'a> {
    names: &'a Names<'a>,
    written: &'a Observer,
    unknowns: usize,
    problems: &'a mut Diagnostics,
}

impl Section<'_> {
    fn lacks(&mut self, what: &str, help: String) {
        let message = format!("the simulation needs {what}");
        self.problems.push(Diagnostic::error(Code::SimulationIncomplete, self.names.section(), message).help(help));
    }

    fn operator(&mut self) -> Option<Operator> {
        let Some(window) = &self.written.window else {
            if self.written.filter.is_none() {
                self.lacks("the observer's filter", "add `observer: {filter: 1}`, in rad/s, or a `window`".to_owned());
            }
            return Some(Operator::Filter(self.written.filter.as_ref()?.value.to_f64()));
        };
        // A whole number above zero, which the model's own check has seen to.
        let wanted = window.value.to_f64();
        let samples = (1..=LONGEST).zip(1_u64..).find(|(_, number)| super::timing::real(*number) >= wanted);
        if samples.is_none() {
            let message = format!("a window of {} samples is too long to be simulated", window.value.text());
            self.problems.push(
                Diagnostic::error(Code::SimulationUnsupported, window.span, message)
                    .help(format!("the simulator has room for {LONGEST} samples: simulate the emitted code")),
            );
        }
        samples.map(|(samples, _)| Operator::Window(samples))
    }

    fn estimator(&mut self) -> Option<Estimator> {
        use model::Estimator as Name;
        let name = self.written.estimator();
        let missing: Vec<&str> = name.needs().iter().copied().filter(|key| self.written.place(key).is_none()).collect();
        for key in &missing {
            self.lacks(
                &format!("the `{key}` of the estimator `{}`", name.name()),
                format!(
                    "add `{key}` under `observer`: `pebo-gen explain setting-conflict` lists what each estimator has"
                ),
            );
        }
        let number = |number: &Option<Spanned<Decimal>>| number.as_ref().map(|number| number.value.to_f64());
        let written = self.written;
        let forgetting = number(&written.forgetting).unwrap_or(0.0);
        let gain = self.each(&written.gain, "a gain for each unknown");
        let regressor_gain = self.each(&written.regressor_gain, "a gain for each unknown");
        let start = self.each(&written.covariance, "a covariance for each unknown");
        let mixes = !matches!(name, Name::Gradient | Name::NormalisedGradient | Name::LeastSquares);
        if mixes && self.unknowns > MOST_MIXED {
            let message = format!("DREM of {} unknowns is too large to be simulated", self.unknowns);
            let place = written.estimator.as_ref().map_or(self.names.section(), |estimator| estimator.span);
            self.problems.push(Diagnostic::error(Code::SimulationUnsupported, place, message).help(format!(
                "the simulator has room for {MOST_MIXED}: simulate the emitted code, or choose `least-squares`"
            )));
            return None;
        }
        if !missing.is_empty() {
            return None;
        }
        let (gain, regressor_gain) = (gain?, regressor_gain?);
        let covariance = Covariance { start: start?, forgetting };
        let finite_time = number(&written.clip).map(|clip| FiniteTime { clip, period: number(&written.period) });
        let extension = match name {
            Name::Gradient => return Some(Estimator::Gradient(gain)),
            Name::NormalisedGradient => {
                return Some(Estimator::NormalisedGradient { gain, mu: number(&written.normalisation)? });
            }
            Name::LeastSquares => return Some(Estimator::LeastSquares(covariance)),
            Name::Drem | Name::FiniteTimeDrem => {
                Extension::Kreisselmeier { gain: regressor_gain, forgetting, finite_time }
            }
            Name::GradientDrem => Extension::Gradient(regressor_gain),
            Name::LeastSquaresDrem => Extension::LeastSquares(covariance),
        };
        Some(Estimator::Drem { gain, extension })
    }

    fn bounds(&mut self) -> Option<[Vec<f64>; 2]> {
        let written = &self.written.bounds;
        let lower = self.values(&written.lower, self.unknowns, f64::NEG_INFINITY, "a bound for each unknown");
        let upper = self.values(&written.upper, self.unknowns, f64::INFINITY, "a bound for each unknown");
        let (lower, upper) = (lower?, upper?);
        if let Some(crossed) = (0..self.unknowns).find(|&unknown| lower[unknown] > upper[unknown]) {
            let (below, above) = (&written.lower, &written.upper);
            let message = format!("no value lies within the bounds of unknown {}", crossed + 1);
            let (below, above) = (below.get(crossed).or(below.first())?, above.get(crossed).or(above.first())?);
            self.problems.push(
                Diagnostic::error(Code::NumberOutOfRange, below.span, message)
                    .also(above.span, "this upper bound is below the lower one")
                    .help("exchange them, or leave one of them out"),
            );
            return None;
        }
        Some([lower, upper])
    }

    /// A value for each unknown, or 1 where none is written.
    fn each(&mut self, written: &[Spanned<Decimal>], what: &str) -> Option<Vec<f64>> {
        self.values(written, self.unknowns, 1.0, what)
    }

    /// As many values as needed: all given, or one for all, or a substitute where the list is empty.
    fn values(&mut self, written: &[Spanned<Decimal>], count: usize, absent: f64, what: &str) -> Option<Vec<f64>> {
        match written {
            [] => Some(vec![absent; count]),
            [one] => Some(vec![one.value.to_f64(); count]),
            all if all.len() == count => Some(all.iter().map(|value| value.value.to_f64()).collect()),
            all => {
                let message = format!("{} values are given, and {count} are expected: {what}", all.len());
                self.problems.push(
                    Diagnostic::error(Code::WrongShape, all[0].span.to(all[all.len() - 1].span), message)
                        .help(format!("write {count} values, or one for all")),
                );
                None
            }
        }
    }
}
