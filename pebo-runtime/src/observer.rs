//! Samples of output and input in, the estimate of the unmeasured state out.

use nalgebra::SVector;

use crate::extension::{Extension, Flow};
use crate::regression::{Primitives, Terms};
use crate::sum::all_finite;
use crate::{Estimator, Fault, Filter, FilteredRegression, Model, Real, Rebase, Regression};

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
/// # Faults
///
/// A call that returns a [`Fault`] has changed nothing, to the last bit. The next good sample goes on from the last
/// accepted one, with the time since that one as `dt`.
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
> where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
{
    model: M,
    state: State<M::Scalar, M::Extension, E, NY, NR, NE>,
}

/// Everything that a step changes.
#[derive(Clone, Debug)]
struct State<S: Real, X, E, const NY: usize, const NR: usize, const NE: usize> {
    /// The last accepted sample.
    y: Option<SVector<S, NY>>,
    extension: X,
    filter: Filter<S>,
    regression: FilteredRegression<S, NR, NE>,
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
        if !all_finite(&chi_0) || !estimator.is_finite() {
            return Err(Fault::Start);
        }
        let extension = M::Extension::new(chi_0);
        let regression = FilteredRegression::at_rest();
        Ok(Self { model, state: State { y: None, extension, filter, regression, estimator } })
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
        if let Some(index) = first_bad(y) {
            return Err(Fault::Output { index });
        }
        if let Some(index) = first_bad(u) {
            return Err(Fault::Input { index });
        }
        if !(dt > nalgebra::zero() && Real::is_finite(dt)) {
            return Err(Fault::Step);
        }
        let mut next = self.state.clone();
        if let Some(before) = next.y.replace(*y) {
            next.advance(&self.model, [&before, y], u, dt)?;
        }
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
        self.state.regression = FilteredRegression::at_rest();
        self.state.estimator.reset(eta);
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

    /// The filtered regression that the estimator was given last.
    pub fn regression(&self) -> &FilteredRegression<M::Scalar, NR, NE> {
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
}

impl<M, E, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NZ>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
    E: Estimator<M::Scalar, NR, NZ>,
{
    /// Moves `shift` from the extension into the estimated `theta`; the estimate of the state, now and later, stays the
    /// same up to rounding.
    ///
    /// The remedy against the drift of the open integrator (the paper, remark R5): when `chi` has grown, re-base by
    /// `chi`, and it starts again from 0.
    ///
    /// # Errors
    /// [`Fault::Start`] if the shift is not finite, [`Fault::State`] if the moved state would not be; the observer is
    /// then exactly as before.
    pub fn rebase(&mut self, shift: &SVector<M::Scalar, NZ>) -> Result<(), Fault> {
        if !all_finite(shift) {
            return Err(Fault::Start);
        }
        let mut next = self.state.clone();
        next.extension.rebase(shift);
        next.regression.shift(shift);
        next.estimator.shift(shift);
        if !next.is_finite() {
            return Err(Fault::State);
        }
        self.state = next;
        Ok(())
    }
}

impl<S: Real, X, E, const NY: usize, const NR: usize, const NE: usize> State<S, X, E, NY, NR, NE> {
    /// Advances extension, regression and estimator from the first output to the second.
    fn advance<M, const NX: usize, const NU: usize, const NZ: usize>(
        &mut self,
        model: &M,
        [before, after]: [&SVector<S, NY>; 2],
        u: &SVector<S, NU>,
        dt: S,
    ) -> Result<(), Fault>
    where
        M: Model<NX, NY, NU, NZ, NR, NE, Scalar = S, Extension = X>,
        X: Extension<S, NZ>,
        E: Estimator<S, NR, NE>,
    {
        let start = self.extension;
        let flow = |y| Flow { lambda: model.lambda(y, u), h: model.h(y, u) };
        self.extension.advance(&flow(before), &flow(after), dt)?;
        let end = self.extension;

        let terms = |x, y| Terms { phi_0: model.phi_0(x, y, u), phi_1: model.phi_1(x, y, u) };
        let terms = [&terms(&start, before), &terms(&end, after)];
        match M::REGRESSION {
            Regression::Static => self.regression.advance_static(&mut self.filter, terms, dt),
            Regression::Dynamic => {
                let primitives = |x, y| Primitives { known: model.primitive_0(x, y), factor: model.primitive_1(x, y) };
                let primitives = [&primitives(&start, before), &primitives(&end, after)];
                self.regression.advance_dynamic(&mut self.filter, terms, primitives, dt);
            }
        }
        self.estimator.advance(self.regression.regressor(), self.regression.regressand(), dt)
    }

    /// The estimate of the state that goes with an output.
    fn estimate<M, const NX: usize, const NU: usize, const NZ: usize>(
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
    fn is_finite<const NZ: usize>(&self) -> bool
    where
        X: Extension<S, NZ>,
        E: Estimator<S, NR, NE>,
    {
        self.extension.is_finite() && self.regression.is_finite() && self.estimator.is_finite()
    }
}

/// The place of the first element that is not finite.
fn first_bad<S: Real, const N: usize>(vector: &SVector<S, N>) -> Option<usize> {
    vector.iter().position(|&element| !Real::is_finite(element))
}
