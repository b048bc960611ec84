//! Sine and cosine of one number, and the quarter turn in which it lies.
//!
//! In: a dyadic angle and a precision. Out: enclosures of both, each a few units of that precision
//! wide relative to its own value, also next to a multiple of pi/2.

use dashu_int::IBig;

use super::constants::half_pi;
use super::dyadic::{Dyadic, Side, length, scaled};
use super::fixed::{exponential_series, halvings, reduce};
use super::{Interval, Precision};

/// Angles of 2^`LARGEST` and more are not reduced.
const LARGEST: i64 = 1 << 14;

/// Scales tried for a remainder next to zero; if the last fails, the enclosure is wider.
const ATTEMPTS: usize = 4;

/// Enclosures of an angle's sine, cosine and quarter turn.
pub(super) struct Angle {
    pub(super) sin: Interval,
    pub(super) cos: Interval,
    /// The least and the greatest value that floor(x / (pi/2)) may have.
    pub(super) quarters: (IBig, IBig),
}

impl Angle {
    /// None where the angle is too large.
    pub(super) fn at(x: &Dyadic, p: Precision) -> Option<Self> {
        let Some(top) = x.top() else {
            return Some(Self {
                sin: Interval::point(Dyadic::ZERO),
                cos: Interval::point(Dyadic::ONE),
                quarters: (IBig::ZERO, IBig::ZERO),
            });
        };
        if top >= LARGEST {
            None
        } else if 2 * top < -p.bits() {
            Self::tiny(x, top, p)
        } else {
            Self::reduced(x, p)
        }
    }

    /// With |x| < 2^(top+1): |sin x - x| <= |x|^3/6 < |x| 2^(2 top), and
    /// 1 - cos x <= x^2/2 < 2^(2 top + 1).
    fn tiny(x: &Dyadic, top: i64, p: Precision) -> Option<Self> {
        let gap = Dyadic::power_of_two(2 * top + 1);
        let quarter = if x.is_negative() { IBig::NEG_ONE } else { IBig::ZERO };
        Some(Self {
            sin: Interval::near(x, 2 * top, p)?,
            cos: Interval::new(Dyadic::ONE.sum(&-&gap, p.bits(), Side::Below), Dyadic::ONE)?,
            quarters: (quarter.clone(), quarter),
        })
    }

    /// e^(i x) = i^k (e^(i r/2^s))^(2^s), with x = k pi/2 + r.
    ///
    /// |r| < 0.8 is off by 2 ulps, so r/2^s and its exponential by less than 3: with the series,
    /// 3 n + 9. A squaring of a number on the unit circle doubles the error and adds less than 3:
    /// two roundings and the square of the error. So the error is less than 2^s (3 n + 12).
    fn reduced(x: &Dyadic, p: Precision) -> Option<Self> {
        let halvings = halvings(p.bits());
        // The smaller of sine and cosine is about as small as r: that many bits more.
        let wanted = p.bits() + halvings + 16;
        let mut scale = wanted + 4;
        let (mut k, mut rest) = reduce(x, half_pi, scale);
        for _ in 1..ATTEMPTS {
            let lost = wanted - length(&rest);
            if lost <= 0 {
                break;
            }
            scale += lost;
            (k, rest) = reduce(x, half_pi, scale);
        }
        let (sums, n) = exponential_series(&scaled(&rest, -halvings), scale);
        let [even, odd, even_negated, odd_negated] = sums;
        let (mut cos, mut sin) = (even - even_negated, odd - odd_negated);
        for _ in 0..halvings {
            let product = &cos * &sin;
            cos = scaled(&((&cos + &sin) * (&cos - &sin)), -scale);
            sin = scaled(&product, 1 - scale);
        }
        let error = scaled(&IBig::from(3 * n + 12), halvings);
        let cos = Interval::around(&cos, &error, scale, p)?.within_unit();
        let sin = Interval::around(&sin, &error, scale, p)?.within_unit();
        let (sin, cos) = match modulo_four(&k) {
            0 => (sin, cos),
            1 => (cos, sin.neg()),
            2 => (sin.neg(), cos.neg()),
            _ => (cos.neg(), sin),
        };
        // Within 2 ulps of the multiple the angle may be on either side of it.
        let before = &k - IBig::ONE;
        let quarters = if rest > IBig::from(2) {
            (k.clone(), k)
        } else if rest < IBig::from(-2) {
            (before.clone(), before)
        } else {
            (before, k)
        };
        Some(Self { sin, cos, quarters })
    }
}

/// The remainder 0, 1, 2 or 3.
pub(super) fn modulo_four(k: &IBig) -> u8 {
    k & 3u8
}
