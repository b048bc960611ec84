//! Dynamic regressor extension and mixing: one scalar estimator for each unknown.

use nalgebra::{SMatrix, SVector};

use super::cramer::{adjugate_times, determinant};
use super::{Estimator, RegressorExtension};
use crate::numeric::sum::{Sum, all_finite};
use crate::{Fault, Real, Turn};

/// DREM with the scalar gradient estimator.
///
/// ```text
/// Q eta = q                                  the extension's regression
/// Delta eta_i = (adj(Q) q)_i                 Delta = det Q
/// theta_i' = gamma_i Delta ((adj(Q) q)_i - Delta theta_i)
/// ```
///
/// Holds when: `Delta` is not square-integrable; then each component converges by itself, without overshoot:
/// `|theta_i - eta_i|` never grows. With [`Kreisselmeier`](super::Kreisselmeier) (`l > 0`) that takes persistent
/// excitation, with `l = 0` or [`Response`](super::Response) excitation during an interval suffices.
///
/// Method: implicit step, `error_new = error / (1 + gamma_i dt Delta^2)`, stable at any gain and step. The mixing is
/// applied to `q - Q theta`, where it cancels nothing; the determinant is never divided by.
///
/// A column of zeros in the regressor makes `Delta` 0, and no component moves: leave out an unknown that nothing
/// depends on.
///
/// A [`turn`](Estimator::turn) of the unknown keeps the information, but changes the components: each then converges by
/// itself in the coordinates of the moment, and its error never grows there.
///
/// Units of `gamma`: 1/s, as `Delta` has none and is about 1 where the data determine the unknowns well.
///
/// Source: Aranovskiy, Bobtsov, Ortega, Pyrkin, *Performance enhancement of parameter estimators via dynamic regressor
/// extension and mixing*, IEEE TAC, 2017, arXiv:1509.02763; Cramer's rule: Ortega, Aranovskiy, Pyrkin, Astolfi,
/// Bobtsov, *New results on parameter estimation via dynamic regressor extension and mixing*, IEEE TAC, 2021.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Drem<S: Real, X, const NE: usize> {
    extension: X,
    gains: SVector<S, NE>,
    theta: Sum<S, NE, 1>,
}

impl<S: Real, X, const NE: usize> Drem<S, X, NE> {
    /// One gain `gamma_i`, in 1/s, for each component, from the estimate 0.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each gain is positive and finite.
    pub fn new(extension: X, gains: &SVector<S, NE>) -> Result<Self, Fault> {
        if gains.iter().all(|&gain| gain > S::zero() && Real::is_finite(gain)) {
            Ok(Self { extension, gains: *gains, theta: Sum::new(SVector::zeros()) })
        } else {
            Err(Fault::Gain)
        }
    }

    /// The same from another estimate.
    ///
    /// # Errors
    /// [`Fault::Start`] unless the estimate is finite.
    pub fn starting_at(self, estimate: &SVector<S, NE>) -> Result<Self, Fault> {
        if all_finite(estimate) { Ok(Self { theta: Sum::new(*estimate), ..self }) } else { Err(Fault::Start) }
    }

    /// The extended regression.
    pub fn extension(&self) -> &X {
        &self.extension
    }

    /// The determinant: 0 before any excitation, never above 1 but for rounding.
    pub fn determinant<const NR: usize>(&self) -> S
    where
        X: RegressorExtension<S, NR, NE>,
    {
        determinant(&self.extension.matrix())
    }

    /// One step; returns the share of the error of each component that went.
    pub(crate) fn contract<const NR: usize>(
        &mut self,
        regressor: &SMatrix<S, NR, NE>,
        regressand: &SVector<S, NR>,
        dt: S,
    ) -> Result<SVector<S, NE>, Fault>
    where
        X: RegressorExtension<S, NR, NE>,
    {
        self.extension.advance(regressor, regressand, dt)?;
        let matrix = self.extension.matrix();
        let mixed = adjugate_times(&matrix, &(self.extension.vector() - matrix * self.theta.value()));
        let delta = determinant(&matrix);
        // An infinite gain times a determinant of 0 would not be a number. At a third of the digits of the largest
        // number nothing is kept of an error that the data determine at all.
        let most = S::one() / (S::EPSILON * S::EPSILON * S::EPSILON);
        let taken = self.gains.map(|gain| {
            let reach = (gain * dt).min(most) * delta;
            reach / (S::one() + reach * delta)
        });
        self.theta.add(&taken.component_mul(&mixed));
        Ok(taken * delta)
    }

    /// The estimate.
    pub fn estimate(&self) -> &SVector<S, NE> {
        self.theta.value()
    }
}

impl<S: Real, X, const NR: usize, const NE: usize> Estimator<S, NR, NE> for Drem<S, X, NE>
where
    X: RegressorExtension<S, NR, NE>,
{
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        self.contract(regressor, regressand, dt)?;
        Ok(())
    }

    fn estimate(&self) -> SVector<S, NE> {
        *self.theta.value()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.extension.shift(shift);
        self.theta.add(shift);
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.extension.turn(turn);
        self.theta.add(&turn.of_unknown(self.theta.value()));
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        self.extension.reset();
        self.theta = Sum::new(*estimate);
    }

    fn is_finite(&self) -> bool {
        self.theta.is_finite() && self.extension.is_finite()
    }
}
