//! The section `observer`: how the observer is built, in the words of the file.

mod check;
mod estimator;

use super::choice::choices;
use super::delay::Delay;
use super::section::{Each, Names, Number, Numbers, Value, section};
use super::spanned::{Entry, Spanned};
use crate::source::Span;
pub use estimator::Estimator;

section! {
    /// The construction of the observer; the generator chooses absent settings.
    pub struct Observer {
        sensors: Each, "sensors: {v2: 0.1}",
            "The standard deviation of each output's samples, from which with `start` and `disturbance` all gains are derived; that of `noise` and `quantisation` together, or a thousandth of the output at the start, if left out"
            => of(Names::Y), positive("the standard deviation of a sensor must be positive");
        start: Each, "start: {i1: 5}",
            "How wrong the estimate of each state can be at the start, a standard deviation; ten times the state, or 10 of its unit, if left out (once the state with a `local` or monotone regression)"
            => of(Names::X), deviation();
        disturbance: Each, "disturbance: {i1: 0.1}",
            "By how much a state or output drifts besides its rate, in its unit per root second; 0 if left out beside `sensors` or `start`"
            => of(Names::XOrY), deviation();
        delay: Delay, "delay: {v2: 2e-6}",
            "How old the samples of an output are as they arrive, in seconds: one number, or one for each output; the observer takes each for the time that it is of; 0 if left out"
            => of(Names::Y), late();
        form: Option<Spanned<Form>>, "form: output",
            "rate: the regression of the rates of the outputs, through a filter or a window; output: the same integrated, which needs no filter; if left out, output, or rate where gains are written";
        estimator: Option<Spanned<Estimator>>, "estimator: gradient",
            "The estimator; if left out beside gains, gradient";
        gain: Numbers, "gain: [1e7, 1e7]",
            "The gain of a gradient, or of DREM in 1/s: one for each unknown, or one for all", or_one()
            => positive("a gain must be positive");
        covariance: Numbers, "covariance: 1e6",
            "The diagonal of the covariance of least squares at the start, which is also its bound", or_one()
            => positive("a covariance must be positive");
        regressor_gain: Numbers, "regressor_gain: [1, 1]",
            "The diagonal of the gain of the regressor extension of DREM", or_one()
            => positive("a gain must be positive");
        forgetting: Number, "forgetting: 100", "The rate of forgetting in 1/s; 0 if left out"
            => not_negative("the rate of forgetting must not be negative", "write 0 for no forgetting");
        process_noise: Numbers, "process_noise: [0, 1]",
            "By how much the covariance of least squares grows in a second; 0 if left out", or_one()
            => not_negative("process noise must not be negative", "write 0 for an unknown that does not wander");
        normalisation: Number, "normalisation: 1", "mu of the normalised gradient, which is divided by 1 + mu |Phi_1|^2"
            => not_negative("the normalisation must not be negative", "write 0 for the gradient without normalisation");
        clip: Number, "clip: 0.1", "mu of finite-time DREM, above 0 and below 1"
            => within(|value| value > 0.0 && value < 1.0, "the clip must be between 0 and 1", "write a number above 0 and below 1: 0.1 amplifies noise at most ten times");
        period: Number, "period: 0.01",
            "Seconds after which finite-time DREM starts again, so that it tracks jumps; never if left out"
            => positive("the period must be positive");
        bounds: Bounds, "bounds: {lower: [-1, 0], upper: 5}", "Bounds of the unknowns";
        within: Within, "within: {lower: 0, upper: [10, 5]}",
            "Bounds of the recovered states: an estimate beyond them is moved to the bound";
        filter: Number, "filter: 500", "The corner frequency of the filter of the regression, in rad/s"
            => positive("the filter frequency must be positive");
        window: Number, "window: 100", "The number of samples of a moving window, in place of the filter"
            => within(|value| value >= 1.0 && value.fract() == 0.0, "a window is a number of samples", "write a whole number above zero");
        hold: Option<Spanned<Hold>>, "hold: zero-order", "What the samples stand for between two instants";
        rebase: Rebase, "rebase: 1",
            "When the extension starts again from the estimate, with all memory carried over: after so many samples (1 is the form without drift), or as the map says; never if left out",
            or_number();
        gate: Number, "gate: 25",
            "The normalised square of the innovation beyond which a sample is refused as an outlier; without gains only"
            => positive("the limit of the gate must be positive");
        wanted: Each, "wanted: {i1: 0.05}",
            "The standard error that each state shall be known to: a run says from when on all are, or which is not; without gains only"
            => of(Names::X), positive("the standard error that is wanted must be positive");
        limits: Vec<Entry<Numbers>>, "limits: {v2: [-50, 50], d: [0, 1]}",
            "Between what a sample of an output or input is, as the rails of its sensor; one beyond is refused"
            => of(Names::YOrU);
        gap: Number, "gap: 1e-3",
            "The longest time in seconds from one accepted sample to the next; after a longer one the observer begins anew"
            => positive("the longest gap must be positive");
        extension: Numbers, "extension: [0, 0]",
            "The dynamic extension at the start: one number for each component; if left out, zeros, or where phi_left has no value at zero, or with a `local` or monotone regression, phi of half the state at which the simulation begins";
    }
}

