//! The generalised cascade: z' = Lambda(y, u) z + h(y, u).
//!
//! In: the derivative of the transform. Out: Lambda and h, if the derivative is an affine combination of the transform
//! itself with coefficients free of x (Ortega, Bobtsov, Nikolaev, Schiffer, Dochain 2021). The claim is that identity
//! alone; the behaviour of `Psi' = Lambda Psi` is a remark beside it ([`super::bounded`]).

use crate::plant::Plant;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr};

use super::bounded;
use crate::analysis::affine::{self, Row};
use crate::analysis::design::Cascade;

/// The row of a rate that is known.
pub(in crate::analysis) fn known(plant: &Plant, rate: Expr) -> Row {
    let mut row = vec![plant.arena.zero(); plant.phi.len() + 1];
    row[0] = rate;
    row
}

/// The row of a rate; none where points of the domain refute that it is affine in the transform.
pub(in crate::analysis) fn row(plant: &Plant, domain: &Domain, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let open = match affine::of(plant, domain, rate) {
        Ok(Some(row)) => return Ok(Some(row)),
        Ok(None) => Obstacle::NoWitness,
        Err(obstacle) => obstacle,
    };
    affine::refuted(plant, domain, rate).map_or(Err(open), |_| Ok(None))
}

/// The cascade of these rows.
pub(in crate::analysis) fn cascade(plant: &Plant, domain: &Domain, rows: Vec<Row>) -> Cascade {
    let h = rows.iter().map(|row| row[0]).collect();
    let lambda: Vec<Vec<Expr>> = rows.into_iter().map(|mut row| row.split_off(1)).collect();
    let fundamental = Some(bounded::of(plant, domain, &lambda));
    Cascade { h, lambda: Some(lambda), fundamental, ..Cascade::default() }
}
