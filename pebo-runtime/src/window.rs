//! The integral form of the regression over a sliding window.

use nalgebra::{SMatrix, SVector};

use crate::regression::{RegressionOperator, Sides};
use crate::sum::{Sum, all_finite};
use crate::{Hold, Real};

/// The mean of both sides over the last `NW` steps.
///
/// For `y' = phi_0 + phi_1 eta` this is the integral form, divided by the window's length `T`:
///
/// ```text
/// (y(t) - y(t - T))/T - mean(phi_0) = mean(phi_1) eta
/// ```
///
/// It forgets completely after `NW` steps, and needs no bandwidth to be chosen. Until then the window grows from the
/// first sample on. Steps of different length are weighted by their length. The cost is memory: `NW` numbers for each
/// entry of both sides, which an [`Observer`](crate::Observer) copies at each step.
///
/// Source: integral regressors: Middleton and Goodwin, *Adaptive computed torque control for rigid link manipulators*,
/// Systems & Control Letters, 1988; over a window: Pan and Yu, *Composite learning robot control with guaranteed
/// parameter convergence*, Automatica, 2018.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WindowedRegression<S: Real, const NR: usize, const NE: usize, const NW: usize> {
    hold: Hold,
    /// Integrals over the steps in the window, in a ring.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    steps: [Integral<S, NR, NE>; NW],
    /// Where the oldest step is, and the next will be.
    oldest: usize,
    /// Over the window.
    total: Total<S, NR, NE>,
    /// Over the steps at the front of the ring, since it was last begun. Full, it becomes the total: so what was lost
    /// beside an outlier is not lost for ever.
    front: Total<S, NR, NE>,
}

/// Integrals of both sides, and the time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Total<S: Real, const NR: usize, const NE: usize> {
    known: Sum<S, NR, 1>,
    factor: Sum<S, NR, NE>,
    duration: Sum<S, 1, 1>,
}

impl<S: Real, const NR: usize, const NE: usize> Total<S, NR, NE> {
    fn nothing() -> Self {
        Self {
            known: Sum::new(SVector::zeros()),
            factor: Sum::new(SMatrix::zeros()),
            duration: Sum::new(SVector::zeros()),
        }
    }

    fn add(&mut self, step: &Integral<S, NR, NE>) {
        self.known.add(&step.known);
        self.factor.add(&step.factor);
        self.duration.add(&SVector::repeat(step.dt));
    }

    fn remove(&mut self, step: &Integral<S, NR, NE>) {
        self.known.add(&-step.known);
        self.factor.add(&-step.factor);
        self.duration.add(&SVector::repeat(-step.dt));
    }

    fn is_finite(&self) -> bool {
        self.known.is_finite() && self.factor.is_finite() && self.duration.is_finite()
    }
}

/// Both sides integrated over one step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Integral<S: Real, const NR: usize, const NE: usize> {
    known: SVector<S, NR>,
    factor: SMatrix<S, NR, NE>,
    dt: S,
}

impl<S: Real, const NR: usize, const NE: usize> Integral<S, NR, NE> {
    fn empty() -> Self {
        Self { known: SVector::zeros(), factor: SMatrix::zeros(), dt: S::zero() }
    }
}

impl<S: Real, const NR: usize, const NE: usize, const NW: usize> WindowedRegression<S, NR, NE, NW> {
    /// An empty window; `hold` says how the sides run between two samples.
    pub fn new(hold: Hold) -> Self {
        const { assert!(NW > 0, "a window holds at least one step") };
        Self { hold, steps: [Integral::empty(); NW], oldest: 0, total: Total::nothing(), front: Total::nothing() }
    }

    /// The window's length in s: that of the last `NW` steps, or of all if there were fewer.
    pub fn duration(&self) -> S {
        self.total.duration.value().x
    }

    /// `1/T`, or 0 for the empty window.
    fn inverse_duration(&self) -> S {
        if self.duration() > S::zero() { S::one() / self.duration() } else { S::zero() }
    }
}

impl<S: Real, const NR: usize, const NE: usize, const NW: usize> RegressionOperator<S, NR, NE>
    for WindowedRegression<S, NR, NE, NW>
{
    fn advance(&mut self, [start, end]: [&Sides<S, NR, NE>; 2], dt: S) {
        let half: S = Real::from_f64(0.5);
        let step = match self.hold {
            Hold::Zero => Integral { known: start.known * dt, factor: start.factor * dt, dt },
            Hold::First => Integral {
                known: (start.known + end.known) * (half * dt),
                factor: (start.factor + end.factor) * (half * dt),
                dt,
            },
        };
        if let Some(slot) = self.steps.get_mut(self.oldest) {
            self.total.remove(slot);
            *slot = step;
        }
        self.total.add(&step);
        self.front.add(&step);
        if self.oldest + 1 < NW {
            self.oldest += 1;
        } else {
            self.oldest = 0;
            self.total = self.front;
            self.front = Total::nothing();
        }
    }

    fn regressand(&self) -> SVector<S, NR> {
        self.total.known.value() * self.inverse_duration()
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        self.total.factor.value() * self.inverse_duration()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        for step in &mut self.steps {
            let offset = step.factor * shift;
            step.known += offset;
        }
        // Summed anew: what leaves the window later must be what the sum holds.
        self.total.known = Sum::new(SVector::zeros());
        self.front.known = Sum::new(SVector::zeros());
        for (place, step) in self.steps.iter().enumerate() {
            self.total.known.add(&step.known);
            if place < self.oldest {
                self.front.known.add(&step.known);
            }
        }
    }

    fn reset(&mut self) {
        *self = Self::new(self.hold);
    }

    fn is_finite(&self) -> bool {
        self.total.is_finite()
            && self.front.is_finite()
            && self.steps.iter().all(|step| all_finite(&step.known) && all_finite(&step.factor))
    }
}
