//! The section `observer`, resolved: a value for each unknown, of the estimator that is named and of nothing else.
//!
//! In: the section as written, the sizes of the regression, and the reading of numbers: exactly for code, rounded for a
//! run.

use crate::model::{self, Decimal, Estimator as Name, Hold, Model, Observer, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics, Span};

/// Settings with which an observer can be built.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings<N> {
    /// The operator on the regression.
    pub operator: Operator<N>,
    /// True if the outputs themselves are the regressand (`OutputForm` of the runtime): unknowns and extension are then
    /// those of the outputs whose rates are used, followed by those of the coordinates.
    pub output: bool,
    /// In the output form: the indices of the outputs in y, where rates and estimates are those of the outputs that the
    /// observer expects.
    pub expected: Option<Vec<usize>>,
    /// The standard deviations of the outputs' sensors, where their noise is in the factor of the unknown too.
    pub errors_in_variables: Option<Vec<N>>,
    /// For each row the index of the output that it gives by its value with an input in it, where that output drives the
    /// cascade too; none where no output does.
    pub feedthrough: Option<Vec<Option<usize>>>,
    /// The outputs that arrive late, if any does.
    pub late: Option<Late<N>>,
    /// True if samples are joined by straight lines; else each is held.
    pub straight: bool,
    /// The estimator of the unknowns.
    pub estimator: Estimator<N>,
    /// Lower bounds of the unknowns.
    pub lower: Option<Vec<N>>,
    /// Upper bounds of the unknowns.
    pub upper: Option<Vec<N>>,
    /// Lower and upper bounds of the recovered states.
    pub within: [Option<Vec<N>>; 2],
    /// The restarts of the extension from the estimate, if any.
    pub rebase: Option<Rebase<N>>,
    /// The extension at the start.
    pub chi_0: Vec<N>,
    /// The normalised square of an innovation beyond which a sample is an outlier, if any is.
    pub gate: Option<N>,
    /// The bounds of samples, if they are known.
    pub limits: Option<Limits<N>>,
}

/// The outputs that arrive late (`LateObserver` of the runtime).
#[derive(Clone, Debug, PartialEq)]
pub struct Late<N> {
    /// The delay of each output in seconds, 0 for one on time.
    pub delays: Vec<N>,
    /// The index in y of the output of each row of the regression.
    pub rows: Vec<usize>,
    /// True for an output that the observer expects by its row.
    pub is_expected: Vec<bool>,
    /// The number of samples that may be on their way.
    pub instants: usize,
}

impl<N> Late<N> {
    /// The same with other numbers.
    pub fn map<M>(&self, other: impl Fn(&N) -> M) -> Late<M> {
        Late {
            delays: self.delays.iter().map(other).collect(),
            rows: self.rows.clone(),
            is_expected: self.is_expected.clone(),
            instants: self.instants,
        }
    }
}

impl Late<f64> {
    /// True if the sample of any output may be missing.
    pub fn may_lack_any(&self) -> bool {
        self.delays.iter().zip(&self.is_expected).all(|(delay, expected)| *expected || *delay > 0.0)
    }
}

/// The restarts of the extension from the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rebase<N> {
    /// After so many samples, a whole number.
    Samples(N),
    /// A restart when a component of it exceeds this (`Drift::Above` of the runtime).
    Above(N),
    /// All the time, at this rate in 1/s (`Drift::Leak` of the runtime).
    Leak(N),
}

impl<N> Rebase<N> {
    /// The number that belongs to it.
    pub fn number(&self) -> &N {
        let (Self::Samples(number) | Self::Above(number) | Self::Leak(number)) = self;
        number
    }

    /// The same with another number.
    pub fn map<M>(&self, other: impl Fn(&N) -> M) -> Rebase<M> {
        match self {
            Self::Samples(number) => Rebase::Samples(other(number)),
            Self::Above(number) => Rebase::Above(other(number)),
            Self::Leak(number) => Rebase::Leak(other(number)),
        }
    }
}

impl<N> Settings<N> {
    /// Tests whether an equation of the regression without an unknown serves: a gate checks the samples of all
    /// equations, and in the output form each has the output at the start as its unknown.
    pub fn uses_all_rates(&self) -> bool {
        self.output || self.gate.is_some()
    }
}

