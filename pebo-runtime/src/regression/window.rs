//! The integral form of the regression over a sliding window.

use nalgebra::{SMatrix, SVector};

use super::{Outcome, RegressionOperator, Sides};
use crate::numeric::sum::{Sum, all_finite, as_blemish};
use crate::{Hold, Real, Turn};

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
/// entry of both sides.
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
    /// The index of the oldest step, which the next one replaces.
    oldest: usize,
    /// Over the window.
    total: Total<S, NR, NE>,
    /// Over the steps at the front of the ring, since it was last begun. Full, it becomes the total: so digits lost
    /// beside an outlier are not lost for ever.
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

    /// `1/T`, or 0 for the empty window.
    fn inverse_duration(&self) -> S {
        let duration = self.duration.value().x;
        if duration > S::zero() { S::one() / duration } else { S::zero() }
    }

    fn mean_known(&self) -> SVector<S, NR> {
        self.known.value() * self.inverse_duration()
    }

    fn mean_factor(&self) -> SMatrix<S, NR, NE> {
        self.factor.value() * self.inverse_duration()
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
}

/// A window with one more step in it.
#[derive(Clone, Copy, Debug)]
pub struct Moved<S: Real, const NR: usize, const NE: usize> {
    step: Integral<S, NR, NE>,
    total: Total<S, NR, NE>,
    front: Total<S, NR, NE>,
}

impl<S: Real, const NR: usize, const NE: usize> Outcome<S, NR, NE> for Moved<S, NR, NE> {
    fn regressand(&self) -> SVector<S, NR> {
        self.total.mean_known()
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        self.total.mean_factor()
    }

    fn blemish(&self) -> S {
        // A step that is not finite makes the total so.
        as_blemish(self.total.is_finite() && self.front.is_finite())
    }
}

impl<S: Real, const NR: usize, const NE: usize, const NW: usize> RegressionOperator<S, NR, NE>
    for WindowedRegression<S, NR, NE, NW>
{
    type Step = Moved<S, NR, NE>;

    fn step(&self, [start, end]: [&Sides<S, NR, NE>; 2], dt: S) -> Self::Step {
        let half: S = Real::from_f64(0.5);
        let step = match self.hold {
            Hold::Zero => Integral { known: start.known * dt, factor: start.factor * dt, dt },
            Hold::First => Integral {
                known: (start.known + end.known) * (half * dt),
                factor: (start.factor + end.factor) * (half * dt),
                dt,
            },
        };
        let (mut total, mut front) = (self.total, self.front);
        if let Some(leaving) = self.steps.get(self.oldest) {
            total.remove(leaving);
        }
        total.add(&step);
        front.add(&step);
        if self.oldest + 1 < NW {
            Moved { step, total, front }
        } else {
            Moved { step, total: front, front: Total::nothing() }
        }
    }

    fn take(&mut self, Moved { step, total, front }: Self::Step) {
        if let Some(slot) = self.steps.get_mut(self.oldest) {
            *slot = step;
        }
        self.oldest = if self.oldest + 1 < NW { self.oldest + 1 } else { 0 };
        self.total = total;
        self.front = front;
    }

    fn regressand(&self) -> SVector<S, NR> {
        self.total.mean_known()
    }

    fn regressor(&self) -> SMatrix<S, NR, NE> {
        self.total.mean_factor()
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

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.total.factor = Sum::new(SMatrix::zeros());
        self.front.factor = Sum::new(SMatrix::zeros());
        for (place, step) in self.steps.iter_mut().enumerate() {
            let turned = turn.of_factor(&step.factor);
            step.factor += turned;
            self.total.factor.add(&step.factor);
            if place < self.oldest {
                self.front.factor.add(&step.factor);
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
