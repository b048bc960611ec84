//! The operator of the regression, of a kind and length that are not known before the run.

use std::collections::VecDeque;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Filter, FilteredRegression, Hold, Outcome, RegressionOperator, Rows, SampledRegression, Sides, Sum, Turn,
};

use super::setup::{Operator, Settings};
use super::sizes::padded;

/// The operator of a padded model.
#[derive(Clone, Debug)]
pub(crate) enum PaddedOperator<const N: usize> {
    Filtered(FilteredRegression<f64, N, N>),
    Windowed(Window<N>),
    Sampled(SampledRegression<f64, N, N>),
}

impl<const N: usize> PaddedOperator<N> {
    pub(crate) fn new(settings: &Settings) -> Result<Self, pebo_runtime::Fault> {
        Ok(match &settings.operator {
            Operator::Filter(alpha) => Self::Filtered(FilteredRegression::new(Filter::new(*alpha, settings.hold)?)),
            Operator::Window(samples) => Self::Windowed(Window::new(*samples, settings.hold)),
            Operator::Sampled(deviations) => Self::Sampled(SampledRegression::new(&padded(deviations, 1.0))?),
        })
    }
}

impl<const N: usize> RegressionOperator<f64, N, N> for PaddedOperator<N> {
    type Step = PaddedStep<N>;

    fn step(&self, sides: [&Sides<f64, N, N>; 2], dt: f64) -> PaddedStep<N> {
        match self {
            Self::Filtered(filtered) => PaddedStep::Filtered(filtered.step(sides, dt)),
            Self::Windowed(window) => PaddedStep::Windowed(Box::new(window.step(sides, dt))),
            Self::Sampled(sampled) => PaddedStep::Sampled(sampled.step(sides, dt)),
        }
    }

    fn take(&mut self, step: PaddedStep<N>) {
        match (self, step) {
            (Self::Filtered(filtered), PaddedStep::Filtered(step)) => filtered.take(step),
            (Self::Windowed(window), PaddedStep::Windowed(step)) => window.take(*step),
            (Self::Sampled(sampled), PaddedStep::Sampled(step)) => sampled.take(step),
            _ => unreachable!("a step is taken by what worked it out"),
        }
    }

    fn regressand(&self) -> SVector<f64, N> {
        match self {
            Self::Filtered(filtered) => RegressionOperator::regressand(filtered),
            Self::Windowed(window) => window.regressand(),
            Self::Sampled(sampled) => RegressionOperator::regressand(sampled),
        }
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        match self {
            Self::Filtered(filtered) => RegressionOperator::regressor(filtered),
            Self::Windowed(window) => window.regressor(),
            Self::Sampled(sampled) => RegressionOperator::regressor(sampled),
        }
    }

    fn shift(&mut self, shift: &SVector<f64, N>) {
        match self {
            Self::Filtered(filtered) => filtered.shift(shift),
            Self::Windowed(window) => window.shift(shift),
            Self::Sampled(sampled) => sampled.shift(shift),
        }
    }

    fn turn(&mut self, turn: &Turn<f64, N>) {
        match self {
            Self::Filtered(filtered) => filtered.turn(turn),
            Self::Windowed(window) => window.turn(turn),
            Self::Sampled(sampled) => sampled.turn(turn),
        }
    }

    fn reset(&mut self) {
        match self {
            Self::Filtered(filtered) => filtered.reset(),
            Self::Windowed(window) => window.reset(),
            Self::Sampled(sampled) => sampled.reset(),
        }
    }

    fn remembers(&self) -> bool {
        match self {
            Self::Filtered(filtered) => filtered.remembers(),
            Self::Windowed(window) => window.remembers(),
            Self::Sampled(sampled) => sampled.remembers(),
        }
    }

    fn is_finite(&self) -> bool {
        match self {
            Self::Filtered(filtered) => filtered.is_finite(),
            Self::Windowed(window) => window.is_finite(),
            Self::Sampled(sampled) => RegressionOperator::is_finite(sampled),
        }
    }
}

/// A step of each kind; that of a window, the largest by far, behind a pointer.
#[derive(Clone, Debug)]
pub(crate) enum PaddedStep<const N: usize> {
    Filtered(FilteredRegression<f64, N, N>),
    Windowed(Box<WindowStep<N>>),
    Sampled(SampledRegression<f64, N, N>),
}

impl<const N: usize> Outcome<f64, N, N> for PaddedStep<N> {
    fn regressand(&self) -> SVector<f64, N> {
        match self {
            Self::Filtered(step) => Outcome::regressand(step),
            Self::Windowed(step) => step.regressand(),
            Self::Sampled(step) => Outcome::regressand(step),
        }
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        match self {
            Self::Filtered(step) => Outcome::regressor(step),
            Self::Windowed(step) => step.regressor(),
            Self::Sampled(step) => Outcome::regressor(step),
        }
    }

    fn blemish(&self) -> f64 {
        match self {
            Self::Filtered(step) => Outcome::blemish(step),
            Self::Windowed(step) => step.blemish(),
            Self::Sampled(step) => step.blemish(),
        }
    }
}

