//! The dynamic extension: integrates samples of `h` (and `Lambda`) to the coordinates `z` less a constant unknown
//! `theta`.
//!
//! After every step `z(t) = chi(t) + theta` ([`Integrator`]) or `z(t) = xi(t) + Psi(t) theta` ([`Fundamental`]) holds
//! as well as the samples tell: the error is of second order in the step.

mod drift;
mod turn;

use core::fmt::Debug;

use nalgebra::{SMatrix, SVector};

use crate::numeric::dense::{applied, product};
use crate::numeric::exponential::Propagator;
use crate::numeric::linear::solve;
use crate::numeric::sum::{all_finite, as_blemish};
use crate::{Fault, Functions, Real, Sum};
pub use drift::Drift;
pub use turn::Turn;

/// The flow `z' = lambda z + h` of the transformed coordinates at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow<S: Real, const NZ: usize> {
    /// `Lambda(y, u)`, in 1/s; not read by [`Integrator`].
    pub lambda: SMatrix<S, NZ, NZ>,
    /// `h(y, u)`, in units of z per second.
    pub h: SVector<S, NZ>,
}

impl<S: Real, const NZ: usize> Flow<S, NZ> {
    /// The flow `z' = h` of a plain cascade.
    #[inline]
    pub fn plain(h: SVector<S, NZ>) -> Self {
        Self { lambda: SMatrix::zeros(), h }
    }
}

/// The dynamic extension of a [`Model`](crate::Model): a solution of the flow with a known start.
pub trait Extension<S: Real, const NZ: usize>: Copy + Debug + PartialEq {
    /// The extension at its start, where `z = start + theta`.
    fn new(start: SVector<S, NZ>) -> Self;

    /// `z` for a given `theta`.
    fn coordinates(&self, theta: &SVector<S, NZ>) -> SVector<S, NZ>;

    /// `theta` for given coordinates, functions of parameters. None where the fundamental matrix has no inverse, to rounding.
    fn theta(&self, z: &Functions<S, NZ, NZ>) -> Option<Functions<S, NZ, NZ>>;

    /// Advances by `dt` seconds with the flow known at both ends.
    ///
    /// # Errors
    /// [`Fault::Singular`] if the step is too long for `Lambda`; the extension is then unspecified.
    fn advance(&mut self, start: &Flow<S, NZ>, end: &Flow<S, NZ>, dt: S) -> Result<(), Fault>;

    /// Advances as [`advance`](Self::advance) does and takes the turn as [`take_turn`](Self::take_turn) does, which `follow`
    /// gets: for less than both, as no fundamental matrix is kept or inverted where it was the identity before.
    ///
    /// # Errors
    /// [`Fault::Singular`] if the step is too long for `Lambda`; the extension is then unspecified.
    fn advance_anew(
        &mut self,
        start: &Flow<S, NZ>,
        end: &Flow<S, NZ>,
        dt: S,
        follow: impl FnOnce(&Turn<S, NZ>),
    ) -> Result<(), Fault>;

    /// Moves `shift` from the extension into `theta`: `coordinates(theta + shift)` then equals `coordinates(theta)`
    /// before.
    fn rebase(&mut self, shift: &SVector<S, NZ>);

    /// The solution with the known start: `chi` or `xi`.
    fn offset(&self) -> &SVector<S, NZ>;

    /// Makes the fundamental matrix the identity and returns the turn of `theta`: `coordinates(Psi theta)` then equals
    /// `coordinates(theta)` before. None if it is always the identity.
    ///
    /// # Errors
    /// [`Fault::Singular`] if the matrix has no inverse, to rounding; the extension is then unspecified.
    fn take_turn(&mut self) -> Result<Option<Turn<S, NZ>>, Fault>;

    /// True if every number of the state is finite.
    fn is_finite(&self) -> bool;

    /// The same as a number, 0 or NaN, see [`Estimator::blemish`](crate::Estimator::blemish).
    fn blemish(&self) -> S {
        as_blemish(self.is_finite())
    }
}

/// `chi' = h(y, u)`, so that `z = chi + theta` (the paper, Section 2.2, equations 8, 11 and 12).
///
/// Trapezoidal rule: exact where h is linear in time over the step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Integrator<S: Real, const NZ: usize> {
    chi: Sum<S, NZ, 1>,
}

impl<S: Real, const NZ: usize> Integrator<S, NZ> {
    /// The extension `chi`.
    pub fn chi(&self) -> &SVector<S, NZ> {
        self.chi.value()
    }
}

impl<S: Real, const NZ: usize> Extension<S, NZ> for Integrator<S, NZ> {
    fn new(start: SVector<S, NZ>) -> Self {
        Self { chi: Sum::new(start) }
    }

    fn coordinates(&self, theta: &SVector<S, NZ>) -> SVector<S, NZ> {
        self.chi.value() + theta
    }

    fn theta(&self, z: &Functions<S, NZ, NZ>) -> Option<Functions<S, NZ, NZ>> {
        Some(Functions { values: z.values - self.chi.value(), slopes: z.slopes })
    }

    fn advance(&mut self, start: &Flow<S, NZ>, end: &Flow<S, NZ>, dt: S) -> Result<(), Fault> {
        let half: S = Real::from_f64(0.5);
        self.chi.add(&((start.h + end.h) * (half * dt)));
        Ok(())
    }

    fn advance_anew(
        &mut self,
        start: &Flow<S, NZ>,
        end: &Flow<S, NZ>,
        dt: S,
        _follow: impl FnOnce(&Turn<S, NZ>),
    ) -> Result<(), Fault> {
        self.advance(start, end, dt)
    }

