//! The section `simulation`: a closed loop to simulate, and what to compare with.

use super::choice::choices;
use super::delay::Delay;
use super::formula::{Decimal, Formula};
use super::section::{Each, Formulas, Names, Number, Numbers, Row, Text, Value, section};
use super::spanned::{Entry, Spanned};
#[cfg(feature = "yaml")]
use super::yaml::{Key, Read};

section! {
    /// A closed loop to simulate.
    pub struct Simulation {
        duration: Number, "duration: 0.1", "How long to simulate, in seconds"
            => positive("the duration must be positive");
        step: Number, "step: 1e-6", "The sampling period of observer and control law, in seconds"
            => positive("the step must be positive");
        initial: Formulas, "initial: {i1: 0, v2: E}", "The states and outputs at the start, in parameters"
            => of(Names::XOrY);
        signals: Vec<Entry<Vec<Piece>>>, "signals: {V_d: {0: 25, 0.2: 30}}",
            "Signals in time, those of `w` too: a formula in t and parameters, or a map from start times to formulas, which are steps";
        noise: Each, "noise: {v2: 0.1, v4: 0.1}",
            "The standard deviation of each output's samples, in the unit of the output; 0 if left out" => of(Names::Y),
            deviation();
        bias: Each, "bias: {v2: 0.1}",
            "The constant offset of each output's sensor, in the unit of the output; 0 if left out" => of(Names::Y);
        quantisation: Each, "quantisation: {v2: 0.05}",
            "The step of each output's converter, in the unit of the output: a sample is the multiple of it that is nearest; none if 0 or left out"
            => of(Names::Y), not_negative("the step of a quantisation must not be negative", "write 0 for none");
        delay: Delay, "delay: {v2: 2e-6}",
            "How old a sample is, in seconds: one number, or one for each output; a part of a step is interpolated straight between samples; that of the section `observer` if left out"
            => of(Names::Y), late();
        jitter: Number, "jitter: 0.3",
            "How far an instant of the loop is from its place at most, as a share of the step below 0.5: uniform, and not told to any observer"
            => within(|value| (0.0..0.5).contains(&value), "`jitter` must be 0 or more, and below 0.5", "write it as a share of the step, as `jitter: 0.3` for 30 %");
        dropped: Number, "dropped: 0.2",
            "The probability that the sample of an instant never arrives, from 0 to below 1; the first one does"
            => within(|value| (0.0..1.0).contains(&value), "`dropped` must be 0 or more, and below 1", "write a probability, as `dropped: 0.2` for every fifth sample");
        every: Each, "every: {v4: 10}",
            "Of an output only each so many-th sample arrives, the first included; 1 if left out" => of(Names::Y),
            count("`every` of `<name>` is a number of samples", "write a whole number above zero: 1 for every sample");
        plant: Vec<Entry<Vec<Piece>>>, "plant: {E: {0: 12, 0.5: 13}}",
            "True values where the model errs: of parameters, and of states whose rate is 0, in t and parameters"
            => of(Names::ParameterOrX);
        define: Formulas, "define: {p: V_d*hat(i1)}", "Names for parts of the formulas of the simulation", hat();
        control: Formulas, "control: {d: V_d/(V_d + E)}",
            "The control law: each input in outputs, estimates hat(x), signals, parameters and t", hat()
            => of(Names::U);
        feedback: Text, "feedback: observer",
            "Whose estimates the control law uses: observer, truth, or the name of a baseline";
        baselines: Vec<Entry<Baseline>>,
            "baselines: {kalman: {sensors: {v2: 0.1}}, copy: {state: {a: -a}, estimate: {i1: a}}}",
            "Other observers to compare with: kalman, ekf, luenberger, or ones given by their equations", hat();
        panels: Vec<Panel>, "panels: [{title: error, unit: A, curves: [hat(i1) - i1]}]", "The panels of the figure",
            hat();
    }
}

/// A formula of time that holds from some time on.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its beginning, in seconds; the pieces of a signal begin one after the other.
    pub from: Spanned<Decimal>,
    /// The formula.
    pub formula: Formula,
}

impl Value for Piece {}

/// An observer to compare with.
#[derive(Clone, Debug, PartialEq)]
pub enum Baseline {
    /// An observer given by its equations, under any name but the reserved ones.
    Equations(Equations),
    /// A Kalman filter of the plant, under its own name.
    Kalman(Kalman),
    /// A Kalman filter of the plant as linearised at its estimate, under its own name.
    Extended(Kalman),
    /// Luenberger's observer of the plant, under its own name.
    Luenberger(Luenberger),
}

impl Baseline {
    /// The name of the Kalman filter, of a plant that is affine in its states.
    pub const KALMAN: &str = "kalman";

    /// The name of the extended Kalman filter.
    pub const EXTENDED: &str = "ekf";

    /// The name of Luenberger's observer.
    pub const LUENBERGER: &str = "luenberger";

    /// The names that say a kind.
    #[cfg(feature = "yaml")]
    pub(super) const KEYS: &'static [Key] = &[
        Key::new(
            Self::KALMAN,
            Kalman::SHAPE,
            "kalman: {sensors: {v2: 0.1}, disturbance: {i1: 1}}",
            "The Kalman filter of a plant that is affine in its states and outputs",
        ),
        Key::new(
            Self::EXTENDED,
            Kalman::SHAPE,
            "ekf: {sensors: {v2: 0.1}, disturbance: {i1: 1}}",
            "The extended Kalman filter, which linearises the plant at its estimate",
        ),
        Key::new(
            Self::LUENBERGER,
            Luenberger::SHAPE,
            "luenberger: {poles: [-100, -110]}",
            "Luenberger's observer, of the plant as linearised at its estimate",
        ),
    ];

    /// Its equations, if it is given by these.
    pub fn equations(&self) -> Option<&Equations> {
        if let Self::Equations(equations) = self { Some(equations) } else { None }
    }
}

