//! A regression `regressand = regressor * eta` in, step by step; an estimate of the constant `eta` out.

mod gradient;
mod information;

pub use gradient::Gradient;
pub use information::Information;

use nalgebra::{SMatrix, SVector};

use crate::{Fault, Real};

/// Estimates `NE` constants from `NR` linear equations a sample.
///
/// An [`Observer`](crate::Observer) advances a copy and keeps it only if all went well, so an implementation need not
/// undo what it did before a fault. Columns of the regressor may be zero: the estimate must then stay finite.
pub trait Estimator<S: Real, const NR: usize, const NE: usize>: Clone {
    /// Advances by `dt` seconds, at whose end `regressand = regressor * eta` holds.
    ///
    /// # Errors
    /// A [`Fault`] if the step cannot be computed; the estimator is then unspecified.
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault>;

    /// The estimate of `eta`.
    fn estimate(&self) -> SVector<S, NE>;

    /// Follows a move of the unknown from `eta` to `eta + shift`: the error of the estimate, now and later, is that of
    /// an estimator that was never moved. All memory of past regressands has to move too.
    fn shift(&mut self, shift: &SVector<S, NE>);

    /// Starts again from an estimate, with no memory of the past.
    fn reset(&mut self, estimate: &SVector<S, NE>);

    /// Whether every number of the state is finite.
    fn is_finite(&self) -> bool;
}
