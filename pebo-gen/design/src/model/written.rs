//! The types of a model as written.
//!
//! These are the sections of a model file, in its words. Lists keep the order of the file, except
//! where [`Model::ordered`] says otherwise.

#[cfg(feature = "yaml")]
use serde::Deserialize;

use super::class::Class;
use super::definitions::sorted;
use super::delay::Delay;
use super::formula::{Comparison, Decimal, Formula};
use super::observer::Observer;
use super::recording::Recording;
use super::spanned::{Entry, Spanned};
use crate::source::Span;

/// A model.
///
/// A list that the file leaves out is empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Identifier: the emitted module's name.
    pub name: Spanned<String>,
    /// One line for people.
    pub title: Option<Spanned<String>>,
    /// The source of the model.
    pub reference: Option<Spanned<String>>,
    /// Parameters, with their values where these are given already.
    pub parameters: Vec<Entry<Option<Spanned<Decimal>>>>,
    /// Unmeasured states.
    pub x: Vec<Spanned<String>>,
    /// Measured outputs.
    pub y: Vec<Spanned<String>>,
    /// Inputs.
    pub u: Vec<Spanned<String>>,
    /// The first use of the time `t` in the formulas, if no declaration has that name: then it is the last input.
    pub time: Option<Span>,
    /// Unmeasured signals that are not estimated: no result may depend on them.
    pub w: Vec<Spanned<String>>,
    /// Named sub-expressions, each of which uses only earlier ones.
    pub define: Vec<Entry<Formula>>,
    /// The class of cascade that the author wants; either if absent.
    pub cascade_class: Option<Spanned<CascadeClass>>,
    /// The form of a regression made of a relation between the components of the transform.
    pub regression_form: Option<Spanned<RegressionForm>>,
    /// Inequalities that hold where the plant operates.
    pub assume: Vec<Comparison>,
    /// The class that the plant is written by, which fills the empty fields below.
    pub class: Option<Class>,
    /// Rates of x: one for each, in the order of `x`.
    pub f_x: Vec<Entry<Formula>>,
    /// Rates of y, in the order of `y`; unneeded ones may be absent.
    pub f_y: Vec<Entry<Formula>>,
    /// Values of outputs that are functions of the other signals, in the order of `y`.
    pub g_y: Vec<Entry<Formula>>,
    /// The transform, component by component.
    pub phi: Vec<Formula>,
    /// The left inverse, in the order of `x`: of all, of some (a partial observer) or of none (to
    /// be derived).
    pub phi_left: Vec<Entry<Formula>>,
    /// Expressions that are zero by physics.
    pub identities: Vec<Formula>,
    /// States that start at these values.
    pub known: Vec<Entry<Formula>>,
    /// States and outputs that are angles, with their periods.
    pub angles: Vec<Entry<Formula>>,
    /// Units of parameters and signals.
    pub units: Vec<Entry<Spanned<String>>>,
    /// The construction of the observer.
    pub observer: Observer,
    /// The simulation.
    pub simulation: Option<Simulation>,
    /// The meaning of recorded data.
    pub recording: Option<Recording>,
}

