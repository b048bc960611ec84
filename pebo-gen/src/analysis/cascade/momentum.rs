//! The rate of a momentum along a Killing field: `h_i = T_i' (G u - dV/dq)`.
//!
//! In: a component whose field is proved to be one. Out: its rate as a formula for people and code. Where the potential does
//! not change along the field, its terms cancel, and they are left out rather than expanded.

use std::collections::BTreeMap;

use crate::cas::Expr;
use crate::cas::domain::Domain;
use crate::cas::tidy::{operations_of, proved_shortest};
use crate::cas::zero::decide;
use crate::plant::Plant;
use crate::plant::class::Mechanical;
use crate::plant::matrix::dot;

/// The rate of a component.
pub(super) fn rate(plant: &Plant, domain: &Domain, mechanical: &Mechanical, index: usize) -> Expr {
    let arena = &plant.arena;
    let short = proved_shortest(arena, domain, mechanical.h[index]);
    // The regressor has the entries of T too.
    let beside = mechanical.frame.column(index);
    let cost = |form: Expr| operations_of(arena, &[beside.as_slice(), &[form]].concat());
    match of_inputs(plant, domain, mechanical.h[index]) {
        Some(form) if cost(form) < cost(short) => form,
        _ => short,
    }
}

/// The rate as a combination of the inputs, where what is left without them cancels.
fn of_inputs(plant: &Plant, domain: &Domain, rate: Expr) -> Option<Expr> {
    let arena = &plant.arena;
    let without: BTreeMap<_, _> = plant.u.iter().map(|input| (*input, arena.zero())).collect();
    let rest = arena.substitute(rate, &without);
    if arena.is_zero(rest) || !decide(arena, rest, domain).is_zero() {
        return None;
    }
    let slopes: Vec<Expr> = plant.u.iter().map(|input| arena.derivative(rate, *input)).collect();
    let inputs: Vec<Expr> = plant.u.iter().map(|input| arena.of_symbol(*input)).collect();
    Some(dot(arena, &slopes, &inputs))
}
