//! Samples of both sides of the regression in, a regression without derivatives out: `regressand = regressor * eta`.
//!
//! Both sides of `d/dt primitive_0 - phi_0 = (phi_1 - d/dt primitive_1) eta` go through the same filter, which starts at
//! rest: the paper's decaying term epsilon is exactly 0. Between two samples a primitive runs straight, so its derivative
//! is the difference quotient; no signal is differentiated otherwise. This equals
//! `alpha (primitive_0 - F primitive_0) - F phi_0` of the paper (equation regmod, `F = alpha/(p + alpha)`, output filter
//! started at the output) to the last term, without the cancellation between its large parts.

use nalgebra::{SMatrix, SVector};

use crate::{Filter, Filtered, Real};

/// The filtered regression `regressand = regressor * eta`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredRegression<S: Real, const NR: usize, const NE: usize> {
    regressand: Filtered<S, NR, 1>,
    regressor: Filtered<S, NR, NE>,
}

/// The terms of a regression at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms<S: Real, const NR: usize, const NE: usize> {
    pub(crate) phi_0: SVector<S, NR>,
    pub(crate) phi_1: SMatrix<S, NR, NE>,
}

/// What stands under the derivative of a dynamic regression at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Primitives<S: Real, const NR: usize, const NE: usize> {
    pub(crate) known: SVector<S, NR>,
    pub(crate) factor: SMatrix<S, NR, NE>,
}

impl<S: Real, const NR: usize, const NE: usize> FilteredRegression<S, NR, NE> {
    /// The regression before any sample: `0 = 0 eta`.
    pub(crate) fn at_rest() -> Self {
        Self { regressand: Filtered::new(SVector::zeros()), regressor: Filtered::new(SMatrix::zeros()) }
    }

    /// The filtered known side, in units of the regression's equations.
    pub fn regressand(&self) -> &SVector<S, NR> {
        self.regressand.value()
    }

    /// The filtered factor of the unknown.
    pub fn regressor(&self) -> &SMatrix<S, NR, NE> {
        self.regressor.value()
    }

    /// Advances `phi_0 = phi_1 eta` by one step from `start` to `end`.
    pub(crate) fn advance_static(&mut self, filter: &mut Filter<S>, [start, end]: [&Terms<S, NR, NE>; 2], dt: S) {
        let weights = filter.weights(dt);
        self.regressand.advance(&weights, &start.phi_0, &end.phi_0);
        self.regressor.advance(&weights, &start.phi_1, &end.phi_1);
    }

    /// Advances `d/dt [known + factor eta] = phi_0 + phi_1 eta` by one step from `start` to `end`.
    pub(crate) fn advance_dynamic(
        &mut self,
        filter: &mut Filter<S>,
        [start, end]: [&Terms<S, NR, NE>; 2],
        [before, after]: [&Primitives<S, NR, NE>; 2],
        dt: S,
    ) {
        let weights = filter.weights(dt);
        let known_rate = (after.known - before.known) / dt;
        let factor_rate = (after.factor - before.factor) / dt;
        self.regressand.advance(&weights, &(known_rate - start.phi_0), &(known_rate - end.phi_0));
        self.regressor.advance(&weights, &(start.phi_1 - factor_rate), &(end.phi_1 - factor_rate));
    }

    /// Moves `shift` into the unknown: the regression now holds for `eta + shift`.
    pub(crate) fn shift(&mut self, shift: &SVector<S, NE>) {
        let offset = self.regressor.value() * shift;
        self.regressand.shift(&offset);
    }

    /// Whether every number of the state is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.regressand.is_finite() && self.regressor.is_finite()
    }
}
