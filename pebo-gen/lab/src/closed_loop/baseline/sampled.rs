//! Baselines given by name: observers of all states that take samples.
//!
//! In: the plant's model and the settings of the baseline. Out: a [`NamedBaseline`], which builds a [`Follower`] that
//! takes the samples of the model's own observer and writes an estimate of each unmeasured state.

use std::fmt;

use pebo_runtime::nalgebra::{SMatrix, SVector};

use crate::closed_loop::scope::{Names, Sight, View, number};
use crate::observe::design::program;
use crate::observe::sizes::{LARGEST, pad};
use crate::settings::Value;
use pebo_cas::Expr;
use pebo_design::model::{Baseline, Decimal, Entry, Kalman, Luenberger, Spanned};
use pebo_design::plant::lower;
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

use super::gain::{self, Gain, Sample};
use super::linearised::{LinearisedPlant, PaddedPlant};

/// An observer by name, ready to be built.
#[derive(Debug)]
pub(crate) struct NamedBaseline {
    plant: LinearisedPlant,
    /// The estimates of x at the start, from the outputs.
    start: Program,
    rule: Rule,
}

#[derive(Debug)]
enum Rule {
    /// Standard deviations of states at the start where they are written, of disturbances, and of sensors.
    Kalman { start: Vec<Option<f64>>, disturbance: Vec<f64>, sensors: Vec<f64> },
    /// Poles of continuous time.
    Luenberger(Vec<f64>),
}

/// The standard deviation of a filter's estimates at the start, where that is not written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum StartError<'a> {
    /// The error itself, as the truth is simulated.
    Known,
    /// That of the model's own observer by name of the state, as nobody knows the truth of a recording.
    Assumed(&'a [Value]),
}

impl NamedBaseline {
    /// Resolves a baseline that has no equations; mistakes are reported.
    pub(crate) fn resolve(
        names: &Names,
        entry: &Entry<Baseline>,
        start_error: StartError<'_>,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let place = (entry.name.value.as_str(), entry.name.span);
        let plant = LinearisedPlant::resolve(names, place, problems)?;
        let (rule, initial) = match &entry.value {
            Baseline::Equations(_) => return None,
            Baseline::Kalman(_) if !plant.is_affine => {
                let (name, span) = place;
                let message = format!("`{name}` needs a plant that is affine in its states and outputs");
                problems.push(
                    Diagnostic::error(Code::SettingConflict, span, message)
                        .help("write `ekf` in its place: the extended filter linearises the plant at its estimate"),
                );
                return None;
            }
            Baseline::Kalman(written) | Baseline::Extended(written) => {
                (kalman(names, written, (&plant, start_error), place, problems)?, &written.initial)
            }
            Baseline::Luenberger(written) => (luenberger(written, &plant, place, problems)?, &written.initial),
        };
        let arena = &names.plant.arena;
        let scope = names.scope(&View { sight: Sight::Outputs, ..View::default() });
        let mut start = Vec::new();
        for state in &names.plant.x {
            let written = initial.iter().find(|entry| arena.symbol(&entry.name.value) == state.symbol);
            start.push(match written {
                Some(entry) => problems.keep(lower(arena, &scope, &entry.value))?,
                None => arena.zero(),
            });
        }
        // The outputs are passed as arguments.
        let measured =
            names.plant.y.iter().map(|output| (names.measured(output.symbol), arena.of_symbol(output.symbol)));
        let measured = measured.collect();
        let start: Vec<Expr> = start.into_iter().map(|formula| arena.replace(formula, &measured)).collect();
        let outputs: Vec<_> = names.plant.y.iter().map(|output| output.symbol).collect();
        let start = problems.keep(program(arena, &outputs, &start, entry.name.span))?;
        Some(Self { plant, start, rule })
    }

    /// The observer at its first sample; the states are truly `x`, where that is known.
    pub(crate) fn follower(&self, x: Option<&[f64]>, y: &[f64]) -> Box<dyn Follower> {
        match self.plant.states.len().max(self.plant.outputs) {
            0..=4 => Box::new(PaddedFollower::<4>::new(self, x, y)),
            5..=8 => Box::new(PaddedFollower::<8>::new(self, x, y)),
            _ => Box::new(PaddedFollower::<LARGEST>::new(self, x, y)),
        }
    }
}

