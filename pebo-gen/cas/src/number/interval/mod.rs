//! Rigorous enclosures of real numbers.
//!
//! In: exact rationals and a working precision in bits. Out: closed intervals with dyadic end
//! points. Holds: the result of an operation contains the exact value of that operation at every
//! point of its operands, or there is no result (`None`): the operation is undefined somewhere on
//! the operands, or may be, or is too large to be represented. At a point the interval is a few
//! units of the working precision wide, so more bits decide the sign of any value that is not zero.
//!
//! The functions work on integers scaled by a power of two, with a bound in units of the last place
//! (ulps) proved beside each; the method is that of R. Brent and P. Zimmermann, *Modern Computer
//! Arithmetic*, Cambridge University Press, 2010, chapter 4.

mod angle;
mod arithmetic;
mod constants;
mod dyadic;
mod exponential;
mod fixed;
mod inverse;
mod piecewise;
mod power;
mod trigonometric;

#[cfg(test)]
mod tests;

use core::fmt;

use dashu_int::IBig;

use crate::{Integer, Rational};
use dyadic::{Dyadic, Side};

/// Absolute values above 2^`RANGE` are refused, those below 2^-`RANGE` widened to reach zero.
const RANGE: i64 = 1 << 40;

/// The number of significant bits of an end point.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Precision(u32);

impl Precision {
    const LEAST: u32 = 16;
    const MOST: u32 = 1 << 16;

    /// So many bits, but at least 16 and at most 65536.
    #[must_use]
    pub const fn new(bits: u32) -> Self {
        if bits < Self::LEAST {
            Self(Self::LEAST)
        } else if bits > Self::MOST {
            Self(Self::MOST)
        } else {
            Self(bits)
        }
    }

    /// Steps of work that a function takes at this precision.
    pub(crate) fn steps(self) -> u64 {
        const STEPS_OF_A_WORD: u64 = 100;
        STEPS_OF_A_WORD * u64::from(self.0.div_ceil(64))
    }

    fn bits(self) -> i64 {
        self.0.into()
    }

    /// With guard bits, for an intermediate result.
    const fn more(self, guard: u32) -> Self {
        Self(self.0.saturating_add(guard))
    }
}

/// A closed interval of real numbers, not empty.
#[derive(Clone, PartialEq, Eq, Debug)]
#[must_use = "arithmetic returns a new interval"]
pub struct Interval {
    /// At most `hi`.
    lo: Dyadic,
    hi: Dyadic,
}

impl Interval {
    /// An enclosure of a rational number.
    pub fn from_rational(q: &Rational, p: Precision) -> Option<Self> {
        let exact = |integer: &Integer| Some(Self::point(Dyadic::integer(integer)?));
        exact(&q.numerator())?.div(&exact(&q.denominator())?, p)
    }

    fn point(x: Dyadic) -> Self {
        Self { lo: x.clone(), hi: x }
    }

    /// From end points in order, brought into the range of exponents.
    fn new(lo: Dyadic, hi: Dyadic) -> Option<Self> {
        debug_assert!(lo <= hi);
        let limited = |x: Dyadic, side: Side| match x.top() {
            Some(top) if top > RANGE => None,
            Some(top) if top < -RANGE => Some(match (side, x.is_negative()) {
                (Side::Below, true) => -&Dyadic::power_of_two(-RANGE),
                (Side::Above, false) => Dyadic::power_of_two(-RANGE),
                _ => Dyadic::ZERO,
            }),
            _ => Some(x),
        };
        Some(Self { lo: limited(lo, Side::Below)?, hi: limited(hi, Side::Above)? })
    }

    /// The numbers within `error` of `value`, both in units of 2^-scale.
    fn around(value: &IBig, error: &IBig, scale: i64, p: Precision) -> Option<Self> {
        Self::new(
            Dyadic::new(value - error, -scale).rounded(p.bits(), Side::Below),
            Dyadic::new(value + error, -scale).rounded(p.bits(), Side::Above),
        )
    }

    fn rounded(self, p: Precision) -> Option<Self> {
        Self::new(self.lo.rounded(p.bits(), Side::Below), self.hi.rounded(p.bits(), Side::Above))
    }

    /// The image under a non-decreasing function, from its enclosures at points.
    fn increasing(&self, at: impl Fn(&Dyadic) -> Option<Self>) -> Option<Self> {
        if self.is_point() {
            return at(&self.lo);
        }
        Self::new(at(&self.lo)?.lo, at(&self.hi)?.hi)
    }

    /// The part between -1 and 1, of an interval that meets it.
    fn within_unit(self) -> Self {
        let minus_one = -&Dyadic::ONE;
        Self { lo: self.lo.max(minus_one), hi: self.hi.min(Dyadic::ONE) }
    }

    fn is_point(&self) -> bool {
        self.lo == self.hi
    }

    /// The smallest interval that contains both.
    pub fn hull(&self, other: &Self) -> Self {
        Self { lo: self.lo.clone().min(other.lo.clone()), hi: self.hi.clone().max(other.hi.clone()) }
    }

    /// True if zero is among the numbers.
    pub fn contains_zero(&self) -> bool {
        !self.is_positive() && !self.is_negative()
    }

    /// True if all numbers are greater than zero.
    pub fn is_positive(&self) -> bool {
        self.lo.is_positive()
    }

    /// True if all numbers are less than zero.
    pub fn is_negative(&self) -> bool {
        self.hi.is_negative()
    }

    /// True if a rational number is not among the numbers.
    pub fn excludes(&self, q: &Rational) -> bool {
        let parts = Dyadic::integer(&q.numerator()).zip(Dyadic::integer(&q.denominator()));
        parts.is_some_and(|(n, d)| self.lo.product(&d) > n || self.hi.product(&d) < n)
    }

    /// A rational number that is no less than any of the multiples; none if that is out of range.
    pub fn above_multiples(&self, factor: &Rational) -> Option<Rational> {
        let end = if factor.is_negative() { self.lo() } else { self.hi() };
        Some(&Rational::from_f64_exact(end)? * factor)
    }

    /// The greatest `f64` that is at most every number.
    pub fn lo(&self) -> f64 {
        self.lo.to_f64(Side::Below)
    }

    /// The least `f64` that is at least every number.
    pub fn hi(&self) -> f64 {
        self.hi.to_f64(Side::Above)
    }

    /// The distance of the end points, rounded up.
    pub fn width(&self) -> f64 {
        self.extent().to_f64(Side::Above)
    }

    fn extent(&self) -> Dyadic {
        self.hi.sum(&-&self.lo, 64, Side::Above)
    }
}

/// The midpoint to twelve digits, and the radius unless it is zero.
impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let middle = self.lo.sum(&self.hi, 64, Side::Below).shifted(-1);
        write!(f, "{:.11e}", middle.to_f64(Side::Below))?;
        if self.is_point() {
            return Ok(());
        }
        write!(f, " +- {:.1e}", self.extent().shifted(-1).to_f64(Side::Above))
    }
}
