//! Integer powers, roots, and rational powers.
//!
//! In: an interval, an exponent and a precision. Out: the image, rounded outward, and exact where
//! the powers and roots are; none where a number has no such power.

use super::dyadic::{Dyadic, Side};
use super::{Interval, Precision};
use crate::Rational;

/// Roots of higher degree, and powers of larger exponent before a root, go by way of the logarithm.
const LARGEST_DEGREE: u32 = 16;
const LARGEST_POWER: i64 = 1 << 20;

impl Interval {
    /// a^n, with a^0 = 1; none where n < 0 and a contains zero.
    pub fn powi(&self, n: i64, p: Precision) -> Option<Self> {
        // Every rounding is raised to the powers after it: less than 2 n units together.
        let more = p.more(n.unsigned_abs().checked_ilog2().unwrap_or(0) + 4);
        let power = if n % 2 == 0 {
            self.abs().power_of_absolute(n.unsigned_abs(), more)?
        } else {
            self.increasing(|x| {
                let power = Self::point(x.abs()).power_of_absolute(n.unsigned_abs(), more)?;
                Some(if x.is_negative() { power.neg() } else { power })
            })?
        };
        if n < 0 {
            return Self::point(Dyadic::ONE).div(&power, p);
        }
        power.rounded(p)
    }

    /// By repeated squaring from the highest bit, for a >= 0.
    fn power_of_absolute(&self, n: u64, p: Precision) -> Option<Self> {
        let mut power = Self::point(Dyadic::ONE);
        for bit in (0..u64::BITS - n.leading_zeros()).rev() {
            power = power.mul(&power, p)?;
            if n >> bit & 1 == 1 {
                power = power.mul(self, p)?;
            }
        }
        Some(power)
    }

    /// The non-negative square root; none where a number is negative.
    pub fn sqrt(&self, p: Precision) -> Option<Self> {
        self.root(2, p)
    }

    /// The root of a degree from 1 to `LARGEST_DEGREE`; none where a number is negative.
    fn root(&self, degree: u32, p: Precision) -> Option<Self> {
        if self.lo.is_negative() {
            return None;
        }
        Self::new(self.lo.root(degree, p.bits(), Side::Below), self.hi.root(degree, p.bits(), Side::Above))
    }

    /// a^q for q not an integer, a >= 0 and, where q < 0, a > 0; as `powi` for an integer.
    pub fn pow(&self, exponent: &Rational, p: Precision) -> Option<Self> {
        if let Some(n) = exponent.to_i64() {
            return self.powi(n, p);
        }
        if self.lo.is_negative() {
            return None;
        }
        let more = p.more(4);
        let absolute = exponent.abs();
        let power = match radical(&absolute) {
            Some((n, degree)) => self.powi(n, more)?.root(degree, more)?,
            None => self.increasing(|x| power_by_logarithm(x, &absolute, more))?,
        };
        if exponent.is_negative() {
            return Self::point(Dyadic::ONE).div(&power, p);
        }
        power.rounded(p)
    }
}

/// Numerator and denominator, where both are small.
fn radical(exponent: &Rational) -> Option<(i64, u32)> {
    let power = exponent.numerator().to_i64().filter(|n| *n <= LARGEST_POWER)?;
    let degree = exponent.denominator().to_i64().and_then(|d| u32::try_from(d).ok())?;
    (degree <= LARGEST_DEGREE).then_some((power, degree))
}

/// e^(q log x), for x >= 0 and q > 0; the bits before the point of q log x are lost, at most 20.
fn power_by_logarithm(x: &Dyadic, exponent: &Rational, p: Precision) -> Option<Interval> {
    if x.is_zero() {
        return Some(Interval::point(Dyadic::ZERO));
    }
    let more = p.more(24);
    let log = Interval::point(x.clone()).log(more)?;
    Interval::from_rational(exponent, more)?.mul(&log, more)?.exp(p)
}
