//! The estimates that are compared with states, and the formulas of their errors.

use std::collections::BTreeMap;

use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::program::Interpreter;
use pebo_design::source::Span;

use super::layout::{Layout, PlacedEstimate};
use crate::observe::design::program;
use crate::summary::Estimate;

/// An estimate that is compared with the state that it is of.
#[derive(Debug)]
pub(crate) struct ScoredEstimate {
    pub(crate) estimate: Estimate,
    /// Its index among the estimates of the model's observer; none for one of a baseline.
    pub(crate) own: Option<usize>,
    /// The position of the state in the table.
    pub(crate) truth: usize,
    /// The period of an angle.
    pub(crate) period: Option<f64>,
    /// The step, if the outputs determine the state only up to multiples of it.
    pub(crate) step: Option<f64>,
}

/// Every estimate of a state of the table with its error, estimate less state: those of the observer, then those of each
/// baseline. Of an angle it is the difference with the least absolute value.
pub(crate) fn scored(
    plant: &Plant,
    derivation: &Derivation,
    numbers: &BTreeMap<Symbol, Expr>,
    layout: &Layout,
) -> (Vec<ScoredEstimate>, Vec<Expr>) {
    let arena = &plant.arena;
    let period = |pairs: &[(Symbol, Expr)], state: Symbol| {
        let found = pairs.iter().find(|(known, _)| *known == state);
        found.map(|(_, period)| arena.substitute(*period, numbers))
    };
    let number = |period: Option<Expr>| {
        let program = program(arena, &[], &[period?], Span::NOWHERE).ok()?;
        Interpreter::new(&program).evaluate(|_| f64::NAN).next()
    };
    // Values of an angle that differ by its period are the same; other states are known up to steps.
    let modulo = derivation.left_inverse.result.as_ref().map_or(&[][..], |inverse| &inverse.modulo);
    let steps = derivation.regression.result.as_ref().map_or(&[][..], |regression| &regression.steps);
    let judged = |(place, placed): (usize, &PlacedEstimate)| {
        let PlacedEstimate { estimate, hat, truth, .. } = placed;
        let (truth, symbol) = ((*truth)?, arena.symbol(&estimate.state));
        let of_angle = period(modulo, symbol);
        let scored = ScoredEstimate {
            estimate: estimate.clone(),
            own: estimate.baseline.is_none().then_some(place),
            truth,
            period: number(of_angle),
            step: number(period(steps, symbol)),
        };
        Some((scored, error(plant, of_angle, arena.of_symbol(layout.symbols[*hat]), symbol)))
    };
    layout.estimates.iter().enumerate().filter_map(judged).unzip()
}

fn error(plant: &Plant, period: Option<Expr>, hat: Expr, state: Symbol) -> Expr {
    use pebo_cas::Function::{Atan2, Cos, Sin};
    let arena = &plant.arena;
    let difference = arena.sub(hat, arena.of_symbol(state));
    let Some(period) = period else { return difference };
    let turn = arena.div(arena.turn(), period);
    let angle = arena.mul(turn, difference);
    arena.div(arena.call(Atan2, &[arena.call(Sin, &[angle]), arena.call(Cos, &[angle])]), turn)
}
