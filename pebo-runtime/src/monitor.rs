//! Monitors the excitation: how well the data so far determine the unknown.

use nalgebra::{SMatrix, SVector};

use crate::numeric::decay::Decay;
use crate::numeric::eigenvalue::smallest_eigenvalue;
use crate::numeric::linear::solve;
use crate::numeric::sum::{Sum, all_finite};
use crate::{Fault, Filter, Real};

/// The excitation by the data so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Excitation {
    /// There was never enough to determine the unknown as well as wanted.
    NotYet,
    /// There is enough.
    Converged,
    /// There was enough, and it has been forgotten since.
    Lost,
}

/// The way of sensor noise into the regression.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Noise<S: Real> {
    /// As it is, its intensity given.
    White,
    /// Each sample through the filter.
    Value(Filter<S>),
    /// The rate from sample to sample through the filter.
    Rate(Filter<S>),
}

/// The covariance of the least-squares estimate as the data come in, from the standard deviations of the sensors.
///
/// ```text
/// estimate - eta = G^-1 s        G' = -beta G + Phi^T Phi        s' = -beta s + Phi^T noise
/// covariance = G^-1 E[s s^T] G^-1
/// ```
///
/// The noise of a regression is not white: filtered white samples are not, and least of all the rate of white samples,
/// whose average depends on its ends alone. So `E[s s^T]` is carried along step by step together with the state of the
/// filter, which is exact for independent samples and the estimator [`LeastSquares`](crate::LeastSquares) with the same
/// forgetting and a weak start. Noise in `h`, and so in the extension, and in `phi_0` and `phi_1` is not counted; where
/// these depend on outputs whose errors matter, use the [output form](crate::OutputForm) and the covariance of its
/// estimator.
///
/// The unknown is known as well as wanted in every direction if and only if no eigenvalue of the covariance, in units
/// of the wanted one, is above 1. Then the state is [`Converged`](Excitation::Converged). It is
/// [`Lost`](Excitation::Lost) once the largest exceeds 2, or the smallest eigenvalue of `G` has fallen to half of what
/// was enough: an estimate without new data keeps its error, but the data behind it are forgotten. Another estimator
/// may need more time, as a gradient does.
///
/// Cost: that of two linear systems and the eigenvalues of a matrix of `NE` rows at each step.
///
/// Source: the covariance of least squares under coloured noise, as in Soderstrom and Stoica, *System identification*,
/// 1989, chapter 7; excitation as an eigenvalue of the Gramian: Sastry and Bodson, *Adaptive control*, 1989, chapter 2.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Monitor<S: Real, const NR: usize, const NE: usize> {
    wanted: SVector<S, NE>,
    forgetting: Decay<S>,
    noise: Noise<S>,
    /// The variance of a sample of each row, or its intensity if it is white.
    variance: SVector<S, NR>,
    /// In units of `wanted`, as all fields below.
    gramian: Sum<S, NE, NE>,
    /// `E[s s^T]`.
    spread: Sum<S, NE, NE>,
    /// `E[f^2]` and `E[f v]`, with the filter's state `f` and the last sample `v` of each row's noise.
    held: SVector<S, NR>,
    held_sample: SVector<S, NR>,
    /// `E[s f]` and `E[s v]`.
    with_held: SMatrix<S, NE, NR>,
    with_sample: SMatrix<S, NE, NR>,
    excitation: Excitation,
    /// The smallest eigenvalue of the Gramian when it was first enough.
    enough: S,
}

impl<S: Real, const NR: usize, const NE: usize> Monitor<S, NR, NE> {
    /// For a regression whose regressand is the rate of sensors through a filter, as every dynamic one with a
    /// [`FilteredRegression`](crate::FilteredRegression): the wanted standard error of each unknown, the standard
    /// deviation of the sensor in each row, the filter, and the rate in 1/s at which data are forgotten (0: never).
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the first two are positive and finite, their squares too, and the rate finite and not
    /// negative.
    pub fn of_rates(
        wanted: &SVector<S, NE>,
        deviations: &SVector<S, NR>,
        filter: Filter<S>,
        beta: S,
    ) -> Result<Self, Fault> {
        Self::of(wanted, &deviations.component_mul(deviations), Noise::Rate(filter), beta)
    }

    /// For a regression whose regressand is the sensors' samples through a filter.
    ///
    /// # Errors
    /// As [`of_rates`](Self::of_rates).
    pub fn of_values(
        wanted: &SVector<S, NE>,
        deviations: &SVector<S, NR>,
        filter: Filter<S>,
        beta: S,
    ) -> Result<Self, Fault> {
        Self::of(wanted, &deviations.component_mul(deviations), Noise::Value(filter), beta)
    }

    /// For a regression with white noise of a known intensity in each row, in units of its equation squared and second:
    /// samples `dt` apart with errors of standard deviation `s` have `s^2 dt`, those of a
    /// [`SampledRegression`](crate::SampledRegression) have 1.
    ///
    /// # Errors
    /// As [`of_rates`](Self::of_rates).
    pub fn of_white(wanted: &SVector<S, NE>, intensities: &SVector<S, NR>, beta: S) -> Result<Self, Fault> {
        Self::of(wanted, intensities, Noise::White, beta)
    }

