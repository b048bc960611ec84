//! Ranges of samples, which only the application knows.

use nalgebra::SVector;

use crate::{Fault, Real};

/// Ranges of outputs and inputs, and the longest time between two accepted samples.
///
/// Check a sample before the observer gets it; a refused one is a missing one. Set the range of an output inside the
/// rails of its sensor, and saturated samples are refused too. A saturated actuator is no fault: tell the observer the
/// input that acted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<S: Real, const NY: usize, const NU: usize> {
    y: Range<S, NY>,
    u: Range<S, NU>,
    gap: Option<S>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Range<S: Real, const N: usize> {
    lower: SVector<S, N>,
    upper: SVector<S, N>,
}

impl<S: Real, const N: usize> Range<S, N> {
    fn new(lower: &SVector<S, N>, upper: &SVector<S, N>) -> Result<Self, Fault> {
        let ordered = lower.iter().zip(upper.iter()).all(|(lower, upper)| lower <= upper);
        if ordered { Ok(Self { lower: *lower, upper: *upper }) } else { Err(Fault::Limits) }
    }

    fn unlimited() -> Self {
        let infinity: S = Real::from_f64(f64::INFINITY);
        Self { lower: SVector::repeat(-infinity), upper: SVector::repeat(infinity) }
    }

    /// The place of the first element out of range.
    fn first_outside(&self, vector: &SVector<S, N>) -> Option<usize> {
        let mut ranges = self.lower.iter().zip(self.upper.iter());
        vector
            .iter()
            .position(|element| !ranges.next().is_some_and(|(lower, upper)| lower <= element && element <= upper))
    }
}

impl<S: Real, const NY: usize, const NU: usize> Limits<S, NY, NU> {
    /// Every number is in range.
    pub fn none() -> Self {
        Self { y: Range::unlimited(), u: Range::unlimited(), gap: None }
    }

    /// With outputs in a range, ends included.
    ///
    /// # Errors
    /// [`Fault::Limits`] unless `lower <= upper` in every component.
    pub fn outputs(self, lower: &SVector<S, NY>, upper: &SVector<S, NY>) -> Result<Self, Fault> {
        Ok(Self { y: Range::new(lower, upper)?, ..self })
    }

    /// With inputs in a range, ends included.
    ///
    /// # Errors
    /// [`Fault::Limits`] unless `lower <= upper` in every component.
    pub fn inputs(self, lower: &SVector<S, NU>, upper: &SVector<S, NU>) -> Result<Self, Fault> {
        Ok(Self { u: Range::new(lower, upper)?, ..self })
    }

    /// With at most `longest` seconds between two accepted samples: beyond, interpolating the outputs is no longer
    /// sound, and the application should [`restart`](crate::Observer::restart).
    ///
    /// # Errors
    /// [`Fault::Limits`] unless the time is positive.
    pub fn gap(self, longest: S) -> Result<Self, Fault> {
        if longest > S::zero() { Ok(Self { gap: Some(longest), ..self }) } else { Err(Fault::Limits) }
    }

    /// Checks a sample before an observer gets it.
    ///
    /// # Errors
    /// [`Fault::OutputRange`], [`Fault::InputRange`] or [`Fault::Gap`], in this order. A NaN is not in any range.
    pub fn check(&self, y: &SVector<S, NY>, u: &SVector<S, NU>, dt: S) -> Result<(), Fault> {
        if let Some(index) = self.y.first_outside(y) {
            return Err(Fault::OutputRange { index });
        }
        if let Some(index) = self.u.first_outside(u) {
            return Err(Fault::InputRange { index });
        }
        if self.gap.is_some_and(|longest| dt > longest) { Err(Fault::Gap) } else { Ok(()) }
    }
}
