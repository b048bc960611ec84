//! Standard errors of estimates, innovations of samples, and steps with missing outputs.
//!
//! All rests on the covariance of the estimator ([`Uncertain`]), which is correct where the noise of the regression is
//! that of sensors: with a [`SampledRegression`](crate::SampledRegression), in the [output form](crate::OutputForm) or
//! of a static regression.

use nalgebra::SVector;

use super::errors_in_variables::Taken;
use super::{Observer, State, check};
use crate::estimator::Information;
use crate::extension::Extension;
use crate::regression::{Outcome, Rows};
use crate::{Estimator, Fault, Model, Real, RegressionOperator, Uncertain};

/// The difference between a sample and the observer's prediction of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation<S: Real, const NR: usize> {
    /// Sample less expectation of each row of the regression, in standard deviations of its sensor.
    pub value: SVector<S, NR>,
    /// The square of the innovation in the norm of its covariance, `e^T (Phi P Phi^T + 1)^-1 e`: on average the number
    /// of rows, if covariances and model are right.
    pub normalised_square: S,
    /// The determinant of that covariance, `det(Phi P Phi^T + 1)`: how much less is known of the sample than of its sensors.
    pub determinant: S,
}

impl<S: Real, const NR: usize> Innovation<S, NR> {
    /// That of no sample, where nothing is expected.
    pub(super) fn nothing() -> Self {
        Self { value: SVector::zeros(), normalised_square: S::zero(), determinant: S::one() }
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE> + Uncertain<M::Scalar, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// The standard error of each state of the estimate: the covariance of the unknown through the derivative of
    /// `phi_left`, which is taken over one standard error of the unknown to either side, the smaller change counting:
    /// an angle may come round on the other.
    ///
    /// It is that of the last sample: [`standard_error_after`](Self::standard_error_after) counts the time since. For
    /// an estimate that [`Within`](crate::Within) moves to a bound it is that of the estimate before.
    ///
    /// None before the first sample, and where `phi_left` has no value one standard error away.
    ///
    /// Cost: `2 NE` left inverses.
    pub fn standard_error(&self) -> Option<SVector<M::Scalar, NX>> {
        self.standard_error_after(nalgebra::zero())
    }

    /// The same for that estimate `dt` seconds later, if no sample has been taken since: by its process noise the
    /// unknown has drifted, and is known less well.
    pub fn standard_error_after(&self, dt: M::Scalar) -> Option<SVector<M::Scalar, NX>> {
        let terms = self.terms.as_ref()?;
        let State { extension, estimator, .. } = &self.state;
        let eta = self.eta();
        let root = estimator.covariance_root(dt)?;
        let root = self.projection().map_or(root, |projection| projection * root);
        let at = |eta: SVector<M::Scalar, NE>| {
            self.model.recover_unbounded(&extension.coordinates(&self.model.theta(&eta)), terms)
        };
        let estimate = at(eta);
        let mut squares = SVector::<M::Scalar, NX>::zeros();
        for column in root.column_iter() {
            let [above, below] = [at(eta + column) - estimate, estimate - at(eta - column)];
            for ((square, above), below) in squares.iter_mut().zip(above.iter()).zip(below.iter()) {
                let (above_it, below_it) = (Real::abs(*above), Real::abs(*below));
                let change = if above_it < below_it { above_it } else { below_it };
                // The smaller of NaN and a number would be the number.
                *square += change * change + (*above + *below) * nalgebra::zero();
            }
        }
        let errors = squares.map(Real::sqrt);
        errors.iter().all(|&error| Real::is_finite(error)).then_some(errors)
    }

    /// The innovation of a sample, without taking it; to be called before a [`step`](Self::step) with the same
    /// arguments. A [`Gate`](crate::Gate) refuses outliers by it.
    ///
    /// Of the first sample it is 0: a start is a guess, by which no sample is refused.
    ///
    /// # Errors
    /// A [`Fault`] as of the step, and [`Fault::State`] where the covariance has no finite value.
    pub fn innovation(
        &self,
        y: impl Into<M::Y>,
        u: impl Into<M::U>,
        dt: M::Scalar,
    ) -> Result<Innovation<M::Scalar, NR>, Fault> {
        let (y, u) = (y.into().into(), u.into().into());
        check(&y, &u, dt)?;
        let carried = self.carried(&u);
        let Some(before) = carried.as_ref().or(self.terms.as_ref()) else { return Ok(Innovation::nothing()) };
        let y = self.unwrapped(&y);
        let (extension, outcome) = self.propagate([before, &self.model.terms(&y)], [&u, &u], dt)?;
        self.innovation_of(&self.weighted_or(outcome, &extension, (&y, &u), dt), dt)
    }

    /// The outcome of a sample with the weight of its sensors at the estimate, where that is not constant.
    fn weighted_or(
        &self,
        outcome: R::Step,
        extension: &M::Extension,
        (y, u): (&SVector<M::Scalar, NY>, &SVector<M::Scalar, NU>),
        dt: M::Scalar,
    ) -> R::Step {
        let weighted = self.correction.as_ref();
        weighted.and_then(|(sensors, _)| self.weighted(extension, (y, u), dt, sensors)).unwrap_or(outcome)
    }

    /// The innovation of an outcome.
    fn innovation_of(&self, outcome: &R::Step, dt: M::Scalar) -> Result<Innovation<M::Scalar, NR>, Fault> {
        let regressor = outcome.regressor();
        let error = outcome.regressand() - regressor * self.state.estimator.estimate();
        let root = regressor * self.state.estimator.covariance_root(dt).ok_or(Fault::State)?;
        // White noise of intensity 1 has the variance 1/dt in a sample.
        let scale = Real::sqrt(dt);
        let (value, root) = (error * scale, root * scale);
        // `e^T (L L^T + 1)^-1 e` is the least of `|d|^2 + |e - L d|^2`: no inverse, however little is known yet.
        let mut least = Information::from_variances(&SVector::<M::Scalar, NE>::repeat(nalgebra::one()))?;
        let (mut normalised_square, mut determinant) = (nalgebra::zero(), nalgebra::one());
        for (row, &value) in root.row_iter().zip(value.iter()) {
            let (rest, weight) = least.absorb_with_rest(&row.transpose(), value, nalgebra::one());
            normalised_square += weight * rest * rest;
            // The weight of a row beyond those before it is the inverse of its variance.
            determinant /= weight;
        }
        if Real::is_finite(normalised_square) {
            Ok(Innovation { value, normalised_square, determinant })
        } else {
            Err(Fault::State)
        }
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
    R::Step: Rows<M::Scalar, NR>,
{
    /// [`step`](Self::step) with a sample that lacks outputs, as of sensors with different periods: a missing output is
    /// NaN. `rows` has for each row of the regression the index in `y` of its output.
    ///
    /// The rows of missing outputs are left out, and the model's functions get what the observer expects of these
    /// outputs, so that nothing waits for them. All may be missing: the step is then a prediction. The first sample must be
    /// whole.
    ///
    /// # Errors
    /// A [`Fault`] as of a step; [`Fault::Output`] of an output that is missing and has no row.
    pub fn step_partly(
        &mut self,
        y: impl Into<M::Y>,
        rows: &[usize; NR],
        u: impl Into<M::U>,
        dt: M::Scalar,
    ) -> Result<M::X, Fault> {
        let (y, u): (SVector<M::Scalar, NY>, SVector<M::Scalar, NU>) = (y.into().into(), u.into().into());
        check_rows(&y, rows)?;
        self.step_lacking(y, (rows, &[true; NY]), &u, dt).map(M::X::from)
    }

    /// The [innovation](Self::innovation) of a sample that lacks outputs, in the rows that it has, without taking it; to
    /// be called before a [`step_partly`](Self::step_partly) with the same arguments.
    ///
    /// # Errors
    /// A [`Fault`] as of that step, and [`Fault::State`] where the covariance has no finite value.
    pub fn innovation_partly(
        &self,
        y: impl Into<M::Y>,
        rows: &[usize; NR],
        u: impl Into<M::U>,
        dt: M::Scalar,
    ) -> Result<Innovation<M::Scalar, NR>, Fault>
    where
        E: Uncertain<M::Scalar, NE>,
    {
        let (y, u): (SVector<M::Scalar, NY>, SVector<M::Scalar, NU>) = (y.into().into(), u.into().into());
        check_rows(&y, rows)?;
        let carried = self.carried(&u);
        let (Some(before), Some(last)) = (carried.as_ref().or(self.terms.as_ref()), &self.state.y) else {
            check(&y, &u, dt)?;
            return Ok(Innovation::nothing());
        };
        let (y, left_out) = self.completed((before, last), y, (rows, &[true; NY]), &u, dt)?;
        let (extension, outcome) = self.propagate([before, &self.model.terms(&y)], [&u, &u], dt)?;
        let outcome = self.weighted_or(outcome, &extension, (&y, &u), dt);
        self.innovation_of(&outcome.without(&left_out), dt)
    }

    /// The step; in place of a missing output that is not expected by its row the last one stands.
    pub(super) fn step_lacking(
        &mut self,
        y: SVector<M::Scalar, NY>,
        (rows, is_expected): (&[usize; NR], &[bool; NY]),
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let carried = self.carried(u);
        let (Some(before), Some(last)) = (carried.as_ref().or(self.terms.as_ref()), &self.state.y) else {
            check(&y, u, dt)?;
            return self.advance(&y, [u, u], dt);
        };
        let (y, left_out) = self.completed((before, last), y, (rows, is_expected), u, dt)?;
        let terms = self.model.terms(&y);
        if let Some(rebasing) = self.rebasing {
            return self.advance_by(rebasing, terms, &Taken { y: &y, u: [u, u], dt, left_out, without: Rows::without });
        }
        let (extension, regression) = self.propagate([before, &terms], [u, u], dt)?;
        self.finish((extension, regression.without(&left_out)), terms, &y, dt)
    }

    /// A sample with what is expected of its missing outputs, from the terms and outputs of the last one; and the rows that
    /// are left out for them.
    fn completed(
        &self,
        (before, last): (&M::Terms, &SVector<M::Scalar, NY>),
        mut y: SVector<M::Scalar, NY>,
        (rows, is_expected): (&[usize; NR], &[bool; NY]),
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<(SVector<M::Scalar, NY>, [bool; NR]), Fault> {
        let missing = y.map(|output| !Real::is_finite(output));
        // The last sample's, then the model's prediction from it.
        for ((output, _), &last) in y.iter_mut().zip(&missing).zip(last).filter(|((_, missing), _)| **missing) {
            *output = last;
        }
        y = self.unwrapped(&y);
        check(&y, u, dt)?;
        let (_, outcome) = self.propagate([before, &self.model.terms(&y)], [u, u], dt)?;
        let (regressand, regressor) = (Outcome::regressand(&outcome), Outcome::regressor(&outcome));
        let error = regressand - regressor * self.state.estimator.estimate();
        let weights = outcome.weights(dt);
        let mut left_out = [false; NR];
        let errors = error.iter().zip(&weights);
        for (row, ((left_out, output), (&error, &weight))) in left_out.iter_mut().zip(rows).zip(errors).enumerate() {
            let (Some(true), Some(is_expected), Some(sample)) =
                (missing.get(*output), is_expected.get(*output), y.get_mut(*output))
            else {
                continue;
            };
            *left_out = true;
            // By the first of its rows.
            if *is_expected && !rows.iter().take(row).any(|before| before == output) {
                *sample -= error / weight;
            }
        }
        check(&y, u, dt)?;
        Ok((y, left_out))
    }
}

/// A missing output must have a row.
fn check_rows<S: Real, const NY: usize, const NR: usize>(y: &SVector<S, NY>, rows: &[usize; NR]) -> Result<(), Fault> {
    let is_lacking = |output: &usize| !Real::is_finite(y[*output]) && !rows.contains(output);
    (0..NY).find(is_lacking).map_or(Ok(()), |index| Err(Fault::Output { index }))
}
