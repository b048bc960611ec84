//! Samples whose noise is in the factor of the unknown too.
//!
//! In: a sample, the standard deviations of its outputs, and the estimate that the sample leads to as it is. Out: the
//! same equations, linearised where the outputs are most likely to have been.

use nalgebra::{SMatrix, SVector};

use super::rebasing::{StepOf, Trigger};
use super::{Next, Observer, State};
use crate::numeric::sum::all_finite;
use crate::{Estimator, Fault, Model, Real, RegressionOperator, Sides, Uncertain};

/// The standard deviations of the sensors, and the correction by them of an observer `O`: the regression after a step
/// with its sample's equations linearised anew, from what the step has led to and the sample.
pub(super) type Correction<
    O,
    M,
    E,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = (SVector<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NY>, Corrected<O, M, E, R, NX, NY, NU, NZ, NR, NE>);

/// The correction alone.
type Corrected<
    O,
    M,
    E,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = fn(
    &O,
    Led<'_, <M as Model<NX, NY, NU, NZ, NR, NE>>::Extension, E, R>,
    &TakenBy<'_, M, R, NX, NY, NU, NZ, NR, NE>,
    &SVector<<M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NY>,
) -> Option<StepOf<R, <M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NR, NE>>;

/// What a step has led to with its sample as it is, and the regression before it.
#[derive(Clone, Copy)]
pub(super) struct Led<'a, X, E, R> {
    pub(super) extension: &'a X,
    pub(super) estimator: &'a E,
    pub(super) regression: &'a R,
}

/// A sample at the end of an interval, with the rows that are left out for its missing outputs.
#[derive(Clone, Copy)]
pub(super) struct Taken<'a, S: Real, Step, const NY: usize, const NU: usize, const NR: usize> {
    pub(super) y: &'a SVector<S, NY>,
    /// The input at both ends.
    pub(super) u: [&'a SVector<S, NU>; 2],
    pub(super) dt: S,
    pub(super) left_out: [bool; NR],
    /// A regression without these rows.
    pub(super) without: fn(Step, &[bool; NR]) -> Step,
}

impl<'a, S: Real, Step, const NY: usize, const NU: usize, const NR: usize> Taken<'a, S, Step, NY, NU, NR> {
    /// A sample with all outputs.
    #[inline]
    pub(super) fn whole(y: &'a SVector<S, NY>, u: [&'a SVector<S, NU>; 2], dt: S) -> Self {
        Self { y, u, dt, left_out: [false; NR], without: |regression, _| regression }
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE> + Uncertain<M::Scalar, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// The same observer for a regression whose factor depends on outputs, as that of `sin(beta) p = cos(beta) q` does
    /// on a bearing: with the standard deviation of each output's sensor, 0 for one without noise.
    ///
    /// The noise of a sample is then in the factor too, and its square pulls the estimate to zero. So each sample is
    /// taken twice: as it is, and with its equations linearised at the outputs that are most likely after that. Where
    /// little is known these outputs are the samples, and the equations are linear whatever the estimate is; where the
    /// unknown is known better than the sensors tell, they are what the observer expects.
    ///
    /// Holds when: the equations are [samples](crate::SampledRegression) and share no output. Costs two or three steps
    /// and `4 NY + 2` evaluations of the regression.
    ///
    /// Source: errors in variables, adjusted with the observations: Deming, *Statistical adjustment of data*, 1943.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each deviation is finite and not negative.
    pub fn with_errors_in_variables(self, sensors: &SVector<M::Scalar, NY>) -> Result<Self, Fault> {
        let is_deviation = |&deviation: &M::Scalar| deviation >= nalgebra::zero() && Real::is_finite(deviation);
        if !sensors.iter().all(is_deviation) {
            return Err(Fault::Gain);
        }
        // The step that is re-based corrects too.
        let rebasing = self.rebasing.or(Some((Trigger::Never, Self::step_corrected)));
        Ok(Self { correction: Some((*sensors, Self::corrected)), rebasing, ..self })
    }

    /// A step without re-basing.
    pub(super) fn step_corrected(
        &mut self,
        _: Trigger<M::Scalar>,
        terms: M::Terms,
        sample: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
    ) -> Result<SVector<M::Scalar, NX>, Fault> {
        let Next { extension, regression, estimator } = self.next(self.led(&terms, sample)?, sample)?;
        let mut moved = State { extension, estimator, ..self.state.clone() };
        moved.regression.take(regression);
        self.keep(moved, terms, sample.y)
    }

    /// The regression after a step, linearised anew; none where that has no value.
    fn corrected(
        &self,
        Led { extension, estimator, regression }: Led<'_, M::Extension, E, R>,
        &Taken { y, u: [_, u], dt, left_out, .. }: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
        sensors: &SVector<M::Scalar, NY>,
    ) -> Option<R::Step> {
        let model = &self.model;
        let sides = |y: &SVector<M::Scalar, NY>| model.regression(extension, &model.terms(y), u);
        let root = estimator.covariance_root(nalgebra::zero())?;
        let equations = Equations { sides: &sides, sensors, eta: estimator.estimate(), root };
        let mut linearised = equations.linearised(y, &equations.likely(y, &left_out));
        linearised.leave_out(&left_out);
        let is_finite = all_finite(&linearised.known) && all_finite(&linearised.factor);
        is_finite.then(|| regression.step([&linearised; 2], dt))
    }
}

