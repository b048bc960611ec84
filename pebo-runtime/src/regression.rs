//! Samples of both sides of the regression in, a regression without derivatives out: `regressand = regressor * eta`.
//!
//! Both sides of `d/dt primitive_0 - phi_0 = (phi_1 - d/dt primitive_1) eta` go through the same linear operator, which
//! starts with nothing: the paper's decaying term epsilon is exactly 0. Between two samples a primitive runs straight,
//! so its derivative is the difference quotient; no signal is differentiated otherwise.
//!
//! - [`FilteredRegression`]: the operator is a [`Filter`];
//! - [`WindowedRegression`](crate::WindowedRegression): the mean over a window, the integral form.

use nalgebra::{SMatrix, SVector};

use crate::sum::as_blemish;
use crate::{Filter, Filtered, Real};

/// Both sides of `known = factor * eta` at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides<S: Real, const NR: usize, const NE: usize> {
    /// What is known, in units of the regression's equations.
    pub known: SVector<S, NR>,
    /// The factor of the unknown.
    pub factor: SMatrix<S, NR, NE>,
}

/// A linear operator in time, applied to both sides of a regression: what holds at every instant holds for its outcome.
pub trait RegressionOperator<S: Real, const NR: usize, const NE: usize>: Clone {
    /// Advances by `dt` seconds over which both sides run straight from the first to the second.
    fn advance(&mut self, sides: [&Sides<S, NR, NE>; 2], dt: S);

    /// The known side of the outcome.
    fn regressand(&self) -> SVector<S, NR>;

    /// The factor of the unknown of the outcome.
    fn regressor(&self) -> SMatrix<S, NR, NE>;

    /// Moves `shift` into the unknown: the outcome now holds for `eta + shift`, also what is still to come of the past.
    fn shift(&mut self, shift: &SVector<S, NE>);

    /// Starts again with nothing: `0 = 0 eta`.
    fn reset(&mut self);

    /// Whether every number of the state is finite.
    fn is_finite(&self) -> bool;

    /// The same as a number, 0 or NaN, see [`Estimator::blemish`](crate::Estimator::blemish).
    fn blemish(&self) -> S {
        as_blemish(self.is_finite())
    }
}

/// The filtered regression.
///
/// This equals `alpha (primitive_0 - F primitive_0) - F phi_0` of the paper (Section 5.3, `F = alpha/(p + alpha)`,
/// output filter started at the output) to the last term, without the cancellation between its large parts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FilteredRegression<S: Real, const NR: usize, const NE: usize> {
    filter: Filter<S>,
    regressand: Filtered<S, NR, 1>,
    regressor: Filtered<S, NR, NE>,
}

impl<S: Real, const NR: usize, const NE: usize> FilteredRegression<S, NR, NE> {
    /// The regression before any sample.
    pub fn new(filter: Filter<S>) -> Self {
        let (regressand, regressor) = (Filtered::new(SVector::zeros()), Filtered::new(SMatrix::zeros()));
        Self { filter, regressand, regressor }
    }

    /// The filtered known side, in units of the regression's equations.
    pub fn regressand(&self) -> &SVector<S, NR> {
        self.regressand.value()
    }

    /// The filtered factor of the unknown.
    pub fn regressor(&self) -> &SMatrix<S, NR, NE> {
        self.regressor.value()
    }
}

impl<S: Real, const NR: usize, const NE: usize> RegressionOperator<S, NR, NE> for FilteredRegression<S, NR, NE> {
    fn advance(&mut self, [start, end]: [&Sides<S, NR, NE>; 2], dt: S) {
        let weights = self.filter.weights(dt);
        self.regressand.advance(&weights, &start.known, &end.known);
        self.regressor.advance(&weights, &start.factor, &end.factor);
    }

    fn regressand(&self) -> SVector<S, NR> {
        *self.regressand.value()
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        *self.regressor.value()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        let offset = self.regressor.value() * shift;
        self.regressand.shift(&offset);
    }

    fn reset(&mut self) {
        *self = Self::new(self.filter);
    }

    fn is_finite(&self) -> bool {
        self.blemish() == S::zero()
    }

    fn blemish(&self) -> S {
        self.regressand.blemish() + self.regressor.blemish()
    }
}