/// A closed loop to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// The duration, in seconds.
    pub duration: Option<Spanned<Decimal>>,
    /// Sampling period of observer and control, in seconds.
    pub step: Option<Spanned<Decimal>>,
    /// States x and outputs y at the start, in parameters.
    pub initial: Vec<Entry<Formula>>,
    /// Signals in time, in `t` and parameters.
    pub signals: Vec<Entry<Vec<Piece>>>,
    /// Standard deviations of the outputs' samples, in their units; none where absent.
    pub noise: Vec<Entry<Spanned<Decimal>>>,
    /// Constant offsets of the outputs' sensors, in the units of the outputs; none where absent.
    pub bias: Vec<Entry<Spanned<Decimal>>>,
    /// Steps of the values of a sensor, in the units of the outputs; none where absent or 0.
    pub quantisation: Vec<Entry<Spanned<Decimal>>>,
    /// The age of a sensor's values, in seconds.
    pub delay: Delay,
    /// The largest distance of an instant of the loop from its nominal time, as a share of the step.
    pub jitter: Option<Spanned<Decimal>>,
    /// The probability that a sample never arrives.
    pub dropped: Option<Spanned<Decimal>>,
    /// The number of samples of an output to one that arrives; one where absent.
    pub every: Vec<Entry<Spanned<Decimal>>>,
    /// True values in time of parameters, and of states whose rate is 0, in `t` and the model's parameters: where they
    /// differ from the model.
    pub plant: Vec<Entry<Vec<Piece>>>,
    /// Named sub-expressions for the control law, each of which uses only earlier ones and those of the model.
    pub define: Vec<Entry<Formula>>,
    /// The control law: inputs in outputs, estimates, signals, parameters and `t`.
    pub control: Vec<Entry<Formula>>,
    /// The source of the control law's estimates: `observer` (so also if absent), `truth`, or a baseline.
    pub feedback: Option<Spanned<String>>,
    /// Other observers to compare with.
    pub baselines: Vec<Entry<Baseline>>,
    /// The panels of the figure.
    pub panels: Vec<Panel>,
}

/// A formula of time that holds from some time on.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its beginning, in seconds; the pieces of a signal begin one after the other.
    pub from: Spanned<Decimal>,
    /// The formula.
    pub formula: Formula,
}

/// An observer to compare with.
#[derive(Clone, Debug, PartialEq)]
pub enum Baseline {
    /// An observer given by its equations, under any name but the reserved ones.
    Equations(Equations),
    /// A Kalman filter of the plant, under its own name.
    Kalman(Kalman),
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

    /// Its equations, if it is given by these.
    pub fn equations(&self) -> Option<&Equations> {
        if let Self::Equations(equations) = self { Some(equations) } else { None }
    }
}

/// A Kalman filter of the states and outputs, with the same samples; standard deviations that are not given here are
/// those of the file's keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Kalman {
    /// True for the extended one, of the plant as linearised at its estimate.
    pub extended: bool,
    /// Standard deviations of the outputs' samples.
    pub sensors: Vec<Entry<Spanned<Decimal>>>,
    /// Standard deviations of the unmeasured states at the start.
    pub start: Vec<Entry<Spanned<Decimal>>>,
    /// The drift of a state or an output besides its rate, in its unit per root second.
    pub disturbance: Vec<Entry<Spanned<Decimal>>>,
    /// Its estimates at the start, zero where absent.
    pub initial: Vec<Entry<Formula>>,
}

/// Luenberger's observer of the states and outputs: the error has these poles while the inputs are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Luenberger {
    /// The poles of continuous time, in 1/s: one for each state and each output that has a rate.
    pub poles: Vec<Spanned<Decimal>>,
    /// Its estimates at the start, zero where absent.
    pub initial: Vec<Entry<Formula>>,
}

/// An observer given by its equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    /// Its states with their rates; `hat(x)` is its own estimate.
    pub state: Vec<Entry<Formula>>,
    /// Its states at the start, in outputs and parameters; zero where absent.
    pub initial: Vec<Entry<Formula>>,
    /// Its estimates of x, in its states, outputs, inputs and parameters.
    pub estimate: Vec<Entry<Formula>>,
}

/// A panel of the figure: curves over time on one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Its heading.
    pub title: Spanned<String>,
    /// The unit of the axis.
    pub unit: Option<Spanned<String>>,
    /// The curves.
    pub curves: Vec<Formula>,
    /// The axis.
    pub scale: Scale,
}

/// The divisions of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "lowercase"))]
pub enum Scale {
    /// Equal differences are equally far apart.
    #[default]
    Linear,
    /// Equal quotients are equally far apart; the absolute values of the curves are drawn.
    Log,
}