/// Rows of samples; from the outcome of a filter or window no row can be left out, and none is asked for.
impl<const N: usize> Rows<f64, N> for PaddedStep<N> {
    fn weights(&self, dt: f64) -> SVector<f64, N> {
        match self {
            Self::Sampled(step) => step.weights(dt),
            Self::Filtered(_) | Self::Windowed(_) => SVector::repeat(1.0),
        }
    }

    fn without(self, left_out: &[bool; N]) -> Self {
        match self {
            Self::Sampled(step) => Self::Sampled(step.without(left_out)),
            other => other,
        }
    }
}

/// The runtime's window, whose length is a constant there. The same operations in the same order: a test holds the two
/// against each other, bit for bit.
#[derive(Clone, Debug)]
pub(crate) struct Window<const N: usize> {
    hold: Hold,
    samples: usize,
    /// Integrals over the steps in the window with their lengths, the oldest first.
    steps: VecDeque<Integral<N>>,
    /// The number of the newest steps in the front.
    recent: usize,
    total: Total<N>,
    /// Full, it becomes the total.
    front: Total<N>,
}

/// Both sides integrated over a step, and its length.
type Integral<const N: usize> = (Sides<f64, N, N>, f64);

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

    fn add(&mut self, (sides, length): &Integral<N>) {
        self.known.add(&sides.known);
        self.factor.add(&sides.factor);
        self.duration.add(&SVector::repeat(*length));
    }

    fn inverse_duration(&self) -> f64 {
        let duration = self.duration.value().x;
        if duration > 0.0 { 1.0 / duration } else { 0.0 }
    }

    fn mean_known(&self) -> SVector<f64, N> {
        self.known.value() * self.inverse_duration()
    }

    fn mean_factor(&self) -> SMatrix<f64, N, N> {
        self.factor.value() * self.inverse_duration()
    }

    fn is_finite(&self) -> bool {
        self.known.is_finite() && self.factor.is_finite() && self.duration.is_finite()
    }
}

impl<const N: usize> Window<N> {
    pub(crate) fn new(samples: usize, hold: Hold) -> Self {
        let (total, front) = (Total::nothing(), Total::nothing());
        Self { hold, samples, steps: VecDeque::new(), recent: 0, total, front }
    }
}

/// A window with one more step in it.
#[derive(Clone, Debug)]
pub(crate) struct WindowStep<const N: usize> {
    step: Integral<N>,
    total: Total<N>,
    front: Total<N>,
}

impl<const N: usize> Outcome<f64, N, N> for WindowStep<N> {
    fn regressand(&self) -> SVector<f64, N> {
        self.total.mean_known()
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        self.total.mean_factor()
    }

    fn blemish(&self) -> f64 {
        if self.total.is_finite() && self.front.is_finite() { 0.0 } else { f64::NAN }
    }
}

impl<const N: usize> RegressionOperator<f64, N, N> for Window<N> {
    type Step = WindowStep<N>;

    fn step(&self, [start, end]: [&Sides<f64, N, N>; 2], dt: f64) -> WindowStep<N> {
        let sides = match self.hold {
            Hold::Zero => Sides { known: start.known * dt, factor: start.factor * dt },
            Hold::First => Sides {
                known: (start.known + end.known) * (0.5 * dt),
                factor: (start.factor + end.factor) * (0.5 * dt),
            },
        };
        let (mut total, mut front) = (self.total.clone(), self.front.clone());
        if self.steps.len() == self.samples
            && let Some((oldest, length)) = self.steps.front()
        {
            total.add(&(Sides { known: -oldest.known, factor: -oldest.factor }, -length));
        }
        let step = (sides, dt);
        total.add(&step);
        front.add(&step);
        if self.recent + 1 == self.samples {
            WindowStep { step, total: front, front: Total::nothing() }
        } else {
            WindowStep { step, total, front }
        }
    }

    fn take(&mut self, WindowStep { step, total, front }: WindowStep<N>) {
        if self.steps.len() == self.samples {
            self.steps.pop_front();
        }
        self.steps.push_back(step);
        self.recent = if self.recent + 1 == self.samples { 0 } else { self.recent + 1 };
        self.total = total;
        self.front = front;
    }

    fn regressand(&self) -> SVector<f64, N> {
        self.total.mean_known()
    }

    fn regressor(&self) -> SMatrix<f64, N, N> {
        self.total.mean_factor()
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

    fn turn(&mut self, turn: &Turn<f64, N>) {
        self.total.factor = Sum::new(SMatrix::zeros());
        self.front.factor = Sum::new(SMatrix::zeros());
        let older = self.steps.len() - self.recent;
        for (place, (sides, _)) in self.steps.iter_mut().enumerate() {
            let turned = turn.of_factor(&sides.factor);
            sides.factor += turned;
            self.total.factor.add(&sides.factor);
            if place >= older {
                self.front.factor.add(&sides.factor);
            }
        }
    }

    fn reset(&mut self) {
        *self = Self::new(self.samples, self.hold);
    }

    fn is_finite(&self) -> bool {
        // A step that is not finite makes a sum so at once.
        self.total.is_finite() && self.front.is_finite()
    }
}
