//! Long division of sparse polynomials.
//!
//! The sums that the remainder consists of are in an array if the box of exponents is well filled, and else in a hash
//! table. They are visited in descending order, so that a sum is complete when its turn comes; the division ends at the
//! first that the divisor's leading term does not divide.

use super::boxed::ExponentBox;
use super::layout::{Exponents, Layout, MAX_WORDS};
use super::multiply::{CoefficientSum, PackedFactor};
use super::work::{TooLarge, Work, steps};
use crate::Integer;

/// The outcome of a division.
pub(super) enum Outcome<C> {
    /// Exact: descending keys, and their coefficients.
    Quotient(Vec<u64>, Vec<C>),
    /// Not exact.
    Remainder,
    /// A coefficient of the quotient, if there is one, does not fit the number type.
    Overflow,
}

/// A coefficient of the remainder while it is summed up.
pub(super) trait RemainderSum: CoefficientSum {
    /// The sum that begins with a coefficient of the dividend, if it fits.
    fn begin(value: &Integer) -> Option<Self>;
    /// The negative of a coefficient: sums add products.
    fn negative(value: &Self::Factor) -> Self::Factor;
    /// The quotient, or the reason why there is none.
    fn over(&self, divisor: &Self::Factor) -> Result<Self::Factor, Outcome<Self::Factor>>;
}

impl RemainderSum for i128 {
    fn begin(value: &Integer) -> Option<Self> {
        // Half of the range is for the products.
        value.to_i128().filter(|value| value.unsigned_abs() < 1 << 126)
    }
    fn negative(value: &i64) -> i64 {
        // The divisor's coefficients are short enough, by the choice of this type.
        -value
    }
    fn over(&self, divisor: &i64) -> Result<i64, Outcome<i64>> {
        let word = i64::try_from(*self).ok();
        let short = word.and_then(|word| Some((word.checked_rem(*divisor)?, word / divisor)));
        match short {
            Some((0, quotient)) => Ok(quotient),
            Some(_) => Err(Outcome::Remainder),
            None if self % i128::from(*divisor) != 0 => Err(Outcome::Remainder),
            None => i64::try_from(self / i128::from(*divisor)).map_err(|_| Outcome::Overflow),
        }
    }
}

impl RemainderSum for Integer {
    fn begin(value: &Integer) -> Option<Self> {
        Some(value.clone())
    }
    fn negative(value: &Self) -> Self {
        -value
    }
    fn over(&self, divisor: &Self) -> Result<Self, Outcome<Self>> {
        self.div_exact(divisor).ok_or(Outcome::Remainder)
    }
}

/// The keys of a division, all in one layout.
pub(super) struct Division<'a> {
    pub(super) layout: &'a Layout,
    pub(super) dividend: &'a [u64],
    pub(super) divisor: &'a [u64],
    /// The degrees of the quotient, if there is one.
    pub(super) degrees: &'a Exponents,
    /// Steps for each product.
    pub(super) weight: u64,
    pub(super) work: &'a Work,
}

impl Division<'_> {
    pub(super) fn run<S: RemainderSum>(
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
