//! Regressors in; how well the data so far determine the unknown out.

use nalgebra::{SMatrix, SVector};

use crate::decay::Decay;
use crate::eigenvalue::smallest_eigenvalue;
use crate::linear::solve;
use crate::sum::{Sum, all_finite};
use crate::{Fault, Real};

/// What the data so far are good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Excitation {
    /// There was never enough to determine the unknown as well as wanted.
    NotYet,
    /// There is enough.
    Converged,
    /// There was enough, and it has been forgotten since.
    Lost,
}

/// The running Gramian of the regressor, in units of what is wanted.
///
/// ```text
/// G' = -beta G + D Phi^T Phi D / r        D = diag(wanted standard errors), r = noise intensity
/// ```
///
/// Without forgetting, `G^-1` is the covariance (in units of `D`) of the least-squares estimate under white noise: the
/// least that any unbiased estimate can have. So every direction of the unknown is known as well as wanted exactly if
/// the smallest eigenvalue of `G` is at least 1. Then the state is [`Converged`](Excitation::Converged); it is
/// [`Lost`](Excitation::Lost) once the eigenvalue falls below 1/2. What an estimator makes of the data is its own
/// matter: a gradient needs its time beyond.
///
/// Units: noise intensity is that of a regression equation squared and second; noise of standard deviation `s` in
/// samples
/// `dt` apart has `s^2 dt`. A filter before makes white noise coloured, and an intensity then is one at low frequencies.
///
/// Source: the observability Gramian of parameter estimation, as in Ljung, *System identification*, 1999, chapter 9;
/// excitation as its smallest eigenvalue: Sastry and Bodson, *Adaptive control*, 1989, chapter 2.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Monitor<S: Real, const NE: usize> {
    /// `D / sqrt(r)`.
    scale: SVector<S, NE>,
    wanted: SVector<S, NE>,
    forgetting: Decay<S>,
    gramian: Sum<S, NE, NE>,
    /// The same with the weights squared, which the noise sees.
    squared: Sum<S, NE, NE>,
    excitation: Excitation,
}

impl<S: Real, const NE: usize> Monitor<S, NE> {
    /// Before any data: the wanted standard error of each component, the noise intensity of the regression's equations,
    /// and the rate `beta` in 1/s at which data age (0: never).
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the first two are positive and finite and the rate finite and not negative.
    pub fn new(wanted: &SVector<S, NE>, noise: S, beta: S) -> Result<Self, Fault> {
        let scale = wanted / Real::sqrt(noise);
        let positive = |&number: &S| number > S::zero() && Real::is_finite(number);
        if !(wanted.iter().all(positive) && scale.iter().all(positive)) {
            return Err(Fault::Gain);
        }
        let empty = Sum::new(SMatrix::zeros());
        let forgetting = Decay::new(beta)?;
        let excitation = Excitation::NotYet;
        Ok(Self { scale, wanted: *wanted, forgetting, gramian: empty, squared: empty, excitation })
    }

    /// Takes the regressor of a step of `dt` seconds.
    ///
    /// # Errors
    /// [`Fault::Step`] unless `dt` is positive and finite, [`Fault::State`] if the Gramian would not be finite; the
    /// monitor is then exactly as before.
    pub fn advance<const NR: usize>(&mut self, regressor: &SMatrix<S, NR, NE>, dt: S) -> Result<(), Fault> {
        if !(dt > S::zero() && Real::is_finite(dt)) {
            return Err(Fault::Step);
        }
        let mut next = *self;
        let scaled = SMatrix::<S, NR, NE>::from_fn(|i, j| regressor[(i, j)] * self.scale[j]);
        let product = scaled.transpose() * scaled;
        let share = next.forgetting.over(dt);
        next.gramian.add(&(product * share.taken - self.gramian.value() * share.lost));
        // (1 - lost)^2 of it is kept; the present has the weight taken^2/dt, as its noise has r/dt.
        let lost = share.lost * (S::one() + (S::one() - share.lost));
        next.squared.add(&(product * (share.taken * share.taken / dt) - self.squared.value() * lost));
        if !(next.gramian.is_finite() && next.squared.is_finite()) {
            return Err(Fault::State);
        }
        let half: S = Real::from_f64(0.5);
        let level = next.level();
        next.excitation = match self.excitation {
            _ if level >= S::one() => Excitation::Converged,
            Excitation::Converged if level < half => Excitation::Lost,
            unchanged => unchanged,
        };
        *self = next;
        Ok(())
    }

    /// What the data so far are good for.
    pub fn excitation(&self) -> Excitation {
        self.excitation
    }

    /// The smallest eigenvalue of the Gramian: 1 is just as much as wanted, and twice that halves the variance.
    pub fn level(&self) -> S {
        smallest_eigenvalue(self.gramian.value())
    }

    /// The standard error of each component of the least-squares estimate with the same forgetting, in units of the
    /// component; none while the data do not determine all of them.
    pub fn standard_error(&self) -> Option<SVector<S, NE>> {
        // G^-1 G_2 G^-1 with G_2 of squared weights.
        let half = solve(*self.gramian.value(), *self.squared.value()).ok()?;
        let covariance = solve(*self.gramian.value(), half.transpose()).ok()?;
        let error = SVector::from_fn(|i, _| self.wanted[i] * Real::sqrt(covariance[(i, i)]));
        all_finite(&error).then_some(error)
    }

    /// Starts again with no data.
    pub fn reset(&mut self) {
        let empty = Sum::new(SMatrix::zeros());
        *self = Self { gramian: empty, squared: empty, excitation: Excitation::NotYet, ..*self };
    }
}
