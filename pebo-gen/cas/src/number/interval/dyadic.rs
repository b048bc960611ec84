//! Dyadic numbers m 2^e: the end points of intervals.
//!
//! In: dyadics, a number of bits, and a side. Out: a dyadic of at most so many significant bits, on
//! that side of the exact result and next to it. Holds: no shift is longer than the operands and
//! the bits asked for together, however far apart the exponents are, so memory stays bounded.

use core::cmp::Ordering;
use core::ops::Neg;

use dashu_int::ops::{BitTest, DivRemEuclid, UnsignedAbs};
use dashu_int::{IBig, Sign};

use crate::Integer;

/// The side of the exact value on which the rounded one lies.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
}

/// The number `mantissa * 2^exponent`. One number has many representations; all compare equal.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    pub(super) mantissa: IBig,
    pub(super) exponent: i64,
}

/// floor(m 2^places).
pub(super) fn scaled(m: &IBig, places: i64) -> IBig {
    let distance = usize::try_from(places.unsigned_abs()).unwrap_or(usize::MAX);
    if places < 0 { m >> distance } else { m << distance }
}

/// The number of bits of |m|.
pub(super) fn length(m: &IBig) -> i64 {
    i64::try_from(m.bit_len()).unwrap_or(i64::MAX)
}

impl Dyadic {
    pub(super) const ZERO: Self = Self::new(IBig::ZERO, 0);
    pub(super) const ONE: Self = Self::new(IBig::ONE, 0);

    /// The exponent of zero is zero, or it would grow without bound.
    pub(super) const fn new(mantissa: IBig, exponent: i64) -> Self {
        let exponent = if mantissa.is_zero() { 0 } else { exponent };
        Self { mantissa, exponent }
    }

    /// The integer n.
    pub(super) fn integer(n: &Integer) -> Option<Self> {
        let mantissa = match n.to_i64() {
            Some(word) => IBig::from(word),
            None => IBig::from_str_radix(&n.to_string(), 10).ok()?,
        };
        Some(Self::new(mantissa, 0))
    }

    /// 2^exponent.
    pub(super) const fn power_of_two(exponent: i64) -> Self {
        Self::new(IBig::ONE, exponent)
    }

    pub(super) const fn is_zero(&self) -> bool {
        self.mantissa.is_zero()
    }

    pub(super) fn is_positive(&self) -> bool {
        self.mantissa > IBig::ZERO
    }

    pub(super) fn is_negative(&self) -> bool {
        self.mantissa.sign() == Sign::Negative
    }

    /// The t with 2^t <= |x| < 2^(t+1); none at zero.
    pub(super) fn top(&self) -> Option<i64> {
        (!self.is_zero()).then(|| self.exponent + length(&self.mantissa) - 1)
    }

    /// x 2^places, exactly.
    pub(super) fn shifted(&self, places: i64) -> Self {
        Self::new(self.mantissa.clone(), self.exponent + places)
    }