fn kalman(
    names: &Names,
    written: &Kalman,
    (plant, start_error): (&LinearisedPlant, StartError<'_>),
    (name, span): (&str, Span),
    problems: &mut Diagnostics,
) -> Option<Rule> {
    let arena = &names.plant.arena;
    let mut sensors = Vec::new();
    for output in names.plant.y.iter().map(|output| arena.name(output.symbol)) {
        let of_noise = || names.simulation.deviation(&output);
        let of_observer = || number(&names.model.observer.sensors, &output);
        let deviation = number(&written.sensors, &output).or_else(of_noise).or_else(of_observer);
        if deviation.is_none() {
            let message = format!("`{name}` needs the standard deviation of `{output}`");
            problems.push(Diagnostic::error(Code::SimulationIncomplete, span, message).help(format!(
                "add `sensors: {{{output}: 0.1}}` to it or to `observer`, or `noise: {{{output}: 0.1}}` to the simulation"
            )));
        }
        sensors.push(deviation?);
    }
    let of_states = |entries: &[Entry<Spanned<Decimal>>]| -> Vec<Option<f64>> {
        plant.states.iter().map(|state| number(entries, &arena.name(*state))).collect()
    };
    let disturbance = of_states(&written.disturbance).into_iter().map(Option::unwrap_or_default).collect();
    let mut start = of_states(&written.start);
    if let StartError::Assumed(own) = start_error {
        for (state, deviation) in names.plant.x.iter().zip(&mut start) {
            let state = arena.name(state.symbol);
            let of_own = || own.iter().find(|value| value.name == state).map(|value| value.value);
            *deviation = deviation.or_else(of_own);
            if deviation.is_none() {
                let message = format!("`{name}` needs to know how wrong its estimate of `{state}` can be at the start");
                problems.push(
                    Diagnostic::error(Code::SimulationIncomplete, span, message)
                        .help(format!("add `start: {{{state}: 1}}`, a standard deviation, to it or to `observer`")),
                );
                return None;
            }
        }
    }
    Some(Rule::Kalman { start, disturbance, sensors })
}

fn luenberger(
    written: &Luenberger,
    plant: &LinearisedPlant,
    (name, span): (&str, Span),
    problems: &mut Diagnostics,
) -> Option<Rule> {
    let (wanted, found) = (plant.states.len(), written.poles.len());
    if wanted == found {
        return Some(Rule::Luenberger(written.poles.iter().map(|pole| pole.value.to_f64()).collect()));
    }
    let message = format!("`{name}` has {found} poles, and {wanted} states");
    problems.push(
        Diagnostic::error(Code::WrongShape, span, message)
            .help("write a pole for each state of x, and for each output that has a rate"),
    );
    None
}

/// A running observer of any size.
pub(crate) trait Follower: fmt::Debug {
    /// Takes the inputs during an interval of `dt` seconds and at its end, and the outputs there if their sample arrived.
    fn sample(&mut self, y: Option<&[f64]>, u: [&[f64]; 2], dt: f64);

    /// Writes the estimates of x; NaN where it has none.
    fn write(&self, hat: &mut [f64]);
}

#[derive(Debug)]
struct PaddedFollower<const N: usize> {
    plant: PaddedPlant<N>,
    gain: Gain<N>,
    state: SVector<f64, N>,
}

impl<const N: usize> PaddedFollower<N> {
    fn new(sampled: &NamedBaseline, x: Option<&[f64]>, y: &[f64]) -> Self {
        let mut start = vec![0.0; sampled.start.outputs.len()];
        Interpreter::new(&sampled.start).run(y, &mut start);
        let mut state = pad::<N>(&start);
        for (output, place) in sampled.plant.places.iter().enumerate() {
            if let Some(place) = place {
                state[*place] = y[output];
            }
        }
        let gain = match &sampled.rule {
            Rule::Luenberger(poles) => {
                Gain::Luenberger(gain::Luenberger { poles: poles.clone(), outputs: y.len(), known: None })
            }
            Rule::Kalman { start: written, disturbance, sensors } => {
                let mut deviations = SVector::<f64, N>::zeros();
                for (place, start) in start.iter().enumerate() {
                    let error = || x.map_or(f64::INFINITY, |x| x[place] - start);
                    deviations[place] = written[place].unwrap_or_else(error);
                }
                for (output, place) in sampled.plant.places.iter().enumerate() {
                    if let Some(place) = place {
                        deviations[*place] = sensors[output];
                    }
                }
                Gain::Kalman(gain::Kalman {
                    covariance: SMatrix::from_diagonal(&deviations.map(|deviation| deviation * deviation)),
                    intensity: pad::<N>(disturbance).map(|deviation| deviation * deviation),
                    sensors: sensors.iter().map(|deviation| deviation * deviation).collect(),
                })
            }
        };
        Self { plant: PaddedPlant::new(&sampled.plant), gain, state }
    }
}

impl<const N: usize> Follower for PaddedFollower<N> {
    fn sample(&mut self, y: Option<&[f64]>, [during, after]: [&[f64]; 2], dt: f64) {
        let Ok(step) = self.plant.advance(&self.state, during, dt) else {
            self.state.fill(f64::NAN);
            return;
        };
        self.gain.predict(&step, dt);
        self.state = step.state;
        let Some(y) = y else { return };
        let (predicted, slopes) = self.plant.measure(&step.state, after);
        let mut sample = Sample { innovation: pad::<N>(y) - predicted, slopes };
        for output in (0..y.len()).filter(|output| y[*output].is_nan()) {
            sample.innovation[output] = 0.0;
            // A covariance learns nothing from a missing output; poles are those of all outputs.
            if matches!(self.gain, Gain::Kalman(_)) {
                sample.slopes.row_mut(output).fill(0.0);
            }
        }
        match self.gain.correct(&step, &sample, dt) {
            Some(correction) => self.state += correction,
            None => self.state.fill(f64::NAN),
        }
    }

    fn write(&self, hat: &mut [f64]) {
        hat.copy_from_slice(&self.state.as_slice()[..hat.len()]);
    }
}