section! {
    /// Known bounds of the unknowns; empty where there is none.
    pub struct Bounds {
        lower: Numbers, "lower: [-1, 0]", "The lower bound: one for each unknown, or one for all", or_one();
        upper: Numbers, "upper: 5", "The upper bound: one for each unknown, or one for all", or_one();
    }
}

section! {
    /// Known bounds of the recovered states; empty where there is none.
    pub struct Within {
        lower: Numbers, "lower: 0", "The lower bound: one for each recovered state, or one for all", or_one();
        upper: Numbers, "upper: [10, 5]", "The upper bound: one for each recovered state, or one for all", or_one();
    }
}

section! {
    /// The restarts of the extension from the estimate: one of these, or never.
    pub struct Rebase {
        samples: Number, "samples: 1", "After so many samples; the same as the number alone"
            => count("`rebase` is a number of samples", "write 1 for every sample, and leave the key out for never");
        above: Number, "above: 100",
            "When a component of the extension exceeds this, in units of phi: cheap, as it seldom does"
            => positive("the bound of the extension must be positive");
        leak: Number, "leak: 5", "All the time, at this rate in 1/s: what leaks from the extension goes into theta"
            => positive("the rate of the leak must be positive");
    }
}

impl Rebase {
    /// The span.
    pub fn span(&self) -> Option<Span> {
        self.written().next().map(|(_, span)| span)
    }

    /// True if it restarts after each sample.
    pub fn is_at_each_sample(&self) -> bool {
        self.samples.as_ref().is_some_and(|samples| samples.value.to_f64() <= 1.0)
    }

    /// The written settings, with their spans.
    fn written(&self) -> impl Iterator<Item = (&'static str, Span)> {
        spans(self)
    }
}

choices! {
    /// The interpolation between samples.
    pub enum Hold {
        /// Constant between samples.
        ZeroOrder = "zero-order",
        /// Straight lines between samples.
        FirstOrder = "first-order",
    }
}

choices! {
    /// The form of the regressand of a regression of rates.
    pub enum Form {
        /// The rates of the outputs, through a filter or window.
        Rate = "rate",
        /// The outputs themselves, whose values at the start are unknowns too.
        Output = "output",
    }
}

impl Observer {
    /// The estimator, whether or not it is written.
    pub fn estimator(&self) -> Estimator {
        let otherwise = if self.has_gains() { Estimator::default() } else { Estimator::LeastSquares };
        self.estimator.as_ref().map_or(otherwise, |estimator| estimator.value)
    }

    /// Tests whether the author chose the numbers of an estimator, beside data on sensors, start and disturbances.
    pub fn has_gains(&self) -> bool {
        let written = self.filter.is_some() || self.window.is_some() || self.estimator.is_some();
        self.known().is_none() && (written || self.settings().next().is_some())
    }

    /// The first of the keys that need an observer of known numbers, with its span.
    pub fn known(&self) -> Option<(&'static str, Span)> {
        let first = |key| Some((key, self.row(key)?.names().first()?.span));
        let output = self.form.as_ref().filter(|form| form.value == Form::Output).map(|form| ("form", form.span));
        ["sensors", "start", "disturbance"].into_iter().find_map(first).or(output)
    }

    /// The span of a key's numbers, if it is written.
    pub fn span_of(&self, key: &str) -> Option<Span> {
        spans(self).find(|(known, _)| *known == key).map(|(_, span)| span)
    }

    /// The written settings of estimators, with their spans.
    fn settings(&self) -> impl Iterator<Item = (&'static str, Span)> {
        spans(self).filter(|(key, _)| Estimator::ALL.iter().any(|estimator| estimator.has(key)))
    }
}

/// The keys of a section that have numbers, with the spans of these.
fn spans(section: &dyn Value) -> impl Iterator<Item = (&'static str, Span)> {
    section.rows().into_iter().filter_map(|row| {
        let numbers = row.value.numbers();
        Some((row.key, numbers.first()?.span.to(numbers.last()?.span)))
    })
}