    pub(super) fn abs(&self) -> Self {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// The nearest multiple of 2^exponent on the side.
    fn at_exponent(&self, exponent: i64, side: Side) -> IBig {
        let places = self.exponent - exponent;
        match side {
            Side::Below => scaled(&self.mantissa, places),
            Side::Above => -scaled(&-&self.mantissa, places),
        }
    }

    /// The nearest number of at most `bits` significant bits on the side.
    pub(super) fn rounded(self, bits: i64, side: Side) -> Self {
        let excess = length(&self.mantissa) - bits;
        if excess <= 0 {
            return self;
        }
        let exponent = self.exponent + excess;
        Self::new(self.at_exponent(exponent, side), exponent)
    }

    /// x + y. Where one of them is less than a unit 2^last, of which the other is a multiple, that
    /// unit stands for it on the side asked for, and zero on the other: both round alike.
    pub(super) fn sum(&self, other: &Self, bits: i64, side: Side) -> Self {
        let (top, other_top) = match (self.top(), other.top()) {
            (None, _) => return other.clone().rounded(bits, side),
            (_, None) => return self.clone().rounded(bits, side),
            (Some(top), Some(other_top)) => (top, other_top),
        };
        let (large, large_top, small, small_top) =
            if top >= other_top { (self, top, other, other_top) } else { (other, other_top, self, top) };
        let last = large.exponent.min(large_top - bits - 2);
        let (exponent, rest) = if small_top < last {
            let rest = match (side, small.is_negative()) {
                (Side::Below, true) => IBig::NEG_ONE,
                (Side::Above, false) => IBig::ONE,
                _ => IBig::ZERO,
            };
            (last, rest)
        } else {
            let exponent = large.exponent.min(small.exponent);
            (exponent, scaled(&small.mantissa, small.exponent - exponent))
        };
        let mantissa = scaled(&large.mantissa, large.exponent - exponent) + rest;
        Self::new(mantissa, exponent).rounded(bits, side)
    }

    /// x y, exactly.
    pub(super) fn product(&self, other: &Self) -> Self {
        Self::new(&self.mantissa * &other.mantissa, self.exponent + other.exponent)
    }

    /// x / y, for y > 0.
    pub(super) fn quotient(&self, other: &Self, bits: i64, side: Side) -> Self {
        let places = (bits + 1 + length(&other.mantissa) - length(&self.mantissa)).max(0);
        let (mut floor, rest) = scaled(&self.mantissa, places).div_rem_euclid(&other.mantissa);
        if side == Side::Above && !rest.is_zero() {
            floor += IBig::ONE;
        }
        Self::new(floor, self.exponent - other.exponent - places).rounded(bits, side)
    }

    /// The root of a positive degree, for x >= 0; exact where it is representable.
    pub(super) fn root(&self, degree: u32, bits: i64, side: Side) -> Self {
        let n = i64::from(degree);
        let least = (n * (bits + 1) - length(&self.mantissa)).max(0);
        let places = least + (self.exponent - least).rem_euclid(n);
        let radicand = scaled(&self.mantissa, places).unsigned_abs();
        let power = usize::try_from(degree).unwrap_or(usize::MAX);
        let mut root = radicand.nth_root(power);
        if side == Side::Above && root.pow(power) != radicand {
            root += 1u8;
        }
        Self::new(IBig::from(root), (self.exponent - places) / n).rounded(bits, side)
    }

    /// The nearest `f64` on the side, infinite where no finite one is.
    pub(super) fn to_f64(&self, side: Side) -> f64 {
        let Some(top) = self.top() else { return 0.0 };
        if top > 1023 {
            return match (side, self.is_negative()) {
                (Side::Below, false) => f64::MAX,
                (Side::Above, true) => f64::MIN,
                (_, false) => f64::INFINITY,
                (_, true) => f64::NEG_INFINITY,
            };
        }
        let unit = (top - 52).max(-1074);
        // At most 2^53 in absolute value: exact, as is the product, unless it rounds up to 2^1024.
        let count = self.at_exponent(unit, side).to_f64().value();
        let unit = u64::try_from(unit + 1074).unwrap_or(0);
        count * f64::from_bits(if unit < 52 { 1 << unit } else { (unit - 51) << 52 })
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;

    fn neg(self) -> Dyadic {
        Dyadic::new(-&self.mantissa, self.exponent)
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        let (sign, other_sign) = (self.mantissa.signum(), other.mantissa.signum());
        let by_absolute_value = || {
            self.top().cmp(&other.top()).then_with(|| {
                let exponent = self.exponent.min(other.exponent);
                let aligned = |x: &Self| scaled(&x.mantissa, x.exponent - exponent).unsigned_abs();
                aligned(self).cmp(&aligned(other))
            })
        };
        sign.cmp(&other_sign)
            .then_with(|| if self.is_negative() { by_absolute_value().reverse() } else { by_absolute_value() })
    }
}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Dyadic {}
