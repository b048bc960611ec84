//! Samples of output and input in, the estimate of the unmeasured state out.

use nalgebra::SVector;

use crate::extension::{Extension, Flow};
use crate::regression::Sides;
use crate::sum::all_finite;
use crate::{
    Drift, Estimator, Fault, Filter, FilteredRegression, Hold, Integrator, Limits, Model, Real, Rebase, Regression,
    RegressionOperator,
};

/// A parameter-estimation-based observer.
///
/// # Sampling
///
/// ```text
/// sample      y_0          y_1          y_2
/// input        |--- u_0 ---|--- u_1 ---|
/// call     step(y_0,_,_) step(y_1,u_0,dt) step(y_2,u_1,dt)
/// ```
///
/// A call gets the output at the *end* of an interval and the input that was held *during* it. The first call has no
/// interval behind it: it sets the clock to 0 with the output `y_0`, and its `u` and `dt` are checked but have no effect.
/// `dt` is the time since the last sample that was accepted; it need not be constant.
///
/// An input that runs straight between samples rather than being held is told with
/// [`with_input_hold`](Self::with_input_hold): each call then gets the input at the *end* of the interval, the first included.
///
/// # Faults
///
/// A call that returns a [`Fault`] has changed nothing, to the last bit. The next good sample goes on from the last
/// accepted one, with the time since that one as `dt`; if the input moved meanwhile, tell each interval without a usable output to
/// [`skip`](Self::skip) instead. What good samples can be is for [`Limits`] to say. The whole state can be saved and restored:
/// [`state`](Self::state).
#[derive(Clone, Debug)]
pub struct Observer<
    M,
    E,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
    R = FilteredRegression<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NR, NE>,
> where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    model: M,
    limits: Limits<M::Scalar, NY, NU>,
    input_hold: Hold,
    state: State<M::Scalar, M::Extension, R, E, NY, NU>,
}

/// Everything that a step of an [`Observer`] changes, gains and filter included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State<S: Real, X, R, E, const NY: usize, const NU: usize> {
    /// The last accepted sample.
    last: Option<Sample<S, NY, NU>>,
    skipped: Skipped<S, NU>,
    extension: X,
    regression: R,
    estimator: E,
}

/// An accepted sample; the input is the one at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Sample<S: Real, const NY: usize, const NU: usize> {
    y: SVector<S, NY>,
    u: SVector<S, NU>,
}

/// The time since the last accepted sample that was skipped, and the integral of the input over it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Skipped<S: Real, const NU: usize> {
    time: S,
    input: SVector<S, NU>,
}

impl<S: Real, const NU: usize> Skipped<S, NU> {
    fn nothing() -> Self {
        Self { time: S::zero(), input: SVector::zeros() }
    }
}

impl<M, E, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
{
    /// An observer before its first sample: extension at `chi_0`, filters at rest, estimator as given.
    ///
    /// # Errors
    /// [`Fault::Start`] unless `chi_0` and the estimator's state are finite.
    pub fn new(
        model: M,
        estimator: E,
        filter: Filter<M::Scalar>,
        chi_0: SVector<M::Scalar, NZ>,
    ) -> Result<Self, Fault> {
        Self::with_regression(model, estimator, FilteredRegression::new(filter), chi_0)
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// An observer whose regression goes through another operator than a filter, as
    /// [`WindowedRegression`](crate::WindowedRegression).
    ///
    /// # Errors
    /// [`Fault::Start`] unless `chi_0` and the estimator's state are finite.
    pub fn with_regression(
        model: M,
        estimator: E,
        regression: R,
        chi_0: SVector<M::Scalar, NZ>,
    ) -> Result<Self, Fault> {
        if !all_finite(&chi_0) || !estimator.is_finite() {
            return Err(Fault::Start);
        }
        let extension = M::Extension::new(chi_0);
        let state = State { last: None, skipped: Skipped::nothing(), extension, regression, estimator };
        Ok(Self { model, limits: Limits::none(), input_hold: Hold::Zero, state })
    }

    /// The same observer, refusing samples beyond the limits.
    #[must_use]
    pub fn with_limits(self, limits: Limits<M::Scalar, NY, NU>) -> Self {
        Self { limits, ..self }
    }

    /// The same observer for inputs that run as told between samples; held at their start if never told.
    #[must_use]
    pub fn with_input_hold(self, input_hold: Hold) -> Self {
        Self { input_hold, ..self }
    }

    /// Takes the output `y` at the end of an interval of `dt` seconds during which the input was held at `u`, and
    /// returns the estimate of the state at that end. See [`Observer`] for the first call.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let next = self.next(y, u, dt)?;
        self.accept(next, y)
    }

