//! Exact integers: `i64` in place, anything larger on the heap.
//!
//! Nearly every coefficient of a derivation fits a machine word, so the small case costs no
//! allocation and no call into the big-number library. Holds always: a value that fits `i64` is
//! stored small, hence equality, order and hash are those of the stored form.

mod ops;
mod slots;

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;

use dashu_int::ops::{BitTest, DivRem, Gcd, UnsignedAbs};
use dashu_int::{IBig, Sign, UBig};

/// An integer of any size.
#[derive(Clone, PartialEq, Eq, Hash)]
#[must_use = "arithmetic returns a new number"]
pub struct Integer(Repr);

#[derive(Clone, PartialEq, Eq, Hash)]
enum Repr {
    Small(i64),
    /// Never a value that fits `i64`.
    Big(Box<IBig>),
}

use Repr::{Big, Small};

impl Integer {
    /// Zero.
    pub const ZERO: Self = Self(Small(0));
    /// One.
    pub const ONE: Self = Self(Small(1));

    fn from_big(value: IBig) -> Self {
        match i64::try_from(&value) {
            Ok(small) => Self(Small(small)),
            Err(_) => Self(Big(Box::new(value))),
        }
    }

    fn big(&self) -> Cow<'_, IBig> {
        match &self.0 {
            Small(value) => Cow::Owned(IBig::from(*value)),
            Big(value) => Cow::Borrowed(value),
        }
    }

    /// The integer written in decimal digits, with an optional sign; `None` of anything else.
    pub fn from_digits(text: &str) -> Option<Self> {
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return None;
        }
        match text.parse::<i64>() {
            Ok(small) => Some(Self(Small(small))),
            Err(_) => IBig::from_str_radix(text, 10).ok().map(Self::from_big),
        }
    }

    /// True if this is zero.
    pub fn is_zero(&self) -> bool {
        matches!(self.0, Small(0))
    }

    /// True if this is one.
    pub fn is_one(&self) -> bool {
        matches!(self.0, Small(1))
    }

    /// True if this is less than zero.
    pub fn is_negative(&self) -> bool {
        self.signum() < 0
    }

    /// The sign: -1, 0 or 1.
    pub fn signum(&self) -> i32 {
        match &self.0 {
            Small(value) => match value.cmp(&0) {
                Ordering::Less => -1,
                Ordering::Equal => 0,
                Ordering::Greater => 1,
            },
            Big(value) if value.sign() == Sign::Negative => -1,
            Big(_) => 1,
        }
    }

    /// The value as a machine word, where it fits.
    pub fn to_i64(&self) -> Option<i64> {
        match self.0 {
            Small(value) => Some(value),
            Big(_) => None,
        }
    }

    /// The value as a double word, where it fits.
    pub fn to_i128(&self) -> Option<i128> {
        match &self.0 {
            Small(value) => Some((*value).into()),
            Big(value) => i128::try_from(value.as_ref()).ok(),
        }
    }

    /// The number of bits of the absolute value; zero has none.
    pub fn bits(&self) -> u64 {
        match &self.0 {
            Small(value) => u64::from(64 - value.unsigned_abs().leading_zeros()),
            Big(value) => value.bit_len() as u64,
        }
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// The greatest common divisor, never negative; zero only of two zeros.
    pub fn gcd(&self, other: &Self) -> Self {
        if self.is_one() || other.is_one() {
            return Self::ONE;
        }
        match (&self.0, &other.0) {
            (Small(a), Small(b)) => Self::from(gcd_u64(a.unsigned_abs(), b.unsigned_abs())),
            (Small(0), Big(_)) => other.abs(),
            (Big(_), Small(0)) => self.abs(),
            // One reduction brings the pair down to words.
            (Small(a), Big(b)) | (Big(b), Small(a)) => {
                let a = a.unsigned_abs();
                Self::from(gcd_u64(a, b.as_ref().unsigned_abs() % a))
            }
            (Big(a), Big(b)) => Self::from_big(IBig::from(a.as_ref().gcd(b.as_ref()))),
        }
    }

    /// The least common multiple, never negative; zero if either is.
    pub fn lcm(&self, other: &Self) -> Self {
        let common = self.gcd(other);
        self.div_exact(&common).map_or(Self::ZERO, |part| (&part * other).abs())
    }

    /// The quotient, if `divisor` is not zero and divides this without remainder.
    pub fn div_exact(&self, divisor: &Self) -> Option<Self> {
        let (quotient, remainder) = self.div_rem(divisor)?;
        remainder.is_zero().then_some(quotient)
    }

    /// Quotient rounded towards zero, and the remainder with the sign of `self`; `None` for
    /// division by zero.
    pub fn div_rem(&self, divisor: &Self) -> Option<(Self, Self)> {
        match (&self.0, &divisor.0) {
            (_, Small(0)) => None,
            (_, Small(1)) => Some((self.clone(), Self::ZERO)),
            (_, Small(-1)) => Some((-self, Self::ZERO)),
            (Small(a), Small(b)) => Some((Self(Small(a / b)), Self(Small(a % b)))),
            _ => {
                let (quotient, remainder) = self.big().as_ref().div_rem(divisor.big().as_ref());
                Some((Self::from_big(quotient), Self::from_big(remainder)))
            }
        }
    }

    /// Quotient rounded down; `None` for division by zero.
    pub fn div_floor(&self, divisor: &Self) -> Option<Self> {
        let (quotient, remainder) = self.div_rem(divisor)?;
        let down = !remainder.is_zero() && (remainder.is_negative() != divisor.is_negative());
        Some(if down { &quotient - &Self::ONE } else { quotient })
    }

    /// The representative of this between 0 and `modulus - 1`. A modulus of zero is a
    /// programming error.
    pub fn rem_u64(&self, modulus: u64) -> u64 {
        let rest = match &self.0 {
            Small(value) => value.unsigned_abs() % modulus,
            Big(value) => value.as_ref().unsigned_abs() % modulus,
        };
        if rest != 0 && self.is_negative() { modulus - rest } else { rest }
    }

    /// The power. The caller bounds the size of the result: it has about `exponent * self.bits()` bits.
    pub fn pow(&self, exponent: u32) -> Self {
        if let Small(value) = self.0
            && let Some(power) = value.checked_pow(exponent)
        {
            return Self(Small(power));
        }
        Self::from_big(self.big().pow(exponent as usize))
    }

    /// This times `2^shift`. The caller bounds the size of the result.
    pub fn shl(&self, shift: u32) -> Self {
        match self.0 {
            Small(value) if shift < 64 => Self::from(i128::from(value) << shift),
            _ => Self::from_big(self.big().as_ref() << shift as usize),
        }
    }

    /// The multiplicity of the factor 2; zero for zero.
    pub fn trailing_zeros(&self) -> u32 {
        match &self.0 {
            Small(0) => 0,
            Small(value) => value.trailing_zeros(),
            Big(value) => value.trailing_zeros().map_or(0, |n| u32::try_from(n).unwrap_or(u32::MAX)),
        }
    }

    /// The root that is an integer, if there is one: the non-negative one of an even degree.
    pub fn root_exact(&self, degree: u32) -> Option<Self> {
        if degree == 0 || (degree.is_multiple_of(2) && self.is_negative()) {
            return None;
        }
        if degree == 1 || self.is_zero() || self.is_one() {
            return Some(self.clone());
        }
        // 2^(bits-1) <= |self| < 2^bits: past this degree only 0 and 1 have roots.
        if u64::from(degree) >= self.bits() {
            let negative_one = self.to_i64() == Some(-1);
            return negative_one.then(|| self.clone());
        }
        let absolute: UBig = self.big().into_owned().unsigned_abs();
        let root = Self::from_big(IBig::from(absolute.nth_root(degree as usize)));
        let root = if self.is_negative() { -&root } else { root };
        (root.pow(degree) == *self).then_some(root)
    }

    /// Adds `a * b`.
    pub fn add_product(&mut self, a: &Self, b: &Self) {
        if let (Small(sum), Small(a), Small(b)) = (&self.0, &a.0, &b.0) {
            // At most 2^126 + 2^63 in absolute value.
            *self = Self::from(i128::from(*a) * i128::from(*b) + i128::from(*sum));
        } else {
            *self += &(a * b);
        }
    }

    /// Subtracts `a * b`.
    pub fn sub_product(&mut self, a: &Self, b: &Self) {
        if let (Small(sum), Small(a), Small(b)) = (&self.0, &a.0, &b.0) {
            *self = Self::from(i128::from(*sum) - i128::from(*a) * i128::from(*b));
        } else {
            *self -= &(a * b);
        }
    }

    /// The nearest `f64`, ties to even; infinite where it is out of range.
    pub fn to_f64(&self) -> f64 {
        match &self.0 {
            #[expect(clippy::cast_precision_loss, reason = "rounding to nearest is what is asked for")]
            Small(value) => *value as f64,
            Big(value) => value.to_f64().value(),
        }
    }

    /// The 64 leading bits of the absolute value with any lower bit folded into the last, and the power of two by which
    /// they are to be multiplied. Zero gives zeros.
    pub(crate) fn leading_bits(&self) -> (u64, u64) {
        let bits = self.bits();
        match &self.0 {
            Small(value) => (value.unsigned_abs(), 0),
            Big(value) if bits > 64 => {
                let shift = bits - 64;
                let absolute = value.as_ref().unsigned_abs();
                let (low, high) = absolute.split_bits(usize::try_from(shift).unwrap_or(usize::MAX));
                let top = u64::try_from(high).unwrap_or(u64::MAX);
                (top | u64::from(!low.is_zero()), shift)
            }
            Big(value) => (u64::try_from(value.as_ref().unsigned_abs()).unwrap_or(u64::MAX), 0),
        }
    }
}

