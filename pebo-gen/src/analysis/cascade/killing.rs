//! Mechanical plants: whether the terms of z' that are quadratic in momenta vanish.
//!
//! In: inertia matrix M and frame T, z = T' p. With v = q' and `L_X M = X.dM + (dX)' M + M dX`,
//!
//! ```text
//! z_i' = h_i + v' (L_{T_i} M) v / 2
//! ```
//!
//! so the terms vanish exactly if each column of T is a Killing field of M. Ortega et al. 2015 state the
//! same as Assumption 3: `B_(i) + B_(i)' = 0` with
//!
//! ```text
//! B_(i) = sum over j of [T_i, T_j] T_j' (M T T')^-1 + T_ji T d/dq_j (T' M T)^-1 T' / 2
//! ```
//!
//! Both are decided, and the answer is theirs only if they agree.

use crate::cas::domain::Domain;
use crate::cas::field::Obstacle;
use crate::cas::rational::half;
use crate::cas::zero::{Answer, decide};
use crate::cas::{Arena, Expr};
use crate::plant::Matrix;
use crate::plant::class::Mechanical;

/// The answer for one column of T.
#[derive(Debug)]
pub(super) enum Column {
    /// It is a Killing field: `z_i' = h_i`.
    Killing,
    /// It is none; with the entries of `B_(i) + B_(i)'` on and above the diagonal that are not zero.
    Other(Vec<(usize, usize, Expr)>),
    /// It could not be decided.
    Open(Obstacle),
}

/// Decides a column of T, directly and by Assumption 3.
pub(super) fn column(arena: &Arena, domain: &Domain, plant: &Mechanical, index: usize) -> Column {
    let directly = vanishes(arena, domain, &lie_derivative(arena, plant, index));
    let offending = structure(arena, domain, plant, index).and_then(|b| {
        let b = b.add(arena, &b.transpose());
        nonzero(arena, domain, &b)
    });
    match (directly, offending) {
        (Ok(true), Ok(offending)) if offending.is_empty() => Column::Killing,
        (Ok(false), Ok(offending)) if !offending.is_empty() => Column::Other(offending),
        // Two forms of one condition that differ: nothing may be concluded.
        (Ok(_), Ok(_)) => Column::Open(Obstacle::Kernel("the two forms of Assumption 3".to_owned())),
        (Err(obstacle), _) | (_, Err(obstacle)) => Column::Open(obstacle),
    }
}

/// `L_{T_i} M = sum over k of T_ki dM/dq_k + (dT_i)' M + M dT_i`.
pub(super) fn lie_derivative(arena: &Arena, plant: &Mechanical, index: usize) -> Matrix {
    let (m, field) = (&plant.inertia, plant.frame.column(index));
    let n = field.len();
    let jacobian = Matrix::build(n, n, |j, k| arena.derivative(field[j], plant.q[k]));
    let drag = m.mul(arena, &jacobian);
    let mut total = drag.add(arena, &drag.transpose());
    for (component, q) in field.iter().zip(&plant.q) {
        if !arena.is_zero(*component) {
            total = total.add(arena, &m.derivative(arena, *q).map(|e| arena.mul(*component, e)));
        }
    }
    total
}

/// `B_(i)` of Assumption 3, with the sum to the number of positions and derivatives by these.
pub(super) fn structure(arena: &Arena, domain: &Domain, plant: &Mechanical, index: usize) -> Result<Matrix, Obstacle> {
    let facts = &domain.facts;
    let Mechanical { q, frame, inverse_frame, inverse_metric, .. } = plant;
    let n = q.len();
    let transposed = frame.transpose();
    // (M T T')^-1 = T'^-1 (T' M T)^-1 T'
    let inverse = inverse_frame.transpose().mul(arena, inverse_metric).mul(arena, &transposed);
    let mut total = Matrix::zero(arena, n, n);
    for (j, position) in q.iter().enumerate() {
        let bracket = bracket(arena, plant, index, j).normal(arena, facts)?;
        if bracket.entries().iter().any(|e| !arena.is_zero(*e)) {
            let row = Matrix::new(vec![frame.column(j)]);
            total = total.add(arena, &bracket.mul(arena, &row).mul(arena, &inverse));
        }
        let weight = arena.scale(frame.at(j, index), &half());
        let slope = inverse_metric.derivative(arena, *position);
        if !arena.is_zero(weight) && slope.entries().iter().any(|e| !arena.is_zero(*e)) {
            let term = frame.mul(arena, &slope).mul(arena, &transposed);
            total = total.add(arena, &term.map(|e| arena.mul(weight, e)));
        }
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

fn vanishes(arena: &Arena, domain: &Domain, symmetric: &Matrix) -> Result<bool, Obstacle> {
    Ok(nonzero(arena, domain, symmetric)?.is_empty())
}

/// The entries on and above the diagonal that provably are not zero, all others being proved zero.
fn nonzero(arena: &Arena, domain: &Domain, symmetric: &Matrix) -> Result<Vec<(usize, usize, Expr)>, Obstacle> {
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
