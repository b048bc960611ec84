//! The section `observer`: how the observer is built, in the words of the file, and held against itself.

#[cfg(feature = "yaml")]
use serde::Deserialize;

use super::delay::Delay;
use super::formula::Decimal;
use super::spanned::{Entry, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed};

/// The construction of the observer; the generator chooses absent settings.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(default, deny_unknown_fields))]
pub struct Observer {
    /// The form of the regressand; chosen by the other settings if absent.
    pub form: Option<Spanned<Form>>,
    /// The standard deviation of the samples of each output.
    pub sensors: Vec<Entry<Spanned<Decimal>>>,
    /// The initial error of each state, a standard deviation.
    pub start: Vec<Entry<Spanned<Decimal>>>,
    /// The drift of states and outputs besides their rates, in their units per root second.
    pub disturbance: Vec<Entry<Spanned<Decimal>>>,
    /// The age of the samples of outputs as they arrive.
    pub delay: Delay,
    /// The estimator; if absent, least squares of known numbers, or a gradient where gains are written.
    pub estimator: Option<Spanned<Estimator>>,
    /// One gain for each unknown, or one for all: of a gradient, or of the scalar estimators of DREM in 1/s.
    pub gain: Vec<Spanned<Decimal>>,
    /// The diagonal of the covariance at the start, which is also its bound, of least squares.
    pub covariance: Vec<Spanned<Decimal>>,
    /// The diagonal of Gamma in DREM's regressor extension: Kreisselmeier's, or the gradient's.
    pub regressor_gain: Vec<Spanned<Decimal>>,
    /// The rate at which the past is forgotten, in 1/s; zero if absent.
    pub forgetting: Option<Spanned<Decimal>>,
    /// The growth of the covariance of least squares in a second: one for each unknown, or one for all.
    pub process_noise: Vec<Spanned<Decimal>>,
    /// `mu` of a gradient divided by `1 + mu |Phi|^2`.
    pub normalisation: Option<Spanned<Decimal>>,
    /// `mu` of finite-time DREM, between 0 and 1.
    pub clip: Option<Spanned<Decimal>>,
    /// Seconds after which finite-time DREM counts from a new instant, which makes it track; it never does if absent.
    pub period: Option<Spanned<Decimal>>,
    /// Known bounds of the unknowns.
    pub bounds: Bounds,
    /// Known bounds of the recovered states: their estimates are kept there.
    pub within: Bounds,
    /// The filters' corner frequency in rad/s.
    pub filter: Option<Spanned<Decimal>>,
    /// The samples of the window of the integral form, in place of the filter.
    pub window: Option<Spanned<Decimal>>,
    /// The interpolation between samples.
    pub hold: Option<Spanned<Hold>>,
    /// The restarts of the extension from the estimate; never if it is empty.
    pub rebase: Rebase,
    /// The normalised square of an innovation beyond which a sample is an outlier; none if absent.
    pub gate: Option<Spanned<Decimal>>,
    /// The standard error that is wanted of each state.
    pub wanted: Vec<Entry<Spanned<Decimal>>>,
    /// Known bounds of the samples of outputs and inputs: two numbers each.
    pub limits: Vec<Entry<Vec<Spanned<Decimal>>>>,
    /// The longest time in seconds between two accepted samples; any if absent.
    pub gap: Option<Spanned<Decimal>>,
    /// The extension chi at the start: one value each; empty where the author does not say.
    pub extension: Vec<Spanned<Decimal>>,
}

/// Known bounds of unknowns or states: one number for each, or one for all; empty where there is no bound.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(default, deny_unknown_fields))]
pub struct Bounds {
    /// From below.
    pub lower: Vec<Spanned<Decimal>>,
    /// From above.
    pub upper: Vec<Spanned<Decimal>>,
}

/// The restarts of the extension from the estimate: one of these, or never.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(default, deny_unknown_fields))]
pub struct Rebase {
    /// After so many samples.
    pub samples: Option<Spanned<Decimal>>,
    /// The bound on its components above which it restarts, in units of phi.
    pub above: Option<Spanned<Decimal>>,
    /// All the time, at this rate in 1/s.
    pub leak: Option<Spanned<Decimal>>,
}

impl Rebase {
    /// The span.
    pub fn span(&self) -> Option<Span> {
        self.written().next().map(|(_, number)| number.span)
    }

    /// True if it restarts after each sample.
    pub fn is_at_each_sample(&self) -> bool {
        self.samples.as_ref().is_some_and(|samples| samples.value.to_f64() <= 1.0)
    }

    /// The written settings, with their keys.
    fn written(&self) -> impl Iterator<Item = (&'static str, &Spanned<Decimal>)> {
        let keys = [("samples", &self.samples), ("above", &self.above), ("leak", &self.leak)];
        keys.into_iter().filter_map(|(key, number)| Some((key, number.as_ref()?)))
    }