/// A sample of a model's observer.
pub(super) type TakenBy<
    'a,
    M,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
> = Taken<
    'a,
    <M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar,
    StepOf<R, <M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NR, NE>,
    NY,
    NU,
    NR,
>;

/// The equations of a sample, as functions of its outputs.
struct Equations<'a, F, S: Real, const NY: usize, const NE: usize> {
    sides: &'a F,
    sensors: &'a SVector<S, NY>,
    eta: SVector<S, NE>,
    /// A root of the covariance of the unknown.
    root: SMatrix<S, NE, NE>,
}

/// The residuals of equations beside a sample.
struct Residuals<S: Real, const NR: usize, const NY: usize> {
    /// Their change with one standard deviation of each output.
    slopes: SMatrix<S, NR, NY>,
    /// The variance of each: by the sensors, and by what they do to the factor of an unknown that is not known.
    variances: SVector<S, NR>,
}

impl<F, S: Real, const NY: usize, const NE: usize> Equations<'_, F, S, NY, NE> {
    /// By the change over one standard deviation to either side.
    fn residuals<const NR: usize>(&self, y: &SVector<S, NY>) -> Residuals<S, NR, NY>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let half: S = Real::from_f64(0.5);
        let mut residuals = Residuals { slopes: SMatrix::<S, NR, NY>::zeros(), variances: SVector::zeros() };
        for (output, &deviation) in self.sensors.iter().enumerate().filter(|(_, deviation)| **deviation > S::zero()) {
            let [mut above, mut below] = [*y; 2];
            above[output] += deviation;
            below[output] -= deviation;
            let [above, below] = [(self.sides)(&above), (self.sides)(&below)];
            let factor = (above.factor - below.factor) * half;
            let slopes = (above.known - below.known) * half - factor * self.eta;
            let spread = factor * self.root;
            for row in 0..NR {
                residuals.variances[row] += slopes[row] * slopes[row] + spread.row(row).norm_squared();
            }
            residuals.slopes.set_column(output, &slopes);
        }
        residuals
    }

    /// The change of the sample to the outputs that are most likely, in standard deviations: the least with which the
    /// equations hold, as far as the unknown is known.
    fn likely<const NR: usize>(&self, y: &SVector<S, NY>, left_out: &[bool; NR]) -> SVector<S, NY>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let Sides { known, factor } = (self.sides)(y);
        let rest = known - factor * self.eta;
        let Residuals { slopes, variances } = self.residuals(y);
        let mut change = SVector::<S, NY>::zeros();
        for row in (0..NR).filter(|row| !left_out[*row] && variances[*row] > S::zero()) {
            let slopes = slopes.row(row).transpose();
            let open = rest[row] + slopes.dot(&change);
            change -= slopes * (open / variances[row]);
        }
        change
    }

    /// The equations at a sample that is changed by so many standard deviations, linear in the change.
    fn linearised<const NR: usize>(&self, y: &SVector<S, NY>, change: &SVector<S, NY>) -> Sides<S, NR, NE>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let at = y + change.component_mul(self.sensors);
        let mut sides = (self.sides)(&at);
        sides.known -= self.residuals(&at).slopes * change;
        sides
    }
}
