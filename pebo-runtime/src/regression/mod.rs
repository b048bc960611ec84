//! Operators that make a regression without derivatives, `regressand = regressor * eta`, of samples of both sides.
//!
//! Both sides of `d/dt primitive_0 - phi_0 = (phi_1 - d/dt primitive_1) eta` go through the same linear operator, which
//! starts at zero: the paper's decaying term epsilon is exactly 0. Between two samples a primitive runs straight, so
//! its derivative is the difference quotient; no signal is differentiated otherwise.
//!
//! - [`FilteredRegression`]: the operator is a [`Filter`];
//! - [`WindowedRegression`]: the mean over a window, the integral form;
//! - [`SampledRegression`]: each sample by itself, for sensors of known standard deviation.

mod filter;
mod sampled;
mod window;

use nalgebra::{SMatrix, SVector};

use crate::{Real, Turn};
pub use filter::{Filter, Filtered, Hold, Weights};
pub use sampled::SampledRegression;
pub use window::{Moved, WindowedRegression};

/// Both sides of `known = factor * eta` at one instant; of a model, `phi_0` and `phi_1`, or its primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides<S: Real, const NR: usize, const NE: usize> {
    /// The known side, in units of the regression's equations.
    pub known: SVector<S, NR>,
    /// The factor of the unknown.
    pub factor: SMatrix<S, NR, NE>,
}

impl<S: Real, const NR: usize, const NE: usize> Sides<S, NR, NE> {
    /// Makes these rows say nothing, `0 = 0 eta`.
    pub(crate) fn leave_out(&mut self, rows: &[bool; NR]) {
        leave_out((&mut self.known, &mut self.factor), rows);
    }
}

/// Makes these rows of both sides say nothing, `0 = 0 eta`.
fn leave_out<S: Real, const NR: usize, const NE: usize>(
    (known, factor): (&mut SVector<S, NR>, &mut SMatrix<S, NR, NE>),
    rows: &[bool; NR],
) {
    let columns = factor.data.0.iter_mut().chain(&mut known.data.0);
    for (entry, _) in columns.flat_map(|column| column.iter_mut().zip(rows)).filter(|(_, is_left_out)| **is_left_out) {
        *entry = S::zero();
    }
}

/// A linear operator in time, applied to both sides of a regression: the equation holds for its outcome too.
///
/// A step is first worked out and then taken, so that an [`Observer`](crate::Observer) can refuse it without a copy of
/// the whole memory.
pub trait RegressionOperator<S: Real, const NR: usize, const NE: usize>: Clone {
    /// A step that is worked out: its outcome, and the state behind it.
    type Step: Outcome<S, NR, NE>;

    /// The step over `dt` seconds in which both sides run straight from the first to the second.
    fn step(&self, sides: [&Sides<S, NR, NE>; 2], dt: S) -> Self::Step;

    /// Takes a step that was worked out from the state as it is.
    fn take(&mut self, step: Self::Step);

    /// The known side of the outcome.
    fn regressand(&self) -> SVector<S, NR>;

    /// The factor of the unknown of the outcome.
    fn regressor(&self) -> SMatrix<S, NR, NE>;

    /// Moves `shift` into the unknown: the outcome now holds for `eta + shift`, also what is still to come of the past.
    fn shift(&mut self, shift: &SVector<S, NE>);

    /// Follows a change of the unknown from `eta` to `T eta`: all regressors, also those still to come of the past, are
    /// multiplied by `T^-1`.
    fn turn(&mut self, turn: &Turn<S, NE>);

    /// Starts again with nothing: `0 = 0 eta`.
    fn reset(&mut self);

    /// True if a step depends on anything but the sides at its end, so that memory has to follow a change of the unknown.
    fn remembers(&self) -> bool {
        true
    }

    /// True if every number of the state is finite.
    fn is_finite(&self) -> bool;
}

/// The outcome of a step of a [`RegressionOperator`]: `regressand = regressor eta`.
pub trait Outcome<S: Real, const NR: usize, const NE: usize> {
    /// The known side.
    fn regressand(&self) -> SVector<S, NR>;

    /// The factor of the unknown.
    fn regressor(&self) -> SMatrix<S, NR, NE>;

    /// 0 if every number of the step is finite, else NaN, see [`Estimator::blemish`](crate::Estimator::blemish).
    fn blemish(&self) -> S;
}

/// An outcome of samples whose rows may be left out.
pub trait Rows<S: Real, const NR: usize> {
    /// The factors of the rows of the regression, `dt` seconds after the sample before.
    fn weights(&self, dt: S) -> SVector<S, NR>;

    /// The same outcome without these rows.
    #[must_use]
    fn without(self, left_out: &[bool; NR]) -> Self;
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
    type Step = Self;

    #[inline]
    fn step(&self, [start, end]: [&Sides<S, NR, NE>; 2], dt: S) -> Self {
        let mut next = *self;
        let weights = next.filter.weights(dt);
        next.regressand.advance(&weights, &start.known, &end.known);
        next.regressor.advance(&weights, &start.factor, &end.factor);
        next
    }

    #[inline]
    fn take(&mut self, step: Self) {
        *self = step;
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

    fn turn(&mut self, turn: &Turn<S, NE>) {
        let step = turn.of_factor(self.regressor.value());
        self.regressor.shift(&step);
    }

    fn reset(&mut self) {
        *self = Self::new(self.filter);
    }

    fn is_finite(&self) -> bool {
        self.blemish() == S::zero()
    }
}

impl<S: Real, const NR: usize, const NE: usize> Outcome<S, NR, NE> for FilteredRegression<S, NR, NE> {
    #[inline]
    fn regressand(&self) -> SVector<S, NR> {
        *self.regressand.value()
    }

    #[inline]
    fn regressor(&self) -> SMatrix<S, NR, NE> {
        *self.regressor.value()
    }

    #[inline]
    fn blemish(&self) -> S {
        self.regressand.blemish() + self.regressor.blemish()
    }
}