impl Value for Baseline {
    fn rows(&self) -> Vec<Row<'_>> {
        match self {
            Self::Equations(equations) => equations.rows(),
            Self::Kalman(filter) | Self::Extended(filter) => filter.rows(),
            Self::Luenberger(observer) => observer.rows(),
        }
    }
}

section! {
    /// A Kalman filter of the states and outputs, with the same samples; standard deviations that are not given here are
    /// those of the file's keys.
    pub struct Kalman {
        sensors: Each, "sensors: {v2: 0.1}",
            "The standard deviation of each output's samples; that of `noise` and `quantisation` together if left out"
            => of(Names::Y), positive("the standard deviation of a sensor must be positive");
        start: Each, "start: {i1: 1}",
            "How wrong each unmeasured state is at the start, a standard deviation; its very error if left out"
            => of(Names::X), deviation();
        disturbance: Each, "disturbance: {i1: 0.1}",
            "By how much a state or output drifts besides its rate, in its unit per root second; 0 if left out"
            => of(Names::XOrY), deviation();
        initial: Formulas, "initial: {i1: 1}",
            "The estimates of the unmeasured states at the start, in parameters and outputs; zero if left out"
            => of(Names::X);
    }
}

section! {
    /// Luenberger's observer of the states and outputs: the error has these poles while the inputs are zero.
    pub struct Luenberger {
        poles: Numbers, "poles: [-100, -110]",
            "Poles of the error in 1/s, negative: one for each state and each output that has a rate, dealt to the outputs in turn",
            required();
        initial: Formulas, "initial: {i1: 1}",
            "The estimates of the unmeasured states at the start, in parameters and outputs; zero if left out"
            => of(Names::X);
    }
}

section! {
    /// An observer given by its equations; `hat(x)` is its own estimate.
    pub struct Equations {
        state: Formulas, "state: {a: -a + v2}", "The states of the baseline observer with their rates", required();
        initial: Formulas, "initial: {a: 0}", "Its states at the start; zero if left out";
        estimate: Formulas, "estimate: {i1: a}", "Its estimates of the unmeasured states", required() => of(Names::X);
    }
}

section! {
    /// A panel of the figure: curves over time on one axis.
    pub struct Panel {
        title: Spanned<String>, "title: error", "The heading of the panel", required();
        unit: Text, "unit: A", "The unit of its axis";
        curves: Vec<Formula>, "curves: [hat(i1) - i1]", "What to draw, as formulas", required();
        scale: Spanned<Scale>, "scale: log", "The scale of its axis; linear if left out";
    }
}

choices! {
    /// The divisions of an axis.
    #[derive(Default)]
    pub enum Scale {
        /// Equal differences are equally far apart.
        #[default]
        Linear = "linear",
        /// Equal quotients are equally far apart; the absolute values of the curves are drawn.
        Log = "log",
    }
}

impl Simulation {
    /// For `feedback`: the estimates of the model's own observer.
    pub const OBSERVER: &str = "observer";

    /// For `feedback`: the unmeasured states themselves, as the control law may see them in a simulation.
    pub const TRUTH: &str = "truth";

    /// Tests whether a sample may differ from its output, or be missing.
    pub fn is_imperfect(&self) -> bool {
        let lists = [&self.noise, &self.bias, &self.quantisation].iter().any(|entries| !entries.is_empty());
        lists || self.delay.written().next().is_some() || self.dropped.is_some() || !self.every.is_empty()
    }

    /// The standard deviation of an output's samples, if it is not zero: by noise, and by rounding to the nearest multiple
    /// of a step, whose error is uniformly distributed.
    pub fn deviation(&self, output: &str) -> Option<f64> {
        let of = |entries: &Each| {
            let entry = entries.iter().find(|entry| entry.name.value == output);
            entry.map_or(0.0, |entry| entry.value.value.to_f64())
        };
        let deviation = of(&self.noise).hypot(of(&self.quantisation) / 12.0_f64.sqrt());
        Some(deviation).filter(|deviation| *deviation > 0.0)
    }

    /// The keys that make the plant and its sensors differ from the model, whose observer knows these delays.
    pub fn departures(&self, known: &Delay) -> Vec<&'static str> {
        let keys = ["plant", "bias", "delay", "jitter", "noise", "quantisation", "dropped", "every"];
        let acts = |key: &str| {
            self.row(key).is_some_and(|value| value.numbers().iter().any(|number| number.value.to_f64() != 0.0))
        };
        let differs = |key: &str| match key {
            "plant" => !self.plant.is_empty(),
            "delay" => acts(key) && self.delay != *known,
            _ => acts(key),
        };
        keys.into_iter().filter(|key| differs(key)).collect()
    }

    /// The possible sources of the control law's estimates.
    pub fn feedbacks(&self) -> Vec<&str> {
        let baselines = self.baselines.iter().map(|entry| entry.name.value.as_str());
        [Self::OBSERVER, Self::TRUTH].into_iter().chain(baselines).collect()
    }
}
