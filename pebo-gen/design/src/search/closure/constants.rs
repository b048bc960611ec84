//! The unknown constants of a plant, and the plant in which they are measured.

use std::collections::BTreeSet;

use crate::plant::{Output, Plant};
use pebo_cas::Symbol;

use crate::search::problem::Problem;

/// The plant in which its unknown constants are outputs; none where there are none beside other states.
pub(in crate::search) fn measured(problem: &Problem<'_>) -> Option<Plant> {
    let constants = constants(problem);
    if constants.is_empty() || constants.len() == problem.x.len() {
        return None;
    }
    let mut measured = problem.plant.clone();
    let known = problem.plant.x.iter().filter(|state| constants.contains(&state.symbol));
    measured.y.extend(known.map(|state| Output {
        symbol: state.symbol,
        rate: Some(state.rate),
        value: None,
        span: state.rate.span,
    }));
    measured.x.retain(|state| !constants.contains(&state.symbol));
    measured.phi.clear();
    Some(measured)
}

/// The states whose rate is zero.
pub(in crate::search) fn constants(problem: &Problem<'_>) -> BTreeSet<Symbol> {
    let is_constant = |state: &Symbol| problem.rates.get(state).is_some_and(|rate| problem.arena.is_zero(*rate));
    problem.x.iter().copied().filter(is_constant).collect()
}
