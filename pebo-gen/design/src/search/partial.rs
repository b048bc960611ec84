//! The states that can be recovered where not all can, found by trying.
//!
//! In: a plant of which no transform that recovers all states is accepted. Out: the plant with a few states among its
//! unmeasured signals, whose rates are then unknown, with a transform that recovers the others. As few states as
//! possible are given up, as far as plants were tried. Or the plant with one state among its outputs: the sensor that it
//! lacks.

use pebo_cas::{Expr, Symbol};

use super::candidate::Candidate;
use super::declaration::{Accepted, Declaration, unseen};
use super::problem::Problem;
use crate::analysis::Class;
use crate::plant::State;

/// So many sets of states are given up, one after the other.
const MOST_SETS: usize = 24;

/// Plants of more states have too many sets of them.
const MOST_STATES: usize = 12;

/// The share of the remaining budget for all of them, and for each.
const SHARE: u64 = 4;

/// The first transform that recovers the other states where some are unmeasured signals: those first that move along
/// a direction of the unknowns which, by a candidate, the outputs do not depend on.
pub(super) fn partial(
    problem: &Problem<'_>,
    candidates: &[Candidate],
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let plant = problem.plant;
    let budget = problem.arena.budget();
    if plant.class.is_some() || plant.x.len() > MOST_STATES {
        return None;
    }
    let recovered = |states: Vec<Symbol>| {
        let plant = plant.with_unmeasured(&states);
        if !problem.goes_on() || !unseen(&plant).is_empty() {
            return None;
        }
        // What is no more than a sample again observes nothing.
        let candidate = budget.share(SHARE, || accepted(&plant, class)).filter(|found| !found.copies_an_output())?;
        Some((candidate, Declaration::Unmeasured(states)))
    };
    let unseen = candidates.iter().find_map(Candidate::hidden_states).filter(|states| states.len() < plant.x.len());
    budget.share(SHARE, || unseen.into_iter().chain(sets(problem)).take(MOST_SETS).find_map(recovered))
}

/// The first transform that recovers the other states where one that moves is measured.
pub(super) fn measured(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let (plant, arena) = (problem.plant, problem.arena);
    if plant.class.is_some() || plant.x.len() > MOST_STATES {
        return None;
    }
    let is_output = |state: Expr| plant.y.iter().any(|output| output.value.is_some_and(|value| value.expr == state));
    let is_new = |state: &&State| !arena.is_zero(state.rate.expr) && !is_output(arena.of_symbol(state.symbol));
    let recovered = |state: &State| {
        let plant = plant.with_measured(state);
        if !problem.goes_on() || plant.x.is_empty() || !unseen(&plant).is_empty() {
            return None;
        }
        let candidate = arena.budget().share(SHARE, || accepted(&plant, class))?;
        Some((candidate, Declaration::Measured(state.symbol)))
    };
    arena.budget().share(SHARE, || plant.x.iter().filter(is_new).find_map(recovered))
}

/// The sets of some but not all states, small ones first.
fn sets(problem: &Problem<'_>) -> Vec<Vec<Symbol>> {
    let states: Vec<Symbol> = problem.plant.x.iter().map(|state| state.symbol).collect();
    let chosen = |mask: u32| -> Vec<Symbol> {
        let is_in = |place: &usize| mask >> place & 1 == 1;
        (0..states.len()).filter(is_in).map(|place| states[place]).collect()
    };
    let mut sets: Vec<Vec<Symbol>> = (1..(1_u32 << states.len()) - 1).map(chosen).collect();
    sets.sort_by_key(Vec::len);
    sets
}
