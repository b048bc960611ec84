//! Mechanical plants: a test for z' without terms quadratic in momenta.
//!
//! In: inertia matrix M and frame T, z = T' p. With v = q' and `L_X M = X.dM + (dX)' M + M dX`,
//!
//! ```text
//! z_i' = h_i + v' (L_{T_i} M) v / 2
//! ```
//!
//! so the terms vanish exactly if each column of T is a Killing field of M. That is decided directly, without an
//! inverse. Ortega et al. 2015 state the same as Assumption 3: `B_(i) + B_(i)' = 0` with
//!
//! ```text
//! B_(i) = sum over j of [T_i, T_j] T_j' (M T T')^-1 + T_ji T d/dq_j (T' M T)^-1 T' / 2
//! ```
//!
//! whose entries tell the reader of a refused column where it fails.

use crate::plant::Matrix;
use crate::plant::class::{Mechanical, change_along};
use pebo_cas::domain::zero::{Answer, all_zero, decide};
use pebo_cas::number::rational::half;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr};

/// Tests whether a field over the positions, as a column of T, is a Killing field: `z_i' = h_i`.
pub(super) fn is_killing(arena: &Arena, domain: &Domain, plant: &Mechanical, field: &[Expr]) -> Result<bool, Obstacle> {
    Ok(nonzero(arena, domain, &change_along(arena, &plant.inertia, field, &plant.q))?.is_empty())
}

/// The entries of `B_(i) + B_(i)'` on and above the diagonal that are not zero, with their rows and columns.
pub(super) fn offending(
    arena: &Arena,
    domain: &Domain,
    plant: &Mechanical,
    index: usize,
) -> Result<Vec<(usize, usize, Expr)>, Obstacle> {
    let b = structure(arena, domain, plant, index)?;
    nonzero(arena, domain, &b.add(arena, &b.transpose()))
}

/// `v' (L_{T_i} M) v / 2`.
pub(super) fn quadratic(arena: &Arena, plant: &Mechanical, index: usize, v: &[Expr]) -> Expr {
    let change = change_along(arena, &plant.inertia, &plant.frame.column(index), &plant.q);
    arena.scale(arena.dot(v, &change.apply(arena, v)), &half())
}

/// `B_(i)` of Assumption 3, with the sum to the number of positions and derivatives by these.
fn structure(arena: &Arena, domain: &Domain, plant: &Mechanical, index: usize) -> Result<Matrix, Obstacle> {
    let facts = &domain.facts;
    let Mechanical { q, frame, inverse_frame, inverse_metric, .. } = plant;
    let n = q.len();
    let transposed = frame.transpose();
    // (M T T')^-1 = T'^-1 (T' M T)^-1 T'
    let inverse = inverse_frame.transpose().mul(arena, inverse_metric).mul(arena, &transposed);
    let mut total = Matrix::zero(arena, n, n);
    for (j, position) in q.iter().enumerate() {
        let bracket = bracket(arena, plant, index, j).normal(arena, facts)?;
        let row = Matrix::new(vec![frame.column(j)]);
        total = total.add(arena, &bracket.mul(arena, &row).mul(arena, &inverse));
        let weight = arena.scale(frame.at(j, index), &half());
        let slope = inverse_metric.derivative(arena, *position);
        let term = frame.mul(arena, &slope).mul(arena, &transposed);
        total = total.add(arena, &term.map(|e| arena.mul(weight, *e)));
    }
    Ok(total)
}

/// The Lie bracket `[T_i, T_j] = dT_j/dq T_i - dT_i/dq T_j`, a column.
fn bracket(arena: &Arena, plant: &Mechanical, i: usize, j: usize) -> Matrix {
    let (first, second) = (plant.frame.column(i), plant.frame.column(j));
    let along = |field: &[Expr], of: Expr| {
        arena.sum(plant.q.iter().zip(field).map(|(q, c)| arena.mul(*c, arena.derivative(of, *q))))
    };
    Matrix::build(first.len(), 1, |row, _| arena.sub(along(&first, second[row]), along(&second, first[row])))
}

/// The entries on and above the diagonal that provably are not zero, all others being proved zero.
fn nonzero(arena: &Arena, domain: &Domain, symmetric: &Matrix) -> Result<Vec<(usize, usize, Expr)>, Obstacle> {
    let upper = |i: usize| (i..symmetric.width()).map(move |j| symmetric.at(i, j));
    if all_zero(arena, &(0..symmetric.height()).flat_map(upper).collect::<Vec<Expr>>(), domain) {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for i in 0..symmetric.height() {
        for j in i..symmetric.width() {
            let entry = symmetric.at(i, j);
            match decide(arena, entry, domain) {
                Answer::Zero => {}
                Answer::NonZero(_) => found.push((i, j, entry)),
                Answer::Open(obstacle) => return Err(obstacle),
            }
        }
    }
    Ok(found)
}