/// The class of a cascade.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "lowercase"))]
pub enum CascadeClass {
    /// z' = h: the extension is an integrator, z = chi + theta.
    Pebo,
    /// z' = Lambda z + h: xi' = Lambda xi + h, Psi' = Lambda Psi, z = xi + Psi theta.
    Gpebo,
}

impl CascadeClass {
    /// The names in a model.
    pub const NAMES: &[&str] = &["pebo", "gpebo"];

    /// The class of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Pebo, Self::Gpebo].into_iter().find(|class| class.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pebo => Self::NAMES[0],
            Self::Gpebo => Self::NAMES[1],
        }
    }
}

/// The form of a regression that a model asks for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "lowercase"))]
pub enum RegressionForm {
    /// A relation between the components of the transform as it holds at every instant, with functions of theta among the
    /// unknowns where it is not affine.
    Static,
    /// Such a relation under the derivative, where constants vanish.
    Differentiated,
    /// All equations as they are, to first order at the estimate.
    Local,
}

impl RegressionForm {
    /// The names in a model.
    pub const NAMES: &[&str] = &["static", "differentiated", "local"];

    /// The form of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Static, Self::Differentiated, Self::Local].into_iter().find(|form| form.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Static => Self::NAMES[0],
            Self::Differentiated => Self::NAMES[1],
            Self::Local => Self::NAMES[2],
        }
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

    /// The keys that make the plant and its sensors differ from the model, whose observer knows these delays.
    pub fn departures(&self, known: &Delay) -> Vec<&'static str> {
        let acts = |number: &Spanned<Decimal>| number.value.to_f64() != 0.0;
        let any = |entries: &[Entry<Spanned<Decimal>>]| entries.iter().any(|entry| acts(&entry.value));
        let keys = [
            ("plant", !self.plant.is_empty()),
            ("bias", any(&self.bias)),
            ("delay", self.delay != *known && self.delay.written().any(acts)),
            ("jitter", self.jitter.as_ref().is_some_and(acts)),
            ("noise", any(&self.noise)),
            ("quantisation", any(&self.quantisation)),
            ("dropped", self.dropped.as_ref().is_some_and(acts)),
            ("every", any(&self.every)),
        ];
        keys.into_iter().filter_map(|(key, is_there)| is_there.then_some(key)).collect()
    }

    /// The possible sources of the control law's estimates.
    pub fn feedbacks(&self) -> Vec<&str> {
        let baselines = self.baselines.iter().map(|entry| entry.name.value.as_str());
        [Self::OBSERVER, Self::TRUTH].into_iter().chain(baselines).collect()
    }
}

impl Model {
    /// The model with the entries of `f_x`, `f_y`, `g_y` and `phi_left` in the order of their states, and definitions
    /// after the ones that they use.
    #[must_use]
    pub(super) fn ordered(mut self) -> Self {
        let order = |entries: &mut Vec<Entry<Formula>>, states: &[Spanned<String>]| {
            entries.sort_by_cached_key(|entry| states.iter().position(|state| state.value == entry.name.value));
        };
        order(&mut self.f_x, &self.x);
        order(&mut self.f_y, &self.y);
        order(&mut self.g_y, &self.y);
        order(&mut self.phi_left, &self.x);
        self.define = sorted(self.define);
        if let Some(simulation) = &mut self.simulation {
            simulation.define = sorted(std::mem::take(&mut simulation.define));
        }
        self
    }

    /// The names of the model: parameters, x, y, u, w and definitions, in this order.
    pub fn names(&self) -> impl Iterator<Item = &Spanned<String>> {
        self.declared().chain(self.define.iter().map(|entry| &entry.name))
    }

    /// The names of symbols: parameters, x, y, u and w, in this order.
    pub fn declared(&self) -> impl Iterator<Item = &Spanned<String>> {
        let parameters = self.parameters.iter().map(|entry| &entry.name);
        let signals = [&self.x, &self.y, &self.u, &self.w].into_iter().flatten();
        parameters.chain(signals)
    }
}