/// The bounds of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits<N> {
    /// The least and the greatest sample of each output that has limits; empty where none has.
    pub outputs: Vec<Option<[N; 2]>>,
    /// The same of inputs.
    pub inputs: Vec<Option<[N; 2]>>,
    /// The longest time in seconds between two accepted samples.
    pub gap: Option<N>,
}

impl<N> Limits<N> {
    /// The limits of a model's section; none where it has none, and where a number cannot be read.
    pub fn of(model: &Model, read: impl Fn(&Decimal) -> Option<N>) -> Option<Self> {
        let written = &model.observer;
        let limit = |signal: &Spanned<String>| {
            let entry = written.limits.iter().find(|entry| entry.name.value == signal.value)?;
            match entry.value.as_slice() {
                [least, most] => Some([read(&least.value)?, read(&most.value)?]),
                _ => None,
            }
        };
        let each = |signals: &[Spanned<String>]| -> Vec<Option<[N; 2]>> {
            let limits: Vec<_> = signals.iter().map(limit).collect();
            if limits.iter().any(Option::is_some) { limits } else { Vec::new() }
        };
        let (outputs, inputs) = (each(&model.y), each(&model.u));
        let gap = written.gap.as_ref().and_then(|gap| read(&gap.value));
        (gap.is_some() || !outputs.is_empty() || !inputs.is_empty()).then_some(Self { outputs, inputs, gap })
    }
}

/// Outliers in a row that a gate refuses.
pub const PATIENCE: u32 = 20;

/// The operator on the regression.
#[derive(Clone, Debug, PartialEq)]
pub enum Operator<N> {
    /// A filter of this bandwidth, in rad/s.
    Filter(N),
    /// The mean over so many samples, a whole number.
    Window(N),
    /// Each sample by itself, weighed by the standard deviation of its errors in each row.
    Sampled(Vec<N>),
}

/// An estimator of the runtime library.
#[derive(Clone, Debug, PartialEq)]
pub enum Estimator<N> {
    /// The gradient of this gain.
    Gradient(Vec<N>),
    /// The same, divided by `1 + mu |Phi|^2`.
    NormalisedGradient {
        /// The diagonal of the gain.
        gain: Vec<N>,
        /// The normalisation.
        mu: N,
    },
    /// Least squares.
    LeastSquares(Covariance<N>),
    /// Least squares with a guess of the process noise besides what is known of it, corrected by the innovations.
    AdaptiveLeastSquares(Covariance<N>, Vec<N>),
    /// A scalar estimator for each unknown.
    Drem {
        /// The gains of these.
        gain: Vec<N>,
        /// The extension that makes the equations square.
        extension: Extension<N>,
    },
}

impl<N> Estimator<N> {
    /// The number of unknowns that it has settings for.
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Gradient(gain) | Self::NormalisedGradient { gain, .. } | Self::Drem { gain, .. } => gain.len(),
            Self::LeastSquares(covariance) | Self::AdaptiveLeastSquares(covariance, _) => covariance.start.len(),
        }
    }
}

/// The settings of least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance<N> {
    /// The diagonal of the covariance at the start.
    pub start: Vec<N>,
    /// The rate of forgetting in 1/s.
    pub forgetting: N,
    /// The growth of the covariance in a second, if any.
    pub process_noise: Option<Vec<N>>,
}

impl<N> Covariance<N> {
    /// All its numbers.
    pub fn numbers(&self) -> impl Iterator<Item = &N> {
        let Self { start, forgetting, process_noise } = self;
        start.iter().chain([forgetting]).chain(process_noise.iter().flatten())
    }
}

/// The regressor extension of DREM.
#[derive(Clone, Debug, PartialEq)]
pub enum Extension<N> {
    /// Kreisselmeier's.
    Kreisselmeier {
        /// The diagonal of its gain.
        gain: Vec<N>,
        /// The rate of forgetting in 1/s.
        forgetting: N,
        /// The settings of a finite-time estimate, if it is one.
        finite_time: Option<FiniteTime<N>>,
    },
    /// The response of a gradient.
    Gradient(Vec<N>),
    /// The response of least squares.
    LeastSquares(Covariance<N>),
}

/// Exactness after a finite time: once, or again and again where there is a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteTime<N> {
    /// The clip, between 0 and 1.
    pub clip: N,
    /// Seconds after which it counts from a new instant.
    pub period: Option<N>,
}

