//! DREM with exact convergence in finite time.

use nalgebra::{SMatrix, SVector};

use super::{Drem, Estimator, RegressorExtension};
use crate::numeric::linear::solve;
use crate::numeric::sum::{Sum, all_finite};
use crate::{Fault, Real, Turn};

/// Finite-time DREM.
///
/// The error of the scalar estimators of [`Drem`] shrinks by a known factor `w_i` since a reference instant, so
///
/// ```text
/// theta_i - eta_i = w_i (theta_i(ref) - eta_i)        w_i' = -gamma_i Delta^2 w_i
/// estimate_i = theta_i(ref) + (theta_i - theta_i(ref)) / (1 - min(w_i, 1 - mu))
/// ```
///
/// is `eta_i` from the moment on when `w_i <= 1 - mu`. Until then the clip `mu` bounds the amplification of noise: the
/// estimate runs ahead of that of DREM by at most `1/mu`.
///
/// Holds when: the integral of `gamma_i Delta^2` reaches `-ln(1 - mu)` (interval excitation) and `eta` is constant.
///
/// - [`once`](Self::once): the reference is the start. As `w` goes to 0 this becomes DREM itself: a later jump of `eta`
///   is followed at the pace of the gains only.
/// - [`tracking`](Self::tracking): the reference moves on, at least every `period` seconds as long as there is
///   excitation; after a jump the estimate is exact again when the reference and the extension's memory lie behind the
///   jump, at most two periods of excitation later.
///
/// A [`turn`](Estimator::turn) of the unknown mixes the components: the factor of the error since the reference is then
/// a matrix `W`, and the estimate is `theta(ref) + (1 - W)^-1 (theta - theta(ref))` once `|(1 - W)^-1| <= 1/mu`; until
/// then it is that of DREM where the clip would not bound it.
///
/// Method: implicit steps in theta and w with the same factor, so the identity holds to rounding at any gain and step.
/// Two references are kept instead of a delay line: one in use, one that ripens.
///
/// Source: Ortega, Gerasimov, Barabanov, Nikiforov, *Adaptive control of linear multivariable systems using dynamic
/// regressor extension and mixing estimators: removing the high-frequency gain assumptions*, Automatica, 2019
/// (clip); tracking: Ortega, Bobtsov, Nikolaev, *Parameter identification with finite-convergence time alertness
/// preservation*, IEEE Control Systems Letters, 2022, Section I.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FiniteTime<S: Real, X, const NE: usize> {
    drem: Drem<S, X, NE>,
    clip: S,
    /// Age at which a ripe reference replaces the one in use; none keeps the first for ever.
    period: Option<S>,
    used: Reference<S, NE>,
    ripening: Reference<S, NE>,
}

/// An instant in the past.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Reference<S: Real, const NE: usize> {
    /// The estimate of DREM then.
    theta: SVector<S, NE>,
    /// The share of that error which has gone since, `1 - W`. In steps that take less than the resolution of 1, `W`
    /// itself would not change. Diagonal as long as nothing was turned.
    gone: Sum<S, NE, NE>,
    age: Sum<S, 1, 1>,
}

impl<S: Real, const NE: usize> Reference<S, NE> {
    fn now(theta: &SVector<S, NE>) -> Self {
        Self { theta: *theta, gone: Sum::new(SMatrix::zeros()), age: Sum::new(SVector::zeros()) }
    }

    /// Loses a share of the rest.
    fn contract(&mut self, lost: &SVector<S, NE>, dt: S) {
        let gone = self.gone.value();
        let more = SMatrix::from_fn(|i, j| (if i == j { S::one() - gone[(i, j)] } else { -gone[(i, j)] }) * lost[i]);
        self.gone.add(&more);
        self.age.add(&SVector::repeat(dt));
    }

    /// Follows a change of the unknown.
    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.theta += turn.of_unknown(&self.theta);
        self.gone.add(&turn.of_map(self.gone.value()));
    }

    /// True if nothing was turned.
    fn is_diagonal(&self) -> bool {
        let gone = self.gone.value();
        (0..NE).all(|i| (0..NE).all(|j| i == j || gone[(i, j)] == S::zero()))
    }

    /// `(1 - W)^-1` where the clip admits it.
    fn inverse(&self, clip: S) -> Option<SMatrix<S, NE, NE>> {
        let inverse = solve(*self.gone.value(), SMatrix::<S, NE, NE>::identity()).ok()?;
        let admitted = inverse.iter().all(|&entry| Real::abs(entry) * clip <= S::one());
        admitted.then_some(inverse)
    }
}

impl<S: Real, X, const NE: usize> FiniteTime<S, X, NE> {
    /// Exact once for a constant unknown; `clip` is `mu` above, `0 < mu < 1`.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the clip is between 0 and 1.
    pub fn once(drem: Drem<S, X, NE>, clip: S) -> Result<Self, Fault> {
        if !(clip > S::zero() && clip < S::one()) {
            return Err(Fault::Gain);
        }
        let start = Reference::now(drem.estimate());
        Ok(Self { drem, clip, period: None, used: start, ripening: start })
    }

    /// Exact again after a jump; a reference serves for `period` seconds or until the next is ripe, whichever is later.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the clip is between 0 and 1 and the period positive and finite.
    pub fn tracking(drem: Drem<S, X, NE>, clip: S, period: S) -> Result<Self, Fault> {
        if period > S::zero() && Real::is_finite(period) {
            Ok(Self { period: Some(period), ..Self::once(drem, clip)? })
        } else {
            Err(Fault::Gain)
        }
    }

    /// The estimate.
    pub fn estimate(&self) -> SVector<S, NE> {
        let Reference { theta, gone, .. } = &self.used;
        let now = self.drem.estimate();
        if self.used.is_diagonal() {
            return SVector::from_fn(|i, _| theta[i] + (now[i] - theta[i]) / gone.value()[(i, i)].max(self.clip));
        }
        self.used.inverse(self.clip).map_or(*now, |inverse| theta + inverse * (now - theta))
    }

    /// True if the estimate is past the clip in every component: exact without noise.
    pub fn has_arrived(&self) -> bool {
        self.is_ripe(&self.used)
    }

    fn is_ripe(&self, reference: &Reference<S, NE>) -> bool {
        if reference.is_diagonal() {
            return reference.gone.value().diagonal().iter().all(|&gone| gone >= self.clip);
        }
        reference.inverse(self.clip).is_some()
    }
}

impl<S: Real, X, const NR: usize, const NE: usize> Estimator<S, NR, NE> for FiniteTime<S, X, NE>
where
    X: RegressorExtension<S, NR, NE>,
{
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let lost = self.drem.contract(regressor, regressand, dt)?;
        self.used.contract(&lost, dt);
        if let Some(period) = self.period {
            self.ripening.contract(&lost, dt);
            if self.ripening.age.value().x >= period && self.is_ripe(&self.ripening) {
                self.used = self.ripening;
                self.ripening = Reference::now(self.drem.estimate());
            }
        }
        Ok(())
    }

    fn estimate(&self) -> SVector<S, NE> {
        self.estimate()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.drem.shift(shift);
        self.used.theta += shift;
        self.ripening.theta += shift;
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.drem.turn(turn);
        self.used.turn(turn);
        self.ripening.turn(turn);
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        self.drem.reset(estimate);
        self.used = Reference::now(estimate);
        self.ripening = self.used;
    }

    fn is_finite(&self) -> bool {
        let finite = |reference: &Reference<S, NE>| all_finite(&reference.theta) && reference.gone.is_finite();
        self.drem.is_finite() && finite(&self.used) && finite(&self.ripening)
    }
}
