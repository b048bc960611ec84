//! The running Gramian of the regressor.

use nalgebra::{SMatrix, SVector};

use super::RegressorExtension;
use crate::numeric::decay::Decay;
use crate::numeric::sum::Sum;
use crate::{Fault, Real, Turn};

/// Kreisselmeier's regressor extension.
///
/// ```text
/// Q' = -l Q + Phi^T Phi        q' = -l q + Phi^T vartheta        Q eta = q
/// matrix = W Q        vector = W q        W = diag(1/(1/gamma_i + Q_ii))
/// ```
///
/// Holds when: always, `eta` constant. `Q` is positive definite once the last `1/l` seconds were exciting; with `l = 0`
/// it remembers for ever, and interval excitation suffices. After a jump of `eta` the two sides disagree by `e^(-l t)`.
///
/// Method: exact for the regressor held over the step. Each row is divided by its own entry of the diagonal, so the
/// determinant is that of the correlations: between 0 and 1 (Hadamard's inequality), the same in any units of the
/// unknowns, and 1 where each unknown is determined by itself, however many there are.
///
/// Units of `gamma_i`: as in [`Gradient`](crate::Gradient); information is enough where `Q_ii` is well above
/// `1/gamma_i`.
///
/// Source: Kreisselmeier, *Adaptive observers with exponential rate of convergence*, IEEE TAC, 1977; its
/// use in DREM: Aranovskiy, Ushirobira, Korotina, Vedyakov, *On preserving-excitation properties of Kreisselmeier's
/// regressor extension scheme*, IEEE TAC, 2023.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Kreisselmeier<S: Real, const NE: usize> {
    gains: SVector<S, NE>,
    forgetting: Decay<S>,
    gramian: Sum<S, NE, NE>,
    correlation: Sum<S, NE, 1>,
}

impl<S: Real, const NE: usize> Kreisselmeier<S, NE> {
    /// The diagonal of `Gamma`, and the rate `l` in 1/s at which the past is forgotten; 0 forgets nothing.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each gain and its inverse is positive and finite and the rate finite and not negative.
    pub fn new(gains: &SVector<S, NE>, forgetting: S) -> Result<Self, Fault> {
        if gains.iter().all(|&gain| gain > S::zero() && Real::is_finite(gain) && Real::is_finite(S::one() / gain)) {
            let (gramian, correlation) = (Sum::new(SMatrix::zeros()), Sum::new(SVector::zeros()));
            Ok(Self { gains: *gains, forgetting: Decay::new(forgetting)?, gramian, correlation })
        } else {
            Err(Fault::Gain)
        }
    }

    /// `1/(1/gamma_i + Q_ii)`.
    fn row_weights(&self) -> SVector<S, NE> {
        self.gains.zip_map(&self.gramian.value().diagonal(), |gain, entry| S::one() / (S::one() / gain + entry))
    }
}

impl<S: Real, const NR: usize, const NE: usize> RegressorExtension<S, NR, NE> for Kreisselmeier<S, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let share = self.forgetting.over(dt);
        let transposed = regressor.transpose();
        self.gramian.decay(share.lost, &((transposed * regressor) * share.taken));
        self.correlation.decay(share.lost, &((transposed * regressand) * share.taken));
        Ok(())
    }

    fn matrix(&self) -> SMatrix<S, NE, NE> {
        let weights = self.row_weights();
        SMatrix::from_fn(|i, j| self.gramian.value()[(i, j)] * weights[i])
    }

    fn vector(&self) -> SVector<S, NE> {
        self.correlation.value().component_mul(&self.row_weights())
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.correlation.add(&(self.gramian.value() * shift));
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.gramian.add(&turn.of_gramian(self.gramian.value()));
        self.correlation.add(&turn.of_correlation(self.correlation.value()));
    }

    fn reset(&mut self) {
        self.gramian = Sum::new(SMatrix::zeros());
        self.correlation = Sum::new(SVector::zeros());
    }

    fn is_finite(&self) -> bool {
        self.gramian.is_finite() && self.correlation.is_finite()
    }
}
