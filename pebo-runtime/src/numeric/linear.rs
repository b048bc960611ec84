//! Solves a square linear system, or finds that it is singular. Never panics.
//!
//! Rows are walked and not indexed: of an index the compiler has to see in each program that it is within its bounds, else
//! it links a panic.

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
    matrix: SMatrix<S, N, N>,
    right: SMatrix<S, N, C>,
) -> Result<SMatrix<S, N, C>, Fault> {
    let mut rows =
        matrix.transpose().data.0.map(|entries| Row { entries, sizes: entries.map(Real::abs), right: [S::zero(); C] });
    for (row, right) in rows.iter_mut().zip(right.transpose().data.0) {
        row.right = right;
    }
    eliminate(&mut rows)?;
    substitute(&mut rows);
    Ok(SMatrix::<S, C, N>::from(rows.map(|row| row.right)).transpose())
}

/// An equation.
struct Row<S, const N: usize, const C: usize> {
    entries: [S; N],
    /// The sums of the absolute values of the terms of each entry.
    sizes: [S; N],
    right: [S; C],
}

impl<S: Real, const N: usize, const C: usize> Row<S, N, C> {
    /// The entry in a column, with the size of its terms.
    fn at(&self, column: usize) -> (S, S) {
        let of = |numbers: &[S; N]| numbers.get(column).copied().unwrap_or_else(S::zero);
        (of(&self.entries), of(&self.sizes))
    }
}

/// Brings the rows to triangular form.
fn eliminate<S: Real, const N: usize, const C: usize>(rows: &mut [Row<S, N, C>; N]) -> Result<(), Fault> {
    let four: S = Real::from_f64(4.0);
    let rounding = four * S::EPSILON;
    let mut rest = rows.as_mut_slice();
    for column in 0..N {
        let Some((pivot, below)) = rest.split_first_mut() else { break };
        // The largest entry rises to the diagonal.
        for row in below.iter_mut() {
            if Real::abs(row.at(column).0) > Real::abs(pivot.at(column).0) {
                core::mem::swap(pivot, row);
            }
        }
        let (divisor, size) = pivot.at(column);
        // False for a NaN too.
        let regular = Real::abs(divisor) > rounding * size;
        if !regular {
            return Err(Fault::Singular);
        }
        for row in below.iter_mut() {
            let factor = row.at(column).0 / divisor;
            let entries = row.entries.iter_mut().zip(&pivot.entries);
            let sizes = row.sizes.iter_mut().zip(&pivot.sizes);
            for ((entry, &above), (size, &terms)) in entries.zip(sizes).skip(column + 1) {
                *entry -= factor * above;
                *size += Real::abs(factor) * terms;
            }
            for (value, &above) in row.right.iter_mut().zip(&pivot.right) {
                *value -= factor * above;
            }
        }
        rest = below;
    }
    Ok(())
}

/// Turns the right sides of triangular rows into the solution, from the last row up.
fn substitute<S: Real, const N: usize, const C: usize>(rows: &mut [Row<S, N, C>; N]) {
    for column in (0..N).rev() {
        let Some((row, solved)) = rows.get_mut(column..).and_then(<[_]>::split_first_mut) else { break };
        for (&factor, known) in row.entries.iter().skip(column + 1).zip(solved.iter()) {
            for (value, &known) in row.right.iter_mut().zip(&known.right) {
                *value -= factor * known;
            }
        }
        let divisor = row.at(column).0;
        for value in &mut row.right {
            *value /= divisor;
        }
    }
}