impl<N: Clone + PartialOrd> Settings<N> {
    /// The settings that a section gives an observer of so many unknowns, coordinates and recovered states. There are
    /// none where the section lacks something, and where a number cannot be read; lists of wrong lengths and bounds
    /// that exclude each other are reported.
    pub fn resolve(
        written: &Observer,
        (unknowns, coordinates, states): (usize, usize, usize),
        read: impl Fn(&Decimal) -> Option<N>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let mut section = Section { written, unknowns, read, problems };
        let estimator = section.estimator();
        let bounds = section.bounds([&written.bounds.lower, &written.bounds.upper], unknowns, "unknown");
        let within = section.bounds([&written.within.lower, &written.within.upper], states, "recovered state");
        let chi_0 = section.list(&written.extension, coordinates, "a start for each component of phi");
        let operator = match (&written.window, &written.filter) {
            (Some(window), _) => Operator::Window(section.number(window)?),
            (None, filter) => Operator::Filter(section.number(filter.as_ref()?)?),
        };
        let ([lower, upper], within, zero) = (bounds?, within?, section.zero()?);
        let rebase = section.rebase().ok()?;
        Some(Self {
            operator,
            output: false,
            expected: None,
            errors_in_variables: None,
            feedthrough: None,
            late: None,
            straight: written.hold.as_ref().is_none_or(|hold| hold.value == Hold::FirstOrder),
            estimator: estimator?,
            lower,
            upper,
            within,
            rebase,
            chi_0: chi_0.ok()?.unwrap_or_else(|| vec![zero; coordinates]),
            gate: None,
            limits: None,
        })
    }
}

/// The settings of a section besides those of its estimator.
#[derive(Clone, Debug)]
pub struct Frame<N> {
    /// The diagonal of the covariance of the coordinates at the start, if it is written.
    pub covariance: Option<Vec<N>>,
    /// The growth of the covariance in a second, if given.
    pub process_noise: Option<Vec<N>>,
    /// Lower and upper bounds of the recovered states.
    pub within: [Option<Vec<N>>; 2],
    /// The restarts of the extension, if given.
    pub rebase: Option<Rebase<N>>,
    /// The limit of the gate.
    pub gate: Option<N>,
    /// True if samples are joined by straight lines.
    pub straight: bool,
    /// The extension at the start, if it is written.
    pub chi_0: Option<Vec<N>>,
}

impl<N: Clone + PartialOrd> Frame<N> {
    /// The same for these numbers of coordinates and recovered states, with mistakes reported as by
    /// [`Settings::resolve`].
    pub fn resolve(
        written: &Observer,
        (coordinates, states): (usize, usize),
        read: impl Fn(&Decimal) -> Option<N>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let mut section = Section { written, unknowns: coordinates, read, problems };
        let covariance = section.list(&written.covariance, coordinates, "a covariance for each component of phi");
        let noise = section.list(&written.process_noise, coordinates, "process noise for each component of phi");
        let within = section.bounds([&written.within.lower, &written.within.upper], states, "recovered state");
        let chi_0 = section.list(&written.extension, coordinates, "a start for each component of phi");
        let rebase = section.rebase().ok()?;
        Some(Self {
            covariance: covariance.ok()?,
            process_noise: noise.ok()?,
            within: within?,
            rebase,
            gate: match &written.gate {
                Some(limit) => Some(section.number(limit)?),
                None => None,
            },
            straight: written.hold.as_ref().is_none_or(|hold| hold.value == Hold::FirstOrder),
            chi_0: chi_0.ok()?,
        })
    }
}

/// The setting `rebase` of a model that admits none.
pub fn cannot_rebase(name: &str, rebase: Span) -> Diagnostic {
    Diagnostic::error(Code::SettingConflict, rebase, format!("`{name}` cannot be re-based"))
        .note("it takes a regression that is affine in z, with theta itself as its unknown")
        .help("remove `rebase`: such an observer is restarted instead")
}

/// A list that has no value for each unknown, or a number that cannot be read.
struct RefusedSetting;

struct Section<'a, F> {
    written: &'a Observer,
    unknowns: usize,
    read: F,
    problems: &'a mut Diagnostics,
}

