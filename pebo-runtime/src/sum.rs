//! Increments in, their sum out, without the loss of what is too small for the sum.
//!
//! A filter with `alpha dt = 1e-6` changes by less than the resolution of `f32` long before it has settled: a plain sum
//! would stop there, percents away. The carried rounding error removes this at the price of ten additions an element.

use nalgebra::SMatrix;

use crate::Real;

/// A running sum of matrices with the rounding error carried along.
///
/// Source: Dekker, *A floating-point technique for extending the available precision*, Numer. Math., 1971; the error
/// term is Knuth's (*The Art of Computer Programming* vol. 2, 4.2.2, theorem B), whichever operand is larger.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sum<S: Real, const R: usize, const C: usize> {
    value: SMatrix<S, R, C>,
    carry: SMatrix<S, R, C>,
}

impl<S: Real, const R: usize, const C: usize> Sum<S, R, C> {
    /// A sum that stands at `value`.
    pub fn new(value: SMatrix<S, R, C>) -> Self {
        Self { value, carry: SMatrix::zeros() }
    }

    /// The sum so far, rounded once.
    pub fn value(&self) -> &SMatrix<S, R, C> {
        &self.value
    }

    /// Adds `increment`.
    pub fn add(&mut self, increment: &SMatrix<S, R, C>) {
        for ((value, carry), &increment) in self.value.iter_mut().zip(self.carry.iter_mut()).zip(increment.iter()) {
            let sum = *value + increment;
            let taken = sum - *value;
            let lost = (*value - (sum - taken)) + (increment - taken);
            let rest = *carry + lost;
            *value = sum + rest;
            *carry = rest - (*value - sum);
        }
    }

    /// Whether every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        all_finite(&self.value) && all_finite(&self.carry)
    }
}

/// Whether every element is finite.
pub(crate) fn all_finite<S: Real, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> bool {
    matrix.iter().all(|&element| Real::is_finite(element))
}
