//! Estimators of the constant `eta` in a regression `regressand = regressor * eta`, step by step.
//!
//! | estimator | converges with | then follows a jump of `eta` |
//! |---|---|---|
//! | [`Gradient`], [`NormalisedGradient`] | persistent excitation | at the pace of the gain |
//! | [`LeastSquares`], `beta = 0` | excitation during an interval, up to the weight of the start | ever more slowly |
//! | [`LeastSquares`], `beta > 0` | the same | within `1/beta` |
//! | [`AdaptiveLeastSquares`] | the same | within some ten samples where it stands out, else at the pace of the guess |
//! | [`Drem`] of [`Kreisselmeier`], `l > 0` | persistent excitation, each component by itself | within `1/l` and the gain's time |
//! | [`Drem`] of [`Kreisselmeier`], `l = 0` | excitation during an interval | never |
//! | [`Drem`] of the [`Response`] of a [`Gradient`] or [`LeastSquares`] | excitation during an interval | as that estimator |
//! | [`FiniteTime`], [`once`](FiniteTime::once) | the same as its DREM, exactly and in finite time | as its DREM |
//! | [`FiniteTime`], [`tracking`](FiniteTime::tracking) | the same | in finite time, if its extension forgets |
//! | [`Bounded`] | as the estimator within | as the estimator within |
//!
//! Every one is stable at any gain and step. To add one, implement [`Estimator`] or, for DREM, [`RegressorExtension`].

mod adaptive;
mod bounded;
mod cramer;
mod drem;
mod extension;
mod finite_time;
mod gradient;
mod information;
mod least_squares;
mod normalised;

pub use adaptive::AdaptiveLeastSquares;
pub use bounded::Bounded;
pub use drem::Drem;
pub use extension::{Kreisselmeier, RegressorExtension, Response};
pub use finite_time::FiniteTime;
pub use gradient::Gradient;
pub use information::Information;
pub use least_squares::LeastSquares;
pub use normalised::NormalisedGradient;

use nalgebra::{SMatrix, SVector};

use crate::numeric::sum::as_blemish;
use crate::{Fault, Real, Turn};

/// Estimates `NE` constants from `NR` linear equations a sample.
///
/// An [`Observer`](crate::Observer) advances a copy and keeps it only if all went well, so an implementation need not
/// undo what it did before a fault. Columns of the regressor may be zero: the estimate must then stay finite.
pub trait Estimator<S: Real, const NR: usize, const NE: usize>: Clone {
    /// Advances by `dt` seconds, at whose end `regressand = regressor * eta` holds.
    ///
    /// # Errors
    /// A [`Fault`] if the step cannot be computed; the estimator is then unspecified. Data that are not finite may also
    /// show only in [`is_finite`](Self::is_finite), which an [`Observer`](crate::Observer) asks after every step.
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault>;

    /// The estimate of `eta`.
    fn estimate(&self) -> SVector<S, NE>;

    /// Follows a shift of the unknown from `eta` to `eta + shift`: the error of the estimate, now and later, is that of
    /// an estimator that was never shifted. All memory of past regressands has to move too.
    fn shift(&mut self, shift: &SVector<S, NE>);

    /// Follows a change of the unknown from `eta` to `T eta`: the estimate is multiplied by `T`, and all memory of past
    /// regressors and regressands becomes that of regressors times `T^-1`. Settings, as gains, do not change: they then
    /// apply to the new unknown.
    fn turn(&mut self, turn: &Turn<S, NE>);

    /// The information of the estimate, of an estimator that keeps it.
    fn information(&self) -> Option<&Information<S, NE>> {
        None
    }

    /// Starts again from an estimate, with no memory of the past.
    fn reset(&mut self, estimate: &SVector<S, NE>);

    /// True if every number of the state is finite.
    fn is_finite(&self) -> bool;

    /// The same as a number, 0 or NaN, which an [`Observer`](crate::Observer) adds to others at every step: to be
    /// written where that is cheaper, as the sum of all numbers times zero.
    fn blemish(&self) -> S {
        as_blemish(self.is_finite())
    }
}

/// An estimator that knows how uncertain its estimate is.
pub trait Uncertain<S: Real, const NE: usize> {
    /// A root of the covariance of the estimate in `dt` seconds, before that instant's sample: `L` with the covariance
    /// `L L^T`, in units of the unknown where the regression has white noise of intensity 1, as a
    /// [`SampledRegression`](crate::SampledRegression) has. None where it has no finite value.
    fn covariance_root(&self, dt: S) -> Option<SMatrix<S, NE, NE>>;
}
