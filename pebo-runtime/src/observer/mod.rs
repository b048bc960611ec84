//! The observer: estimates the unmeasured state from samples of outputs and inputs.

mod beginning;
mod confidence;
mod constrained;
mod errors_in_variables;
mod feedthrough;
mod late;
mod rebasing;

use nalgebra::{SMatrix, SVector};

use crate::extension::{Extension, Flow};
use crate::numeric::sum::{all_finite, blemish};
use crate::regression::{Outcome as _, Sides};
use crate::{
    Estimator, Fault, Filter, FilteredRegression, Functions, Model, Real, Regression, RegressionOperator, unwrapped,
};
pub use confidence::Innovation;
use errors_in_variables::{Correction, Led, Taken};
use feedthrough::Feedthrough;
pub use late::{Late, LateObserver};
use rebasing::Rebasing;

/// A parameter-estimation-based observer.
///
/// # Sampling
///
/// ```text
/// sample      y_0          y_1          y_2
/// input        |--- u_0 ---|--- u_1 ---|
/// call     step(y_0,u_0,_) step(y_1,u_0,dt) step(y_2,u_1,dt)
/// ```
///
/// A call gets the output at the *end* of an interval and the input that was held *during* it. The first call has no
/// interval behind it: it sets the clock to 0 with the output `y_0`. Its `dt` has no effect, and its `u` is the input
/// at that instant, as an output that is given by its value may hold it. Later `dt` is the time since the last sample
/// that was accepted; it need not be constant.
///
/// For an input that runs straight between samples rather than being held, call [`step_straight`](Self::step_straight).
///
/// # Faults
///
/// A call that returns a [`Fault`] has changed nothing, to the last bit. The next good sample goes on from the last
/// accepted one, with the time since that one as `dt`; if the input changed meanwhile, a [`Gap`](crate::Gap) has the
/// mean input. A sample that was refused because its estimate has no state, [`Fault::Estimate`], may be given to
/// [`learn`](Self::learn) instead. [`Limits`](crate::Limits) find samples that are finite but out of range or saturated, before they get
/// here. The whole state can be saved and restored: [`state`](Self::state).
///
/// # Unknowns that depend on one another
///
/// Where the regression's unknown holds functions of `theta` ([`Model::functions`]), as `theta` and `theta^2`, or `phi` has
/// components that depend on one another ([`Model::transform`]), as `x1`, `x2` and `x1 x2`, the estimator takes them for
/// independent: it is linear, and converges from any start. Of an estimator with an information matrix the estimate that
/// goes out is then the nearest one, in the norm of the information, among those values. So an unknown that the samples
/// excite in some directions only is known in all of which `theta` or the state leaves no choice.
///
/// # Re-basing
///
/// `z = xi + Psi theta` says less and less of `z` as `Psi` dies out, and overflows as it grows.
/// [`rebasing`](Self::rebasing) makes the extension start again from the estimate: exact, for every estimator, and for
/// any `Lambda`.
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
    state: State<M::Scalar, M::Extension, R, E, NY, NU>,
    /// The terms of the last accepted sample; there if and only if that sample is.
    terms: Option<M::Terms>,
    /// The step that is re-based or corrected, with its trigger. It is compiled only where either is asked for, and the step
    /// without it has no second caller.
    rebasing: Option<Rebasing<Self, M, R, NX, NY, NU, NZ, NR, NE>>,
    /// The standard deviations of the sensors and the correction by them, where their noise is in the factor too.
    correction: Option<Correction<Self, M, E, R, NX, NY, NU, NZ, NR, NE>>,
    /// The outputs that hold the input and drive the cascade, where there are some.
    feedthrough: Option<Feedthrough<Self, M, NX, NY, NU, NZ, NR, NE>>,
    /// True while a sample is taken whether or not the state then has a value.
    is_learning: bool,
}