    /// Reports several of them at once.
    fn check(&self, diagnostics: &mut Diagnostics) {
        let mut written = self.written();
        let (Some((first, span)), Some((second, other))) = (written.next(), written.next()) else { return };
        let message = format!("`rebase` has both `{first}` and `{second}`");
        diagnostics.push(
            Diagnostic::error(Code::SettingConflict, other.span, message)
                .also(span.span, format!("`{first}` is here"))
                .help("keep one of them: each of the forms alone keeps the extension from running away"),
        );
    }
}

/// The interpolation between samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "kebab-case"))]
pub enum Hold {
    /// Constant between samples.
    ZeroOrder,
    /// Straight lines between samples.
    FirstOrder,
}

/// The form of the regressand of a regression of rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "kebab-case"))]
pub enum Form {
    /// The rates of the outputs, through a filter or window.
    Rate,
    /// The outputs themselves, whose values at the start are unknowns too.
    Output,
}

impl Form {
    /// Their names in a file.
    pub const NAMES: &[&str] = &["rate", "output"];
}

/// The estimators of the runtime library.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "kebab-case"))]
pub enum Estimator {
    /// The paper's.
    #[default]
    Gradient,
    /// The same, of a speed that does not depend on the size of the regressor.
    NormalisedGradient,
    /// With forgetting and bounded covariance.
    LeastSquares,
    /// On Kreisselmeier's regressor extension.
    Drem,
    /// The same, exact after a finite time.
    FiniteTimeDrem,
    /// On the response of a gradient.
    GradientDrem,
    /// On the response of least squares.
    LeastSquaresDrem,
}

impl Estimator {
    /// All of them, in the order of [`NAMES`](Self::NAMES).
    pub const ALL: [Self; 7] = [
        Self::Gradient,
        Self::NormalisedGradient,
        Self::LeastSquares,
        Self::Drem,
        Self::FiniteTimeDrem,
        Self::GradientDrem,
        Self::LeastSquaresDrem,
    ];

    /// Their names in a file.
    pub const NAMES: &[&str] = &[
        "gradient",
        "normalised-gradient",
        "least-squares",
        "drem",
        "finite-time-drem",
        "gradient-drem",
        "least-squares-drem",
    ];

    /// Its name in a file.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().zip(Self::NAMES).find(|(estimator, _)| **estimator == self).map_or("", |(_, name)| name)
    }

    /// The settings without which it cannot run.
    pub fn needs(self) -> &'static [&'static str] {
        match self {
            Self::Gradient => &["gain"],
            Self::NormalisedGradient => &["gain", "normalisation"],
            Self::LeastSquares => &["covariance"],
            Self::Drem | Self::GradientDrem => &["gain", "regressor_gain"],
            Self::FiniteTimeDrem => &["gain", "regressor_gain", "clip"],
            Self::LeastSquaresDrem => &["gain", "covariance"],
        }
    }

    /// The settings that it may have besides.
    pub fn admits(self) -> &'static [&'static str] {
        match self {
            Self::Gradient | Self::NormalisedGradient | Self::GradientDrem => &[],
            Self::LeastSquares => &["forgetting", "process_noise"],
            Self::LeastSquaresDrem | Self::Drem => &["forgetting"],
            Self::FiniteTimeDrem => &["forgetting", "period"],
        }
    }

    fn has(self, key: &str) -> bool {
        self.needs().contains(&key) || self.admits().contains(&key)
    }
}

/// The settings that belong to estimators.
const SETTINGS: [&str; 8] =
    ["gain", "covariance", "regressor_gain", "forgetting", "process_noise", "normalisation", "clip", "period"];

impl Observer {
    /// The estimator, whether or not it is written.
    pub fn estimator(&self) -> Estimator {
        let otherwise = if self.has_gains() { Estimator::default() } else { Estimator::LeastSquares };
        self.estimator.as_ref().map_or(otherwise, |estimator| estimator.value)
    }

    /// Tests whether the author chose the numbers of an estimator, beside data on sensors, start and disturbances.
    pub fn has_gains(&self) -> bool {
        let written = self.filter.is_some() || self.window.is_some() || self.estimator.is_some();
        self.known().is_none() && (written || SETTINGS.iter().any(|key| self.span_of(key).is_some()))
    }

    /// The first of the keys that need an observer of known numbers, with its span.
    pub fn known(&self) -> Option<(&'static str, Span)> {
        let first = |key, entries: &[Entry<Spanned<Decimal>>]| Some((key, entries.first()?.name.span));
        let output = self.form.as_ref().filter(|form| form.value == Form::Output).map(|form| ("form", form.span));
        first("sensors", &self.sensors)
            .or_else(|| first("start", &self.start))
            .or_else(|| first("disturbance", &self.disturbance))
            .or(output)
    }