/// Binary greatest common divisor of words (Stein, 1967).
pub fn gcd_u64(mut a: u64, mut b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let shift = (a | b).trailing_zeros();
    a >>= a.trailing_zeros();
    loop {
        b >>= b.trailing_zeros();
        if a > b {
            std::mem::swap(&mut a, &mut b);
        }
        b -= a;
        if b == 0 {
            return a << shift;
        }
    }
}

impl Default for Integer {
    fn default() -> Self {
        Self::ZERO
    }
}

impl From<i64> for Integer {
    fn from(value: i64) -> Self {
        Self(Small(value))
    }
}

impl From<i32> for Integer {
    fn from(value: i32) -> Self {
        Self(Small(value.into()))
    }
}

impl From<u64> for Integer {
    fn from(value: u64) -> Self {
        Self::from(i128::from(value))
    }
}

impl From<i128> for Integer {
    #[inline]
    fn from(value: i128) -> Self {
        match i64::try_from(value) {
            Ok(small) => Self(Small(small)),
            Err(_) => Self(Big(Box::new(IBig::from(value)))),
        }
    }
}

impl PartialOrd for Integer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Integer {
    fn cmp(&self, other: &Self) -> Ordering {
        match (&self.0, &other.0) {
            (Small(a), Small(b)) => a.cmp(b),
            _ => self.big().cmp(&other.big()),
        }
    }
}

impl fmt::Display for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Small(value) => value.fmt(f),
            Big(value) => fmt::Display::fmt(value, f),
        }
    }
}

impl fmt::Debug for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
pub(crate) mod tests;
