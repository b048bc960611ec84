//! Solves a transform that is another analytic function of the states on each cell of the domain.
//!
//! In: the plant. Out: for each state one formula in z and y that is right on all cells: of `z = 2*a + abs(a)` the
//! inverses `z/3` and `z` are joined as `min(z, z/3)`. The formulas of two sides of a border are joined as the greater or
//! the lesser of both, or by the sign of the border function at their values; which of these is right is proved.

use std::collections::BTreeMap;

use crate::plant::Plant;
use pebo_cas::domain::cells::{Cell, Side};
use pebo_cas::forms::tidy::shortest;
use pebo_cas::number::rational::half;
use pebo_cas::solve::solve;
use pebo_cas::{Domain, Expr, Function, Relation, Symbol};

use super::checking::check;
use super::equations::{equations, states};

/// A formula for each state.
type Formulas = BTreeMap<Symbol, Expr>;

/// The formulas for the states, where there is one for each state on each cell; else none.
pub(super) fn on_cells(plant: &Plant, domain: &Domain) -> Formulas {
    let transform = plant.transform();
    let hidden = plant.hidden();
    let is_of_states = plant.arena.dividers(&transform).iter().any(|divider| plant.arena.depends_on(*divider, &hidden));
    if !is_of_states {
        return Formulas::new();
    }
    let cells = domain.cells(&plant.arena, &transform, |_| true).unwrap_or_default();
    let solved: Option<Vec<(Cell, Formulas)>> =
        cells.into_iter().map(|cell| Some((cell.clone(), on_cell(plant, &cell.domain, &transform)?))).collect();
    solved.and_then(|solved| joined(plant, domain, 0, &solved)).unwrap_or_default()
}

/// The formulas on a cell, each of them right there.
fn on_cell(plant: &Plant, domain: &Domain, transform: &[Expr]) -> Option<Formulas> {
    let arena = &plant.arena;
    let branch = domain.analytic(arena, transform);
    let solved = solve(arena, domain, &equations(plant, branch), &states(plant)).ok()?;
    let right = |state: Symbol| {
        let mut candidates = solved.get(&state)?.iter().copied();
        candidates.find(|formula| check(plant, domain, state, *formula).1.is_zero())
    };
    states(plant).into_iter().map(|state| Some((state, right(state)?))).collect()
}

/// The formulas on the cells together, which share their first sides.
fn joined(plant: &Plant, domain: &Domain, shared: usize, cells: &[(Cell, Formulas)]) -> Option<Formulas> {
    let [(first, own), others @ ..] = cells else { return None };
    if others.is_empty() {
        return Some(own.clone());
    }
    let arena = &plant.arena;
    let (border, _) = *first.sides.get(shared)?;
    let on_side = |side: Side| {
        let of_side = |(cell, _): &&(Cell, Formulas)| cell.sides.get(shared) == Some(&(border, side));
        let mut there = domain.clone();
        there.facts.assume(side.positive(arena, border), Relation::Positive);
        joined(plant, &there, shared + 1, &cells.iter().filter(of_side).cloned().collect::<Vec<_>>())
    };
    let (above, below) = (on_side(Side::Positive)?, on_side(Side::Negative)?);
    let at = |formulas: &Formulas| arena.substitute(border, formulas);
    // Between the values of both sides, where the formula itself jumps.
    let middle = arena.scale(arena.add(at(&above), at(&below)), &half());
    let middle = shortest(arena, domain, middle);
    let formula = |state: Symbol| {
        let (above, below) = (above[&state], below[&state]);
        let by_sign = || {
            let sign = arena.call(Function::Sign, &[middle]);
            let [share, half] = [arena.sub(above, below), arena.add(above, below)].map(|e| arena.scale(e, &half()));
            arena.add(half, arena.mul(share, sign))
        };
        let candidates =
            [above, arena.call(Function::Min, &[above, below]), arena.call(Function::Max, &[above, below]), by_sign()];
        let right = |formula: &Expr| check(plant, domain, state, *formula).1.is_zero();
        Some((state, candidates.into_iter().find(right)?))
    };
    above.keys().map(|state| formula(*state)).collect()
}
