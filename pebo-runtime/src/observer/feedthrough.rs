//! Samples that hold the input, at an instant at which the input jumps.
//!
//! In: the last sample with its input, and the input that is held after it. Out: the outputs just after the jump, from
//! which the next interval begins, where the estimate knows the jump better than the sample does.

use nalgebra::SVector;

use super::rebasing::Trigger;
use super::{Observer, State, is_none};
use crate::numeric::sum::blemish;
use crate::regression::{Outcome, Rows};
use crate::{Estimator, Fault, Model, OutputForm, Real, RegressionOperator, Uncertain};

/// The standard deviations of a sensor within which an estimate explains a sample.
const NEAR: f64 = OutputForm::<(), f64, 0, 0>::NEAR;

/// The output that each row gives by its value with the input in it, and the terms of the last sample of an observer `O`
/// with another input at that instant; none where they do not change.
pub(super) type Feedthrough<
    O,
    M,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = (
    [Option<usize>; NR],
    fn(
        &O,
        &[Option<usize>; NR],
        &SVector<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NU>,
    ) -> Option<<M as Model<NX, NY, NU, NZ, NR, NE>>::Terms>,
);

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE> + Uncertain<M::Scalar, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
    R::Step: Rows<M::Scalar, NR>,
{
    /// The same observer for outputs that drive the cascade and hold the input, as an accelerometer on a car does the
    /// steering angle: `outputs` has for each row of the regression that is `y_i - (..)` the index `i`, where `u` is among
    /// what is in brackets.
    ///
    /// A sample is of the instant before a held input jumps, and the next interval begins after it. There the observer
    /// takes `y_i + g(u) - g(u_last)` for the sample, where `g` is what its row expects: if the estimate explains the
    /// sample to three standard deviations of its sensor, and the standard error of the jump is less than the jump. So
    /// an estimate that is on its way is driven by samples alone, as is one of a model that is wrong.
    ///
    /// Holds when: the equations are [samples](crate::SampledRegression).
    ///
    /// # Errors
    /// [`Fault::Limits`] if an index is out of `y`.
    pub fn with_feedthrough(self, outputs: [Option<usize>; NR]) -> Result<Self, Fault> {
        if outputs.iter().flatten().any(|output| *output >= NY) {
            return Err(Fault::Limits);
        }
        // The step that is re-based or corrected begins after the jump.
        let rebasing = self.rebasing.or(Some((Trigger::Never, Self::step_corrected)));
        Ok(Self { feedthrough: Some((outputs, Self::after_jump)), rebasing, ..self })
    }

    /// The terms of the last sample with this input at its instant, see [`with_feedthrough`](Self::with_feedthrough).
    fn after_jump(&self, outputs: &[Option<usize>; NR], u: &SVector<M::Scalar, NU>) -> Option<M::Terms> {
        let State { y: Some(y), u: Some(last), extension, estimator, regression, .. } = &self.state else {
            return None;
        };
        let terms = self.terms.as_ref().filter(|_| last != u)?;
        let (model, eta) = (&self.model, estimator.estimate());
        let root = estimator.covariance_root(nalgebra::zero())?;
        // Over a second a sample has the weight of its sensor.
        let second = nalgebra::one();
        let [before, after] = [last, u].map(|u| regression.step([&model.regression(extension, terms, u); 2], second));
        let rest = |step: &R::Step| step.regressand() - step.regressor() * eta;
        let (unexplained, jumps) = (rest(&before), rest(&before) - rest(&after));
        let spread = (before.regressor() - after.regressor()) * root;
        let weights = before.weights(second);
        let mut carried = *y;
        for (row, output) in outputs.iter().enumerate() {
            let (jump, explained) = (jumps[row], Real::abs(unexplained[row]) <= Real::from_f64(NEAR));
            if let Some(output) = output.and_then(|output| carried.get_mut(output))
                && explained
                && spread.row(row).norm_squared() < jump * jump
            {
                *output += jump / weights[row];
            }
        }
        let carried = model.terms(&carried);
        let flow = model.flow(&carried, u);
        is_none(blemish(&flow.h) + blemish(&flow.lambda)).then_some(carried)
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// The terms from which an interval with this input begins: those of the last accepted output, just after the input has
    /// jumped, see [`with_feedthrough`](Self::with_feedthrough); none before the first sample.
    pub fn terms_with(&self, u: &SVector<M::Scalar, NU>) -> Option<M::Terms> {
        self.carried(u).or(self.terms)
    }

    /// The terms from which an interval with this input begins, where they are not those of the last sample.
    #[inline]
    pub(super) fn carried(&self, u: &SVector<M::Scalar, NU>) -> Option<M::Terms> {
        let (outputs, after_jump) = self.feedthrough.as_ref()?;
        after_jump(self, outputs, u)
    }
}
