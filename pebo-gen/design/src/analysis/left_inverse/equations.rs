//! The equations of a left inverse: the transform is z.

use crate::plant::Plant;
use pebo_cas::solve::Equation;
use pebo_cas::{Expr, Symbol};

/// The unknowns: all states.
pub(super) fn states(plant: &Plant) -> Vec<Symbol> {
    plant.x.iter().map(|state| state.symbol).collect()
}

/// The transform, in these formulas, equal to z.
pub(super) fn equations(plant: &Plant, transform: Vec<Expr>) -> Vec<Equation> {
    let values = plant.z.iter().map(|z| plant.arena.of_symbol(*z));
    transform.into_iter().zip(values).map(|(formula, value)| Equation { formula, value }).collect()
}
