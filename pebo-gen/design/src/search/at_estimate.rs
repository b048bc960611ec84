//! Transforms whose regression has its slopes at the estimate: monotone, or to first order.
//!
//! In: a search, and the candidates whose outputs are not linear in functions of theta. Out: the transform with the fewest
//! components with which such a regression is accepted, or proves that nothing recovers the states.

use crate::analysis::AtEstimate;
use crate::plant::Plant;
use crate::source::Span;
use pebo_cas::Expr;

use super::candidate::Candidate;
use super::problem::Problem;

/// The share of the remaining budget for each transform.
const SHARE: u64 = 2;

/// The first transform whose regression is monotone, with all claims proved.
pub(super) fn monotone(problem: &Problem<'_>, candidates: &[Candidate]) -> Option<Candidate> {
    let is_monotone = |found: &Candidate| found.derivation.at_estimate() == Some(AtEstimate::Monotone);
    found(problem, AtEstimate::Monotone, candidates).filter(Candidate::is_full).filter(is_monotone)
}

/// The first such transform: the states, or one of the candidates.
pub(super) fn found(problem: &Problem<'_>, sense: AtEstimate, candidates: &[Candidate]) -> Option<Candidate> {
    let arena = problem.arena;
    let plant = match sense {
        AtEstimate::Local => Plant { local_regression: Some(Span::NOWHERE), ..problem.plant.clone() },
        AtEstimate::Monotone => Plant { monotone_regression: true, ..problem.plant.clone() },
    };
    let near = Problem::of(&plant);
    let states: Vec<Expr> = problem.x.iter().map(|state| arena.of_symbol(*state)).collect();
    let has_coordinates = |candidate: &&Candidate| candidate.has_coordinates();
    let mut transforms: Vec<Vec<Expr>> =
        candidates.iter().filter(has_coordinates).map(|c| c.plant.transform()).collect();
    transforms.insert(0, states);
    transforms.sort_by_key(Vec::len);
    let of = |phi: Vec<Expr>| arena.budget().share(SHARE, || Candidate::of(&near, &phi));
    let is_decided = |candidate: &Candidate| candidate.is_full() || candidate.hides_states();
    transforms.into_iter().take_while(|_| problem.goes_on()).map(of).find(is_decided)
}
