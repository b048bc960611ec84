//! A transform of part of the states, extended by states whose rates are affine in it.
//!
//! In: functions of x and y whose rates are free of x. Out: a few of them, with the states whose rates are affine in
//! them and in each other, from whose gradients all states can be told; none where that is not so. The cascade of the
//! whole is a generalised one: the fluxes of a motor have known rates, and its speed is driven by their products with
//! the measured currents.

use pebo_cas::Expr;
use pebo_cas::tower::Obstacle;

use crate::search::candidate::size;
use crate::search::problem::Problem;
use crate::search::sample::{is_affine_in, rank_of_gradients};

/// The extended transform, without components that neither its rates nor the states need.
pub(in crate::search) fn extended(problem: &Problem<'_>, solutions: &[Expr]) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let mut states: Vec<Expr> = problem.x.iter().map(|x| arena.of_symbol(*x)).collect();
    loop {
        let all = [solutions, &states].concat();
        let mut affine = Vec::new();
        for state in &states {
            if is_affine_in(problem, &[problem.rate(*state)], &all)? {
                affine.push(*state);
            }
        }
        if affine.len() == states.len() {
            break;
        }
        states = affine;
    }
    let is_whole = |kept: &[Expr]| -> Result<bool, Obstacle> {
        let rates: Vec<Expr> = kept.iter().filter(|e| states.contains(e)).map(|state| problem.rate(*state)).collect();
        Ok(rank_of_gradients(problem, kept)? == problem.x.len() && is_affine_in(problem, &rates, kept)?)
    };
    let others = states.iter().copied().filter(|state| !solutions.contains(state));
    let mut kept: Vec<Expr> = solutions.iter().copied().chain(others).collect();
    if states.is_empty() || !is_whole(&kept)? {
        return Ok(None);
    }
    // The longest is dropped first.
    let mut order = kept.clone();
    order.sort_by_key(|component| std::cmp::Reverse(size(arena, &[*component])));
    for component in order {
        let without: Vec<Expr> = kept.iter().copied().filter(|other| *other != component).collect();
        if is_whole(&without)? {
            kept = without;
        }
    }
    Ok(Some(kept))
}
