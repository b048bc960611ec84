//! Products of small matrices, column by column, as loops that the compiler unrolls and puts into vector registers.
//!
//! A zero in the right factor costs a comparison and nothing else: the matrices of plants are mostly zeros, and an
//! identity is no work. Large results are written where they are wanted, as a microcontroller copies word by word.

use nalgebra::{SMatrix, SVector};

use crate::Real;

/// `left right`.
#[inline]
pub(crate) fn product<S: Real, const R: usize, const K: usize, const C: usize>(
    left: &SMatrix<S, R, K>,
    right: &SMatrix<S, K, C>,
) -> SMatrix<S, R, C> {
    let mut product = SMatrix::zeros();
    add_product(&mut product, left, right);
    product
}

/// `sum + left right`.
#[inline]
pub(crate) fn add_product<S: Real, const R: usize, const K: usize, const C: usize>(
    sum: &mut SMatrix<S, R, C>,
    left: &SMatrix<S, R, K>,
    right: &SMatrix<S, K, C>,
) {
    for (column, factors) in sum.data.0.iter_mut().zip(&right.data.0) {
        // In registers until the column is done.
        let mut sums = *column;
        for (added, &factor) in left.data.0.iter().zip(factors) {
            if factor != S::zero() {
                for (sum, &added) in sums.iter_mut().zip(added) {
                    *sum += factor * added;
                }
            }
        }
        *column = sums;
    }
}

/// A matrix times a vector, in which no zeros are looked for.
#[inline]
pub(crate) fn applied<S: Real, const R: usize, const K: usize>(
    matrix: &SMatrix<S, R, K>,
    vector: &SVector<S, K>,
) -> SVector<S, R> {
    let mut sums = [S::zero(); R];
    for (column, &factor) in matrix.data.0.iter().zip(&vector.data.0[0]) {
        for (sum, &entry) in sums.iter_mut().zip(column) {
            *sum += factor * entry;
        }
    }
    SVector::from(sums)
}

/// The largest sum of a row's absolute values, which bounds the matrix in one norm.
#[inline]
pub(crate) fn largest_row<S: Real, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> S {
    let mut rows = [S::zero(); R];
    for column in &matrix.data.0 {
        for (row, &entry) in rows.iter_mut().zip(column) {
            *row += Real::abs(entry);
        }
    }
    largest(&rows)
}

/// The largest of positive numbers.
#[inline]
pub(crate) fn largest<S: Real>(numbers: &[S]) -> S {
    numbers.iter().fold(S::zero(), |largest, &number| if number > largest { number } else { largest })
}
