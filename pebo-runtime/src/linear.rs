//! A square linear system in, its solution out, or the fact that there is none. Nothing here panics.

use nalgebra::SMatrix;

use crate::{Fault, Real};

/// Solves `matrix * X = right` by elimination with row pivoting.
///
/// # Errors
/// [`Fault::Singular`] if a pivot vanishes against the matrix: `|pivot| <= EPSILON * max |matrix|`.
pub(crate) fn solve<S: Real, const N: usize, const C: usize>(
    mut matrix: SMatrix<S, N, N>,
    mut right: SMatrix<S, N, C>,
) -> Result<SMatrix<S, N, C>, Fault> {
    let largest = matrix.iter().fold(S::zero(), |largest, &element| largest.max(Real::abs(element)));
    let negligible = S::EPSILON * largest;
    for column in 0..N {
        // The largest entry rises to the diagonal.
        for row in column + 1..N {
            if Real::abs(matrix[(row, column)]) > Real::abs(matrix[(column, column)]) {
                exchange(&mut matrix, column, row);
                exchange(&mut right, column, row);
            }
        }
        let divisor = matrix[(column, column)];
        // False for a NaN too.
        let regular = Real::abs(divisor) > negligible;
        if !regular {
            return Err(Fault::Singular);
        }
        for row in column + 1..N {
            let factor = matrix[(row, column)] / divisor;
            for k in column + 1..N {
                let above = matrix[(column, k)];
                matrix[(row, k)] -= factor * above;
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
