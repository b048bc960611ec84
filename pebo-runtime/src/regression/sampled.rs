//! Takes each sample of the regression by itself, weighted by the standard deviations of its sensors.

use nalgebra::{SMatrix, SVector};

use super::{Outcome, RegressionOperator, Rows, Sides, leave_out};
use crate::numeric::sum::blemish;
use crate::{Fault, Real, Turn};

/// The sides of the regression at each sample, row `i` divided by `s_i sqrt(dt)`.
///
/// Holds when: the regressand is the sensors' samples, as in the [output form](crate::OutputForm) or in a static
/// regression whose rows are outputs, and row `i` has independent errors of standard deviation `s_i` in each sample.
/// Then the covariance of [`LeastSquares`](crate::LeastSquares) without forgetting is that of the unknown, in its units
/// squared, and process noise is in these units per second: combined a Kalman filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SampledRegression<S: Real, const NR: usize, const NE: usize> {
    deviations: SVector<S, NR>,
    regressand: SVector<S, NR>,
    regressor: SMatrix<S, NR, NE>,
}

impl<S: Real, const NR: usize, const NE: usize> SampledRegression<S, NR, NE> {
    /// Before any sample, with the standard deviation of the sensor behind each row, in the row's units.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each and its inverse is positive and finite.
    pub fn new(deviations: &SVector<S, NR>) -> Result<Self, Fault> {
        let positive = |number: S| number > S::zero() && Real::is_finite(number);
        if deviations.iter().all(|&deviation| positive(deviation) && positive(S::one() / deviation)) {
            let (regressand, regressor) = (SVector::zeros(), SMatrix::zeros());
            Ok(Self { deviations: *deviations, regressand, regressor })
        } else {
            Err(Fault::Gain)
        }
    }
}

impl<S: Real, const NR: usize, const NE: usize> Rows<S, NR> for SampledRegression<S, NR, NE> {
    fn weights(&self, dt: S) -> SVector<S, NR> {
        let root = S::one() / Real::sqrt(dt);
        self.deviations.map(|deviation| root / deviation)
    }

    fn without(mut self, left_out: &[bool; NR]) -> Self {
        leave_out((&mut self.regressand, &mut self.regressor), left_out);
        self
    }
}

impl<S: Real, const NR: usize, const NE: usize> RegressionOperator<S, NR, NE> for SampledRegression<S, NR, NE> {
    type Step = Self;

    fn step(&self, [_, end]: [&Sides<S, NR, NE>; 2], dt: S) -> Self {
        let weights = self.weights(dt);
        let regressor = SMatrix::from_fn(|i, j| end.factor[(i, j)] * weights[i]);
        Self { deviations: self.deviations, regressand: end.known.component_mul(&weights), regressor }
    }

    fn take(&mut self, step: Self) {
        *self = step;
    }

    fn regressand(&self) -> SVector<S, NR> {
        self.regressand
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        self.regressor
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.regressand += self.regressor * shift;
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.regressor += turn.of_factor(&self.regressor);
    }

    fn reset(&mut self) {
        self.regressand = SVector::zeros();
        self.regressor = SMatrix::zeros();
    }

    fn remembers(&self) -> bool {
        false
    }

    fn is_finite(&self) -> bool {
        self.blemish() == S::zero()
    }
}

impl<S: Real, const NR: usize, const NE: usize> Outcome<S, NR, NE> for SampledRegression<S, NR, NE> {
    fn regressand(&self) -> SVector<S, NR> {
        self.regressand
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        self.regressor
    }

    fn blemish(&self) -> S {
        blemish(&self.regressand) + blemish(&self.regressor)
    }
}
