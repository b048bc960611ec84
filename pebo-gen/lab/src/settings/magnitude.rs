//! Assumed standard deviations where none are known: orders of magnitude at the start, and times of changes.
//!
//! These numbers estimate nothing: they make an observer that converges on an exact model, in any units, and follows
//! changes of it within some hundred samples.

use pebo_cas::{Expr, Symbol};
use pebo_design::model::{Decimal, Entry, Model, Spanned};
use pebo_design::plant::{Plant, State};

use super::point::{Point, UNIT};
use super::shown::Shown;

/// The error of a sensor, as a share of its value at the start.
const SENSOR: f64 = 1e-3;

/// The error of the start, as a multiple of the state.
const START: f64 = 10.0;

/// The same of a local regression: the estimate begins at half the state, and converges from a neighbourhood.
const NEAR: f64 = 1.0;

/// The drift of a state that has a rate, as a share of the drift of a constant.
const DRIFT: f64 = 0.02;

/// Or its drift if all the summands of its rate had this relative error for that long; but no more than the error of
/// its start. Summands that cancel, as those of a converter with a small inductance, would mean that nothing is known
/// of it after a few samples, and with such an observer no other unknown is distinguished from it.
const RATE: f64 = 0.01;

/// Standard deviations in the order of the plant's states and outputs, written or assumed.
#[derive(Clone, Debug)]
pub(super) struct Deviations {
    /// The standard deviation of the samples of each output.
    pub(super) sensors: Vec<f64>,
    /// The standard deviation of each state at the start.
    pub(super) start: Vec<f64>,
    /// The drift of each state per root second.
    pub(super) disturbance: Vec<f64>,
    /// The drift of each output besides its rate.
    pub(super) of_outputs: Vec<f64>,
    /// True if the author wrote none of them: the disturbances are a guess.
    pub(super) are_assumed: bool,
    /// True for an observer that converges from a neighbourhood.
    #[cfg(feature = "simulate")]
    pub(super) is_local: bool,
}

impl Deviations {
    /// Samples within which a constant drifts by its own magnitude.
    pub(super) const SAMPLES: f64 = 1000.0;

    /// The deviations of the model, those that samples show, and assumed ones in place of the rest; `period` is that of
    /// the samples.
    pub(super) fn of(
        model: &Model,
        plant: &Plant,
        point: &Point,
        (shown, period): (&Shown, Option<f64>),
        is_local: bool,
    ) -> Option<Self> {
        let arena = &plant.arena;
        let written = &model.observer;
        let silent = [&written.sensors, &written.start, &written.disturbance].iter().all(|entries| entries.is_empty());
        let of = |entries: &[Entry<Spanned<Decimal>>], symbol: Symbol| {
            let name = arena.name(symbol);
            entries.iter().find(|entry| entry.name.value == name).map(|entry| entry.value.value.to_f64())
        };
        let magnitude =
            |symbol: Symbol| point.of_symbol(symbol).map(f64::abs).filter(|size| *size > 0.0).unwrap_or(UNIT);
        let simulated = |symbol: Symbol| model.simulation.as_ref()?.deviation(&arena.name(symbol));
        // A plant that starts at rest has its rates later.
        let along = point.along(shown);
        let x: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let y: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let sensor = |symbol: &Symbol| {
            let assumed = || SENSOR * magnitude(*symbol);
            let recorded = || shown.deviations.get(symbol).copied();
            of(&written.sensors, *symbol).or_else(recorded).or_else(|| simulated(*symbol)).unwrap_or_else(assumed)
        };
        let far = if is_local { NEAR } else { START };
        let is_known = |symbol: &Symbol| plant.known.iter().any(|(known, _)| known == symbol);
        let assumed = |symbol: &Symbol| if is_known(symbol) { 0.0 } else { far * magnitude(*symbol) };
        let start = |symbol: &Symbol| of(&written.start, *symbol).unwrap_or_else(|| assumed(symbol));
        let drift = |state: &State| match of(&written.disturbance, state.symbol) {
            Some(deviation) => Some(deviation),
            None if silent => {
                let (size, root) = (magnitude(state.symbol), (Self::SAMPLES * period?).sqrt());
                let rate = rate(plant, state, &along);
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
            are_assumed: silent,
            #[cfg(feature = "simulate")]
            is_local,
        })
    }
}

/// The sum of the mean absolute values of a rate's summands, at these points.
fn rate(plant: &Plant, state: &State, points: &[Point]) -> f64 {
    let summands: Vec<Expr> = plant.terms.get(&state.symbol).into_iter().flatten().map(|term| term.expr).collect();
    let values: Vec<Vec<f64>> = points.iter().filter_map(|point| point.values(&summands)).collect();
    let mean = |place: usize| {
        let known: Vec<f64> =
            values.iter().map(|values| values[place].abs()).filter(|value| value.is_finite()).collect();
        known.iter().sum::<f64>() / known.iter().map(|_| 1.0).sum::<f64>()
    };
    (0..summands.len()).map(mean).filter(|mean| mean.is_finite()).sum()
}
