//! Forms of the extension without drift; any offset of a sensor makes the plain one run away.

use nalgebra::SVector;

use crate::{Fault, Real};

/// The form in which an observer that can be re-based keeps `chi` or `xi` from running away (the paper, remark R5).
///
/// Each form moves a shift `c` from `chi` into the estimated `theta` and into all memory of past regressands. That is
/// exact: all forms give the same estimates of the state, up to rounding, and so does the plain one as long as its
/// `chi` keeps its digits.
///
/// For a [`Fundamental`](crate::Fundamental) extension `chi` is `xi`, and `Psi` starts again from the identity with
/// each shift, as in [re-basing](crate::Observer::rebasing), which lists the memory that is carried over. A `Psi` that
/// dies out calls for [`Free`](Self::Free), [`Leak`](Self::Leak) or re-basing.
///
/// | form | `chi` | cost beside [`Observer::step`](crate::Observer::step) |
/// |---|---|---|
/// | plain | grows with the offset for ever: in `f32`, after `2^24` times the step's increment, it no longer moves | none |
/// | [`Above`](Self::Above) | below the bound plus one step | a comparison; a shift now and then |
/// | [`Leak`](Self::Leak) | below offset/rate | an exponential when `dt` changes; a shift each step |
/// | [`Free`](Self::Free) | 0 | a shift each step |
///
/// A shift costs a product of regressor and vector, and one of the Gramian with DREM;
/// [`WindowedRegression`](crate::WindowedRegression) moves each of its steps.
///
/// # Drift-free form
///
/// With [`Free`](Self::Free) the estimate of `theta` is `z_hat` itself. Over a step it moves by the integral of `h` and
/// by the estimator's correction, while the filtered regressand follows by the filtered regressor times that integral:
///
/// ```text
/// z_hat' = h(y, u) + gain * (innovation of the filtered regression, written in z)
/// ```
///
/// which is the observer without extension that the swapping lemma gives (Morse, *Global stability of
/// parameter-adaptive control systems*, IEEE TAC, 1980; Sastry and Bodson, *Adaptive control*, 1989, lemma 3.6.5).
///
/// # Offset of a sensor
///
/// An offset `b` in `h` makes the true `theta` a ramp of slope `b`, in every form alike. The error of the estimate then
/// depends on the estimator: `b/(gamma |Phi|^2)` for a gradient, `b/beta` for least squares that forgets at `beta`, and
/// `b t/2`, growing without end, for one that does not. An observer that must live with an offset needs an estimator
/// that forgets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drift<S: Real> {
    /// Re-base by `chi` when a component exceeds the bound, in units of z.
    Above(S),
    /// Let `chi` leak at the rate, in 1/s: `chi' = h - rate chi`, and the leak goes into `theta`.
    Leak(S),
    /// Re-base by `chi` at every step.
    Free,
}

impl<S: Real> Drift<S> {
    /// True if the present extension calls for a shift.
    ///
    /// # Errors
    /// [`Fault::Gain`] if the bound is not positive or the rate negative or either NaN.
    pub(crate) fn is_due<const NZ: usize>(self, offset: &SVector<S, NZ>) -> Result<bool, Fault> {
        match self {
            Self::Above(bound) if bound > S::zero() => Ok(offset.iter().any(|&component| Real::abs(component) > bound)),
            Self::Leak(rate) if rate >= S::zero() => Ok(true),
            Self::Free => Ok(true),
            Self::Above(_) | Self::Leak(_) => Err(Fault::Gain),
        }
    }

    /// The shift after a step of `dt` seconds.
    pub(crate) fn shift<const NZ: usize>(self, offset: &SVector<S, NZ>, dt: S) -> SVector<S, NZ> {
        match self {
            Self::Above(_) | Self::Free => *offset,
            Self::Leak(rate) => offset * -Real::exp_m1(-rate * dt),
        }
    }
}