    /// The span of a setting of estimators, if it is written.
    pub fn span_of(&self, key: &str) -> Option<Span> {
        let all = |values: &[Spanned<Decimal>]| Some(values.first()?.span.to(values.last()?.span));
        let one = |value: &Option<Spanned<Decimal>>| value.as_ref().map(|value| value.span);
        match key {
            "gain" => all(&self.gain),
            "covariance" => all(&self.covariance),
            "regressor_gain" => all(&self.regressor_gain),
            "forgetting" => one(&self.forgetting),
            "process_noise" => all(&self.process_noise),
            "normalisation" => one(&self.normalisation),
            "clip" => one(&self.clip),
            "period" => one(&self.period),
            _ => None,
        }
    }

    /// Reports settings out of their range, and conflicting ones.
    pub(super) fn check(&self, diagnostics: &mut Diagnostics) {
        // A misspelt estimator is absent, and its settings are unknown.
        let known = self.estimator.is_some() || !diagnostics.has_errors();
        self.contradictions(diagnostics);
        for key in SETTINGS.iter().copied().filter(|_| self.known().is_none()) {
            let estimator = self.estimator();
            if let Some(span) = self.span_of(key).filter(|_| known && !estimator.has(key)) {
                diagnostics.push(self.stranger(key, span));
            }
        }
        let mut within = |number: &Spanned<Decimal>, admitted: fn(f64) -> bool, message: &str, help: &str| {
            if !admitted(number.value.to_f64()) {
                diagnostics.push(Diagnostic::error(Code::NumberOutOfRange, number.span, message).help(help));
            }
        };
        let above_zero = "write a number above zero";
        let positive = [
            (self.gain.as_slice(), "a gain must be positive"),
            (self.covariance.as_slice(), "a covariance must be positive"),
            (self.regressor_gain.as_slice(), "a gain must be positive"),
            (self.period.as_slice(), "the period must be positive"),
            (self.filter.as_slice(), "the filter frequency must be positive"),
            (self.gate.as_slice(), "the limit of the gate must be positive"),
            (self.gap.as_slice(), "the longest gap must be positive"),
            (self.rebase.above.as_slice(), "the bound of the extension must be positive"),
            (self.rebase.leak.as_slice(), "the rate of the leak must be positive"),
        ];
        for (numbers, message) in positive {
            for number in numbers {
                within(number, |value| value > 0.0, message, above_zero);
            }
        }
        let not_negative = [
            (&self.forgetting, "the rate of forgetting must not be negative", "write 0 for no forgetting"),
            (
                &self.normalisation,
                "the normalisation must not be negative",
                "write 0 for the gradient without normalisation",
            ),
        ];
        for (number, message, help) in not_negative {
            if let Some(number) = number {
                within(number, |value| value >= 0.0, message, help);
            }
        }
        for number in &self.process_noise {
            let help = "write 0 for an unknown that does not wander";
            within(number, |value| value >= 0.0, "process noise must not be negative", help);
        }
        if let Some(clip) = &self.clip {
            let help = "write a number above 0 and below 1: 0.1 amplifies noise at most ten times";
            within(clip, |value| value > 0.0 && value < 1.0, "the clip must be between 0 and 1", help);
        }
        let whole = |value: f64| value >= 1.0 && value.fract() == 0.0;
        if let Some(rebase) = &self.rebase.samples {
            let countable = |value: f64| value >= 1.0 && value.fract() == 0.0 && value <= f64::from(u32::MAX);
            let help = "write 1 for every sample, and leave the key out for never";
            within(rebase, countable, "`rebase` is a number of samples", help);
        }
        if let Some(window) = &self.window {
            within(window, whole, "a window is a number of samples", "write a whole number above zero");
        }
        if let Some(gate) = self.gate.as_ref().filter(|_| self.has_gains()) {
            let message = "`gate` stands beside gains, which do not say how far a sample may be from what is expected";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, gate.span, message)
                    .help("write `sensors`, `start` and `disturbance` in place of gains, or remove `gate`"),
            );
        }
        if let Some(wanted) = self.wanted.first().filter(|_| self.has_gains()) {
            let message = "`wanted` stands beside gains, which do not say how far an estimate errs";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, wanted.name.span, message).help(
                    "write `sensors`, `start` and `disturbance` in place of gains, or remove `wanted`: for gains the runtime \
                     has a `Monitor`",
                ),
            );
        }
        if let Some(delay) = self.delay.span().filter(|_| self.has_gains()) {
            let message = "`delay` stands beside gains, whose observer takes every sample for one of the moment";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, delay, message)
                    .help("write `sensors`, `start` and `disturbance` in place of gains, or remove `delay` and give the observer the inputs as late as the outputs"),
            );
        }
        self.rebase.check(diagnostics);
        self.limits.iter().for_each(|entry| limits(entry, diagnostics));
        if let (Some(filter), Some(window)) = (&self.filter, &self.window) {
            let message = "the observer has both a filter and a window";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, window.span, message)
                    .also(filter.span, "the filter")
                    .help("remove one of them: the regression goes through a filter or a window"),
            );
        }
    }

    /// Reports gains beside the numbers that they would be derived from.
    fn contradictions(&self, diagnostics: &mut Diagnostics) {
        let Some((key, known)) = self.known() else {
            self.idle_bounds(diagnostics);
            return;
        };
        let instead = [("covariance", &self.start, "start"), ("process_noise", &self.disturbance, "disturbance")];
        for (gain, entries, name) in instead {
            if let (Some(span), Some(first)) = (self.span_of(gain), entries.first()) {
                let message = format!("`{gain}` stands beside the `{name}` that it would be derived from");
                diagnostics.push(
                    Diagnostic::error(Code::SettingConflict, span, message)
                        .also(first.name.span, format!("`{name}` begins here"))
                        .help(format!("remove one of them: `{name}` is in units of the states, `{gain}` of phi")),
                );
            }
        }
        let others = ["gain", "regressor_gain", "forgetting", "normalisation", "clip", "period"];
        let mut strangers: Vec<(&str, Span)> =
            others.into_iter().filter_map(|key| Some((key, self.span_of(key)?))).collect();
        let operators = [("filter", &self.filter), ("window", &self.window)];
        strangers.extend(operators.iter().filter_map(|(key, number)| Some((*key, number.as_ref()?.span))));
        strangers.extend(
            [("bounds", &self.bounds.lower), ("bounds", &self.bounds.upper)]
                .iter()
                .filter_map(|(key, numbers)| Some((*key, numbers.first()?.span))),
        );
        let other = self.estimator.as_ref().filter(|estimator| estimator.value != Estimator::LeastSquares);
        strangers.extend(other.map(|estimator| ("estimator", estimator.span)));
        for (stranger, span) in strangers {
            let message = format!("`{stranger}` stands beside `{key}`, from which the observer is derived");
            let help = match stranger {
                "bounds" => "bound the states instead, by `within`".to_owned(),
                "estimator" => format!("write `least-squares`, or gains in place of `{key}`"),
                _ => format!("remove `{stranger}`: the observer is least squares, whose numbers are derived"),
            };
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, span, message)
                    .also(known, format!("`{key}` is here"))
                    .help(help),
            );
        }
    }

    /// Reports bounds of the unknowns of an estimator that the section does not choose.
    fn idle_bounds(&self, diagnostics: &mut Diagnostics) {
        // An estimator that was misspelt is absent.
        let bounds = self.bounds.lower.first().or(self.bounds.upper.first());
        if let Some(bound) = bounds.filter(|_| !self.has_gains() && !diagnostics.has_errors()) {
            let message = "`bounds` are those of an estimator's unknowns, and this section chooses no estimator";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, bound.span, message)
                    .help("bound the states instead, by `within`, or choose an `estimator` with its settings"),
            );
        }
    }

    /// A setting that the estimator does not have.
    fn stranger(&self, key: &str, span: Span) -> Diagnostic {
        let estimator = self.estimator();
        let message = format!("the estimator `{}` has no `{key}`", estimator.name());
        let others = Estimator::ALL.into_iter().filter(|other| other.has(key)).map(Estimator::name);
        let own = estimator.needs().iter().chain(estimator.admits()).copied();
        let diagnostic = Diagnostic::error(Code::SettingConflict, span, message)
            .note(format!("`{key}` is a setting of {}", listed(others)));
        match &self.estimator {
            Some(estimator) => diagnostic.also(estimator.span, "the estimator is chosen here").help(format!(
                "remove `{key}`, or choose another estimator: the settings of this one are {}",
                listed(own)
            )),
            None => diagnostic
                .help("add `estimator:` with one that has this setting; without that key the estimator is `gradient`"),
        }
    }
}

/// Reports limits of a signal that are no two numbers in order.
fn limits(entry: &Entry<Vec<Spanned<Decimal>>>, diagnostics: &mut Diagnostics) {
    let name = &entry.name.value;
    match entry.value.as_slice() {
        [least, most] if least.value.to_f64() <= most.value.to_f64() => {}
        [least, most] => diagnostics.push(
            Diagnostic::error(
                Code::NumberOutOfRange,
                least.span,
                format!("no sample of `{name}` is within its limits"),
            )
            .also(most.span, "this upper limit is below the lower one")
            .help("exchange them"),
        ),
        values => {
            let message = format!("{} numbers are given as the limits of `{name}`", values.len());
            let help = format!("write the least and the greatest, as `{name}: [0, 1]`");
            diagnostics.push(Diagnostic::error(Code::WrongShape, entry.name.span, message).help(help));
        }
    }
}
