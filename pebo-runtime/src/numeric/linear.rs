//! Solves a square linear system, or finds that it is singular. Never panics.

use nalgebra::SMatrix;

use crate::{Fault, Real};

/// Solves `matrix * X = right` by elimination with row pivoting.
///
/// Each entry carries the size of the terms of its sum, so the test of a pivot against rounding does not depend on the
/// units of rows and columns.
///
/// # Errors
/// [`Fault::Singular`] if a pivot vanishes against its terms: `|pivot| <= 4 EPSILON * sum |terms|`.
pub(crate) fn solve<S: Real, const N: usize, const C: usize>(
    mut matrix: SMatrix<S, N, N>,
    mut right: SMatrix<S, N, C>,
) -> Result<SMatrix<S, N, C>, Fault> {
    let mut size = matrix.map(Real::abs);
    let four: S = Real::from_f64(4.0);
    let rounding = four * S::EPSILON;
    for column in 0..N {
        // The largest entry rises to the diagonal.
        for row in column + 1..N {
            if Real::abs(matrix[(row, column)]) > Real::abs(matrix[(column, column)]) {
                exchange(&mut matrix, column, row);
                exchange(&mut size, column, row);
                exchange(&mut right, column, row);
            }
        }
        let divisor = matrix[(column, column)];
        // False for a NaN too.
        let regular = Real::abs(divisor) > rounding * size[(column, column)];
        if !regular {
            return Err(Fault::Singular);
        }
        for row in column + 1..N {
            let factor = matrix[(row, column)] / divisor;
            for k in column + 1..N {
                let (above, terms) = (matrix[(column, k)], size[(column, k)]);
                matrix[(row, k)] -= factor * above;
                size[(row, k)] += Real::abs(factor) * terms;
            }
            for k in 0..C {
                let above = right[(column, k)];
                right[(row, k)] -= factor * above;
            }
        }
    }
    for k in 0..C {
        for row in (0..N).rev() {
            let mut value = right[(row, k)];
            for column in row + 1..N {
                value -= matrix[(row, column)] * right[(column, k)];
            }
            right[(row, k)] = value / matrix[(row, row)];
        }
    }
    Ok(right)
}

/// Exchanges two rows.
fn exchange<S: Real, const N: usize, const C: usize>(matrix: &mut SMatrix<S, N, C>, upper: usize, lower: usize) {
    for mut column in matrix.column_iter_mut() {
        let above = column[upper];
        column[upper] = column[lower];
        column[lower] = above;
    }
}
