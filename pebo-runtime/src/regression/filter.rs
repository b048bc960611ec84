//! Filters samples of a signal by `alpha / (p + alpha)`, exactly between the samples for the hold chosen.
//!
//! With `a = alpha dt`, a filter at `f` whose input runs from `x0` to `x1` over the step arrives at
//!
//! ```text
//! f + (1 - e^-a) (x0 - f) + (1 - (1 - e^-a)/a) (x1 - x0)
//! ```
//!
//! (variation of constants; without the last term for an input held at `x0`). Exact at any step, so neither a huge nor
//! a tiny `alpha dt` is a special case, and two half steps along a straight input are one whole step.

use nalgebra::SMatrix;

use crate::{Fault, Real, Sum};

/// The course of a signal between two samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Hold {
    /// Held at the sample before: first order accurate.
    Zero,
    /// The straight line between both samples: second order accurate.
    First,
}

/// The filter `alpha / (p + alpha)`, `p = d/dt` (the paper, Section 5.3, at the filtered regression).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Filter<S: Real> {
    alpha: S,
    hold: Hold,
    /// The weights of the last step: sampling is periodic as a rule, and they cost an exponential.
    weights: Weights<S>,
}

/// The weights of one step of a filter: how far it follows its input.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Weights<S: Real> {
    dt: S,
    /// Of the distance between input and filter at the start of the step: `1 - e^-a`.
    level: S,
    /// Of the change of the input during the step: `1 - (1 - e^-a)/a`.
    slope: S,
}

impl<S: Real> Filter<S> {
    /// A filter of bandwidth `alpha`, in rad/s; infinity lets the signal pass unfiltered.
    ///
    /// # Errors
    /// [`Fault::Filter`] unless `alpha > 0`.
    pub fn new(alpha: S, hold: Hold) -> Result<Self, Fault> {
        if alpha > S::zero() {
            let weights = Weights { dt: S::zero(), level: S::zero(), slope: S::zero() };
            Ok(Self { alpha, hold, weights })
        } else {
            Err(Fault::Filter)
        }
    }

    /// The weights of a step of `dt` seconds, `dt > 0`.
    pub fn weights(&mut self, dt: S) -> Weights<S> {
        if self.weights.dt != dt {
            self.weights = Weights::new(self.alpha, self.hold, dt);
        }
        self.weights
    }
}

impl<S: Real> Weights<S> {
    /// The weights of the distance between input and filter at the start of the step, and of the input's change during
    /// it.
    pub(crate) fn level_and_slope(&self) -> (S, S) {
        (self.level, self.slope)
    }

    /// Passes values, so that the results of a step of the usual length stay in registers.
    #[cold]
    #[inline(never)]
    fn new(alpha: S, hold: Hold, dt: S) -> Self {
        let a = alpha * dt;
        let level = -Real::exp_m1(-a);
        let slope = match hold {
            Hold::Zero => S::zero(),
            Hold::First => slope(a, level),
        };
        Self { dt, level, slope }
    }
}

/// `1 - (1 - e^-a)/a`, given `level = 1 - e^-a`.
fn slope<S: Real>(a: S, level: S) -> S {
    if a > S::one() {
        return S::one() - level / a;
    }
    // The difference would cancel: its series a/2! - a^2/3! + a^3/4! - .. is summed inwards instead. The first term
    // left out is below a/20! < 1e-18 of the sum.
    let series = (3..20_u8).rev().fold(S::one(), |tail, k| {
        let k: S = Real::from_f64(f64::from(k));
        S::one() - a / k * tail
    });
    let half: S = Real::from_f64(0.5);
    half * a * series
}

/// A vector or matrix behind a [`Filter`], element by element.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Filtered<S: Real, const R: usize, const C: usize> {
    output: Sum<S, R, C>,
}

impl<S: Real, const R: usize, const C: usize> Filtered<S, R, C> {
    /// A filter whose output is `output`.
    pub fn new(output: SMatrix<S, R, C>) -> Self {
        Self { output: Sum::new(output) }
    }

    /// The filter's output.
    pub fn value(&self) -> &SMatrix<S, R, C> {
        self.output.value()
    }

    /// Advances by one step over which the input runs from `start` to `end`.
    pub fn advance(&mut self, weights: &Weights<S>, start: &SMatrix<S, R, C>, end: &SMatrix<S, R, C>) {
        let behind = (start - self.output.value()) * weights.level;
        self.output.add(&(behind + (end - start) * weights.slope));
    }

    /// Adds `offset` to the output.
    pub fn shift(&mut self, offset: &SMatrix<S, R, C>) {
        self.output.add(offset);
    }

    /// True if every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        self.output.is_finite()
    }

    /// Zero if every number of the state is finite, else NaN.
    pub(crate) fn blemish(&self) -> S {
        self.output.blemish()
    }
}
