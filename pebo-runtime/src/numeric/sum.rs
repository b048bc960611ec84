//! Sums with the rounding error carried along, so that increments too small for the sum are not lost.
//!
//! A filter with `alpha dt = 1e-6` changes by less than the resolution of `f32` long before it has settled: a plain sum
//! would stop there, percents away. Carrying the error costs ten additions an element.

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
    /// A sum that begins at `value`.
    pub fn new(value: SMatrix<S, R, C>) -> Self {
        Self { value, carry: SMatrix::zeros() }
    }

    /// The sum so far, rounded once.
    pub fn value(&self) -> &SMatrix<S, R, C> {
        &self.value
    }

    /// Adds `increment`.
    pub fn add(&mut self, increment: &SMatrix<S, R, C>) {
        let sums = self.value.as_mut_slice().iter_mut().zip(self.carry.as_mut_slice());
        for ((value, carry), &increment) in sums.zip(increment.as_slice()) {
            let sum = *value + increment;
            let taken = sum - *value;
            let lost = (*value - (sum - taken)) + (increment - taken);
            let rest = *carry + lost;
            *value = sum + rest;
            *carry = rest - (*value - sum);
        }
    }

    /// Loses a share of its value, and adds `increment`.
    ///
    /// The loss is rounded relative to the old value: where little is left, that would cost many of its digits.
    pub(crate) fn decay(&mut self, lost: S, increment: &SMatrix<S, R, C>) {
        if lost > Real::from_f64(0.5) {
            let kept = S::one() - lost;
            *self = Self::new(self.value * kept + (self.carry * kept + increment));
        } else {
            self.add(&(increment - self.value * lost));
        }
    }

    /// The sum, carried error included, less `base`.
    pub(crate) fn beyond(&self, base: &SMatrix<S, R, C>) -> SMatrix<S, R, C> {
        (self.value - base) + self.carry
    }

    /// True if every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        self.blemish() == S::zero()
    }

    /// [`blemish`] of every number of the state.
    pub(crate) fn blemish(&self) -> S {
        blemish(&self.value) + blemish(&self.carry)
    }
}

/// True if every element is finite.
#[inline]
pub(crate) fn all_finite<S: Real, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> bool {
    blemish(matrix) == S::zero()
}

/// A truth value as a [`blemish`].
#[inline]
pub(crate) fn as_blemish<S: Real>(finite: bool) -> S {
    if finite { S::zero() } else { Real::from_f64(f64::NAN) }
}

/// Zero if every element is finite, else NaN: zero times a finite number is zero and anything else is NaN, which a sum
/// keeps. Two instructions an element and one branch at the end, where comparing each takes eight and a branch.
#[inline]
pub(crate) fn blemish<S: Real, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> S {
    let zeros = matrix.as_slice().iter().map(|&element| element * S::zero());
    zeros.reduce(|sum, zero| sum + zero).unwrap_or(S::zero())
}
