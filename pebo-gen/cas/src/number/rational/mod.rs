//! Exact rational numbers: a pair of words in place, anything larger on the heap.
//!
//! Holds always: lowest terms, positive denominator, and the small form whenever numerator and
//! denominator fit `i64`; hence equality and hash are those of the stored form.

mod convert;
mod ops;
mod total;

use std::cmp::Ordering;
use std::fmt;
use std::num::NonZeroI64;

use crate::Integer;

pub use convert::InvalidDecimal;

/// A rational number of any size.
#[derive(Clone, PartialEq, Eq, Hash)]
#[must_use = "arithmetic returns a new number"]
pub struct Rational(Repr);

#[derive(Clone, PartialEq, Eq, Hash)]
enum Repr {
    Small(i64, NonZeroI64),
    /// Numerator and denominator, at least one of which does not fit `i64`.
    Big(Box<(Integer, Integer)>),
}

use Repr::{Big, Small};

const UNIT: NonZeroI64 = NonZeroI64::new(1).unwrap();

/// Powers larger than this many bits are refused.
const MAX_POWER_BITS: u64 = 1 << 20;

impl Rational {
    /// Zero.
    pub const ZERO: Self = Self(Small(0, UNIT));
    /// One.
    pub const ONE: Self = Self(Small(1, UNIT));

    /// The quotient of two integers, `None` if the second is zero.
    pub fn new(numerator: impl Into<Integer>, denominator: impl Into<Integer>) -> Option<Self> {
        let (numerator, denominator) = (numerator.into(), denominator.into());
        let common = numerator.gcd(&denominator);
        let common = if denominator.is_negative() { -common } else { common };
        let lowest = numerator.div_exact(&common)?;
        denominator.div_exact(&common).filter(|d| !d.is_zero()).map(|d| Self::from_lowest(lowest, d))
    }

    /// From parts in lowest terms, the denominator positive.
    fn from_lowest(numerator: Integer, denominator: Integer) -> Self {
        if let (Some(n), Some(d)) = (numerator.to_i64(), denominator.to_i64())
            && let Some(d) = NonZeroI64::new(d)
        {
            return Self(Small(n, d));
        }
        Self(Big(Box::new((numerator, denominator))))
    }

    /// As `from_lowest`, from double words.
    #[inline]
    fn from_lowest_wide(numerator: i128, denominator: i128) -> Self {
        if let (Ok(n), Ok(d)) = (i64::try_from(numerator), i64::try_from(denominator))
            && let Some(d) = NonZeroI64::new(d)
        {
            return Self(Small(n, d));
        }
        Self(Big(Box::new((numerator.into(), denominator.into()))))
    }

    /// The numerator, in lowest terms; it carries the sign.
    pub fn numerator(&self) -> Integer {
        match &self.0 {
            Small(n, _) => Integer::from(*n),
            Big(parts) => parts.0.clone(),
        }
    }

    /// The denominator, in lowest terms; positive.
    pub fn denominator(&self) -> Integer {
        match &self.0 {
            Small(_, d) => Integer::from(d.get()),
            Big(parts) => parts.1.clone(),
        }
    }

    /// True if this is zero.
    pub fn is_zero(&self) -> bool {
        matches!(self.0, Small(0, _))
    }

    /// True if this is one.
    pub fn is_one(&self) -> bool {
        matches!(self.0, Small(1, UNIT))
    }

    /// True if the denominator is one.
    pub fn is_integer(&self) -> bool {
        match &self.0 {
            Small(_, d) => *d == UNIT,
            Big(parts) => parts.1.is_one(),
        }
    }

    /// True if this is less than zero.
    pub fn is_negative(&self) -> bool {
        self.signum() < 0
    }

    /// The sign: -1, 0 or 1.
    pub fn signum(&self) -> i32 {
        match &self.0 {
            Small(n, _) => Integer::from(*n).signum(),
            Big(parts) => parts.0.signum(),
        }
    }

