//! Re-basing: moves an offset or the fundamental matrix from the extension into the unknown.
//!
//! `z = xi + Psi theta` holds as well with `xi + Psi c` for `xi` and `theta - c` for `theta`, and with the identity for
//! `Psi` and `Psi theta` for `theta`. Estimator and regression follow either change, so nothing is lost but rounding.

use nalgebra::SVector;

use super::errors_in_variables::{Taken, TakenBy};
use super::{Next, Observer, State, check};
use crate::numeric::sum::all_finite;
use crate::{Drift, Estimator, Extension, Fault, Model, Real, Rebase, Regression, RegressionOperator, Sides};

/// The trigger of re-basing.
#[derive(Clone, Copy, Debug)]
pub(super) enum Trigger<S: Real> {
    /// None: the step is corrected alone.
    Never,
    /// This number of samples since the last time.
    Samples(u32),
    /// The size of the extension.
    Drift(Drift<S>),
}

/// The step of an observer `O` that starts its extension again: from its trigger, terms of the sample and the sample.
type Step<
    O,
    M,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = fn(
    &mut O,
    Trigger<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar>,
    <M as Model<NX, NY, NU, NZ, NR, NE>>::Terms,
    &TakenBy<'_, M, R, NX, NY, NU, NZ, NR, NE>,
) -> Result<SVector<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NX>, Fault>;

/// The trigger of re-basing, and the step that does so.
pub(super) type Rebasing<
    O,
    M,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = (Trigger<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar>, Step<O, M, R, NX, NY, NU, NZ, NR, NE>);

/// The state after an interval.
type NextOf<X, R, E, S, const NR: usize, const NE: usize> = Next<X, StepOf<R, S, NR, NE>, E>;

