//! The generalised cascade: z' = Lambda(y, u) z + h(y, u).
//!
//! In: the derivative of the transform. Out: Lambda and h, if the derivative is an affine combination of
//! the transform itself with coefficients free of x (Ortega, Bobtsov, Nikolaev, Schiffer, Dochain 2021). That is an
//! identity, and all that the claim asks for; what becomes of `Psi' = Lambda Psi` is remarked beside it
//! ([`super::bounded`]).

use crate::cas::Expr;
use crate::cas::combination::combine_on;
use crate::cas::domain::Domain;
use crate::cas::field::Obstacle;
use crate::cas::zero::{Answer, decide};
use crate::plant::Plant;
use crate::plant::matrix::dot;

use super::design::Cascade;
use super::{bounded, relations};

/// A component's rate: h, then its row of Lambda.
pub(super) type Row = Vec<Expr>;

/// The row of a rate that is known.
pub(super) fn known(plant: &Plant, rate: Expr) -> Row {
    let mut row = vec![plant.arena.zero(); plant.phi.len() + 1];
    row[0] = rate;
    row
}

/// The row of a rate; none where points of the domain show that it is no affine function of the transform.
pub(super) fn row(plant: &Plant, domain: &Domain, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let open = match affine(plant, domain, rate) {
        Ok(Some(row)) => return Ok(Some(row)),
        Ok(None) => Obstacle::NoWitness,
        Err(obstacle) => obstacle,
    };
    relations::not_affine(plant, domain, rate).map_or(Err(open), |_| Ok(None))
}

/// An expression as an affine combination of the transform with coefficients free of x, proved: the known part, then
/// the factors; none where there is no such combination.
pub(super) fn affine(plant: &Plant, domain: &Domain, expr: Expr) -> Result<Option<Row>, Obstacle> {
    let arena = &plant.arena;
    let phi = plant.transform();
    let mut basis = vec![arena.one()];
    basis.extend(&phi);
    let Some(row) = combine_on(arena, domain, expr, &basis, &plant.hidden())? else { return Ok(None) };
    match decide(arena, arena.sub(expr, dot(arena, &row, &basis)), domain) {
        Answer::Zero => Ok(Some(row)),
        Answer::Open(obstacle) => Err(obstacle),
        Answer::NonZero(_) => Err(Obstacle::NoWitness),
    }
}

/// The cascade of these rows.
pub(super) fn cascade(plant: &Plant, domain: &Domain, rows: Vec<Row>) -> Cascade {
    let h = rows.iter().map(|row| row[0]).collect();
    let lambda: Vec<Vec<Expr>> = rows.into_iter().map(|mut row| row.split_off(1)).collect();
    let fundamental = Some(bounded::of(plant, domain, &lambda));
    Cascade { h, lambda: Some(lambda), fundamental, ..Cascade::default() }
}
