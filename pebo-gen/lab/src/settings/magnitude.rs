//! What is assumed where nothing is known: magnitudes at the start, and how long a change takes.
//!
//! These numbers are no estimates of anything: they make an observer that converges on an exact model, whatever its units
//! are, and follows changes of it within some hundred samples.

use pebo_cas::Symbol;
use pebo_design::model::{Decimal, Entry, Model, Spanned};
use pebo_design::plant::{Plant, State};

use super::point::Point;

/// A sensor errs by this part of what it shows at the start.
const SENSOR: f64 = 1e-3;

/// The start may be wrong by so many times the state.
const START: f64 = 10.0;

/// Samples within which a constant drifts by its own magnitude.
const SAMPLES: f64 = 1000.0;

/// A state that has a rate drifts by this part of that: its rate says the rest.
const DRIFT: f64 = 0.02;

/// Or as much as it would if all the summands of its rate erred by this part for so long; but by no more than its start may
/// be wrong by. Summands that cancel, as those of a converter with a small inductance, would say that nothing is known of
/// it after a few samples, and with such an observer no other unknown is told apart from it.
const RATE: f64 = 0.01;

/// A magnitude that is nowhere said: 1 of its unit.
const UNIT: f64 = 1.0;

/// Standard deviations in the order of the plant's states and outputs, written or assumed.
#[derive(Clone, Debug)]
pub(super) struct Deviations {
    /// Of the samples of each output.
    pub(super) sensors: Vec<f64>,
    /// Of each state at the start.
    pub(super) start: Vec<f64>,
    /// Of what each state drifts by per root second.
    pub(super) disturbance: Vec<f64>,
    /// Of what each output drifts by besides its rate.
    pub(super) of_outputs: Vec<f64>,
}

impl Deviations {
    /// What the model says, and what is assumed in place of the rest; `period` is that of the samples.
    pub(super) fn of(model: &Model, plant: &Plant, point: &Point, period: Option<f64>) -> Option<Self> {
        let arena = &plant.arena;
        let written = &model.observer;
        let silent = [&written.sensors, &written.start, &written.disturbance].iter().all(|entries| entries.is_empty());
        let of = |entries: &[Entry<Spanned<Decimal>>], symbol: Symbol| {
            let name = arena.name(symbol);
            entries.iter().find(|entry| entry.name.value == name).map(|entry| entry.value.value.to_f64())
        };
        let magnitude =
            |symbol: Symbol| point.of_symbol(symbol).map(f64::abs).filter(|size| *size > 0.0).unwrap_or(UNIT);
        let simulated = |symbol: Symbol| {
            let simulation = model.simulation.as_ref()?;
            let noise = of(&simulation.noise, symbol).unwrap_or_default();
            // Rounding to the nearest multiple of a step errs evenly.
            let rounding = of(&simulation.quantisation, symbol).unwrap_or_default() / 12.0_f64.sqrt();
            Some(noise.hypot(rounding)).filter(|deviation| *deviation > 0.0)
        };
        let x: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let sensor = |symbol: &Symbol| {
            let assumed = || SENSOR * magnitude(*symbol);
            of(&written.sensors, *symbol).or_else(|| simulated(*symbol)).unwrap_or_else(assumed)
        };
        let start = |symbol: &Symbol| of(&written.start, *symbol).unwrap_or_else(|| START * magnitude(*symbol));
        let drift = |state: &State| match of(&written.disturbance, state.symbol) {
            Some(deviation) => Some(deviation),
            None if silent => {
                let (size, root) = (magnitude(state.symbol), (SAMPLES * period?).sqrt());
                let summands = plant.terms.get(&state.symbol).into_iter().flatten();
                let rate: f64 = summands.filter_map(|summand| point.value(summand.expr)).map(f64::abs).sum();
                if arena.is_zero(state.rate.expr) {
                    return Some(size / root);
                }
                let erring = if rate.is_finite() { (RATE * rate * root).min(START * size / root) } else { 0.0 };
                Some((DRIFT * size / root).max(erring))
            }
            None => Some(0.0),
        };
        Some(Self {
            sensors: y.iter().map(sensor).collect(),
            start: x.iter().map(start).collect(),
            disturbance: plant.x.iter().map(drift).collect::<Option<_>>()?,
            of_outputs: y.iter().map(|output| of(&written.disturbance, *output).unwrap_or_default()).collect(),
        })
    }
}