    /// Takes an interval of `dt` seconds with the input `u` at whose end there is no usable output. Nothing of it is lost:
    /// the next [`step`](Self::step) (whose `dt` is then the time since the interval skipped) covers all intervals, with the mean of their inputs.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn skip(&mut self, u: &SVector<M::Scalar, NU>, dt: M::Scalar) -> Result<(), Fault> {
        self.limits.check_input(u)?;
        check_step(dt)?;
        if self.state.last.is_none() {
            return Ok(());
        }
        let Skipped { time, input } = self.state.skipped;
        let skipped = Skipped { time: time + dt, input: input + u * dt };
        self.limits.check_gap(skipped.time)?;
        if !Real::is_finite(skipped.time) || !all_finite(&skipped.input) {
            return Err(Fault::State);
        }
        self.state.skipped = skipped;
        Ok(())
    }

    /// Starts again before the first sample, as after an outage that no `dt` can bridge: extension at `chi_0`, filters
    /// at rest, estimator at `eta` with its gains kept.
    ///
    /// # Errors
    /// [`Fault::Start`] unless both are finite; the observer is then exactly as before.
    pub fn restart(&mut self, chi_0: SVector<M::Scalar, NZ>, eta: &SVector<M::Scalar, NE>) -> Result<(), Fault> {
        if !all_finite(&chi_0) || !all_finite(eta) {
            return Err(Fault::Start);
        }
        self.state.last = None;
        self.state.skipped = Skipped::nothing();
        self.state.extension = M::Extension::new(chi_0);
        self.state.regression.reset();
        self.state.estimator.reset(eta);
        Ok(())
    }

    /// Everything that a step changes, to be saved; with the feature `serde` it can be written and read.
    pub fn state(&self) -> &State<M::Scalar, M::Extension, R, E, NY, NU> {
        &self.state
    }

    /// Goes on from a saved state, bit for bit as the observer that it was taken from. Limits and input hold stay this
    /// observer's own. A reset in flight is answered so, with the time since the state was saved as the next `dt`.
    ///
    /// # Errors
    /// [`Fault::State`] if the state is not finite; the observer is then exactly as before. Whether it is undamaged is for
    /// a checksum to say.
    pub fn restore(&mut self, state: State<M::Scalar, M::Extension, R, E, NY, NU>) -> Result<(), Fault> {
        if !state.is_finite() {
            return Err(Fault::State);
        }
        self.state = state;
        Ok(())
    }

    /// The estimate of the state at the last accepted sample; none before the first.
    pub fn estimate(&self) -> Option<SVector<M::Scalar, NX>> {
        self.state.last.as_ref().map(|last| self.estimate_at(&last.y))
    }

    /// The estimate of the state that goes with an output `y`, as before the first sample.
    pub fn estimate_at(&self, y: &SVector<M::Scalar, NY>) -> SVector<M::Scalar, NX> {
        self.state.estimate(&self.model, y)
    }

    /// The estimate of `theta`.
    pub fn theta(&self) -> SVector<M::Scalar, NZ> {
        self.model.theta(&self.state.estimator.estimate())
    }

    /// The estimate of the regression's unknown.
    pub fn eta(&self) -> SVector<M::Scalar, NE> {
        self.state.estimator.estimate()
    }

    /// The dynamic extension.
    pub fn extension(&self) -> &M::Extension {
        &self.state.extension
    }

    /// The regression that the estimator was given last.
    pub fn regression(&self) -> &R {
        &self.state.regression
    }

    /// The estimator.
    pub fn estimator(&self) -> &E {
        &self.state.estimator
    }

    /// The model.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The state after a sample.
    fn next(
        &self,
        y: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<State<M::Scalar, M::Extension, R, E, NY, NU>, Fault> {
        self.limits.check_output(y)?;
        self.limits.check_input(u)?;
        check_step(dt)?;
        let mut next = self.state.clone();
        let Some(before) = next.last.replace(Sample { y: *y, u: *u }) else {
            return Ok(next);
        };
        let Skipped { time, input } = core::mem::replace(&mut next.skipped, Skipped::nothing());
        let whole = time + dt;
        self.limits.check_gap(whole)?;
        let inputs = if time > nalgebra::zero() {
            let mean = (input + u * dt) / whole;
            [mean, mean]
        } else {
            match self.input_hold {
                Hold::Zero => [*u, *u],
                Hold::First => [before.u, *u],
            }
        };
        next.advance(&self.model, [&before.y, y], inputs.each_ref(), whole)?;
        Ok(next)
    }

    /// Keeps a state if all of it and its estimate are finite.
    fn accept(
        &mut self,
        next: State<M::Scalar, M::Extension, R, E, NY, NU>,
        y: &SVector<M::Scalar, NY>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        if !next.is_finite() {
            return Err(Fault::State);
        }
        let estimate = next.estimate(&self.model, y);
        if !all_finite(&estimate) {
            return Err(Fault::Estimate);
        }
        self.state = next;
        Ok(estimate)
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NZ, R>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
    E: Estimator<M::Scalar, NR, NZ>,
    R: RegressionOperator<M::Scalar, NR, NZ>,
{
    /// Moves `shift` from the extension into the estimated `theta`; the estimate of the state, now and later, stays the
    /// same up to rounding.
    ///
    /// The remedy against the drift of the open integrator (the paper, remark R5): when `chi` has grown, re-base by
    /// `chi`, and it starts again from 0. [`step_without_drift`](Self::step_without_drift) does so by itself.
    ///
    /// # Errors
    /// [`Fault::Start`] if the shift is not finite, [`Fault::State`] if the moved state would not be; the observer is
    /// then exactly as before.
    pub fn rebase(&mut self, shift: &SVector<M::Scalar, NZ>) -> Result<(), Fault> {
        if !all_finite(shift) {
            return Err(Fault::Start);
        }
        let mut next = self.state.clone();
        next.rebase(shift);
        if !next.is_finite() {
            return Err(Fault::State);
        }
        self.state = next;
        Ok(())
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NZ, R>
where
    M: Rebase<NX, NY, NU, NZ, NR, Extension = Integrator<<M as Model<NX, NY, NU, NZ, NR, NZ>>::Scalar, NZ>>,
    E: Estimator<M::Scalar, NR, NZ>,
    R: RegressionOperator<M::Scalar, NR, NZ>,
{
    /// [`step`](Self::step) with an extension that cannot run away: see [`Drift`] for the forms and what each costs.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step_without_drift(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
        drift: Drift<M::Scalar>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let mut next = self.next(y, u, dt)?;
        if let Some(shift) = drift.shift(&next.extension, dt)? {
            next.rebase(&shift);
        }
        self.accept(next, y)
    }
}

impl<S: Real, X, R, E, const NY: usize, const NU: usize> State<S, X, R, E, NY, NU> {
    /// Advances extension, regression and estimator from the first output to the second.
    fn advance<M, const NX: usize, const NZ: usize, const NR: usize, const NE: usize>(
        &mut self,
        model: &M,
        [before, after]: [&SVector<S, NY>; 2],
        [u_before, u_after]: [&SVector<S, NU>; 2],
        dt: S,
    ) -> Result<(), Fault>
    where
        M: Model<NX, NY, NU, NZ, NR, NE, Scalar = S, Extension = X>,
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NE>,
        E: Estimator<S, NR, NE>,
    {
        let start = self.extension;
        let flow = |y, u| Flow { lambda: model.lambda(y, u), h: model.h(y, u) };
        self.extension.advance(&flow(before, u_before), &flow(after, u_after), dt)?;
        let end = self.extension;

        let sides = |x, y, u| Sides { known: model.phi_0(x, y, u), factor: model.phi_1(x, y, u) };
        let mut sides = [sides(&start, before, u_before), sides(&end, after, u_after)];
        if M::REGRESSION == Regression::Dynamic {
            let known_rate = (model.primitive_0(&end, after) - model.primitive_0(&start, before)) / dt;
            let factor_rate = (model.primitive_1(&end, after) - model.primitive_1(&start, before)) / dt;
            for Sides { known, factor } in &mut sides {
                *known = known_rate - *known;
                *factor -= factor_rate;
            }
        }
        self.regression.advance(sides.each_ref(), dt);
        self.estimator.advance(&self.regression.regressor(), &self.regression.regressand(), dt)
    }

    /// Moves a shift from the extension into the unknown.
    fn rebase<const NZ: usize, const NR: usize>(&mut self, shift: &SVector<S, NZ>)
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NZ>,
        E: Estimator<S, NR, NZ>,
    {
        self.extension.rebase(shift);
        self.regression.shift(shift);
        self.estimator.shift(shift);
    }

    /// The estimate of the state that goes with an output.
    fn estimate<M, const NX: usize, const NZ: usize, const NR: usize, const NE: usize>(
        &self,
        model: &M,
        y: &SVector<S, NY>,
    ) -> SVector<S, NX>
    where
        M: Model<NX, NY, NU, NZ, NR, NE, Scalar = S, Extension = X>,
        X: Extension<S, NZ>,
        E: Estimator<S, NR, NE>,
    {
        let theta = model.theta(&self.estimator.estimate());
        model.phi_left(&self.extension.coordinates(&theta), y)
    }

    /// Whether every number of the state is finite.
    fn is_finite<const NZ: usize, const NR: usize, const NE: usize>(&self) -> bool
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NE>,
        E: Estimator<S, NR, NE>,
    {
        self.extension.is_finite()
            && self.regression.is_finite()
            && self.estimator.is_finite()
            && Real::is_finite(self.skipped.time)
            && all_finite(&self.skipped.input)
            && self.last.as_ref().is_none_or(|last| all_finite(&last.y) && all_finite(&last.u))
    }
}

/// A step must be a positive finite time.
fn check_step<S: Real>(dt: S) -> Result<(), Fault> {
    if dt > S::zero() && Real::is_finite(dt) { Ok(()) } else { Err(Fault::Step) }
}
