//! Exact quotients: cheap exclusions, and the choice of the division.
//!
//! The sums that the remainder consists of are in an array if the box of exponents is well filled, and else in a hash
//! table. They are visited in descending order, so that a sum is complete when its turn comes; the division ends at the
//! first that the divisor's leading term does not divide.

use super::Poly;
use super::boxed::ExponentBox;
use super::layout::{Exponents, Layout, MAX_WORDS, key_quotient};
use super::sums::{Division, Outcome, PackedFactor, RemainderSum};
use super::work::{TooLarge, Work, steps};
use crate::Integer;

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
        let degrees: Option<Exponents> = self
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

impl Division<'_> {
    /// The quotient by the quicker of the two.
    fn run<S: RemainderSum>(
        &self,
        dividend: &[Integer],
        divisor: &[S::Factor],
    ) -> Result<Outcome<S::Factor>, TooLarge> {
        let cost = self.weight.saturating_mul(steps(divisor.len()));
        // A cell costs about a nanosecond, an access to the table ten.
        let degrees = self.layout.degrees(self.dividend);
        if let Some(cells) = ExponentBox::new(self.layout, &degrees, 8 * dividend.len()) {
            let dividend = PackedFactor { keys: self.dividend, coefficients: dividend };
            let divisor = PackedFactor { keys: self.divisor, coefficients: divisor };
            return cells.quotient::<S, _>(&dividend, &divisor, self.degrees, || self.work.spend(cost));
        }
        match self.layout.words() {
            1 => self.in_table::<1, S>(dividend, divisor),
            2 => self.in_table::<2, S>(dividend, divisor),
            4 => self.in_table::<4, S>(dividend, divisor),
            8 => self.in_table::<8, S>(dividend, divisor),
            16 => self.in_table::<16, S>(dividend, divisor),
            MAX_WORDS => self.in_table::<MAX_WORDS, S>(dividend, divisor),
            _ => Err(TooLarge),
        }
    }
}