    fn rebase(&mut self, shift: &SVector<S, NZ>) {
        self.chi.add(&-shift);
    }

    fn offset(&self) -> &SVector<S, NZ> {
        self.chi.value()
    }

    fn take_turn(&mut self) -> Result<Option<Turn<S, NZ>>, Fault> {
        Ok(None)
    }

    fn is_finite(&self) -> bool {
        self.chi.is_finite()
    }

    fn blemish(&self) -> S {
        self.chi.blemish()
    }
}

/// `xi' = Lambda xi + h`, `Psi' = Lambda Psi` with `Psi(0) = I`, so that `z = xi + Psi theta` (generalised PEBO:
/// Ortega, Bobtsov, Nikolaev, Schiffer, Dochain, *Generalized parameter estimation-based observers*, Automatica, 2021).
///
/// Both advance by the exponential of the mean of `Lambda` at both ends, with the mean of `h`: exact to rounding where
/// both are constant over the step and `|Lambda| dt` is below 0.02, within 1e-7 of a rate at any step, and of second
/// order where they vary. As both parts advance by the same map, moving a shift between `xi` and `theta` commutes with
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fundamental<S: Real, const NZ: usize> {
    xi: Sum<S, NZ, 1>,
    psi: Sum<S, NZ, NZ>,
}

impl<S: Real, const NZ: usize> Fundamental<S, NZ> {
    /// The particular solution `xi`.
    pub fn xi(&self) -> &SVector<S, NZ> {
        self.xi.value()
    }

    /// The fundamental matrix `Psi`, of no unit.
    pub fn psi(&self) -> &SMatrix<S, NZ, NZ> {
        self.psi.value()
    }

    /// Advances the particular solution; `step` becomes the map of the step.
    #[inline]
    fn advance_xi(
        &mut self,
        start: &Flow<S, NZ>,
        end: &Flow<S, NZ>,
        dt: S,
        step: &mut Propagator<S, NZ>,
    ) -> Result<(), Fault> {
        let half: S = Real::from_f64(0.5);
        let half = half * dt;
        let mut q = start.lambda;
        for (starts, ends) in q.data.0.iter_mut().zip(&end.lambda.data.0) {
            for (start, &end) in starts.iter_mut().zip(ends) {
                *start = (*start + end) * half;
            }
        }
        let mut rate = applied(&q, self.xi.value()) + (start.h + end.h) * half;
        step.set(&mut q, &mut rate)?;
        // As an increment: a small step then loses nothing to the identity.
        self.xi.add(&step.gained);
        Ok(())
    }

    /// The extension with a matrix before `theta`: its coordinates at `theta` are those of this one at `map theta`.
    #[must_use]
    pub fn mapped(&self, map: &SMatrix<S, NZ, NZ>) -> Self {
        Self { xi: self.xi, psi: Sum::new(self.psi.value() * map) }
    }
}

impl<S: Real, const NZ: usize> Extension<S, NZ> for Fundamental<S, NZ> {
    fn new(start: SVector<S, NZ>) -> Self {
        Self { xi: Sum::new(start), psi: Sum::new(SMatrix::identity()) }
    }

    fn coordinates(&self, theta: &SVector<S, NZ>) -> SVector<S, NZ> {
        self.xi.value() + applied(self.psi.value(), theta)
    }

    fn theta(&self, z: &Functions<S, NZ, NZ>) -> Option<Functions<S, NZ, NZ>> {
        let psi = *self.psi.value();
        let values = solve(psi, z.values - self.xi.value()).ok()?;
        Some(Functions { values, slopes: solve(psi, z.slopes).ok()? })
    }

    fn advance(&mut self, start: &Flow<S, NZ>, end: &Flow<S, NZ>, dt: S) -> Result<(), Fault> {
        let mut step = Propagator::nothing();
        self.advance_xi(start, end, dt, &mut step)?;
        match &step.whole {
            None => self.psi.add(&product(&step.turn.gained, self.psi.value())),
            Some(whole) => self.psi = Sum::new(product(whole, self.psi.value())),
        }
        Ok(())
    }

    fn advance_anew(
        &mut self,
        start: &Flow<S, NZ>,
        end: &Flow<S, NZ>,
        dt: S,
        follow: impl FnOnce(&Turn<S, NZ>),
    ) -> Result<(), Fault> {
        let mut step = Propagator::nothing();
        if self.psi.value().data.0 == SMatrix::<S, NZ, NZ>::identity().data.0 {
            self.advance_xi(start, end, dt, &mut step)?;
            if step.whole.is_some() && !all_finite(&step.turn.lost) {
                return Err(Fault::Singular);
            }
        } else {
            self.advance(start, end, dt)?;
            step.turn = Turn::new(&self.psi)?;
            self.psi = Sum::new(SMatrix::identity());
        }
        follow(&step.turn);
        Ok(())
    }

    fn rebase(&mut self, shift: &SVector<S, NZ>) {
        self.xi.add(&-applied(self.psi.value(), shift));
    }

    fn offset(&self) -> &SVector<S, NZ> {
        self.xi.value()
    }

    fn take_turn(&mut self) -> Result<Option<Turn<S, NZ>>, Fault> {
        let turn = Turn::new(&self.psi)?;
        self.psi = Sum::new(SMatrix::identity());
        Ok(Some(turn))
    }

    fn is_finite(&self) -> bool {
        self.xi.is_finite() && self.psi.is_finite()
    }
}
