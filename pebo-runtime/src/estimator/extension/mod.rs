//! Regressor extensions: square regressions with memory, made of regressions of any shape; the first half of DREM.

mod kreisselmeier;
mod response;

pub use kreisselmeier::Kreisselmeier;
pub use response::Response;

use nalgebra::{SMatrix, SVector};

use crate::{Fault, Real, Turn};

/// A regressor extension: keeps a square regression `vector = matrix * eta` that follows from all data so far.
///
/// The determinant of `matrix` is a measure of excitation: it has no unit and is between 0, before any excitation, and
/// about 1, where every unknown is determined well by itself. An entry of `matrix` has the unit of its row's unknown
/// over that of its column's.
pub trait RegressorExtension<S: Real, const NR: usize, const NE: usize>: Clone {
    /// Advances by `dt` seconds, at whose end `regressand = regressor * eta` holds.
    ///
    /// # Errors
    /// A [`Fault`] if the step cannot be computed; the extension is then unspecified.
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault>;

    /// The factor of `eta`.
    fn matrix(&self) -> SMatrix<S, NE, NE>;

    /// The known side, in units of `eta`.
    fn vector(&self) -> SVector<S, NE>;

    /// Follows a shift of the unknown from `eta` to `eta + shift`.
    fn shift(&mut self, shift: &SVector<S, NE>);

    /// Follows a change of the unknown from `eta` to `T eta`, see [`Estimator::turn`](crate::Estimator::turn).
    fn turn(&mut self, turn: &Turn<S, NE>);

    /// Starts again with no memory of the past.
    fn reset(&mut self);

    /// True if every number of the state is finite.
    fn is_finite(&self) -> bool;
}
