//! Sums of products of coefficients, one for each monomial of a product or a remainder.
//!
//! In: pairs of coefficients, as words or integers of any size. Out: their sum, in the narrowest type that is known to
//! hold it. The strategies of products and quotients (`boxed`, `hashed`, `packed`) differ in how they keep such sums;
//! `multiply` and `divide` choose among them.

use super::layout::{Exponents, Layout};
use super::work::Work;
use crate::Integer;

/// A sum of products of coefficients.
pub(super) trait CoefficientSum: Clone + Default {
    /// The coefficients that are multiplied.
    type Factor;
    /// Adds `a * b`.
    fn add_product(&mut self, a: &Self::Factor, b: &Self::Factor);
    /// True if nothing remains.
    fn vanishes(&self) -> bool;
    /// The value.
    fn into_integer(self) -> Integer;
}

/// Only if the sum is known to fit.
impl CoefficientSum for i64 {
    type Factor = i64;
    #[inline]
    fn add_product(&mut self, a: &i64, b: &i64) {
        *self += a * b;
    }
    fn vanishes(&self) -> bool {
        *self == 0
    }
    fn into_integer(self) -> Integer {
        self.into()
    }
}

/// Only if the sum is known to fit.
impl CoefficientSum for i128 {
    type Factor = i64;
    #[inline]
    fn add_product(&mut self, a: &i64, b: &i64) {
        *self += i128::from(*a) * i128::from(*b);
    }
    fn vanishes(&self) -> bool {
        *self == 0
    }
    fn into_integer(self) -> Integer {
        self.into()
    }
}

impl CoefficientSum for Integer {
    type Factor = Integer;
    #[inline]
    fn add_product(&mut self, a: &Integer, b: &Integer) {
        Integer::add_product(self, a, b);
    }
    fn vanishes(&self) -> bool {
        self.is_zero()
    }
    fn into_integer(self) -> Integer {
        self
    }
}

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

/// Keys and coefficients of a factor, in the layout of the product.
pub(super) struct PackedFactor<'a, C> {
    pub(super) keys: &'a [u64],
    pub(super) coefficients: &'a [C],
}

/// Descending keys, and their coefficients.
pub(super) type PackedTerms = (Vec<u64>, Vec<Integer>);

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
