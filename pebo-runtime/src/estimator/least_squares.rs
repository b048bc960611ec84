//! Recursive least squares with forgetting, whose covariance never exceeds its start.

use nalgebra::{SMatrix, SVector};

use super::{Estimator, Information, Uncertain};
use crate::numeric::decay::Decay;
use crate::numeric::dense::product;
use crate::numeric::sum::{Sum, all_finite};
use crate::{Fault, Real, Turn};

/// Least squares with forgetting and bounded covariance.
///
/// ```text
/// theta' = P Phi^T (vartheta - Phi theta)
/// R'     = -beta (R - R_0) + Phi^T Phi - R Q R        R = P^-1, R(0) = R_0
/// ```
///
/// Holds when: without forgetting (`beta = 0`) the estimate minimises the integral of the squared equation error plus
/// `|theta - theta(0)|^2` in the norm of `R_0`: it settles as soon as the data determine it, and white noise leaves it
/// the least variance of all unbiased estimates, up to the weight of `R_0`. With `beta > 0` and persistent excitation
/// it follows a moving unknown with the time constant `1/beta`. Since `R >= R_0` at all times, `P` never exceeds its
/// start: no wind-up in directions without excitation, where the estimate is constant.
/// [Process noise](Self::with_process_noise) `Q` instead lets the unknown wander: then this is a Kalman filter, `P`
/// grows where there is no excitation, and nothing is forgotten that still holds.
///
/// A [`turn`](Estimator::turn) of the unknown takes `P` to `T P T^T`; `R_0`, the limit of forgetting, and `Q` then
/// apply to the unknown as it is now. No component becomes known better than the rounding of its deviation at the start.
///
/// Method: `R` in the triangular form of [`Information`], the regressor held over the step: the past decays by
/// `e^(-beta dt)`, `1 - e^(-beta dt)` of `R_0` flows in, then each equation is absorbed by a rotation. Nothing is
/// subtracted, so `R` remains positive definite at any step and gain, and the error never grows in the norm of `R`.
///
/// In `f32` a weight takes in no more than the last `2^24` samples or so: at a rate below `2^-24/dt`, 0.6/s in steps of
/// 100 ns, the estimator forgets faster than asked, and one with `beta = 0` is that of so many samples.
///
/// Units of `P`: `theta^2` over (regression equation)^2 and second, as the gain of [`Gradient`](super::Gradient): white
/// noise of variance `s^2` in samples `dt` apart makes the covariance of the estimate `s^2 dt P`.
///
/// Source: Slotine and Li, *Applied nonlinear control*, 1991, chapter 8 (least squares with exponential forgetting);
/// the bound by an inflow of `R_0`: Gunnarsson, *Combining tracking and regularization in recursive least squares
/// identification*, CDC 1996.
#[derive(Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LeastSquares<S: Real, const NE: usize> {
    /// `R`, with the right side 0 between steps.
    information: Information<S, NE>,
    /// `R_0`.
    floor: Information<S, NE>,
    forgetting: Decay<S>,
    /// The intensity of the process noise of each component.
    noise: SVector<S, NE>,
    theta: Sum<S, NE, 1>,
}

#[allow(clippy::expl_impl_clone_on_copy, reason = "as one block: member by member each matrix is copied twice")]
impl<S: Real, const NE: usize> Clone for LeastSquares<S, NE> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Real, const NE: usize> LeastSquares<S, NE> {
    /// Starts from the estimate 0 with a variance of each component (the diagonal of `P(0)`), and forgets at the rate
    /// `beta` in 1/s; 0 forgets nothing.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each variance and its inverse is positive and finite, and the rate finite and not
    /// negative.
    pub fn diagonal(variances: &SVector<S, NE>, beta: S) -> Result<Self, Fault> {
        Self::from_information(Information::from_variances(variances)?, beta)
    }

    /// The same with a full matrix `P(0)`.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless `P(0)` is symmetric, positive definite and finite, and the rate finite and not negative.
    pub fn full(covariance: &SMatrix<S, NE, NE>, beta: S) -> Result<Self, Fault> {
        Self::from_information(Information::from_covariance(covariance)?, beta)
    }

