//! The largest rank that transforms of a class can have: by completion, where that says nothing by series.

use pebo_cas::Expr;

use super::driven::driven;
use super::{Bound, BoundClass, LARGEST_ORDER, bound};
use crate::search::completion::decision::decided;
use crate::search::problem::Problem;

/// The bound of the transforms affine in x with a plain cascade, by completion, or where that says nothing by series;
/// for values of the parameters that are found after so many others.
pub(in crate::search) fn affine(problem: &Problem<'_>, others: usize) -> Option<Bound> {
    decided(problem, BoundClass::Affine, others).or_else(|| bound(problem, BoundClass::Affine, (LARGEST_ORDER, others)))
}

/// The bound of the smooth transforms with a plain cascade by completion, where that of the affine ones is known; for
/// values of the parameters that are found after so many others.
pub(in crate::search) fn smooth(problem: &Problem<'_>, affine: Option<&Bound>, others: usize) -> Option<Bound> {
    if !is_driven(problem) {
        return None;
    }
    match affine {
        // There are no others.
        Some(affine) if affine.proved && driven(problem).iter().all(|driven| *driven) => {
            Some(Bound { class: BoundClass::Smooth, ..affine.clone() })
        }
        _ => decided(problem, BoundClass::Smooth, others),
    }
}

/// The same by series to an order.
pub(in crate::search) fn smooth_to(problem: &Problem<'_>, order: usize, others: usize) -> Option<Bound> {
    if is_driven(problem) { bound(problem, BoundClass::Smooth, (order, others)) } else { None }
}

/// Tests whether a plant has inputs: without them every plant has local transforms.
fn is_driven(problem: &Problem<'_>) -> bool {
    let rates: Vec<Expr> = problem.rates.values().copied().collect();
    let symbols = problem.arena.symbols_of(&rates);
    problem.plant.u.iter().any(|input| symbols.contains(input))
}
