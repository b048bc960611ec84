//! Inverse circular functions, and pi.
//!
//! In: an interval and a precision. Out: the image, rounded outward; none of an inverse sine or
//! cosine where a number is outside [-1, 1], nor of the angle of a box that meets the cut.

use dashu_int::IBig;
use dashu_int::ops::{SquareRoot, UnsignedAbs};

use super::constants::{half_pi, pi};
use super::dyadic::{Dyadic, scaled};
use super::exponential::odd;
use super::fixed::{halvings, odd_series};
use super::{Interval, Precision};

impl Interval {
    /// pi.
    pub fn pi(p: Precision) -> Option<Self> {
        let scale = p.bits() + 2;
        let floor = pi(scale);
        let ceiling = &floor + IBig::ONE;
        Self { lo: Dyadic::new(floor, -scale), hi: Dyadic::new(ceiling, -scale) }.rounded(p)
    }

    fn half_pi(p: Precision) -> Option<Self> {
        Some(Self::pi(p)?.shifted(-1))
    }

    /// The inverse tangent, between -pi/2 and pi/2.
    pub fn atan(&self, p: Precision) -> Option<Self> {
        self.increasing(|x| odd(x, |x| atan_at(x, p)))
    }

    /// The inverse sine; none where a number is outside [-1, 1].
    pub fn asin(&self, p: Precision) -> Option<Self> {
        self.unit()?.increasing(|x| odd(x, |x| asin_at(x, p)))
    }

    /// The inverse cosine, between 0 and pi; none where a number is outside [-1, 1].
    pub fn acos(&self, p: Precision) -> Option<Self> {
        let falling = |x: &Dyadic| Some(acos_at(x, p)?.neg());
        Some(self.unit()?.increasing(falling)?.neg())
    }

    /// The angle in (-pi, pi] of the point (x, y), where `self` is y.
    ///
    /// None where the box holds the origin, or numbers on both sides of the cut y = 0, x < 0.
    pub fn atan2(&self, x: &Self, p: Precision) -> Option<Self> {
        let more = p.more(4);
        if x.is_positive() {
            return self.div(x, more)?.atan(p);
        }
        if self.is_positive() {
            let from_axis = x.div(self, more)?.atan(more)?;
            return Self::half_pi(more)?.sub(&from_axis, p);
        }
        if self.is_negative() {
            return Some(self.neg().atan2(x, p)?.neg());
        }
        if self.lo.is_zero() && x.is_negative() {
            return Self::pi(more)?.add(&self.div(x, more)?.atan(more)?, p);
        }
        None
    }

    /// Itself, where it is within [-1, 1].
    fn unit(&self) -> Option<&Self> {
        (self.lo >= -&Dyadic::ONE && self.hi <= Dyadic::ONE).then_some(self)
    }
}

/// atan x = 2^s atan z, where each step replaces x by x/(1 + sqrt(1 + x^2)); x > 1 by way of 1/x.
///
/// x or 1/x is off by one ulp; a step halves the error at least, and adds 1 for the quotient and
/// 1/4 for the root, so z <= 0.42 is off by less than 3; pi/2 adds one ulp.
fn atan_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let top = x.top()?;
    if 2 * top < -p.bits() - 4 {
        // |atan x - x| <= |x|^3/3 < |x| 2^(2 top + 1): less than an eighth of a unit at either end, so that an argument
        // that is itself an interval, as in an inverse sine, leaves the image a few units wide.
        return Interval::near(x, 2 * top + 1, p);
    }
    let halvings = halvings(p.bits()).max(1);
    let scale = p.bits() + halvings + 16 - top.min(0);
    let one = scaled(&IBig::ONE, scale);
    let large = *x > Dyadic::ONE;
    let mut z = if large {
        scaled(&IBig::ONE, scale - x.exponent) / &x.mantissa
    } else {
        scaled(&x.mantissa, x.exponent + scale)
    };
    let one_squared = scaled(&one, scale);
    for _ in 0..halvings {
        let radicand = (&one_squared + IBig::from(z.sqr())).unsigned_abs();
        z = scaled(&z, scale) / (&one + IBig::from(radicand.sqrt()));
    }
    let (series, error) = odd_series(&z, scale, true);
    let angle = scaled(&series, halvings);
    let error = scaled(&IBig::from(error + 3), halvings) + IBig::ONE;
    let value = if large { half_pi(scale) - angle } else { angle };
    Interval::around(&value, &error, scale, p)
}

/// atan (x / sqrt((1 - x)(1 + x))), for x > 0.
fn asin_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let more = p.more(4);
    let opposite = Interval::point(x.clone());
    opposite.atan2(&adjacent(x, more)?, p)
}

/// From the same triangle if |x| is not small; else pi/2 - asin x, without cancellation.
fn acos_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    if x.top() < Some(-1) {
        let more = p.more(4);
        return Interval::half_pi(more)?.sub(&odd(x, |x| asin_at(x, more))?, p);
    }
    adjacent(x, p.more(4))?.atan2(&Interval::point(x.clone()), p)
}

/// sqrt((1 - x)(1 + x)).
fn adjacent(x: &Dyadic, p: Precision) -> Option<Interval> {
    let (x, one) = (Interval::point(x.clone()), Interval::point(Dyadic::ONE));
    one.sub(&x, p)?.mul(&one.add(&x, p)?, p)?.sqrt(p)
}
