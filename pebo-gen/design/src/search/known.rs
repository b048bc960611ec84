//! The transform of a plant whose start is known: states that no output shows are components of it.
//!
//! In: a plant with states that start at known values. Out: the states themselves, or the transform of the plant without
//! those that no output depends on beside these, where its claims are proved.

use crate::analysis::Class;
use pebo_cas::{Expr, Symbol};

use super::candidate::Candidate;
use super::declaration::{Accepted, unseen};
use super::problem::Problem;

/// The transform that the known start makes one of an observer; none where nothing is known of it.
pub(super) fn from_known_start(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<Candidate> {
    let (plant, arena) = (problem.plant, problem.arena);
    let is_known = |state: &Symbol| plant.known.iter().any(|(known, _)| known == state);
    let unseen: Vec<Symbol> = unseen(plant).into_iter().filter(is_known).collect();
    let of_symbols = |states: &[Symbol]| states.iter().map(|state| arena.of_symbol(*state)).collect::<Vec<Expr>>();
    let states = || Some(of_symbols(&problem.x));
    let beside = || {
        let others = (!unseen.is_empty() && unseen.len() < problem.x.len()).then(|| plant.without_states(&unseen))?;
        Some([accepted(&others, None)?.plant.transform(), of_symbols(&unseen)].concat())
    };
    let is_accepted =
        |candidate: &Candidate| candidate.is_full() && class.is_none_or(|class| candidate.derivation.class == class);
    let tried =
        |transform: &dyn Fn() -> Option<Vec<Expr>>| Some(Candidate::of(problem, &transform()?)).filter(is_accepted);
    if plant.known.is_empty() { None } else { tried(&states).or_else(|| tried(&beside)) }
}
