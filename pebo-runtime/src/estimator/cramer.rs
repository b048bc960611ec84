//! Determinants, and Cramer's rule without its division.

use nalgebra::{SMatrix, SVector};

use crate::Real;

/// The determinant.
///
/// Method: cofactors up to three rows, elimination with row pivoting beyond. No division but by the largest entry of a
/// column, so a singular matrix has determinant 0 and is no special case.
pub(crate) fn determinant<S: Real, const N: usize>(matrix: &SMatrix<S, N, N>) -> S {
    let a = |row: usize, column: usize| matrix[(row, column)];
    match N {
        1 => a(0, 0),
        2 => a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0),
        3 => {
            a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0))
                + a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0))
        }
        _ => eliminate(*matrix),
    }
}

fn eliminate<S: Real, const N: usize>(mut matrix: SMatrix<S, N, N>) -> S {
    let mut product = S::one();
    for column in 0..N {
        // The largest entry rises to the diagonal; an exchange of rows changes the sign.
        for row in column + 1..N {
            if Real::abs(matrix[(row, column)]) > Real::abs(matrix[(column, column)]) {
                for k in column..N {
                    let above = matrix[(column, k)];
                    matrix[(column, k)] = matrix[(row, k)];
                    matrix[(row, k)] = above;
                }
                product = -product;
            }
        }
        let pivot = matrix[(column, column)];
        if pivot == S::zero() {
            return S::zero();
        }
        product *= pivot;
        for row in column + 1..N {
            let factor = matrix[(row, column)] / pivot;
            for k in column + 1..N {
                let eliminated = factor * matrix[(column, k)];
                matrix[(row, k)] -= eliminated;
            }
        }
    }
    product
}

/// `adj(matrix) * right` by Cramer's rule: component `i` is the determinant with column `i` replaced.
pub(crate) fn adjugate_times<S: Real, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    right: &SVector<S, N>,
) -> SVector<S, N> {
    let mut replaced = *matrix;
    SVector::from_fn(|column, _| {
        replaced.set_column(column, right);
        let value = determinant(&replaced);
        replaced.set_column(column, &matrix.column(column));
        value
    })
}
