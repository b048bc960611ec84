//! The paper's estimator: the gradient of the squared equation error, for any gain and any step.

use nalgebra::{SMatrix, SVector};

use super::{Estimator, Information};
use crate::numeric::sum::{Sum, all_finite, as_blemish};
use crate::{Fault, Real, Turn};

/// The gradient estimator `theta' = Gamma Phi^T (vartheta - Phi theta)` (the paper, Section 5.3, the equation
/// after the filtered regression; it has no number).
///
/// One step is the implicit (backward) Euler step, which needs no bound on gain times step: with consistent data
/// `error_new = (I + dt Gamma Phi^T Phi)^-1 error`, so the error never grows in the norm of `Gamma^-1`. The step is the
/// vector `d` that minimises `d^T Gamma^-1 d + dt |vartheta - Phi (theta + d)|^2`, and that is how it is computed.
///
/// Units of `Gamma`: those of `theta^2` over (regression equation)^2 and second.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gradient<S: Real, const NE: usize> {
    /// `Gamma^-1`.
    inertia: Information<S, NE>,
    /// `Gamma^-1` at the start, if the gain turns with the unknown.
    carried: Option<Information<S, NE>>,
    theta: Sum<S, NE, 1>,
}

impl<S: Real, const NE: usize> Gradient<S, NE> {
    /// One gain for each component, from the estimate 0.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each gain and its inverse is positive and finite.
    pub fn diagonal(gains: &SVector<S, NE>) -> Result<Self, Fault> {
        Ok(Self::of(Information::from_variances(gains)?))
    }

    /// A gain matrix `Gamma`, from the estimate 0.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless `Gamma` is symmetric, positive definite and finite.
    pub fn full(gain: &SMatrix<S, NE, NE>) -> Result<Self, Fault> {
        Ok(Self::of(Information::from_covariance(gain)?))
    }

    fn of(inertia: Information<S, NE>) -> Self {
        Self { inertia, carried: None, theta: Sum::new(SVector::zeros()) }
    }

    /// The same with a gain that turns with the unknown, `Gamma` becoming `T Gamma T^T`: the estimator of the unknown
    /// as it was at the start, in any coordinates. Without it, the gain is one in the coordinates of the moment.
    #[must_use]
    pub fn carrying_its_gain(self) -> Self {
        Self { carried: Some(self.inertia), ..self }
    }

    /// The same gains from another estimate.
    ///
    /// # Errors
    /// [`Fault::Start`] unless the estimate is finite.
    pub fn starting_at(self, estimate: &SVector<S, NE>) -> Result<Self, Fault> {
        if all_finite(estimate) { Ok(Self { theta: Sum::new(*estimate), ..self }) } else { Err(Fault::Start) }
    }

    /// The estimate.
    pub fn estimate(&self) -> &SVector<S, NE> {
        self.theta.value()
    }
}

impl<S: Real, const NR: usize, const NE: usize> Estimator<S, NR, NE> for Gradient<S, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let innovation = regressand - regressor * self.theta.value();
        let mut step = self.inertia.without_target();
        for (row, &error) in regressor.row_iter().zip(innovation.iter()) {
            step.absorb(&row.transpose(), error, dt);
        }
        self.theta.add(&step.solve()?);
        Ok(())
    }

    fn estimate(&self) -> SVector<S, NE> {
        *self.theta.value()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.theta.add(shift);
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.theta.add(&turn.of_unknown(self.theta.value()));
        if self.carried.is_some() {
            self.inertia.turn(turn);
            // Marked here rather than looked for at each step.
            let gain: S = as_blemish(self.inertia.is_finite());
            self.theta.add(&SVector::repeat(gain));
        }
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        self.inertia = self.carried.unwrap_or(self.inertia);
        self.theta = Sum::new(*estimate);
    }

    fn is_finite(&self) -> bool {
        self.theta.is_finite() && (self.carried.is_none() || self.inertia.is_finite())
    }

    fn blemish(&self) -> S {
        self.theta.blemish()
    }
}
