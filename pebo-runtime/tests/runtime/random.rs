//! Random numbers, vectors and matrices.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use proptest::prelude::*;

/// A positive number whose magnitude is spread evenly over the decades.
pub(crate) fn decades(from: i32, to: i32) -> impl Strategy<Value = f64> {
    (f64::from(from)..f64::from(to)).prop_map(|exponent| 10_f64.powf(exponent))
}

/// A vector of such elements.
pub(crate) fn vector<const N: usize>(element: impl Strategy<Value = f64>) -> impl Strategy<Value = SVector<f64, N>> {
    matrix::<N, 1>(element)
}

/// A matrix of such elements.
pub(crate) fn matrix<const R: usize, const C: usize>(
    element: impl Strategy<Value = f64>,
) -> impl Strategy<Value = SMatrix<f64, R, C>> {
    proptest::collection::vec(element, R * C).prop_map(|elements| SMatrix::from_column_slice(&elements))
}
