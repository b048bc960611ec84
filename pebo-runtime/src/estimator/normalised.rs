//! The normalised gradient: its speed does not depend on the size of the regressor.

use nalgebra::{SMatrix, SVector};

use super::{Estimator, Gradient};
use crate::{Fault, Real, Turn};

/// The normalised gradient estimator `theta' = Gamma Phi^T (vartheta - Phi theta) / (1 + mu |Phi|^2)`.
///
/// Holds when: as the gradient, with persistent excitation. However large the regressor, a component moves no faster
/// than at its gain over `mu`; below `|Phi|^2 = 1/mu` this is the gradient. `|.|` is the Frobenius norm.
///
/// Method: the implicit step of [`Gradient`] with `dt/(1 + mu |Phi|^2)` for `dt`, hence stable at any gain and step.
///
/// Units of `mu`: 1 over (regressor)^2; of `Gamma`: as in [`Gradient`].
///
/// Source: Ioannou and Sun, *Robust adaptive control*, 1996, chapter 4 (gradient method with normalisation).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NormalisedGradient<S: Real, const NE: usize> {
    gradient: Gradient<S, NE>,
    mu: S,
}

impl<S: Real, const NE: usize> NormalisedGradient<S, NE> {
    /// The gradient estimator given, normalised by `1 + mu |Phi|^2`.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless `mu` is finite and not negative.
    pub fn new(gradient: Gradient<S, NE>, mu: S) -> Result<Self, Fault> {
        if mu >= S::zero() && Real::is_finite(mu) { Ok(Self { gradient, mu }) } else { Err(Fault::Gain) }
    }

    /// The estimate.
    pub fn estimate(&self) -> &SVector<S, NE> {
        self.gradient.estimate()
    }
}

impl<S: Real, const NR: usize, const NE: usize> Estimator<S, NR, NE> for NormalisedGradient<S, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        // mu first: nothing overflows at mu = 0.
        let size = regressor.iter().fold(S::one(), |size, &entry| size + self.mu * entry * entry);
        self.gradient.advance(regressor, regressand, dt / size)
    }

    fn estimate(&self) -> SVector<S, NE> {
        *self.gradient.estimate()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        Estimator::<S, NR, NE>::shift(&mut self.gradient, shift);
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        Estimator::<S, NR, NE>::turn(&mut self.gradient, turn);
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        Estimator::<S, NR, NE>::reset(&mut self.gradient, estimate);
    }

    fn is_finite(&self) -> bool {
        Estimator::<S, NR, NE>::is_finite(&self.gradient)
    }
}
