//! Series and argument reduction on integers scaled by 2^scale.
//!
//! In: an integer X for the number x = X 2^-scale, and the scale. Out: integers of the same scale.
//! Holds: every result is within the stated number of ulps of the exact value; a shift or quotient
//! of integers is off by less than one. Method: Brent and Zimmermann, 2010, sections 4.3 (argument
//! reduction) and 4.4 (power series).

use dashu_int::IBig;
use dashu_int::ops::DivRemEuclid;

use super::dyadic::{Dyadic, length, scaled};

/// The number of halvings of an argument before a series is summed, for the least total work.
pub(super) fn halvings(bits: i64) -> i64 {
    bits.isqrt() / 2
}

/// The multiple k and the rest R with |x - k c - R 2^-scale| < 2 ulps and |R| about c/2 or less.
///
/// The constant c >= 0.69 is given as floor(c 2^scale). With x < 2^(t+1), |k| < 2^(t+2); at the
/// scale longer by t+3 bits, x is off by 1 and k c by |k|, together less than 2^(t+3): one ulp
/// after the shift, which adds another.
pub(super) fn reduce(x: &Dyadic, constant: fn(i64) -> IBig, scale: i64) -> (IBig, IBig) {
    let guard = x.top().unwrap_or(0).max(0) + 3;
    let value = scaled(&x.mantissa, x.exponent + scale + guard);
    let unit = constant(scale + guard);
    let doubled: IBig = &unit << 1;
    let (multiple, _) = ((&value << 1) + &unit).div_rem_euclid(&doubled);
    let rest = value - &multiple * unit;
    (multiple, scaled(&rest, -guard))
}

/// The sums of t^j/j! over j = 0, 1, 2, 3 modulo 4, for |t| <= 1/2, and the number of terms n.
///
/// A term is off by half the error of the one before it and 3/2, so by at most 3; the first that is
/// left out, found at most one ulp, is at most 4, and those after it at most a quarter of the one
/// before. In all less than 3 n + 6 ulps.
pub(super) fn exponential_series(t: &IBig, scale: i64) -> ([IBig; 4], i64) {
    let mut sums = [IBig::ZERO, IBig::ZERO, IBig::ZERO, IBig::ZERO];
    let mut term = scaled(&IBig::ONE, scale);
    let mut n = 0;
    while length(&term) > 1 {
        for sum in &mut sums {
            *sum += &term;
            n += 1;
            term = scaled(&(term * t), -scale) / n;
        }
    }
    (sums, n)
}

/// The sum of (+-1)^j z^(2j+1)/(2j+1), for |z| <= 1/2, and a bound of its error in ulps.
///
/// A power is off by a quarter of the error of the one before it and 3/2, so by at most 2, and a
/// term by at most 2; the first power found at most one ulp is at most 3, and the terms after it
/// are together less than 1.
pub(super) fn odd_series(z: &IBig, scale: i64, alternating: bool) -> (IBig, i64) {
    let mut square = scaled(&z.sqr().into(), -scale);
    if alternating {
        square = -square;
    }
    let mut power = z.clone();
    let mut sum = z.clone();
    let mut odd = 1;
    while length(&power) > 1 {
        power = scaled(&(power * &square), -scale);
        odd += 2;
        sum += &power / odd;
    }
    (sum, odd + 2)
}