    /// The value as an integer, if it is one.
    pub fn to_integer(&self) -> Option<Integer> {
        self.is_integer().then(|| self.numerator())
    }

    /// The value as a machine word, if it is an integer that fits.
    pub fn to_i64(&self) -> Option<i64> {
        match self.0 {
            Small(n, UNIT) => Some(n),
            _ => None,
        }
    }

    /// The number of bits of numerator and denominator combined, as a measure of size.
    pub fn bits(&self) -> u64 {
        match &self.0 {
            Small(n, d) => Integer::from(*n).bits() + Integer::from(d.get()).bits(),
            Big(parts) => parts.0.bits() + parts.1.bits(),
        }
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// The largest integer that is not above this.
    pub fn floor(&self) -> Integer {
        match &self.0 {
            Small(n, d) => Integer::from(n.div_euclid(d.get())),
            Big(parts) => parts.0.div_floor(&parts.1).unwrap_or(Integer::ZERO),
        }
    }

    /// The reciprocal; `None` of zero.
    pub fn recip(&self) -> Option<Self> {
        Self::ONE.checked_div(self)
    }

    /// The quotient; `None` for division by zero.
    pub fn checked_div(&self, divisor: &Self) -> Option<Self> {
        if divisor.is_zero() {
            return None;
        }
        let (n, d) = (divisor.numerator(), divisor.denominator());
        let inverse = if n.is_negative() { Self::from_lowest(-d, -n) } else { Self::from_lowest(d, n) };
        Some(self * &inverse)
    }

    /// The power; `None` for a negative power of zero, and for a result of more than a million
    /// bits.
    pub fn pow(&self, exponent: i32) -> Option<Self> {
        let base = if exponent < 0 { self.recip()? } else { self.clone() };
        let absolute = exponent.unsigned_abs();
        let (n, d) = (base.numerator(), base.denominator());
        let unit = |part: &Integer| part.bits() < 2;
        if !(unit(&n) && unit(&d)) && base.bits().saturating_mul(u64::from(absolute)) > MAX_POWER_BITS {
            return None;
        }
        Some(Self::from_lowest(n.pow(absolute), d.pow(absolute)))
    }

    /// The root of the given degree, if it is rational: the non-negative one of an even degree.
    pub fn root_exact(&self, degree: u32) -> Option<Self> {
        let numerator = self.numerator().root_exact(degree)?;
        Some(Self::from_lowest(numerator, self.denominator().root_exact(degree)?))
    }

    /// The non-negative square root, if it is rational.
    pub fn sqrt_exact(&self) -> Option<Self> {
        self.root_exact(2)
    }

    /// The largest rational with both as integer multiples: never negative, zero of two zeros.
    pub fn gcd(&self, other: &Self) -> Self {
        // Lowest terms: a prime of the joint numerator divides neither denominator.
        Self::from_lowest(self.numerator().gcd(&other.numerator()), self.denominator().lcm(&other.denominator()))
    }
}

/// One half, the exponent of a square root.
pub fn half() -> Rational {
    Rational::from_lowest(Integer::ONE, Integer::from(2))
}

impl From<i64> for Rational {
    fn from(value: i64) -> Self {
        Self(Small(value, UNIT))
    }
}

impl From<i32> for Rational {
    fn from(value: i32) -> Self {
        Self(Small(value.into(), UNIT))
    }
}

impl From<Integer> for Rational {
    fn from(value: Integer) -> Self {
        Self::from_lowest(value, Integer::ONE)
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        if let (Small(a, b), Small(c, d)) = (&self.0, &other.0) {
            return (i128::from(*a) * i128::from(d.get())).cmp(&(i128::from(*c) * i128::from(b.get())));
        }
        (&self.numerator() * &other.denominator()).cmp(&(&other.numerator() * &self.denominator()))
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.numerator())?;
        if self.is_integer() { Ok(()) } else { write!(f, "/{}", self.denominator()) }
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests;
