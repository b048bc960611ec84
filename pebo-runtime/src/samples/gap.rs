//! Joins intervals without a usable output into one, with the mean of their inputs.

use core::cmp::Ordering;

use nalgebra::SVector;

use crate::{Fault, Real, Sum};

/// The time since the last accepted sample, and the integral of the input over it.
///
/// Add every interval; when a good sample ends one, [`step`](crate::Observer::step) the observer with the mean input
/// and the time that [`take`](Self::take) returns. That is exact to second order where `h` is affine in the input. An
/// input that is not a number is unknown: it takes part in the time and not in the mean.
///
/// ```
/// # use pebo_runtime::{Gap, nalgebra::SVector};
/// let mut gap = Gap::new();
/// gap.add(&SVector::from([1.0]), 0.1)?;       // the sample at the end of this interval is missing
/// gap.add(&SVector::from([4.0]), 0.2)?;       // the one at the end of this is there
/// let (u, dt) = gap.take();                   // observer.step(y, u, dt)
/// assert!((u[0] - 3.0_f64).abs() < 1e-15 && (dt - 0.3_f64).abs() < 1e-15);
/// # Ok::<(), pebo_runtime::Fault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gap<S: Real, const NU: usize> {
    time: Sum<S, 1, 1>,
    /// The part of the time in which the input is known, and the integral of the input over it.
    known: Sum<S, 1, 1>,
    input: Sum<S, NU, 1>,
}

impl<S: Real, const NU: usize> Gap<S, NU> {
    /// No interval yet.
    pub fn new() -> Self {
        let none = Sum::new(SVector::zeros());
        Self { time: none, known: none, input: Sum::new(SVector::zeros()) }
    }

    /// Adds an interval of `dt` seconds with the input `u`, of which one that is not finite is unknown.
    ///
    /// # Errors
    /// [`Fault::Step`] unless `dt` is positive, and finite with the intervals before.
    pub fn add(&mut self, u: &SVector<S, NU>, dt: S) -> Result<(), Fault> {
        let mut next = *self;
        next.time.add(&SVector::repeat(dt));
        if dt.partial_cmp(&S::zero()) != Some(Ordering::Greater) || !next.time.is_finite() {
            return Err(Fault::Step);
        }
        next.input.add(&(u * dt));
        if next.input.is_finite() {
            next.known.add(&SVector::repeat(dt));
        } else {
            next.input = self.input;
        }
        *self = next;
        Ok(())
    }

    /// The mean input over all intervals in which it is known, NaN without one, and the time of all intervals; to be
    /// called when the observer has accepted nothing since the first of them. Starts again with no interval.
    pub fn take(&mut self) -> (SVector<S, NU>, S) {
        let Self { time, known, input } = core::mem::take(self);
        (input.value() / known.value().x, time.value().x)
    }
}

impl<S: Real, const NU: usize> Default for Gap<S, NU> {
    fn default() -> Self {
        Self::new()
    }
}
