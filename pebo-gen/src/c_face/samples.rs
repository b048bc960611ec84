//! Samples for the example, and values of parameters that the model leaves open.
//!
//! In: an accepted model. Out: the first samples of the closed loop that it describes; of a model that describes none, or
//! whose run fails, a place of its domain. Numbers have six digits: an example is read.

use std::collections::BTreeMap;

use crate::derived::Derived;
use pebo_cas::number::interval::Precision;
use pebo_cas::{Expr, Symbol};
use pebo_lab::{Overrides, Trace};

/// The most samples.
const MOST: usize = 40;

/// The period where the model tells none, in seconds.
const PERIOD: f64 = 1e-3;

/// Samples of outputs and inputs.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(super) origin: Origin,
    pub(super) rows: Vec<Sample>,
    /// Values of all parameters: the model's, if it has them.
    pub(super) parameters: Vec<f64>,
}

/// Where samples come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    Run,
    Domain,
}

/// A sample.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    /// The time since the sample before.
    pub(super) period: f64,
    /// The outputs at its end.
    pub(super) y: Vec<f64>,
    /// The inputs during that time.
    pub(super) u: Vec<f64>,
}

impl Samples {
    /// The samples of a model.
    pub(crate) fn of(derived: &Derived) -> Self {
        let place = place(derived);
        let value = |symbol: &Symbol| place.get(symbol).copied().unwrap_or(1.0);
        let plant = &derived.plant;
        let parameters = plant.parameters.iter().map(|parameter| value(&parameter.symbol)).collect();
        let at_rest = || {
            let y = plant.y.iter().map(|output| value(&output.symbol)).collect();
            let u = plant.u.iter().map(value).collect();
            vec![Sample { period: PERIOD, y, u }; MOST]
        };
        match of_run(derived) {
            Some(rows) => Self { origin: Origin::Run, rows, parameters },
            None => Self { origin: Origin::Domain, rows: at_rest(), parameters },
        }
    }
}

/// The first samples of the model's closed loop.
fn of_run(derived: &Derived) -> Option<Vec<Sample>> {
    let plant = &derived.plant;
    let step = derived.model.simulation.as_ref()?.step.as_ref()?.value.to_f64();
    let samples = u32::try_from(MOST - 1).ok()?;
    let overrides =
        Overrides { duration: Some(step * f64::from(samples)), every: Some(step / 2.0), ..Overrides::default() };
    let trace = derived.scenario(&overrides).ok()?.run().ok()?;
    let times = trace.column("t")?;
    let outputs: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
    let (y, u) = (columns(derived, &trace, &outputs)?, columns(derived, &trace, &plant.u)?);
    let at = |columns: &[Vec<f64>], row: usize| columns.iter().map(|column| rounded(column[row])).collect::<Vec<_>>();
    let rows = (0..times.len().min(MOST)).map(|row| {
        let period = if row == 0 { step } else { times[row] - times[row - 1] };
        // The input was held since the sample before.
        Sample { period: rounded(period), y: at(&y, row), u: at(&u, row.saturating_sub(1)) }
    });
    let rows: Vec<Sample> = rows.collect();
    let is_good = |row: &Sample| row.period > 0.0 && row.y.iter().chain(&row.u).all(|value| value.is_finite());
    rows.iter().all(is_good).then_some(rows)
}

/// The columns of signals.
fn columns(derived: &Derived, trace: &Trace, signals: &[Symbol]) -> Option<Vec<Vec<f64>>> {
    signals.iter().map(|signal| trace.column(&derived.plant.arena.name(*signal))).collect()
}

/// Values in the domain, at the given values of parameters.
fn place(derived: &Derived) -> BTreeMap<Symbol, f64> {
    let plant = &derived.plant;
    let arena = &plant.arena;
    let domain = derived.derivation.domain(plant).at_given_values(arena);
    let signals = plant.y.iter().map(|output| output.symbol).chain(plant.u.iter().copied());
    let parameters = plant.parameters.iter().map(|parameter| parameter.symbol);
    let states = plant.x.iter().map(|state| state.symbol);
    let all: Vec<Expr> = signals.chain(parameters).chain(states).map(|symbol| arena.of_symbol(symbol)).collect();
    let point = domain.points(arena, &all).next().unwrap_or_default();
    let value = |value: Expr| Some(arena.enclose(value, &BTreeMap::new(), Precision::new(64))?.lo());
    point.into_iter().filter_map(|(symbol, constant)| Some((symbol, rounded(value(constant)?)))).collect()
}

/// A number with six digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