impl<F> Section<'_, F> {
    fn number<N>(&self, number: &Spanned<Decimal>) -> Option<N>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        (self.read)(&number.value)
    }

    fn zero<N>(&self) -> Option<N>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        (self.read)(&Decimal::zero())
    }

    fn estimator<N: Clone>(&mut self) -> Option<Estimator<N>>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        let (written, unknowns) = (self.written, self.unknowns);
        // All four, so that each mistake is reported.
        let gain = self.list(&written.gain, unknowns, "a gain for each unknown");
        let regressor_gain = self.list(&written.regressor_gain, unknowns, "a gain for each unknown");
        let start = self.list(&written.covariance, unknowns, "a covariance for each unknown");
        let process_noise = self.list(&written.process_noise, unknowns, "process noise for each unknown");
        let (gain, regressor_gain, start) = (gain.ok()?, regressor_gain.ok()?, start.ok()?);
        let process_noise = process_noise.ok()?;
        let one = |number: &Option<Spanned<Decimal>>| number.as_ref().and_then(|number| self.number(number));
        let forgetting = one(&written.forgetting).or_else(|| self.zero())?;
        let name = written.estimator();
        let extension = match name {
            Name::Gradient => return Some(Estimator::Gradient(gain?)),
            Name::NormalisedGradient => {
                return Some(Estimator::NormalisedGradient { gain: gain?, mu: one(&written.normalisation)? });
            }
            Name::LeastSquares => {
                return Some(Estimator::LeastSquares(Covariance { start: start?, forgetting, process_noise }));
            }
            Name::Drem => Extension::Kreisselmeier { gain: regressor_gain?, forgetting, finite_time: None },
            Name::FiniteTimeDrem => Extension::Kreisselmeier {
                gain: regressor_gain?,
                forgetting,
                finite_time: Some(FiniteTime { clip: one(&written.clip)?, period: one(&written.period) }),
            },
            Name::GradientDrem => Extension::Gradient(regressor_gain?),
            Name::LeastSquaresDrem => Extension::LeastSquares(Covariance { start: start?, forgetting, process_noise }),
        };
        Some(Estimator::Drem { gain: gain?, extension })
    }

    /// The restarts of the extension, if any.
    fn rebase<N>(&self) -> Result<Option<Rebase<N>>, RefusedSetting>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        let model::Rebase { samples, above, leak, .. } = &self.written.rebase;
        let number = |written: &Spanned<Decimal>| self.number(written).ok_or(RefusedSetting);
        Ok(match (samples, above, leak) {
            (Some(samples), ..) => Some(Rebase::Samples(number(samples)?)),
            (None, Some(bound), _) => Some(Rebase::Above(number(bound)?)),
            (None, None, Some(rate)) => Some(Rebase::Leak(number(rate)?)),
            (None, None, None) => None,
        })
    }

    /// Bounds of so many quantities of a kind.
    fn bounds<N: Clone + PartialOrd>(
        &mut self,
        [below, above]: [&[Spanned<Decimal>]; 2],
        count: usize,
        kind: &str,
    ) -> Option<[Option<Vec<N>>; 2]>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        let what = format!("a bound for each {kind}");
        let lower = self.list(below, count, &what);
        let upper = self.list(above, count, &what);
        let (lower, upper) = (lower.ok()?, upper.ok()?);
        let pairs = lower.iter().flatten().zip(upper.iter().flatten());
        if let Some((crossed, _)) = pairs.enumerate().find(|(_, (lower, upper))| lower > upper) {
            let message = format!("no value lies within the bounds of {kind} {}", crossed + 1);
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

    /// As many values as needed, all given or one for all; none where the list is empty.
    fn list<N: Clone>(
        &mut self,
        written: &[Spanned<Decimal>],
        count: usize,
        what: &str,
    ) -> Result<Option<Vec<N>>, RefusedSetting>
    where
        F: Fn(&Decimal) -> Option<N>,
    {
        match written {
            [] => Ok(None),
            [one] => Ok(Some(vec![self.number(one).ok_or(RefusedSetting)?; count])),
            all if all.len() == count => all
                .iter()
                .map(|value| self.number(value).ok_or(RefusedSetting))
                .collect::<Result<Vec<N>, _>>()
                .map(Some),
            all => {
                let message = format!("{} values are given, where the observer takes {count}: {what}", all.len());
                self.problems.push(
                    Diagnostic::error(Code::WrongShape, all[0].span.to(all[all.len() - 1].span), message).help(
                        if count == 1 {
                            "write one value".to_owned()
                        } else {
                            format!("write {count} values, or one for all")
                        },
                    ),
                );
                Err(RefusedSetting)
            }
        }
    }
}
