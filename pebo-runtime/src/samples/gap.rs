//! Joins intervals without a usable output into one, with the mean of their inputs.

use nalgebra::SVector;

use crate::{Real, Sum};

/// The time since the last accepted sample, and the integral of the input over it.
///
/// Add every interval; when a good sample ends one, [`step`](crate::Observer::step) the observer with the mean input
/// and the time that [`take`](Self::take) returns. That is exact to second order where `h` is affine in the input.
///
/// ```
/// # use pebo_runtime::{Gap, nalgebra::SVector};
/// let mut gap = Gap::new();
/// gap.add(&SVector::from([1.0]), 0.1);        // the sample at the end of this interval is missing
/// gap.add(&SVector::from([4.0]), 0.2);        // the one at the end of this is there
/// let (u, dt) = gap.take();                   // observer.step(y, u, dt)
/// assert!((u[0] - 3.0_f64).abs() < 1e-15 && (dt - 0.3_f64).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gap<S: Real, const NU: usize> {
    time: Sum<S, 1, 1>,
    input: Sum<S, NU, 1>,
}

impl<S: Real, const NU: usize> Gap<S, NU> {
    /// No interval yet.
    pub fn new() -> Self {
        Self { time: Sum::new(SVector::zeros()), input: Sum::new(SVector::zeros()) }
    }

    /// Adds an interval of `dt` seconds with the input `u`. Numbers that are not finite, and a time that is not
    /// positive, are for the observer to refuse.
    pub fn add(&mut self, u: &SVector<S, NU>, dt: S) {
        self.time.add(&SVector::repeat(dt));
        self.input.add(&(u * dt));
    }

    /// The mean input over all intervals, and their time; to be called when the observer has accepted nothing since the
    /// first of them. Starts again with no interval.
    pub fn take(&mut self) -> (SVector<S, NU>, S) {
        let Self { time, input } = core::mem::take(self);
        (input.value() / time.value().x, time.value().x)
    }
}

impl<S: Real, const NU: usize> Default for Gap<S, NU> {
    fn default() -> Self {
        Self::new()
    }
}
