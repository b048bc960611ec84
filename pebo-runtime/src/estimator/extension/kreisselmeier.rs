//! The running Gramian of the regressor.

use nalgebra::{SMatrix, SVector};

use super::RegressorExtension;
use crate::decay::Decay;
use crate::sum::Sum;
use crate::{Fault, Real};

/// Kreisselmeier's regressor extension.
///
/// ```text
/// Q' = -l Q + Phi^T Phi        q' = -l q + Phi^T vartheta        Q eta = q
/// matrix = Gamma Q / (1 + tr(Gamma Q))        vector = Gamma q / (1 + tr(Gamma Q))
/// ```
///
/// Holds when: always, `eta` constant. `Q` is positive definite once the last `1/l` seconds were exciting; with `l = 0`
/// it remembers for ever, and interval excitation suffices. After a jump of `eta` the two sides disagree by `e^(-l t)`.
///
/// Method: exact for the regressor held over the step; the normalisation keeps the determinant from overflow and makes
/// it free of units.
///
/// Units of `Gamma`: as in [`Gradient`](crate::Gradient); it says at which `Q` there is information enough.
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
    /// [`Fault::Gain`] unless each gain is positive and finite and the rate finite and not negative.
    pub fn new(gains: &SVector<S, NE>, forgetting: S) -> Result<Self, Fault> {
        if gains.iter().all(|&gain| gain > S::zero() && Real::is_finite(gain)) {
            let (gramian, correlation) = (Sum::new(SMatrix::zeros()), Sum::new(SVector::zeros()));
            Ok(Self { gains: *gains, forgetting: Decay::new(forgetting)?, gramian, correlation })
        } else {
            Err(Fault::Gain)
        }
    }

    /// `1/(1 + tr(Gamma Q))`.
    fn scale(&self) -> S {
        let trace =
            self.gains.iter().enumerate().fold(S::zero(), |sum, (i, &gain)| sum + gain * self.gramian.value()[(i, i)]);
        S::one() / (S::one() + trace)
    }
}

impl<S: Real, const NR: usize, const NE: usize> RegressorExtension<S, NR, NE> for Kreisselmeier<S, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let share = self.forgetting.over(dt);
        let transposed = regressor.transpose();
        let gramian = (transposed * regressor) * share.taken - self.gramian.value() * share.lost;
        let correlation = (transposed * regressand) * share.taken - self.correlation.value() * share.lost;
        self.gramian.add(&gramian);
        self.correlation.add(&correlation);
        Ok(())
    }

    fn matrix(&self) -> SMatrix<S, NE, NE> {
        let scale = self.scale();
        SMatrix::from_fn(|i, j| self.gramian.value()[(i, j)] * (self.gains[i] * scale))
    }

    fn vector(&self) -> SVector<S, NE> {
        let scale = self.scale();
        self.correlation.value().zip_map(&self.gains, |entry, gain| entry * (gain * scale))
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.correlation.add(&(self.gramian.value() * shift));
    }

    fn reset(&mut self) {
        self.gramian = Sum::new(SMatrix::zeros());
        self.correlation = Sum::new(SVector::zeros());
    }

    fn is_finite(&self) -> bool {
        // A trace that overflows would make all of the regression 0.
        self.gramian.is_finite() && self.correlation.is_finite() && self.scale() > S::zero()
    }
}
