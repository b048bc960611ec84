//! Exact quotients: cheap exclusions, and the choice of the division.

use super::Poly;
use super::division::{Division, Outcome};
use super::layout::{Layout, MAX_WORDS};
use super::work::{TooLarge, Work, steps};
use crate::Integer;

/// The quotient of two keys, if the second divides the first.
#[inline]
pub(super) fn key_quotient(guard: u64, key: &[u64], divisor: &[u64], quotient: &mut [u64]) -> bool {
    let mut borrowed = 0;
    for ((word, other), result) in key.iter().zip(divisor).zip(quotient) {
        let difference = (word | guard).wrapping_sub(*other);
        borrowed |= !difference & guard;
        *result = difference & !guard;
    }
    borrowed == 0
}

impl Poly {
    /// The quotient, if `divisor` is not zero and divides this without remainder over the integers.
    pub fn div_exact(&self, divisor: &Self, work: &Work) -> Result<Option<Self>, TooLarge> {
        if divisor.is_zero() {
            return Ok(None);
        }
        if self.is_zero() {
            return Ok(Some(Self::zero()));
        }
        if let Some(value) = divisor.to_constant() {
            return Ok(self.div_integer(&value));
        }
        let layout = self.layout.union(&divisor.layout);
        if layout != self.layout {
            // The divisor has a variable or an exponent that this does not have.
            return Ok(None);
        }
        let keys = divisor.keys_in(&layout);
        let words = layout.words();
        let mut quotient = vec![0; words];
        let mut ends = |coefficients: (Option<&Integer>, Option<&Integer>), key: &[u64], other: &[u64]| {
            key_quotient(layout.guard(), key, other, &mut quotient)
                && matches!(coefficients, (Some(a), Some(b)) if a.div_exact(b).is_some())
        };
        let first = (self.coefficients.first(), divisor.coefficients.first());
        let last = (self.coefficients.last(), divisor.coefficients.last());
        if !ends(first, &self.keys[..words], &keys[..words])
            || !ends(last, &self.keys[self.keys.len() - words..], &keys[keys.len() - words..])
        {
            return Ok(None);
        }
        if divisor.term_count() == 1 {
            return Ok(self.div_term(&layout, &keys, &divisor.coefficients[0]));
        }
        self.div_long(divisor, &keys, work)
    }

    /// The quotient by a polynomial that is known to divide this.
    pub(super) fn over(&self, divisor: &Self, work: &Work) -> Result<Self, TooLarge> {
        let quotient = self.div_exact(divisor, work)?;
        debug_assert!(quotient.is_some(), "{divisor} does not divide {self}");
        Ok(quotient.unwrap_or_default())
    }

    fn div_term(&self, layout: &Layout, divisor: &[u64], coefficient: &Integer) -> Option<Self> {
        let mut keys = vec![0; self.keys.len()];
        let quotients = keys.chunks_exact_mut(layout.words());
        let mut divides = true;
        for (key, quotient) in self.keys().zip(quotients) {
            divides &= key_quotient(layout.guard(), key, divisor, quotient);
        }
        let quotients = self.coefficients.iter().map(|c| c.div_exact(coefficient)).collect();
        let coefficients = if divides { quotients } else { None };
        coefficients.map(|coefficients| Self::from_sorted(layout.clone(), keys, coefficients))
    }

    fn div_long(&self, divisor: &Self, keys: &[u64], work: &Work) -> Result<Option<Self>, TooLarge> {
        let degrees: Option<super::layout::Exponents> = self
            .degrees()
            .iter()
            .zip(self.variables())
            .map(|(degree, variable)| degree.checked_sub(divisor.degree(*variable)))
            .collect();
        let Some(degrees) = degrees else {
            return Ok(None);
        };
        if self.layout.words() > MAX_WORDS {
            return Err(TooLarge);
        }
        let weight = self.bits().div_ceil(64) * divisor.bits().div_ceil(64);
        work.spend(steps(self.term_count() * (1 + self.variables().len())))?;
        let division =
            Division { layout: &self.layout, dividend: &self.keys, divisor: keys, degrees: &degrees, weight, work };
        // A double word holds as many products of words as the divisor has terms, and more.
        let fewer = u64::from(usize::BITS - divisor.term_count().leading_zeros());
        if divisor.bits() + fewer < 63
            && let Some(small) = divisor.small_coefficients()
        {
            match division.run::<i128>(&self.coefficients, &small)? {
                Outcome::Quotient(keys, coefficients) => {
                    let coefficients = coefficients.into_iter().map(Integer::from).collect();
                    return Ok(Some(Self::from_sorted(self.layout.clone(), keys, coefficients)));
                }
                Outcome::Remainder => return Ok(None),
                Outcome::Overflow => {}
            }
        }
        Ok(match division.run::<Integer>(&self.coefficients, &divisor.coefficients)? {
            Outcome::Quotient(keys, coefficients) => Some(Self::from_sorted(self.layout.clone(), keys, coefficients)),
            Outcome::Remainder | Outcome::Overflow => None,
        })
    }
}