    fn of(wanted: &SVector<S, NE>, variance: &SVector<S, NR>, noise: Noise<S>, beta: S) -> Result<Self, Fault> {
        let positive = |&number: &S| number > S::zero() && Real::is_finite(number);
        if !(wanted.iter().all(positive) && variance.iter().all(positive)) {
            return Err(Fault::Gain);
        }
        let empty = Sum::new(SMatrix::zeros());
        Ok(Self {
            wanted: *wanted,
            forgetting: Decay::new(beta)?,
            noise,
            variance: *variance,
            gramian: empty,
            spread: empty,
            held: SVector::zeros(),
            held_sample: SVector::zeros(),
            with_held: SMatrix::zeros(),
            with_sample: SMatrix::zeros(),
            excitation: Excitation::NotYet,
            enough: S::zero(),
        })
    }

    /// Takes the regressor of a step of `dt` seconds, as the estimator does.
    ///
    /// # Errors
    /// [`Fault::Step`] unless `dt` is positive and finite, [`Fault::State`] if the new state would not be finite; the
    /// monitor is then exactly as before.
    pub fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, dt: S) -> Result<(), Fault> {
        if !(dt > S::zero() && Real::is_finite(dt)) {
            return Err(Fault::Step);
        }
        let mut next = *self;
        let share = next.forgetting.over(dt);
        let kept = S::one() - share.lost;
        // f_new = kept_f f + old v + new v_new, where v_new is independent of all before.
        let (kept_f, old, new, variance) = match &mut next.noise {
            Noise::White => (S::zero(), S::zero(), S::one(), self.variance / dt),
            Noise::Value(filter) => {
                let (level, slope) = filter.weights(dt).level_and_slope();
                (S::one() - level, level - slope, slope, self.variance)
            }
            Noise::Rate(filter) => {
                let level = filter.weights(dt).level_and_slope().0;
                (S::one() - level, -level / dt, level / dt, self.variance)
            }
        };
        let mut spread = self.spread.value() * -(share.lost * (S::one() + kept));
        for i in 0..NR {
            let row = SVector::<S, NE>::from_fn(|j, _| regressor[(i, j)] * self.wanted[j]) * share.taken;
            let mixed = (self.held[i] * kept_f + self.held_sample[i] * (old + old)) * kept_f;
            next.held[i] = mixed + (old * old + new * new) * variance[i];
            next.held_sample[i] = new * variance[i];
            let coming = (self.with_held.column(i) * kept_f + self.with_sample.column(i) * old) * kept;
            spread += coming * row.transpose() + row * coming.transpose() + row * row.transpose() * next.held[i];
            next.with_held.set_column(i, &(coming + row * next.held[i]));
            next.with_sample.set_column(i, &(row * next.held_sample[i]));
            // The weight of the present in G is taken, not its square.
            let seen = row * row.transpose() / share.taken;
            next.gramian.add(&seen);
        }
        next.spread.add(&spread);
        next.gramian.add(&(self.gramian.value() * -share.lost));
        let finite = next.gramian.is_finite() && next.spread.is_finite();
        if !(finite && all_finite(&next.with_held) && all_finite(&next.with_sample) && all_finite(&next.held)) {
            return Err(Fault::State);
        }
        let half: S = Real::from_f64(0.5);
        let level = next.level();
        let weight = smallest_eigenvalue(next.gramian.value());
        next.excitation = match self.excitation {
            Excitation::NotYet if level < S::one() => Excitation::NotYet,
            Excitation::NotYet => {
                next.enough = weight;
                Excitation::Converged
            }
            Excitation::Converged if level < half || weight < half * self.enough => Excitation::Lost,
            Excitation::Lost if level >= S::one() && weight >= self.enough => Excitation::Converged,
            unchanged => unchanged,
        };
        *self = next;
        Ok(())
    }

    /// The excitation by the data so far.
    pub fn excitation(&self) -> Excitation {
        self.excitation
    }

    /// The inverse of the largest eigenvalue of the covariance in units of the wanted one: 1 is just as much as wanted,
    /// and twice that halves the variance; 0 while the data do not determine the unknown.
    pub fn level(&self) -> S {
        let Some(covariance) = self.covariance() else { return S::zero() };
        let largest = -smallest_eigenvalue(&-covariance);
        if largest > S::zero() { S::one() / largest } else { S::zero() }
    }

    /// The standard error of each component of the least-squares estimate with the same forgetting, in units of the
    /// component; none while the data do not determine all of them.
    pub fn standard_error(&self) -> Option<SVector<S, NE>> {
        let covariance = self.covariance()?;
        Some(SVector::from_fn(|i, _| self.wanted[i] * Real::sqrt(covariance[(i, i)].max(S::zero()))))
    }

    /// `G^-1 E[s s^T] G^-1`.
    fn covariance(&self) -> Option<SMatrix<S, NE, NE>> {
        let half = solve(*self.gramian.value(), *self.spread.value()).ok()?;
        let covariance = solve(*self.gramian.value(), half.transpose()).ok()?;
        let two: S = Real::from_f64(2.0);
        Some((covariance + covariance.transpose()) / two).filter(all_finite)
    }

    /// Starts again with no data.
    pub fn reset(&mut self) {
        let empty = Sum::new(SMatrix::zeros());
        *self = Self {
            gramian: empty,
            spread: empty,
            held: SVector::zeros(),
            held_sample: SVector::zeros(),
            with_held: SMatrix::zeros(),
            with_sample: SMatrix::zeros(),
            excitation: Excitation::NotYet,
            ..*self
        };
    }
}
