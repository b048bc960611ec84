//! The response of an estimator to its data so far, as a square regression.

use nalgebra::{SMatrix, SVector};

use super::RegressorExtension;
use crate::estimator::Estimator;
use crate::numeric::sum::Sum;
use crate::{Fault, Real, Turn};

/// The response of an estimator as an extended regression.
///
/// The error of a linear estimator obeys `theta_hat - eta = F (theta_hat(0) - eta)` with a matrix `F` that depends on
/// the regressor alone, so
///
/// ```text
/// (I - F) eta = theta_hat - F theta_hat(0)
/// ```
///
/// is a square regression, and it keeps all past excitation: without further excitation `F` is constant.
///
/// Holds when: the estimator is linear in the regressand and the start ([`Gradient`](crate::Gradient),
/// [`NormalisedGradient`](crate::NormalisedGradient), [`LeastSquares`](crate::LeastSquares) are; a projected one is
/// not) and `eta` is constant. `I - F` is regular as soon as the data determine `eta` (interval excitation).
///
/// Method: column `i` of `I - F` is the estimate of the same estimator, started at 0 with the same memory, when the
/// unknown is the unit vector `i`: no identity is subtracted, so little excitation keeps all its digits. The cost is
/// that of `NE + 1` estimators.
///
/// Source: Ortega, Romero, Aranovskiy, *A new least squares parameter estimator for nonlinear regression equations with
/// relaxed excitation conditions and forgetting factor*, Systems & Control Letters, 2022 (least squares; Proposition 1
/// of its preprint, arXiv:2205.00099);
/// Korotina, Romero, Aranovskiy, Bobtsov, Ortega, *A new on-line exponential parameter estimator without persistent
/// excitation*, Systems & Control Letters, 2022 (gradient);
/// Bobtsov, Yi, Ortega, Astolfi, *Generation of new exciting regressors for consistent on-line estimation of unknown
/// constant parameters*, IEEE TAC, 2022, arXiv:2104.02210 (the scalar regressions of DREM).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "S: serde::Deserialize<'de>, E: serde::Deserialize<'de> + Copy"))
)]
pub struct Response<S: Real, E, const NR: usize, const NE: usize> {
    /// The estimate at the start.
    start: Sum<S, NE, 1>,
    estimator: E,
    /// Copies that estimate the unit vectors from 0.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    units: [E; NE],
    /// The estimator without any memory, at 0.
    fresh: E,
}

impl<S: Real, E, const NR: usize, const NE: usize> Response<S, E, NR, NE>
where
    E: Estimator<S, NR, NE> + Copy,
{
    /// The response of an estimator from its present estimate and memory on.
    ///
    /// # Errors
    /// [`Fault::Start`] unless the estimator's state is finite.
    pub fn new(estimator: E) -> Result<Self, Fault> {
        if !estimator.is_finite() {
            return Err(Fault::Start);
        }
        let start = estimator.estimate();
        let mut fresh = estimator;
        fresh.reset(&SVector::zeros());
        // Its memory decides how it takes later data: only the estimate goes to 0. The second shift takes the error
        // that a sum carries beyond its rounded value.
        let mut unit = estimator;
        unit.shift(&-start);
        unit.shift(&-unit.estimate());
        Ok(Self { start: Sum::new(start), estimator, units: [unit; NE], fresh })
    }

    /// The estimator.
    pub fn estimator(&self) -> &E {
        &self.estimator
    }
}

impl<S: Real, E, const NR: usize, const NE: usize> RegressorExtension<S, NR, NE> for Response<S, E, NR, NE>
where
    E: Estimator<S, NR, NE> + Copy,
{
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        for (unit, column) in self.units.iter_mut().zip(regressor.column_iter()) {
            unit.advance(regressor, &column.into_owned(), dt)?;
        }
        self.estimator.advance(regressor, regressand, dt)
    }

    fn matrix(&self) -> SMatrix<S, NE, NE> {
        let mut matrix = SMatrix::<S, NE, NE>::zeros();
        for (mut column, unit) in matrix.column_iter_mut().zip(&self.units) {
            column.copy_from(&unit.estimate());
        }
        matrix
    }

    fn vector(&self) -> SVector<S, NE> {
        let start = self.start.value();
        (self.estimator.estimate() - start) + self.matrix() * start
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        self.start.add(shift);
        self.estimator.shift(shift);
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        self.start.add(&turn.of_unknown(self.start.value()));
        self.estimator.turn(turn);
        // I - F becomes T (I - F) T^-1: each copy turns, and its estimate is then moved to the column of its unit
        // vector.
        let before = self.matrix();
        let turned = before + turn.of_map(&before);
        for (unit, column) in self.units.iter_mut().zip(turned.column_iter()) {
            unit.turn(turn);
            unit.shift(&(column - unit.estimate()));
        }
        self.fresh.turn(turn);
        self.fresh.reset(&SVector::zeros());
    }

    fn reset(&mut self) {
        self.start = Sum::new(SVector::zeros());
        self.estimator = self.fresh;
        self.units = [self.fresh; NE];
    }

    fn is_finite(&self) -> bool {
        self.start.is_finite() && self.estimator.is_finite() && self.units.iter().all(Estimator::is_finite)
    }
}
