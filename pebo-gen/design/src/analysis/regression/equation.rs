//! One equation of a regression, before theta is separated from known signals.

use crate::analysis::design::Cascade;
use crate::plant::{Formula, Output, Plant};
use pebo_cas::{Arena, Expr};

/// `d/dt primitive = rate`, the rate as a function of z, y and u, the primitive of y and perhaps z. Without a primitive
/// it is a relation that holds at every instant.
#[derive(Clone)]
pub(super) struct Equation {
    pub(super) primitive: Expr,
    pub(super) rate: Expr,
    /// Positions of the outputs whose equation it is.
    pub(super) outputs: Vec<usize>,
}

impl Equation {
    /// A relation that holds at every instant, of these outputs.
    pub(super) fn instant(arena: &Arena, rate: Expr, outputs: Vec<usize>) -> Self {
        Self { primitive: arena.zero(), rate, outputs }
    }

    /// A relation that holds at every instant, of the outputs in it.
    pub(super) fn relation(plant: &Plant, rate: Expr) -> Self {
        Self::instant(&plant.arena, rate, outputs_in(plant, rate))
    }
}

/// Positions of the outputs in a formula.
pub(super) fn outputs_in(plant: &Plant, formula: Expr) -> Vec<usize> {
    let symbols = plant.arena.symbols_of(&[formula]);
    (0..plant.y.len()).filter(|position| symbols.contains(&plant.y[*position].symbol)).collect()
}

/// The outputs whose equation an identity is: the one whose value it gives, or all in it.
pub(super) fn outputs_of(plant: &Plant, identity: &Formula) -> Vec<usize> {
    let is_value = |output: &Output| output.value.is_some_and(|value| value.span == identity.span);
    match plant.y.iter().position(is_value) {
        Some(position) => vec![position],
        None => outputs_in(plant, identity.expr),
    }
}

/// The rate of a component of the transform: `Lambda z + h`.
pub(super) fn velocity(plant: &Plant, cascade: &Cascade, component: usize) -> Expr {
    let arena = &plant.arena;
    let own = cascade.lambda.iter().flat_map(|lambda| lambda[component].iter().zip(&plant.z));
    let own = arena.sum(own.map(|(factor, z)| arena.mul(*factor, arena.of_symbol(*z))));
    arena.add(own, cascade.h[component])
}
