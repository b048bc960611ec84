//! Known bounds of the unknown.

use nalgebra::{SMatrix, SVector};

use super::{Estimator, Information, Uncertain};
use crate::numeric::linear::solve;
use crate::numeric::sum::{Sum, all_finite};
use crate::{Fault, Real, Turn};

/// An estimator whose estimate is projected onto bounds `lower <= eta <= upper`, component by component.
///
/// Holds when: the unknown obeys the bounds. Then the projection brings every component of the error closer to 0 or
/// leaves it. Only the estimate that goes out is projected: the estimator's own keeps the exact form of its equations
/// (least squares remain least squares, the response remains linear), and its stability needs no help.
///
/// A [`shift`](Estimator::shift) of the unknown moves the bounds along and a [`turn`](Estimator::turn) turns them, so
/// they bound the unknown as it was at the start; a [`reset`](Estimator::reset) puts them back. Where all turns
/// combined have no inverse any more, nothing is projected. Bounds of the state itself are for
/// [`Within`](crate::Within).
///
/// Source: Ioannou and Sun, *Robust adaptive control*, 1996, chapter 4 (parameter projection; there it acts
/// on the adaptive law).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bounded<S: Real, E, const NE: usize> {
    estimator: E,
    lower: SVector<S, NE>,
    upper: SVector<S, NE>,
    /// The sum of the unknown's shifts.
    moved: Sum<S, NE, 1>,
    /// The product of its turns, if there were any: it is `turned eta + moved` of the unknown `eta` at the start.
    turned: Option<SMatrix<S, NE, NE>>,
}

impl<S: Real, E, const NE: usize> Bounded<S, E, NE> {
    /// Bounds on every component; an infinite one does not bind.
    ///
    /// # Errors
    /// [`Fault::Start`] unless `lower <= upper` in every component.
    pub fn new(estimator: E, lower: &SVector<S, NE>, upper: &SVector<S, NE>) -> Result<Self, Fault> {
        if lower.iter().zip(upper.iter()).all(|(lower, upper)| lower <= upper) {
            let moved = Sum::new(SVector::zeros());
            Ok(Self { estimator, lower: *lower, upper: *upper, moved, turned: None })
        } else {
            Err(Fault::Start)
        }
    }

    /// The estimator within.
    pub fn estimator(&self) -> &E {
        &self.estimator
    }
}

impl<S: Real, E, const NR: usize, const NE: usize> Estimator<S, NR, NE> for Bounded<S, E, NE>
where
    E: Estimator<S, NR, NE>,
{
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        self.estimator.advance(regressor, regressand, dt)
    }

    fn estimate(&self) -> SVector<S, NE> {
        let (estimate, moved) = (self.estimator.estimate(), self.moved.value());
        let Some(turned) = &self.turned else {
            return estimate.sup(&(self.lower + moved)).inf(&(self.upper + moved));
        };
        let first = solve(*turned, estimate - moved).ok().filter(all_finite);
        first.map_or(estimate, |first| {
            let beyond = first.sup(&self.lower).inf(&self.upper) - first;
            estimate + turned * beyond
        })
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.estimator.shift(shift);
        self.moved.add(shift);
    }

    fn information(&self) -> Option<&Information<S, NE>> {
        self.estimator.information()
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.estimator.turn(turn);
        self.moved.add(&turn.of_unknown(self.moved.value()));
        let turned = self.turned.unwrap_or_else(SMatrix::identity);
        self.turned = Some(turned + turn.of_unknown(&turned));
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        self.estimator.reset(estimate);
        self.moved = Sum::new(SVector::zeros());
        self.turned = None;
    }

    fn is_finite(&self) -> bool {
        self.estimator.is_finite() && self.moved.is_finite() && all_finite(&self.estimate())
    }
}

/// That of the estimator within: bounds make an estimate no less certain.
impl<S: Real, E: Uncertain<S, NE>, const NE: usize> Uncertain<S, NE> for Bounded<S, E, NE> {
    fn covariance_root(&self, dt: S) -> Option<SMatrix<S, NE, NE>> {
        self.estimator.covariance_root(dt)
    }
}
