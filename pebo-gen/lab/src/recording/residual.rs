//! The residuals of the outputs, beside the model with the estimates.
//!
//! ```text
//! r' = y' - f_y(x_hat, y, u) - r/T        r = y - g_y(x_hat, y, u)
//! ```
//!
//! On the left for an output that has a rate: the output less the integral of its rate, over the last hundred samples
//! or so. It needs no measured x, is in the unit of the output, and remains near the noise of the sensor if estimates
//! and model are right. Fewer samples would be hidden by that noise, and more would include outdated estimates.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::{Expr, Symbol};
use pebo_design::plant::Plant;
use pebo_design::plant::settings::Late;
use pebo_design::program::{Interpreter, Program};

use crate::closed_loop::scope::Estimates;

/// T in samples.
const MEMORY: f64 = 100.0;

/// The outputs with residuals, with programs from the table.
#[derive(Debug)]
pub(super) struct Residuals {
    /// Positions in y; true if the rate is given.
    pub(super) outputs: Vec<(usize, bool)>,
    /// Their rates, or their values.
    pub(super) formulas: Program,
}

/// The outputs whose formulas need estimates, outputs and inputs of one moment alone, a late sample being of another, and
/// their formulas.
pub(super) fn formulas(
    plant: &Plant,
    (hats, late): (&Estimates, Option<&Late<f64>>),
    numbers: &BTreeMap<Symbol, Expr>,
) -> (Vec<(usize, bool)>, Vec<Expr>) {
    let arena = &plant.arena;
    let is_late = |place: usize| late.is_some_and(|late| late.delays[place] > 0.0);
    let late = plant.y.iter().enumerate().filter(|(place, _)| is_late(*place)).map(|(_, output)| output.symbol);
    let states = plant.x.iter().map(|state| state.symbol);
    let hidden: BTreeSet<Symbol> = states.chain(plant.w.iter().copied()).chain(late).collect();
    let mut known = numbers.clone();
    known.extend(hats.iter().map(|(state, hat)| (arena.symbol(state), *hat)));
    let meaning = |output: &pebo_design::plant::Output| {
        let (formula, is_rate) = match (output.value, output.rate) {
            (Some(value), _) => (value, false),
            (None, rate) => (rate?, true),
        };
        let formula = arena.substitute(formula.expr, &known);
        (!arena.depends_on(formula, &hidden)).then_some((formula, is_rate))
    };
    let on_time = plant.y.iter().enumerate().filter(|(place, _)| !is_late(*place));
    let found = on_time.filter_map(|(place, output)| Some((place, meaning(output)?)));
    found.map(|(place, (formula, is_rate))| ((place, is_rate), formula)).unzip()
}

impl Residuals {
    /// The residuals before the first sample.
    pub(super) fn start(&self) -> ResidualState<'_> {
        let nothing = vec![0.0; self.outputs.len()];
        let interpreter = Interpreter::new(&self.formulas);
        ResidualState { residuals: self, interpreter, end: nothing.clone(), start: None, values: nothing }
    }
}

/// The state of the residuals in a replay.
#[derive(Debug)]
pub(super) struct ResidualState<'a> {
    residuals: &'a Residuals,
    interpreter: Interpreter,
    /// The formulas at the end of an interval.
    end: Vec<f64>,
    /// The formulas at its start, and the outputs there.
    start: Option<(Vec<f64>, Vec<f64>)>,
    values: Vec<f64>,
}

impl ResidualState<'_> {
    /// Takes an accepted sample, at the end of an interval of `dt` seconds; `y` is part of the table, the inputs are
    /// those of the interval. The first sample has no residual.
    pub(super) fn sample(&mut self, table: &[f64], y: &[f64], dt: f64) {
        let Some((rates, outputs)) = &self.start else { return };
        self.interpreter.run(table, &mut self.end);
        let kept = (-1.0 / MEMORY).exp();
        for (place, &(output, is_rate)) in self.residuals.outputs.iter().enumerate() {
            self.values[place] = if is_rate {
                let unexplained = (y[output] - outputs[output]) / dt - 0.5 * (rates[place] + self.end[place]);
                kept * self.values[place] + (1.0 - kept) * MEMORY * dt * unexplained
            } else {
                y[output] - self.end[place]
            };
        }
    }

    /// Begins the interval after an accepted sample, with its inputs in the table.
    pub(super) fn begin(&mut self, table: &[f64], y: &[f64]) {
        let (rates, outputs) = self.start.get_or_insert_with(|| (self.end.clone(), y.to_vec()));
        self.interpreter.run(table, rates);
        outputs.copy_from_slice(y);
    }

    /// The residuals at the last accepted sample; none before the second.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }
}
