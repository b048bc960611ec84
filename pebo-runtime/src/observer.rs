//! Samples of output and input in, the estimate of the unmeasured state out.

use nalgebra::{SMatrix, SVector};

use crate::extension::{Extension, Flow};
use crate::regression::Sides;
use crate::sum::{all_finite, blemish};
use crate::{
    Drift, Estimator, Fault, Filter, FilteredRegression, Integrator, Model, Real, Rebase, Regression,
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
/// interval behind it: it sets the clock to 0 with the output `y_0`, and its `u` and `dt` are checked but have no
/// effect.
/// `dt` is the time since the last sample that was accepted; it need not be constant.
///
/// For an input that runs straight between samples rather than being held, call [`step_straight`](Self::step_straight).
///
/// # Faults
///
/// A call that returns a [`Fault`] has changed nothing, to the last bit. The next good sample goes on from the last
/// accepted one, with the time since that one as `dt`; if the input moved meanwhile, a [`Gap`](crate::Gap) says with
/// what input. Samples that are finite but out of range or saturated are for [`Limits`](crate::Limits) to find before
/// they get here. The whole state can be saved and restored: [`state`](Self::state).
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
    state: State<M::Scalar, M::Extension, R, E, NY>,
}

/// Everything that a step of an [`Observer`] changes, gains and filter included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State<S: Real, X, R, E, const NY: usize> {
    /// The last accepted sample.
    y: Option<SVector<S, NY>>,
    extension: X,
    regression: R,
    estimator: E,
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
        Ok(Self { model, state: State { y: None, extension, regression, estimator } })
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
        check(y, u, dt)?;
        let next = self.next(y, [u, u], dt)?;
        self.accept(next, y)
    }

    /// [`step`](Self::step) for an input that runs straight from the first to the second over the interval.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step_straight(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        u: [&SVector<M::Scalar, NU>; 2],
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        check(y, u[0], dt)?;
        check(y, u[1], dt)?;
        let next = self.next(y, u, dt)?;
        self.accept(next, y)
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
        self.state.y = None;
        self.state.extension = M::Extension::new(chi_0);
        self.state.regression.reset();
        self.state.estimator.reset(eta);
        Ok(())
    }

    /// Everything that a step changes, to be saved; with the feature `serde` it can be written and read.
    pub fn state(&self) -> &State<M::Scalar, M::Extension, R, E, NY> {
        &self.state
    }

    /// Goes on from a saved state, bit for bit as the observer that it was taken from. A reset in flight is answered
    /// so, with the time since the state was saved as the next `dt`.
    ///
    /// # Errors
    /// [`Fault::State`] if the state is not finite; the observer is then exactly as before. Whether it is undamaged is
    /// for a checksum to say.
    pub fn restore(&mut self, state: State<M::Scalar, M::Extension, R, E, NY>) -> Result<(), Fault> {
        if !state.is_finite() || state.y.as_ref().is_some_and(|y| !all_finite(y)) {
            return Err(Fault::State);
        }
        self.state = state;
        Ok(())
    }

    /// The estimate of the state at the last accepted sample; none before the first.
    pub fn estimate(&self) -> Option<SVector<M::Scalar, NX>> {
        self.state.y.as_ref().map(|y| self.estimate_at(y))
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

    /// The state after a good sample, for an input that runs straight from the first to the second.
    #[inline]
    fn next(
        &self,
        y: &SVector<M::Scalar, NY>,
        u: [&SVector<M::Scalar, NU>; 2],
        dt: M::Scalar,
    ) -> Result<State<M::Scalar, M::Extension, R, E, NY>, Fault> {
        let mut next = self.state.clone();
        if let Some(before) = next.y.replace(*y) {
            next.advance(&self.model, [&before, y], u, dt)?;
        }
        Ok(next)
    }

    /// Keeps a state if all of it and its estimate are finite.
    fn accept(
        &mut self,
        next: State<M::Scalar, M::Extension, R, E, NY>,
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
        check(y, u, dt)?;
        let mut next = self.next(y, [u, u], dt)?;
        if let Some(shift) = drift.shift(&next.extension, dt)? {
            next.rebase(&shift);
        }
        self.accept(next, y)
    }
}

impl<S: Real, X, R, E, const NY: usize> State<S, X, R, E, NY> {
    /// Advances extension, regression and estimator from the first output to the second.
    fn advance<M, const NX: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>(
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
            for Sides { known, .. } in &mut sides {
                *known = known_rate - *known;
            }
            let factor_change = model.primitive_1(&end, after) - model.primitive_1(&start, before);
            // Where there is no such primitive the compiler knows so, and no division is left.
            if factor_change != SMatrix::<S, NR, NE>::zeros() {
                for Sides { factor, .. } in &mut sides {
                    *factor -= factor_change / dt;
                }
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
    fn estimate<M, const NX: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>(
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
        // One branch for all.
        self.extension.blemish() + self.regression.blemish() + self.estimator.blemish() == S::zero()
    }
}

/// A sample must be finite, and its time positive too.
#[inline]
fn check<S: Real, const NY: usize, const NU: usize>(
    y: &SVector<S, NY>,
    u: &SVector<S, NU>,
    dt: S,
) -> Result<(), Fault> {
    let finite = blemish(y) + blemish(u) + dt * S::zero() == S::zero();
    if finite && dt > S::zero() { Ok(()) } else { Err(what_is_wrong(y, u)) }
}

/// The fault of a sample that has one.
#[cold]
fn what_is_wrong<S: Real, const NY: usize, const NU: usize>(y: &SVector<S, NY>, u: &SVector<S, NU>) -> Fault {
    let bad = |&element: &S| !Real::is_finite(element);
    if let Some(index) = y.iter().position(bad) {
        Fault::Output { index }
    } else if let Some(index) = u.iter().position(bad) {
        Fault::Input { index }
    } else {
        Fault::Step
    }
}