/// Everything that a step of an [`Observer`] changes, gains and filter included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State<S: Real, X, R, E, const NY: usize, const NU: usize> {
    /// The last accepted sample.
    y: Option<SVector<S, NY>>,
    /// The input at its instant, where an output holds it that drives the cascade.
    u: Option<SVector<S, NU>>,
    extension: X,
    regression: R,
    estimator: E,
    /// Samples since the extension started again, where it does.
    since: u32,
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
        let state = State { y: None, u: None, extension, regression, estimator, since: 0 };
        Ok(Self { model, state, terms: None, rebasing: None, correction: None, feedthrough: None, is_learning: false })
    }

    /// Takes the output `y` at the end of an interval of `dt` seconds during which the input was held at `u`, and
    /// returns the estimate of the state at that end. See [`Observer`] for the first call.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step(&mut self, y: impl Into<M::Y>, u: impl Into<M::U>, dt: M::Scalar) -> Result<M::X, Fault> {
        let (y, u) = (y.into().into(), u.into().into());
        check(&y, &u, dt)?;
        self.advance(&self.unwrapped(&y), [&u, &u], dt).map(M::X::from)
    }

    /// [`step`](Self::step) for an input that runs straight from the first to the second over the interval.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step_straight(&mut self, y: impl Into<M::Y>, u: [impl Into<M::U>; 2], dt: M::Scalar) -> Result<M::X, Fault> {
        let (y, u) = (y.into().into(), u.map(|u| u.into().into()));
        check(&y, &u[0], dt)?;
        check(&y, &u[1], dt)?;
        self.advance(&self.unwrapped(&y), u.each_ref(), dt).map(M::X::from)
    }

    /// Takes a sample as [`step`](Self::step) does, also where the state then has no value: what a step refuses with
    /// [`Fault::Estimate`]. The unknown is estimated all the same, and a later step returns a state again, while an
    /// observer that refuses all such samples learns nothing that would bring its estimate back. Meanwhile the
    /// [`estimate`](Self::estimate) is not finite.
    ///
    /// # Errors
    /// A [`Fault`] as of the step, but for that one unless it is the first sample; the observer is then exactly as before.
    pub fn learn(&mut self, y: impl Into<M::Y>, u: impl Into<M::U>, dt: M::Scalar) -> Result<(), Fault> {
        self.is_learning = true;
        let taken = self.step(y, u, dt);
        self.is_learning = false;
        taken.map(|_| ())
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
        self.state.u = None;
        self.terms = None;
        self.state.extension = M::Extension::new(chi_0);
        self.state.regression.reset();
        self.state.estimator.reset(eta);
        self.state.since = 0;
        Ok(())
    }

    /// Everything that a step changes, to be saved; with the feature `serde` it can be written and read.
    pub fn state(&self) -> &State<M::Scalar, M::Extension, R, E, NY, NU> {
        &self.state
    }

    /// Goes on from a saved state, bit for bit as the observer that it was taken from. A reset in flight is answered
    /// so, with the time since the state was saved as the next `dt`.
    ///
    /// # Errors
    /// [`Fault::State`] if the state is not finite; the observer is then exactly as before. Other damage is for a
    /// checksum to find.
    pub fn restore(&mut self, state: State<M::Scalar, M::Extension, R, E, NY, NU>) -> Result<(), Fault> {
        let is_sample = state.y.as_ref().is_none_or(all_finite) && state.u.as_ref().is_none_or(all_finite);
        if !state.is_finite() || !is_sample {
            return Err(Fault::State);
        }
        self.terms = state.y.as_ref().map(|y| self.model.terms(y));
        self.state = state;
        Ok(())
    }

    /// The estimate of the state at the last accepted sample; none before the first.
    pub fn estimate(&self) -> Option<M::X> {
        self.terms.as_ref().map(|terms| self.estimate_with(terms).into())
    }

    /// The estimate of the state that goes with an output `y`, as before the first sample.
    pub fn estimate_at(&self, y: impl Into<M::Y>) -> M::X {
        self.estimate_with(&self.model.terms(&y.into().into())).into()
    }

    /// The estimate of `theta`.
    pub fn theta(&self) -> SVector<M::Scalar, NZ> {
        self.model.theta(&self.eta())
    }

    /// The estimate of the regression's unknown.
    pub fn eta(&self) -> SVector<M::Scalar, NE> {
        let State { extension, estimator, .. } = &self.state;
        self.terms.as_ref().map_or_else(|| estimator.estimate(), |terms| self.unknown(extension, estimator, terms))
    }

    /// The map from an error of the estimator's estimate to that of [`eta`](Self::eta), where unknowns depend on one
    /// another; none where both are the same.
    pub fn projection(&self) -> Option<SMatrix<M::Scalar, NE, NE>> {
        let State { extension, estimator, .. } = &self.state;
        let nearest = self.nearest(extension, estimator, self.terms.as_ref()?)?;
        constrained::projection(&nearest.slopes, estimator.information()?)
    }

    /// The terms of the last accepted output; none before the first sample.
    pub fn terms(&self) -> Option<&M::Terms> {
        self.terms.as_ref()
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

    /// The sample as it goes on from the last one.
    #[inline]
    fn unwrapped(&self, y: &SVector<M::Scalar, NY>) -> SVector<M::Scalar, NY> {
        let Some(last) = &self.state.y else { return *y };
        let periods = self.model.periods();
        SVector::from_fn(|i, _| unwrapped(y[i], last[i], periods[i]))
    }

    /// Takes a good sample, for an input that runs straight from the first to the second.
    #[inline]
    fn advance(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        u: [&SVector<M::Scalar, NU>; 2],
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let terms = self.model.terms(y);
        let Some(before) = &self.terms else {
            return self.begin(terms, y, u[1], dt);
        };
        // Handed over as copies, so that all may stay in registers where there is no re-basing.
        if let Some(rebasing) = self.rebasing {
            let (y, [u_before, u_after]) = (*y, [*u[0], *u[1]]);
            let u = [&u_before, &u_after];
            return self.advance_by(rebasing, terms, &Taken::whole(&y, u, dt));
        }
        let (extension, regression) = self.propagate([before, &terms], u, dt)?;
        self.finish((extension, regression), terms, y, dt)
    }

    /// Takes a sample by the step that is re-based or corrected.
    fn advance_by(
        &mut self,
        (trigger, step): Rebasing<Self, M, R, NX, NY, NU, NZ, NR, NE>,
        terms: M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let estimate = step(self, trigger, terms, sample)?;
        if self.feedthrough.is_some() {
            self.state.u = Some(*sample.u[1]);
        }
        Ok(estimate)
    }

    /// The end of a step that is neither re-based nor corrected, from extension and regression at the end of the interval.
    #[inline]
    fn finish(
        &mut self,
        (extension, regression): (M::Extension, R::Step),
        terms: M::Terms,
        y: &SVector<M::Scalar, NY>,
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let mut estimator = self.state.estimator.clone();
        estimator.advance(&regression.regressor(), &regression.regressand(), dt)?;
        self.accept(Next { extension, regression, estimator }, terms, y)
    }

    /// What a step leads to, from extension and regression at the end of the interval.
    fn next(
        &self,
        (extension, regression): (M::Extension, R::Step),
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<Next<M::Extension, R::Step, E>, Fault> {
        let equations = Sides { known: regression.regressand(), factor: regression.regressor() };
        let before = (&extension, &self.state.regression);
        let (estimator, corrected) = self.estimated(self.state.estimator.clone(), before, &equations, sample)?;
        Ok(Next { extension, regression: corrected.unwrap_or(regression), estimator })
    }

    /// The estimator after a sample, from the one before it; and the regression in which it is corrected, where it is.
    fn estimated(
        &self,
        before: E,
        (extension, regression): (&M::Extension, &R),
        equations: &Sides<M::Scalar, NR, NE>,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<(E, Option<R::Step>), Fault> {
        let learned = |mut estimator: E, equations: &Sides<M::Scalar, NR, NE>| {
            estimator.advance(&equations.factor, &equations.known, sample.dt).map(|()| estimator)
        };
        let corrected = self.correction.as_ref().and_then(|(sensors, corrected)| {
            corrected(self, Led { extension, estimator: &before, regression }, sample, sensors)
        });
        match corrected {
            Some((estimator, outcome)) => Ok((estimator, Some(outcome))),
            None => Ok((learned(before, equations)?, None)),
        }
    }

    /// The unknown where it is nearest to the estimate: among the values of functions of theta, or in the range of `phi`; none
    /// of a model that has neither.
    #[inline]
    fn nearest(
        &self,
        extension: &M::Extension,
        estimator: &E,
        terms: &M::Terms,
    ) -> Option<Functions<M::Scalar, NE, NZ>> {
        let (model, eta) = (&self.model, estimator.estimate());
        let information = estimator.information()?;
        let theta = model.theta(&eta);
        if !M::RELATED {
            return constrained::nearest(|theta| model.functions(theta), theta, &eta, information);
        }
        const { assert!(!M::RELATED || NE == NZ, "the unknown is theta itself") };
        let unknown = |parameters: &SVector<M::Scalar, NZ>| {
            let Functions { values, slopes } = extension.theta(&model.range(parameters, terms)?)?;
            let values = SVector::from_fn(|i, _| values[i]);
            Some(Functions { values, slopes: SMatrix::from_fn(|i, j| slopes[(i, j)]) })
        };
        let start = model.parameters(&extension.coordinates(&theta), terms);
        constrained::nearest(unknown, start, &eta, information)
    }

    /// The unknown of an estimate.
    #[inline]
    fn unknown(&self, extension: &M::Extension, estimator: &E, terms: &M::Terms) -> SVector<M::Scalar, NE> {
        let nearest = self.nearest(extension, estimator, terms);
        nearest.map_or_else(|| estimator.estimate(), |functions| functions.values)
    }

    /// Keeps the state after an interval if all of it and its estimate are finite.
    #[inline]
    fn accept(
        &mut self,
        next: Next<M::Extension, R::Step, E>,
        terms: M::Terms,
        y: &SVector<M::Scalar, NY>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        // One branch for all.
        if !is_none(next.extension.blemish() + next.regression.blemish() + next.estimator.blemish()) {
            return Err(Fault::State);
        }
        let estimate = self.recovered(&next.extension, &next.estimator, &terms)?;
        self.state.y = Some(*y);
        self.state.extension = next.extension;
        self.state.regression.take(next.regression);
        self.state.estimator = next.estimator;
        self.terms = Some(terms);
        Ok(estimate)
    }

    /// The estimate of the state, if it is finite.
    #[inline]
    fn recovered(
        &self,
        extension: &M::Extension,
        estimator: &E,
        terms: &M::Terms,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let estimate = self.state_of(extension, estimator, terms);
        if all_finite(&estimate) || self.is_learning { Ok(estimate) } else { Err(Fault::Estimate) }
    }

    /// Keeps a moved state if all of it and its estimate are finite.
    fn keep(
        &mut self,
        mut moved: StateOf<M, E, R, NX, NY, NU, NZ, NR, NE>,
        terms: M::Terms,
        y: &SVector<M::Scalar, NY>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        if !moved.is_finite() {
            return Err(Fault::State);
        }
        let estimate = self.recovered(&moved.extension, &moved.estimator, &terms)?;
        moved.y = Some(*y);
        self.state = moved;
        self.terms = Some(terms);
        Ok(estimate)
    }

    /// Extension and regression at the end of an interval, from the terms and inputs at both ends.
    #[inline]
    fn propagate(
        &self,
        [before, after]: [&M::Terms; 2],
        [u_before, u_after]: [&SVector<M::Scalar, NU>; 2],
        dt: M::Scalar,
    ) -> Result<(M::Extension, R::Step), Fault> {
        let model = &self.model;
        let start = &self.state.extension;
        let mut end = *start;
        let theta = || model.theta(&self.state.estimator.estimate());
        let z = if M::LINEARISED { start.coordinates(&theta()) } else { SVector::zeros() };
        let [first, last] = self.flows([before, after], [u_before, u_after], &z, dt);
        end.advance(&first, &last, dt)?;

        let mut sides = [model.regression(start, before, u_before), model.regression(&end, after, u_after)];
        if M::REGRESSION == Regression::Dynamic {
            let held = [model.primitive(start, before), model.primitive(&end, after)];
            let known_rate = (held[1].known - held[0].known) / dt;
            for Sides { known, .. } in &mut sides {
                *known = known_rate - *known;
            }
            let factor_change = held[1].factor - held[0].factor;
            // Where there is no such primitive the compiler knows so, and no division is left.
            if factor_change != SMatrix::<M::Scalar, NR, NE>::zeros() {
                for Sides { factor, .. } in &mut sides {
                    *factor -= factor_change / dt;
                }
            }
        }
        Ok((end, self.state.regression.step(sides.each_ref(), dt)))
    }

    /// The flow at both ends of an interval, of a model that linearises it from these coordinates at the start.
    #[inline]
    fn flows(
        &self,
        [before, after]: [&M::Terms; 2],
        [u_before, u_after]: [&SVector<M::Scalar, NU>; 2],
        z: &SVector<M::Scalar, NZ>,
        dt: M::Scalar,
    ) -> [Flow<M::Scalar, NZ>; 2] {
        let model = &self.model;
        if M::LINEARISED {
            let first = model.flow_near(before, u_before, z);
            let last = model.flow_near(after, u_after, &model.ahead(&first, z, dt));
            [first, last]
        } else {
            [model.flow(before, u_before), model.flow(after, u_after)]
        }
    }

    /// Extension and regression at the end of a sample's interval, of an observer that has one before.
    fn led(
        &self,
        terms: &M::Terms,
        &Taken { u, dt, ref left_out, without, .. }: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<(M::Extension, R::Step), Fault> {
        let carried = self.carried(u[0]);
        let before = carried.as_ref().or(self.terms.as_ref()).ok_or(Fault::State)?;
        let (extension, regression) = self.propagate([before, terms], u, dt)?;
        Ok((extension, without(regression, left_out)))
    }

    /// The estimate of the state that goes with an output.
    fn estimate_with(&self, terms: &M::Terms) -> SVector<M::Scalar, NX> {
        self.state_of(&self.state.extension, &self.state.estimator, terms)
    }

    /// The state of an estimate.
    #[inline]
    fn state_of(&self, extension: &M::Extension, estimator: &E, terms: &M::Terms) -> SVector<M::Scalar, NX> {
        let eta = self.unknown(extension, estimator, terms);
        self.model.recover(&extension.coordinates(&self.model.theta(&eta)), terms)
    }
}

/// The state of a model's observer.
pub(crate) type StateOf<
    M,
    E,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = State<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, <M as Model<NX, NY, NU, NZ, NR, NE>>::Extension, R, E, NY, NU>;

/// The state after an interval, before it is accepted.
struct Next<X, R, E> {
    extension: X,
    regression: R,
    estimator: E,
}

impl<S: Real, X, R, E, const NY: usize, const NU: usize> State<S, X, R, E, NY, NU> {
    /// True if every number of the state is finite.
    fn is_finite<const NZ: usize, const NR: usize, const NE: usize>(&self) -> bool
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NE>,
        E: Estimator<S, NR, NE>,
    {
        self.extension.is_finite() && self.regression.is_finite() && self.estimator.is_finite()
    }
}

/// True for the blemish of numbers that are all finite.
#[inline]
fn is_none<S: Real>(blemish: S) -> bool {
    blemish == S::zero()
}

/// A sample must be finite, and its time positive too.
#[inline]
fn check<S: Real, const NY: usize, const NU: usize>(
    y: &SVector<S, NY>,
    u: &SVector<S, NU>,
    dt: S,
) -> Result<(), Fault> {
    let finite = is_none(blemish(y) + blemish(u) + dt * S::zero());
    if finite && dt > S::zero() { Ok(()) } else { Err(what_is_wrong(y, u)) }
}

/// The fault of a sample that has one.
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
