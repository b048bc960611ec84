//! Exponential, logarithm, and the hyperbolic functions with their inverses.
//!
//! In: an interval and a precision. Out: the image, rounded outward; none of a logarithm where a
//! number is not positive, of an inverse outside its domain, nor of an exponential at 2^20 or more.

use dashu_int::IBig;
use dashu_int::ops::{SquareRoot, UnsignedAbs};

use super::constants::log_two;
use super::dyadic::{Dyadic, Side, length, scaled};
use super::fixed::{exponential_series, halvings, odd_series, reduce};
use super::{Interval, Precision};

/// Arguments of the exponential are less than 2^`LARGEST`.
const LARGEST: i64 = 20;

impl Interval {
    /// e^a; none where an argument is 2^20 or more.
    pub fn exp(&self, p: Precision) -> Option<Self> {
        self.increasing(|x| exp_at(x, p))
    }

    /// The natural logarithm; none where a number is not positive.
    pub fn log(&self, p: Precision) -> Option<Self> {
        if !self.is_positive() {
            return None;
        }
        self.increasing(|x| log_at(x, p))
    }

    /// The hyperbolic sine; none where an argument is 2^20 or more.
    pub fn sinh(&self, p: Precision) -> Option<Self> {
        self.increasing(|x| odd(x, |x| sinh_at(x, p)))
    }

    /// The hyperbolic cosine; none where an argument is 2^20 or more.
    pub fn cosh(&self, p: Precision) -> Option<Self> {
        self.abs().increasing(|x| cosh_at(x, p))
    }

    /// The hyperbolic tangent.
    pub fn tanh(&self, p: Precision) -> Option<Self> {
        self.increasing(|x| odd(x, |x| tanh_at(x, p)))
    }

    /// The inverse hyperbolic sine.
    pub fn asinh(&self, p: Precision) -> Option<Self> {
        self.increasing(|x| odd(x, |x| asinh_at(x, p)))
    }

    /// The inverse hyperbolic cosine, not negative; none where a number is less than 1.
    pub fn acosh(&self, p: Precision) -> Option<Self> {
        if self.lo < Dyadic::ONE {
            return None;
        }
        self.increasing(|x| acosh_at(x, p))
    }

    /// The inverse hyperbolic tangent; none where a number is not strictly between -1 and 1.
    pub fn atanh(&self, p: Precision) -> Option<Self> {
        if self.lo <= -&Dyadic::ONE || self.hi >= Dyadic::ONE {
            return None;
        }
        self.increasing(|x| odd(x, |x| atanh_at(x, p)))
    }

    /// Between x - |x| 2^k and x + |x| 2^k.
    pub(super) fn near(x: &Dyadic, k: i64, p: Precision) -> Option<Self> {
        let radius = x.abs().shifted(k);
        Self::new(x.sum(&-&radius, p.bits(), Side::Below), x.sum(&radius, p.bits(), Side::Above))
    }
}

/// An odd function from its values at positive arguments.
pub(super) fn odd(x: &Dyadic, at: impl Fn(&Dyadic) -> Option<Interval>) -> Option<Interval> {
    if x.is_zero() {
        Some(Interval::point(Dyadic::ZERO))
    } else if x.is_negative() {
        Some(at(&-x)?.neg())
    } else {
        at(x)
    }
}

/// e^x = 2^k (e^(r/2^s))^(2^s), with x = k log 2 + r.
///
/// |r| < 0.36 is off by 2 ulps, so r/2^s by less than 3 and its exponential by 5: with the series,
/// 3 n + 11. A squaring of y multiplies the error by 2 y and adds less than 2; the product of all
/// 2 y is less than 2^s e^0.36 < 1.5 2^s. So the error is less than 2^(s+1) (3 n + 13).
fn exp_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    match x.top() {
        None => return Some(Interval::point(Dyadic::ONE)),
        Some(top) if top >= LARGEST && x.is_positive() => return None,
        Some(top) if top >= LARGEST => {
            // e^x < 2^x, as x < 0
            return Interval::new(Dyadic::ZERO, Dyadic::power_of_two(-(1 << LARGEST)));
        }
        _ => {}
    }
    let halvings = halvings(p.bits());
    let scale = p.bits() + halvings + 20;
    let (k, rest) = reduce(x, log_two, scale);
    let (sums, n) = exponential_series(&scaled(&rest, -halvings), scale);
    let mut y: IBig = sums.into_iter().sum();
    for _ in 0..halvings {
        y = scaled(&y.sqr().into(), -scale);
    }
    let error = scaled(&IBig::from(3 * n + 13), halvings + 1);
    Interval::around(&y, &error, scale - i64::try_from(&k).ok()?, p)
}

/// e^x - 1 for x > 0, without cancellation: for x < 1 it is x + d with 0 < d < x^2.
fn exp_minus_one_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let top = x.top().unwrap_or(0).min(0);
    if top < -p.bits() {
        return Interval::near(x, top + 1, p);
    }
    let lost = u32::try_from(2 - top).unwrap_or(0);
    exp_at(x, p.more(lost))?.sub(&Interval::point(Dyadic::ONE), p)
}

