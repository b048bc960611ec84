//! The rate of a momentum along a Killing field: `h_i = T_i' (G u - dV/dq)`.
//!
//! In: a component whose field is proved to be one. Out: its rate as a formula for people and code. The term of the
//! potential is separate from that of the inputs: it often cancels wholly or to a constant, such as a weight, which is
//! then neither expanded nor divided by the denominator of the frame.

use std::collections::BTreeMap;

use crate::plant::Plant;
use crate::plant::class::Mechanical;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy::{operations_of, proved_shortest};
use pebo_cas::{Domain, Expr};

/// The rate of a component.
pub(super) fn rate(plant: &Plant, domain: &Domain, mechanical: &Mechanical, index: usize) -> Expr {
    let arena = &plant.arena;
    let short = proved_shortest(arena, domain, mechanical.h[index]);
    // The regressor has the entries of T too.
    let beside = mechanical.frame.column(index);
    let cost = |form: Expr| operations_of(arena, &[beside.as_slice(), &[form]].concat());
    let apart = apart(plant, domain, mechanical.h[index]);
    if cost(apart) < cost(short) { apart } else { short }
}

/// The rate as the term of the potential and a combination of the inputs, each in its own form.
fn apart(plant: &Plant, domain: &Domain, rate: Expr) -> Expr {
    let arena = &plant.arena;
    let without: BTreeMap<_, _> = plant.u.iter().map(|input| (*input, arena.zero())).collect();
    let left = arena.substitute(rate, &without);
    let left = if is_zero(arena, left, domain) { arena.zero() } else { proved_shortest(arena, domain, left) };
    let slopes: Vec<Expr> = plant.u.iter().map(|input| arena.derivative(rate, *input)).collect();
    let inputs: Vec<Expr> = plant.u.iter().map(|input| arena.of_symbol(*input)).collect();
    arena.add(arena.dot(&slopes, &inputs), left)
}
