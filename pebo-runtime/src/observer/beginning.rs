//! The first sample, which has no interval behind it.
//!
//! In: the sample, with the input at that instant. Out: the first estimate of the state; outputs that are given by their
//! values have told the unknown what they say of it, and those with rates begin there. Holds after: the next interval can
//! begin with this sample.

use nalgebra::SVector;

use super::errors_in_variables::Taken;
use super::{Observer, is_none};
use crate::extension::Extension;
use crate::numeric::sum::{all_finite, blemish};
use crate::regression::{Outcome as _, Sides};
use crate::{Estimator, Fault, Model, Real, RegressionOperator};

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// The share of a period that the first sample stands for: there is no interval before it, and nothing drifts.
    pub const INSTANT: f64 = 1e-9;

    /// Takes the first sample, which has no interval behind it.
    pub(super) fn begin(
        &mut self,
        terms: M::Terms,
        y: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let extension = self.model.begin(&self.state.extension, &terms);
        let theta = self.model.theta(&self.state.estimator.estimate());
        let z = extension.coordinates(&theta);
        let start = self.model.recover(&z, &terms);
        // An observer begins also where its start has a state and the sample leads to none.
        let learned = self.learned_at_once(&extension, &terms, &Taken::whole(y, [u, u], dt));
        let learned = learned.and_then(|(estimator, regression)| {
            let estimate = self.state_of(&extension, &estimator, &terms);
            all_finite(&estimate).then_some((estimator, regression, estimate))
        });
        let (estimate, learned) = match learned {
            Some((estimator, regression, estimate)) => (estimate, Some((estimator, regression))),
            None if all_finite(&start) => (start, None),
            None => return Err(Fault::Estimate),
        };
        // An interval begins where the one before ended: from a sample without rates none would lead on.
        let flow = self.model.flow_near(&terms, u, &z);
        let sides = self.model.regression(&extension, &terms, u);
        let rates = blemish(&flow.h) + blemish(&flow.lambda) + blemish(&sides.known) + blemish(&sides.factor);
        if !extension.is_finite() || !is_none(rates) {
            return Err(Fault::State);
        }
        if let Some((estimator, regression)) = learned {
            self.state.estimator = estimator;
            self.state.regression.take(regression);
        }
        self.state.extension = extension;
        self.state.y = Some(*y);
        if self.feedthrough.is_some() {
            self.state.u = Some(*u);
        }
        self.terms = Some(terms);
        Ok(estimate)
    }

    /// Estimator and regression after the rows of the first sample that need no interval; none where there are none, or
    /// they have no value.
    fn learned_at_once(
        &self,
        extension: &M::Extension,
        terms: &M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Option<(E, R::Step)> {
        let (rates, before) = (self.model.rates(), &self.state.regression);
        if rates >= NR || before.remembers() {
            return None;
        }
        let left_out = core::array::from_fn(|row| row < rates);
        let mut sides = self.model.regression(extension, terms, sample.u[1]);
        sides.leave_out(&left_out);
        // A sample by itself has the same weight after any time, in which the unknown drifts.
        let sample = Taken { left_out, dt: sample.dt * Real::from_f64(Self::INSTANT), ..*sample };
        let step = before.step([&sides; 2], sample.dt);
        let equations = Sides { known: step.regressand(), factor: step.regressor() };
        let (estimator, corrected) =
            self.estimated(self.state.estimator.clone(), (extension, before), &equations, &sample).ok()?;
        let step = corrected.unwrap_or(step);
        is_none(step.blemish() + estimator.blemish()).then_some((estimator, step))
    }
}
