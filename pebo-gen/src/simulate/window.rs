//! What the regression goes through, of a kind and length that are not known before the run.

use std::collections::VecDeque;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Filter, FilteredRegression, Hold, RegressionOperator, Sides, Sum};

use super::settings::{Operator, Settings};

/// The longest window in samples: an observer copies it at every step.
pub(super) const LONGEST: usize = 1024;

/// The operator of a padded model.
#[derive(Clone, Debug)]
pub(super) enum Passage<const N: usize> {
    Filtered(FilteredRegression<f64, N, N>),
    Windowed(Window<N>),
}

impl<const N: usize> Passage<N> {
    pub(super) fn new(settings: &Settings) -> Result<Self, pebo_runtime::Fault> {
        Ok(match settings.operator {
            Operator::Filter(alpha) => Self::Filtered(FilteredRegression::new(Filter::new(alpha, settings.hold)?)),
            Operator::Window(samples) => Self::Windowed(Window::new(samples, settings.hold)),
        })
    }
}

impl<const N: usize> RegressionOperator<f64, N, N> for Passage<N> {
    fn advance(&mut self, sides: [&Sides<f64, N, N>; 2], dt: f64) {
        match self {
            Self::Filtered(filtered) => filtered.advance(sides, dt),
            Self::Windowed(window) => window.advance(sides, dt),
        }
    }

    fn regressand(&self) -> SVector<f64, N> {
        match self {
            Self::Filtered(filtered) => RegressionOperator::regressand(filtered),
            Self::Windowed(window) => window.regressand(),
        }
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        match self {
            Self::Filtered(filtered) => RegressionOperator::regressor(filtered),
            Self::Windowed(window) => window.regressor(),
        }
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        match self {
            Self::Filtered(filtered) => filtered.shift(shift),
            Self::Windowed(window) => window.shift(shift),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Filtered(filtered) => filtered.reset(),
            Self::Windowed(window) => window.reset(),
        }
    }

    fn is_finite(&self) -> bool {
        match self {
            Self::Filtered(filtered) => filtered.is_finite(),
            Self::Windowed(window) => window.is_finite(),
        }
    }
}

/// The runtime's window, whose length is a constant there. The same operations in the same order: a test holds the two
/// against each other, bit for bit.
#[derive(Clone, Debug)]
pub(super) struct Window<const N: usize> {
    hold: Hold,
    samples: usize,
    /// Integrals over the steps in the window with their lengths, the oldest first.
    steps: VecDeque<Step<N>>,
    /// How many of the newest make up the front.
    recent: usize,
    total: Total<N>,
    /// Full, it becomes the total.
    front: Total<N>,
}

/// Both sides integrated over a step, and its length.
type Step<const N: usize> = (Sides<f64, N, N>, f64);

#[derive(Clone, Debug)]
struct Total<const N: usize> {
    known: Sum<f64, N, 1>,
    factor: Sum<f64, N, N>,
    duration: Sum<f64, 1, 1>,
}

impl<const N: usize> Total<N> {
    fn nothing() -> Self {
        Self {
            known: Sum::new(SVector::zeros()),
            factor: Sum::new(SMatrix::zeros()),
            duration: Sum::new(SVector::zeros()),
        }
    }

    fn add(&mut self, (sides, length): &Step<N>) {
        self.known.add(&sides.known);
        self.factor.add(&sides.factor);
        self.duration.add(&SVector::repeat(*length));
    }

    fn is_finite(&self) -> bool {
        self.known.is_finite() && self.factor.is_finite() && self.duration.is_finite()
    }
}

impl<const N: usize> Window<N> {
    pub(super) fn new(samples: usize, hold: Hold) -> Self {
        let (total, front) = (Total::nothing(), Total::nothing());
        Self { hold, samples, steps: VecDeque::new(), recent: 0, total, front }
    }

    fn inverse_duration(&self) -> f64 {
        let duration = self.total.duration.value().x;
        if duration > 0.0 { 1.0 / duration } else { 0.0 }
    }
}

impl<const N: usize> RegressionOperator<f64, N, N> for Window<N> {
    fn advance(&mut self, [start, end]: [&Sides<f64, N, N>; 2], dt: f64) {
        let sides = match self.hold {
            Hold::Zero => Sides { known: start.known * dt, factor: start.factor * dt },
            Hold::First => Sides {
                known: (start.known + end.known) * (0.5 * dt),
                factor: (start.factor + end.factor) * (0.5 * dt),
            },
        };
        if self.steps.len() == self.samples
            && let Some((oldest, length)) = self.steps.pop_front()
        {
            self.total.add(&(Sides { known: -oldest.known, factor: -oldest.factor }, -length));
        }
        let step = (sides, dt);
        self.total.add(&step);
        self.front.add(&step);
        self.steps.push_back(step);
        self.recent += 1;
        if self.recent == self.samples {
            self.recent = 0;
            self.total = std::mem::replace(&mut self.front, Total::nothing());
        }
    }

    fn regressand(&self) -> SVector<f64, N> {
        self.total.known.value() * self.inverse_duration()
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        self.total.factor.value() * self.inverse_duration()
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        self.total.known = Sum::new(SVector::zeros());
        self.front.known = Sum::new(SVector::zeros());
        let older = self.steps.len() - self.recent;
        for (place, (sides, _)) in self.steps.iter_mut().enumerate() {
            let offset = sides.factor * shift;
            sides.known += offset;
            self.total.known.add(&sides.known);
            if place >= older {
                self.front.known.add(&sides.known);
            }
        }
    }

    fn reset(&mut self) {
        *self = Self::new(self.samples, self.hold);
    }

    fn is_finite(&self) -> bool {
        // What is not finite makes a sum so at once.
        self.total.is_finite() && self.front.is_finite()
    }
}