/// (d + d/(d+1))/2 for d = e^x - 1.
fn sinh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let more = p.more(4);
    let d = exp_minus_one_at(x, more)?;
    let falling = d.div(&d.add(&Interval::point(Dyadic::ONE), more)?, more)?;
    d.add(&falling, more)?.shifted(-1).rounded(p)
}

/// (e + 1/e)/2 for e = e^x.
fn cosh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let more = p.more(4);
    let e = exp_at(x, more)?;
    let falling = Interval::point(Dyadic::ONE).div(&e, more)?;
    e.add(&falling, more)?.shifted(-1).rounded(p)
}

/// d/(d+2) for d = e^(2x) - 1; and 1 > tanh x > 1 - 2 e^(-2x) > 1 - 2^-x for large x.
fn tanh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    const FLAT: i64 = LARGEST - 2;
    if x.top() >= Some(FLAT) {
        let gap = Dyadic::power_of_two(-(1 << FLAT));
        return Interval::new(Dyadic::ONE.sum(&-&gap, p.bits(), Side::Below), Dyadic::ONE);
    }
    let more = p.more(4);
    let d = exp_minus_one_at(&x.shifted(1), more)?;
    let quotient = d.div(&d.add(&Interval::point(Dyadic::power_of_two(1)), more)?, more)?;
    Some(quotient.rounded(p)?.within_unit())
}

/// log(1 + d) for d > 0, to as many digits of its own as `d` has: it is at least d/2 where d < 1.
fn log_of_one_more(d: &Interval, p: Precision) -> Option<Interval> {
    let lost = d.lo.top().map_or(0, |top| 2 - top.min(0));
    d.add(&Interval::point(Dyadic::ONE), p.more(u32::try_from(lost).ok()?))?.log(p)
}

/// log(1 + d) with d = x + x^2/(1 + sqrt(1 + x^2)), for x > 0; it is less than x, and x - asinh x less than x^3.
fn asinh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let top = x.top()?;
    if 2 * top < -p.bits() - 4 {
        return Interval::near(x, 2 * top + 2, p);
    }
    let more = p.more(8);
    let (x, one) = (Interval::point(x.clone()), Interval::point(Dyadic::ONE));
    let square = x.mul(&x, more)?;
    let root = square.add(&one, more)?.sqrt(more)?;
    let d = x.add(&square.div(&root.add(&one, more)?, more)?, more)?;
    log_of_one_more(&d, more)?.rounded(p)
}

/// log(1 + d) with d = e + sqrt(e (e + 2)) for e = x - 1.
fn acosh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let more = p.more(8);
    let e = Interval::point(x.clone()).sub(&Interval::point(Dyadic::ONE), more)?;
    if e.lo.is_zero() {
        return (e.hi.is_zero()).then(|| Interval::point(Dyadic::ZERO));
    }
    let root = e.mul(&e.add(&Interval::point(Dyadic::power_of_two(1)), more)?, more)?.sqrt(more)?;
    log_of_one_more(&e.add(&root, more)?, more)?.rounded(p)
}

/// log(1 + d)/2 with d = 2 x/(1 - x), for 0 < x < 1; atanh x - x is less than x^3 for x < 1/2.
fn atanh_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let top = x.top()?;
    if 2 * top < -p.bits() - 4 {
        return Interval::near(x, 2 * top + 2, p);
    }
    let more = p.more(8);
    let below = Interval::point(Dyadic::ONE).sub(&Interval::point(x.clone()), more)?;
    let d = Interval::point(x.shifted(1)).div(&below, more)?;
    log_of_one_more(&d, more)?.shifted(-1).rounded(p)
}

/// log x = k log 2 + 2^(s+1) atanh z, with y the 2^s-th root of x 2^-k and z = (y - 1)/(y + 1).
///
/// x 2^-k in [3/4, 3/2) is off by one ulp; a root multiplies the error by less than 0.6 and adds 1,
/// so y is off by less than 3, z by less than 0.66 of it and 1, so by 3, and atanh z by 4; the
/// multiple of log 2 by |k|.
fn log_at(x: &Dyadic, p: Precision) -> Option<Interval> {
    let top = x.top()?;
    let upper_half = scaled(&x.mantissa, 2 - length(&x.mantissa)) == IBig::from(3);
    let k = top + i64::from(upper_half);
    let reduced = x.shifted(-k);
    let below_one = if k == 0 {
        let ones = scaled(&IBig::ONE, -x.exponent);
        match Dyadic::new(&x.mantissa - ones, x.exponent).top() {
            None => return Some(Interval::point(Dyadic::ZERO)),
            Some(distance) => -distance,
        }
    } else {
        0
    };
    let halvings = halvings(p.bits()) / 2 + 1;
    let scale = p.bits() + below_one + halvings + 20;
    let one = scaled(&IBig::ONE, scale);
    let mut y = scaled(&reduced.mantissa, reduced.exponent + scale);
    for _ in 0..halvings {
        y = scaled(&y, scale).unsigned_abs().sqrt().into();
    }
    let z = scaled(&(&y - &one), scale) / (y + one);
    let (series, error) = odd_series(&z, scale, false);
    let value = scaled(&series, halvings + 1) + log_two(scale) * k;
    let error = scaled(&IBig::from(error + 4), halvings + 1) + k.abs();
    Interval::around(&value, &error, scale, p)
}