pub(super) type StepOf<R, S, const NR: usize, const NE: usize> = <R as RegressionOperator<S, NR, NE>>::Step;

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NZ, R>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
    E: Estimator<M::Scalar, NR, NZ>,
    R: RegressionOperator<M::Scalar, NR, NZ>,
{
    /// The same observer, which starts its extension again from the estimate at every `every`-th sample:
    ///
    /// ```text
    /// xi <- xi + Psi theta_hat        Psi <- I        theta_hat <- 0
    /// ```
    ///
    /// with the memory of estimator and regression carried over. That changes no estimate by more than rounding, with
    /// two exceptions, which are the purpose: a gain, a floor of the information and process noise are those of `z`
    /// itself from then on, and not of what `z` was at the start; and neither a `Psi` that dies out nor one that grows
    /// is ever held. [`Gradient::carrying_its_gain`](crate::Gradient::carrying_its_gain) and least squares without
    /// forgetting take their memory along in full.
    ///
    /// A filter or window holds regressors of the past, which are carried over by the model's flow since. Where `Psi`
    /// dies out, take a bandwidth well above its rate or a window well below its time, or the [output
    /// form](crate::OutputForm), which holds nothing: older regressors rest on the model alone.
    ///
    /// With [`LeastSquares`](crate::LeastSquares), [process noise](crate::LeastSquares::with_process_noise) and every
    /// sample this is a Kalman filter of the transformed plant. In `f32`, at `|Lambda| dt` below 1e-5, take every
    /// hundredth sample or so: the change of a turn must not be lost beside the identity.
    ///
    /// # Errors
    /// [`Fault::Gain`] if `every` is 0.
    pub fn rebasing(self, every: u32) -> Result<Self, Fault> {
        if every == 0 {
            return Err(Fault::Gain);
        }
        Ok(Self { rebasing: Some((Trigger::Samples(every), Self::step_rebasing)), ..self })
    }

    /// The same observer, each step of which is [`step_without_drift`](Self::step_without_drift); in place of
    /// [`rebasing`](Self::rebasing).
    ///
    /// # Errors
    /// [`Fault::Gain`] if the bound is not positive, or the rate of the leak negative, or either NaN.
    pub fn without_drift(self, drift: Drift<M::Scalar>) -> Result<Self, Fault> {
        drift.is_due(&SVector::<M::Scalar, NZ>::zeros())?;
        Ok(Self { rebasing: Some((Trigger::Drift(drift), Self::step_drifting)), ..self })
    }

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
        next.shift(shift);
        if !next.is_finite() {
            return Err(Fault::State);
        }
        self.state = next;
        Ok(())
    }

    /// [`step`](Self::step) with an extension that cannot run away: see [`Drift`] for the forms and what each costs. In
    /// place of [`rebasing`](Self::rebasing), which such a step does not heed.
    ///
    /// # Errors
    /// A [`Fault`]; the observer is then exactly as before.
    pub fn step_without_drift(
        &mut self,
        y: impl Into<M::Y>,
        u: impl Into<M::U>,
        dt: M::Scalar,
        drift: Drift<M::Scalar>,
    ) -> Result<M::X, Fault> {
        let (y, u) = (y.into().into(), u.into().into());
        check(&y, &u, dt)?;
        self.advance_without_drift(&y, &u, dt, drift).map(M::X::from)
    }

    /// Takes a good sample without drift.
    fn advance_without_drift(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
        drift: Drift<M::Scalar>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let terms = self.model.terms(y);
        if self.terms.is_none() {
            // A form that is none is refused before anything changes.
            drift.is_due(self.state.extension.offset())?;
            let estimate = self.begin(terms, y, u, dt)?;
            if drift.is_due(self.state.extension.offset())? {
                self.state.turn()?;
                self.state.shift(&drift.shift(self.state.extension.offset(), dt));
            }
            return Ok(estimate);
        }
        self.advance_by((Trigger::Drift(drift), Self::step_drifting), terms, &Taken::whole(y, [u, u], dt))
    }

    /// Takes the state after a sample, and moves a shift where the form asks for one.
    fn move_by_drift(
        &mut self,
        drift: Drift<M::Scalar>,
        next: NextOf<M::Extension, R, E, M::Scalar, NR, NZ>,
        (terms, y): (M::Terms, &SVector<M::Scalar, NY>),
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        if !drift.is_due(next.extension.offset())? {
            return self.accept(next, terms, y);
        }
        let Next { extension, regression, estimator } = next;
        let mut moved = State { extension, estimator, ..self.state.clone() };
        moved.regression.take(regression);
        moved.turn()?;
        moved.shift(&drift.shift(moved.extension.offset(), dt));
        self.keep(moved, terms, y)
    }

    /// A step of an observer whose steps are all without drift.
    fn step_drifting(
        &mut self,
        trigger: Trigger<M::Scalar>,
        terms: M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let Trigger::Drift(drift) = trigger else { return Err(Fault::Gain) };
        let next = self.next(self.led(&terms, sample)?, sample)?;
        self.move_by_drift(drift, next, (terms, sample.y), sample.dt)
    }

    /// A step of an observer that starts its extension again. The coordinates change before the estimator's step, so
    /// process noise is that of the moment.
    fn step_rebasing(
        &mut self,
        trigger: Trigger<M::Scalar>,
        terms: M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let Trigger::Samples(every) = trigger else { return Err(Fault::Gain) };
        // What can be copied as one block is.
        let State { y, u, extension, ref regression, ref estimator, since } = self.state;
        let before = State { y, u, extension, regression: regression.clone(), estimator: estimator.clone(), since };
        match self.rebased(every, &terms, sample) {
            Ok(estimate) => {
                self.state.y = Some(*sample.y);
                self.terms = Some(terms);
                Ok(estimate)
            }
            Err(fault) => {
                self.state = before;
                Err(fault)
            }
        }
    }

    /// The same, in place: after a fault the state is unspecified.
    fn rebased(
        &mut self,
        every: u32,
        terms: &M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        if every == 1 && M::REGRESSION == Regression::Static && !self.state.regression.remembers() {
            self.move_anew(terms, sample)?;
        } else {
            self.move_rebasing(every, terms, sample)?;
        }
        let state = &mut self.state;
        let equations = Sides { known: state.regression.regressand(), factor: state.regression.regressor() };
        if self.correction.is_none() {
            state.estimator.advance(&equations.factor, &equations.known, sample.dt)?;
        } else {
            let before = (&self.state.extension, &self.state.regression);
            let (estimator, corrected) = self.estimated(self.state.estimator.clone(), before, &equations, sample)?;
            self.state.estimator = estimator;
            if let Some(outcome) = corrected {
                self.state.regression.take(outcome);
            }
        }
        if !(self.state.regression.is_finite() && self.state.estimator.is_finite()) {
            return Err(Fault::State);
        }
        self.recovered(&self.state.extension, &self.state.estimator, terms)
    }

    /// Goes to the end of an interval, before the estimator's step, of an observer that starts its extension again at every
    /// sample and whose regression has no past: the coordinates are those of the moment from the beginning.
    fn move_anew(
        &mut self,
        terms: &M::Terms,
        &Taken { u: [u_before, u_after], dt, ref left_out, without, .. }: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<(), Fault> {
        let carried = self.carried(u_before);
        let before = carried.as_ref().or(self.terms.as_ref()).ok_or(Fault::State)?;
        let estimate = self.state.estimator.estimate();
        let z = self.state.extension.coordinates(&estimate);
        let [start, end] = self.flows([before, terms], [u_before, u_after], &z, dt);
        let State { extension, regression, estimator, .. } = &mut self.state;
        extension.rebase(&-estimate);
        estimator.shift(&-estimate);
        extension.advance_anew(&start, &end, dt, |turn| estimator.turn(turn))?;
        // The fundamental matrix is the identity.
        if !all_finite(extension.offset()) {
            return Err(Fault::State);
        }
        let sides = self.model.regression(extension, terms, u_after);
        let step = regression.step([&sides; 2], dt);
        regression.take(without(step, left_out));
        Ok(())
    }

    /// The same of any other.
    fn move_rebasing(
        &mut self,
        every: u32,
        terms: &M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<(), Fault> {
        let (extension, regression) = self.led(terms, sample)?;
        let state = &mut self.state;
        state.extension = extension;
        state.regression.take(regression);
        state.since = state.since.saturating_add(1);
        if state.since >= every {
            state.onto_estimate()?;
            state.since = 0;
            // A regression whose past dies out more slowly than `Psi` grows without end in the coordinates of the
            // moment. Started again it holds as well.
            let most = largest_regressor::<M::Scalar>();
            if state.regression.regressor().iter().any(|&entry| Real::abs(entry) > most) {
                state.regression.reset();
            }
        }
        if state.extension.is_finite() { Ok(()) } else { Err(Fault::State) }
    }
}

impl<S: Real, X, R, E, const NY: usize, const NU: usize> State<S, X, R, E, NY, NU> {
    /// Moves a shift from the extension into the unknown.
    fn shift<const NZ: usize, const NR: usize>(&mut self, shift: &SVector<S, NZ>)
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NZ>,
        E: Estimator<S, NR, NZ>,
    {
        self.extension.rebase(shift);
        self.regression.shift(shift);
        self.estimator.shift(shift);
    }

    /// Moves the fundamental matrix from the extension into the unknown.
    fn turn<const NZ: usize, const NR: usize>(&mut self) -> Result<(), Fault>
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NZ>,
        E: Estimator<S, NR, NZ>,
    {
        if let Some(turn) = self.extension.take_turn()? {
            self.regression.turn(&turn);
            self.estimator.turn(&turn);
        }
        Ok(())
    }

    /// Moves the estimate into the extension, which starts again from there.
    fn onto_estimate<const NZ: usize, const NR: usize>(&mut self) -> Result<(), Fault>
    where
        X: Extension<S, NZ>,
        R: RegressionOperator<S, NR, NZ>,
        E: Estimator<S, NR, NZ>,
    {
        self.shift(&-self.estimator.estimate());
        self.turn()
    }
}

/// Beyond this a regressor of the past is not carried over: its square would have no value.
fn largest_regressor<S: Real>() -> S {
    S::max_value().map_or(S::one() / S::EPSILON, |largest| Real::sqrt(largest) * S::EPSILON)
}
