//! One equation of a regression, before theta is separated from known signals.

use crate::analysis::design::Cascade;
use crate::plant::Plant;
use pebo_cas::Expr;

/// `d/dt primitive = rate`, the rate as a function of z, y and u, the primitive of y and perhaps z.
#[derive(Clone)]
pub(super) struct Equation {
    pub(super) primitive: Expr,
    pub(super) rate: Expr,
}

/// The rate of a component of the transform: `Lambda z + h`.
pub(super) fn velocity(plant: &Plant, cascade: &Cascade, component: usize) -> Expr {
    let arena = &plant.arena;
    let own = cascade.lambda.iter().flat_map(|lambda| lambda[component].iter().zip(&plant.z));
    let own = arena.sum(own.map(|(factor, z)| arena.mul(*factor, arena.of_symbol(*z))));
    arena.add(own, cascade.h[component])
}