    fn from_information(floor: Information<S, NE>, beta: S) -> Result<Self, Fault> {
        let theta = Sum::new(SVector::zeros());
        Ok(Self { information: floor, floor, forgetting: Decay::new(beta)?, noise: SVector::zeros(), theta })
    }

    /// The same for an unknown that wanders: `P` gains `Q dt` over a step, `Q` the diagonal given, in units of `P` per
    /// second.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each entry is finite and not negative.
    pub fn with_process_noise(self, noise: &SVector<S, NE>) -> Result<Self, Fault> {
        let admitted = |&entry: &S| entry >= S::zero() && Real::is_finite(entry);
        if noise.iter().all(admitted) { Ok(Self { noise: *noise, ..self }) } else { Err(Fault::Gain) }
    }

    /// The same from another estimate.
    ///
    /// # Errors
    /// [`Fault::Start`] unless the estimate is finite.
    pub fn starting_at(self, estimate: &SVector<S, NE>) -> Result<Self, Fault> {
        if all_finite(estimate) { Ok(Self { theta: Sum::new(*estimate), ..self }) } else { Err(Fault::Start) }
    }

    /// The estimate.
    pub fn estimate(&self) -> &SVector<S, NE> {
        self.theta.value()
    }

    /// The intensity of the process noise of each component.
    pub(super) fn noise(&self) -> &SVector<S, NE> {
        &self.noise
    }

    /// `R = P^-1`, in triangular form.
    pub fn information(&self) -> &Information<S, NE> {
        &self.information
    }

    /// The unknown has wandered: `P` gains this diagonal times `dt`.
    #[inline]
    pub(super) fn diffuse(&mut self, noise: &SVector<S, NE>, dt: S) {
        for (component, &intensity) in noise.iter().enumerate() {
            if intensity > S::zero() && dt > S::zero() {
                self.information.diffuse(component, intensity * dt);
            }
        }
    }

    /// A step over which the unknown wanders by these intensities; `seen` gets of each row what it says beyond the estimate
    /// and the rows before it, the weight of that, and its share of the row's own weight.
    #[inline]
    pub(super) fn take<const NR: usize>(
        &mut self,
        regressor: &SMatrix<S, NR, NE>,
        regressand: &SVector<S, NR>,
        dt: S,
        noise: &SVector<S, NE>,
        mut seen: impl FnMut(usize, S, S, S),
    ) -> Result<(), Fault> {
        let share = self.forgetting.over(dt);
        if share.lost == S::one() {
            self.information = self.floor;
        } else if share.lost > S::zero() {
            self.information.scale(S::one() - share.lost);
            self.information.absorb_information(&self.floor, share.lost);
        }
        self.diffuse(noise, dt);
        let innovation = regressand - product(regressor, self.theta.value());
        let rows = regressor.transpose();
        for (index, (row, &error)) in rows.column_iter().zip(innovation.iter()).enumerate() {
            let (rest, weight) = self.information.absorb_with_rest(&row.into_owned(), error, share.taken);
            seen(index, rest, weight, weight / share.taken);
        }
        self.theta.add(&self.information.take_solution()?);
        Ok(())
    }
}

impl<S: Real, const NR: usize, const NE: usize> Estimator<S, NR, NE> for LeastSquares<S, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let noise = self.noise;
        self.take(regressor, regressand, dt, &noise, |_, _, _, _| {})
    }

    fn estimate(&self) -> SVector<S, NE> {
        *self.theta.value()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.theta.add(shift);
    }

    fn information(&self) -> Option<&Information<S, NE>> {
        Some(&self.information)
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.theta.add(&turn.of_unknown(self.theta.value()));
        self.information.turn(turn);
        // Where a component dies out faster than others, those known best and least would leave each other no digits.
        self.information.diffuse_beyond(&(self.floor.weight() * (S::one() / (S::EPSILON * S::EPSILON))));
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        self.theta = Sum::new(*estimate);
        self.information = self.floor;
    }

    fn is_finite(&self) -> bool {
        self.theta.is_finite() && self.information.is_finite()
    }
}

impl<S: Real, const NE: usize> Uncertain<S, NE> for LeastSquares<S, NE> {
    fn covariance_root(&self, dt: S) -> Option<SMatrix<S, NE, NE>> {
        let mut wandered = *self;
        wandered.diffuse(&self.noise, dt);
        wandered.information.covariance_root()
    }
}
