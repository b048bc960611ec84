//! Finds transforms affine in x in closed form, where they are integrals.
//!
//! ```text
//! equations for T and the gradient of s, completed -> dw = G w -> T, and s by its gradient -> T(y) x + s(y)
//! ```
//!
//! In: a plant whose equations for `T(y) x + s(y)` complete to a flat connection (see [`crate::search::completion`]),
//! so that a solution is given by its values at a point. Out: transforms, for those solutions that have a closed form;
//! nothing is proved of the domain.

use pebo_cas::forms::tidy::shortest;
use pebo_cas::tower::{Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::connection::potential;
use super::flat::Flat;
use super::gradient::{EquationRows, GradientEquations};
use super::{Derivations, Solutions, System};
use crate::search::problem::Problem;

/// The transforms affine in x, as far as they are integrals of the functions in their equations.
pub(in crate::search) fn integrated(problem: &Problem<'_>) -> Result<Vec<Expr>, Obstacle> {
    let arena = problem.arena;
    let equations = GradientEquations::affine(problem, &problem.rates)?;
    let Some(field) = equations.field(problem)? else { return Ok(Vec::new()) };
    let Some(EquationRows { kept, rows }) = equations.rows(problem, &field)? else { return Ok(Vec::new()) };
    let by = Derivations::of(&field, &equations.base)?;
    // An elimination keeps the last functions: T, which determine the gradient of s.
    let (states, outputs) = (problem.x.len(), equations.base.len());
    let turned = |row: &Vec<Fraction>| {
        let (slopes, values) = row.split_at(kept.len() * outputs);
        let (of_frame, of_shift) = slopes.split_at(states * outputs);
        let (frame, shift) = values.split_at(states);
        [of_shift, of_frame, shift, frame].concat()
    };
    let rows = rows.iter().map(turned).collect();
    let completed = System::new(&by, (kept.len(), kept.len()), rows).giving(kept.len() - states).completed()?;
    if completed.solutions != Solutions::AsFunctions {
        return Ok(Vec::new());
    }
    let printed = |row: &Vec<Fraction>| row.iter().map(|e| field.show(e)).collect::<Vec<Expr>>();
    let slopes = completed.slopes.iter().map(|rows| rows.iter().map(printed).collect()).collect();
    let flat = Flat::new(problem, slopes);
    let lift: Vec<Vec<Expr>> = completed.lift.iter().map(printed).collect();
    let mut found = Vec::new();
    for solution in flat.solutions()? {
        let values: Vec<Expr> =
            lift.iter().map(|row| shortest(arena, &problem.domain, arena.dot(row, &solution))).collect();
        let (gradient, frame) = values.split_at(values.len() - states);
        if frame.iter().all(|e| arena.is_zero(*e)) {
            continue;
        }
        let along: Vec<(Symbol, Expr)> =
            kept[states..].iter().map(|function| problem.y[function - states]).zip(gradient.iter().copied()).collect();
        let Some(shift) = potential(problem, &along) else { continue };
        let terms = frame.iter().zip(&problem.x).map(|(factor, x)| arena.mul(*factor, arena.of_symbol(*x)));
        found.push(arena.add(arena.sum(terms.collect::<Vec<Expr>>()), shift));
    }
    Ok(found)
}
