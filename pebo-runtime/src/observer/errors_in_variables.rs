//! Samples whose noise is in their equations otherwise than by a constant factor.
//!
//! In: a sample, the standard deviations of its outputs, and the estimate before it. Out: the same equations with the weight
//! of the noise that is in them at this sample, linearised where the outputs are most likely to have been.

use nalgebra::{SMatrix, SVector};

use super::rebasing::{StepOf, Trigger};
use super::{Next, Observer, State};
use crate::numeric::sum::all_finite;
use crate::{Estimator, Fault, Model, Outcome as _, Real, RegressionOperator, Sides, Uncertain};

/// The standard deviations of the sensors, and the correction by them of an observer `O`: estimator and regression after a
/// sample with its equations weighted and linearised anew, from what was before it.
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
) -> Option<(E, StepOf<R, <M as Model<NX, NY, NU, NZ, NR, NE>>::Scalar, NR, NE>)>;

/// The extension at the end of an interval, estimator and regression before its sample.
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
    /// The same observer for a regression in which an output stands otherwise than with a constant factor, as a bearing does
    /// in `sin(beta) p = cos(beta) q` and a range in `r^2 = p^2 + q^2`: with the standard deviation of each output's
    /// sensor, 0 for one without noise.
    ///
    /// The noise of a sample is as large in an equation as its slope by the output. Where that is known, as `2 r` of a
    /// range, the equation has the weight of its sensors at the sample, in place of a constant one. Where the noise is in
    /// the factor of the unknown, a weight by the estimate would favour the error of the estimate, and the square of the
    /// noise would pull it to zero.
    ///
    /// So each sample is taken twice: as it is, and with its equations linearised at the outputs that are most likely after
    /// that. Where little is known these outputs are the samples, and the equations are linear whatever the estimate is;
    /// where the unknown is known better than the sensors tell, they are what the observer expects.
    ///
    /// Holds when: the equations are [samples](crate::SampledRegression) and share no output. Costs two or three steps
    /// and `6 NY + 4` evaluations of the regression.
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

    /// Estimator and regression after a sample that is weighted and linearised anew; none where that has no value.
    fn corrected(
        &self,
        Led { extension, estimator, regression }: Led<'_, M::Extension, E, R>,
        &Taken { y, u: [_, u], dt, left_out, .. }: &Taken<'_, M::Scalar, R::Step, NY, NU, NR>,
        sensors: &SVector<M::Scalar, NY>,
    ) -> Option<(E, R::Step)> {
        let model = &self.model;
        let sides = |y: &SVector<M::Scalar, NY>| model.regression(extension, &model.terms(y), u);
        let constant = self.constant();
        let learned = |mut sides: Sides<M::Scalar, NR, NE>| {
            sides.leave_out(&left_out);
            let is_finite = all_finite(&sides.known) && all_finite(&sides.factor);
            let step = is_finite.then(|| regression.step([&sides; 2], dt))?;
            let mut after = estimator.clone();
            after.advance(&step.regressor(), &step.regressand(), dt).ok()?;
            Some((after, step))
        };
        let equations = Equations::at(&sides, sensors, estimator, dt)?;
        let (as_it_is, _) = learned(equations.weighted(y, &constant))?;
        let equations = Equations::at(&sides, sensors, &as_it_is, nalgebra::zero())?;
        learned(equations.linearised(y, &equations.likely(y, &left_out), &constant))
    }

    /// The standard deviation by which the regression weights each row, if the weight of its sensors replaces it: not of a
    /// rate; else 0.
    fn constant(&self) -> SVector<M::Scalar, NR> {
        let ones = Sides { known: SVector::repeat(nalgebra::one()), factor: SMatrix::zeros() };
        // Over a second a sample has the weight of its sensor.
        let weights = self.state.regression.step([&ones; 2], nalgebra::one()).regressand();
        let rates = self.model.rates();
        SVector::from_fn(
            |row, _| {
                if row < rates { nalgebra::zero() } else { nalgebra::one::<M::Scalar>() / weights[row] }
            },
        )
    }

    /// A sample at the end of an interval of `dt` seconds with the weight of its sensors at the estimate; none where that
    /// has no value.
    pub(super) fn weighted(
        &self,
        extension: &M::Extension,
        (y, u): (&SVector<M::Scalar, NY>, &SVector<M::Scalar, NU>),
        dt: M::Scalar,
        sensors: &SVector<M::Scalar, NY>,
    ) -> Option<R::Step> {
        let State { regression, estimator, .. } = &self.state;
        let constant = self.constant();
        let sides = |y: &SVector<M::Scalar, NY>| self.model.regression(extension, &self.model.terms(y), u);
        let equations = Equations::at(&sides, sensors, estimator, dt)?;
        Some(regression.step([&equations.weighted(y, &constant); 2], dt))
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
struct Residuals<S: Real, const NR: usize, const NY: usize, const NE: usize> {
    /// Their change with one standard deviation of each output.
    slopes: SMatrix<S, NR, NY>,
    /// The variance of each: by the sensors, and by what they do to the factor of an unknown that is not known.
    variances: SVector<S, NR>,
    /// True for one with noise in its factor.
    in_factor: [bool; NR],
    /// The sides at the sample.
    here: Sides<S, NR, NE>,
}

impl<'a, F, S: Real, const NY: usize, const NE: usize> Equations<'a, F, S, NY, NE> {
    /// At the estimate of an estimator, `dt` seconds after its last sample.
    fn at<E, const NR: usize>(sides: &'a F, sensors: &'a SVector<S, NY>, estimator: &E, dt: S) -> Option<Self>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
        E: Estimator<S, NR, NE> + Uncertain<S, NE>,
    {
        Some(Self { sides, sensors, eta: estimator.estimate(), root: estimator.covariance_root(dt)? })
    }

    /// By the change over one standard deviation to either side.
    fn residuals<const NR: usize>(&self, y: &SVector<S, NY>) -> Residuals<S, NR, NY, NE>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let half: S = Real::from_f64(0.5);
        let here = (self.sides)(y);
        let mut residuals = Residuals {
            slopes: SMatrix::<S, NR, NY>::zeros(),
            variances: SVector::zeros(),
            in_factor: [false; NR],
            here,
        };
        let columns = residuals.slopes.data.0.iter_mut().zip(self.sensors).enumerate();
        for (output, (column, &deviation)) in columns.filter(|(_, (_, deviation))| **deviation > S::zero()) {
            let [above, below] = [deviation, -deviation].map(|change| {
                let mut y = *y;
                y.iter_mut().skip(output).take(1).for_each(|output| *output += change);
                (self.sides)(&y)
            });
            let factor = (above.factor - below.factor) * half;
            let slopes = (above.known - below.known) * half - factor * self.eta;
            let spread = factor * self.root;
            // Where the slope is 0 the square of the noise is left, of variance 2.
            let beside = above.known + below.known - (above.factor + below.factor) * self.eta;
            let bends = beside * half - (here.known - here.factor * self.eta);
            for row in 0..NR {
                let (slope, bend) = (slopes[row], bends[row]);
                residuals.variances[row] += slope * slope + (bend + bend) * bend + spread.row(row).norm_squared();
                residuals.in_factor[row] |= factor.row(row).iter().any(|change| *change != S::zero());
            }
            [*column] = slopes.data.0;
        }
        residuals
    }

    /// The change of the sample to the outputs that are most likely, in standard deviations: the least with which the
    /// equations hold, as far as the unknown is known.
    fn likely<const NR: usize>(&self, y: &SVector<S, NY>, left_out: &[bool; NR]) -> SVector<S, NY>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let Residuals { slopes, variances, here: Sides { known, factor }, .. } = self.residuals(y);
        let rest = known - factor * self.eta;
        let mut change = SVector::<S, NY>::zeros();
        for row in (0..NR).filter(|row| !left_out[*row] && variances[*row] > S::zero()) {
            let slopes = slopes.row(row).transpose();
            let open = rest[row] + slopes.dot(&change);
            change -= slopes * (open / variances[row]);
        }
        change
    }

    /// The equations at a sample that is changed by so many standard deviations, linear in the change, for a regression
    /// that weights rows by these constant deviations.
    fn linearised<const NR: usize>(
        &self,
        y: &SVector<S, NY>,
        change: &SVector<S, NY>,
        constant: &SVector<S, NR>,
    ) -> Sides<S, NR, NE>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        let mut residuals = self.residuals(&(y + change.component_mul(self.sensors)));
        residuals.here.known -= residuals.slopes * change;
        residuals.weighted(constant)
    }

    /// The equations at a sample as it is, for such a regression.
    fn weighted<const NR: usize>(&self, y: &SVector<S, NY>, constant: &SVector<S, NR>) -> Sides<S, NR, NE>
    where
        F: Fn(&SVector<S, NY>) -> Sides<S, NR, NE>,
    {
        self.residuals(y).weighted(constant)
    }
}

impl<S: Real, const NR: usize, const NY: usize, const NE: usize> Residuals<S, NR, NY, NE> {
    /// The sides, each row multiplied so that its error comes to this constant deviation; not one with noise in its factor, and
    /// none without an error or such a deviation.
    fn weighted(self, constant: &SVector<S, NR>) -> Sides<S, NR, NE> {
        let mut sides = self.here;
        for row in (0..NR).filter(|row| !self.in_factor[*row]) {
            let share = constant[row] / Real::sqrt(self.variances[row]);
            if Real::is_finite(share) && share > S::zero() {
                sides.known[row] *= share;
                sides.factor.row_mut(row).scale_mut(share);
            }
        }
        sides
    }
}
