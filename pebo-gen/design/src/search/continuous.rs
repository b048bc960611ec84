//! Transforms without jumps.
//!
//! In: a component of a transform, as a form of the search has it. Out: one that is continuous across each non-smooth
//! point, of the same merit; none where that is not found. To the equations of the cascade the sign of `q - 1` is a
//! constant on each side, so that they may choose `q*sign(q - 1)` where `(q - 1)*sign(q - 1)` is as good. Theta would
//! be another constant on each side, and an observer wrong after each crossing.

use std::collections::BTreeSet;

use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Expr, Function, Symbol};

use super::problem::Problem;

/// Borders of one component that are made good one after another.
const MOST_BORDERS: usize = 8;

/// The component with another constant on each side of a border where it jumps there.
pub(super) fn continuous(problem: &Problem<'_>, component: Expr) -> Option<Expr> {
    let (arena, domain) = (problem.arena, &problem.domain);
    let moves = |expr: Expr| !arena.symbols_of(&[expr]).is_disjoint(&problem.signals);
    let jumps = |expr: Expr| domain.jumps(arena, expr, moves).ok();
    let mut found = component;
    for _ in 0..MOST_BORDERS {
        let open = jumps(found)?;
        let Some(jump) = open.first() else {
            return Some(if found == component { found } else { shortest(arena, domain, found) });
        };
        let (sign, by) = (arena.call(Function::Sign, &[jump.border]), jump.by?);
        found = if moves(by) {
            // On one side it may be the negative of a function that goes over.
            Some(arena.mul(sign, found)).filter(|other| jumps(*other).is_some_and(|left| left.len() < open.len()))?
        } else {
            arena.sub(found, arena.mul(arena.scale(by, &pebo_cas::number::rational::half()), sign))
        };
    }
    None
}

/// Tests whether a component holds only states, outputs with a rate, and constants.
pub(super) fn is_of_states_and_outputs(problem: &Problem<'_>, component: Expr) -> bool {
    let known: BTreeSet<Symbol> = problem.x.iter().chain(&problem.y).copied().collect();
    let signals = problem.arena.symbols_of(&[component]).into_iter().filter(|symbol| problem.signals.contains(symbol));
    signals.into_iter().all(|symbol| known.contains(&symbol))
}
