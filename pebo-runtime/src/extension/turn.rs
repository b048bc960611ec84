//! A linear change of the unknown with its inverse, both stored less the identity.

use nalgebra::{SMatrix, SVector};

use crate::numeric::dense::product;
use crate::numeric::linear::solve;
use crate::{Fault, Real, Sum};

/// The unknown `eta` becomes `matrix * eta`.
///
/// Kept as `matrix - 1` and `1 - matrix^-1`: over a short step both are small beside the identity, and products with
/// them keep the digits that products with the matrices would lose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<S: Real, const N: usize> {
    pub(crate) gained: SMatrix<S, N, N>,
    pub(crate) lost: SMatrix<S, N, N>,
}

impl<S: Real, const N: usize> Turn<S, N> {
    /// The change by a matrix, which may carry more digits than the identity leaves it.
    ///
    /// # Errors
    /// [`Fault::Singular`] if it has no inverse, to rounding.
    pub fn new(matrix: &Sum<S, N, N>) -> Result<Self, Fault> {
        let gained = matrix.beyond(&SMatrix::identity());
        Ok(Self { gained, lost: solve(*matrix.value(), gained)? })
    }

    /// No change.
    pub(crate) fn nothing() -> Self {
        Self { gained: SMatrix::zeros(), lost: SMatrix::zeros() }
    }

    /// The change of the first `M` unknowns, where the others are not mixed with them.
    #[must_use]
    pub fn leading<const M: usize>(&self) -> Turn<S, M> {
        let first =
            |matrix: &SMatrix<S, N, N>| SMatrix::from_fn(|i, j| matrix.get((i, j)).copied().unwrap_or_else(S::zero));
        Turn { gained: first(&self.gained), lost: first(&self.lost) }
    }

    /// The increment of an estimate of the unknown: `(matrix - 1) eta`.
    pub fn of_unknown<const C: usize>(&self, eta: &SMatrix<S, N, C>) -> SMatrix<S, N, C> {
        product(&self.gained, eta)
    }

    /// The increment of a factor of the unknown: `factor (matrix^-1 - 1)`.
    pub fn of_factor<const R: usize>(&self, factor: &SMatrix<S, R, N>) -> SMatrix<S, R, N> {
        -product(factor, &self.lost)
    }

    /// The increment of a sum of products of a factor and a known side: `(matrix^-T - 1) correlation`.
    pub fn of_correlation(&self, correlation: &SVector<S, N>) -> SVector<S, N> {
        -self.lost.tr_mul(correlation)
    }

    /// The increment of a sum of products of a factor with itself: `matrix^-T gramian matrix^-1 - gramian`.
    pub fn of_gramian(&self, gramian: &SMatrix<S, N, N>) -> SMatrix<S, N, N> {
        let right = -(gramian * self.lost);
        let both = gramian + right;
        right - self.lost.tr_mul(&both)
    }

    /// The increment of a map of the unknown into itself: `matrix map matrix^-1 - map`.
    pub fn of_map(&self, map: &SMatrix<S, N, N>) -> SMatrix<S, N, N> {
        let left = self.gained * map;
        left - (map + left) * self.lost
    }
}
