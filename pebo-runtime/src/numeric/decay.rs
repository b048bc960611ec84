//! Exponential forgetting over a step: the share of the past that is kept, and the weight of the present.

use crate::{Fault, Real};

/// Exponential forgetting: `m' = -rate m + s` with the signal `s` held over the step arrives at `kept m + taken s`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Decay<S: Real> {
    rate: S,
    /// The shares of the last step: sampling is periodic as a rule, and they cost an exponential.
    share: Share<S>,
}

/// The two parts of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Share<S: Real> {
    dt: S,
    /// `1 - e^(-rate dt)`: the share of the past that goes.
    pub(crate) lost: S,
    /// `(1 - e^(-rate dt))/rate`, in s: the weight of the present; `dt` without forgetting.
    pub(crate) taken: S,
}

impl<S: Real> Decay<S> {
    /// Forgetting at `rate`, in 1/s; 0 keeps everything.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the rate is finite and not negative.
    pub(crate) fn new(rate: S) -> Result<Self, Fault> {
        if rate >= S::zero() && Real::is_finite(rate) {
            Ok(Self { rate, share: Share { dt: S::zero(), lost: S::zero(), taken: S::zero() } })
        } else {
            Err(Fault::Gain)
        }
    }

    /// The shares of a step of `dt` seconds, `dt > 0`.
    pub(crate) fn over(&mut self, dt: S) -> Share<S> {
        if self.share.dt != dt {
            let lost = -Real::exp_m1(-self.rate * dt);
            // A rate so small that nothing is lost is no rate.
            let taken = if lost > S::zero() { lost / self.rate } else { dt };
            self.share = Share { dt, lost, taken };
        }
        self.share
    }
}
