//! Helpers of the tests: functions, their arguments, and comparisons of intervals.

mod cases;
mod identities;
mod properties;

use proptest::prelude::*;

use super::{Interval, Precision};
use crate::Rational;

/// A function of one argument, and its counterpart in floating point.
struct Unary {
    name: &'static str,
    enclose: fn(&Interval, Precision) -> Option<Interval>,
    value: fn(f64) -> f64,
    /// Arguments strictly between these are in the domain.
    domain: (i64, i64),
}

const FUNCTIONS: [Unary; 18] = [
    row("sin", Interval::sin, f64::sin, (-1000, 1000)),
    row("cos", Interval::cos, f64::cos, (-1000, 1000)),
    row("tan", Interval::tan, f64::tan, (-1, 1)),
    row("asin", Interval::asin, f64::asin, (-1, 1)),
    row("acos", Interval::acos, f64::acos, (-1, 1)),
    row("atan", Interval::atan, f64::atan, (-1000, 1000)),
    row("sinh", Interval::sinh, f64::sinh, (-300, 300)),
    row("cosh", Interval::cosh, f64::cosh, (-300, 300)),
    row("tanh", Interval::tanh, f64::tanh, (-300, 300)),
    row("asinh", Interval::asinh, f64::asinh, (-1000, 1000)),
    row("acosh", Interval::acosh, |x| (x - 1.0 + ((x - 1.0) * (x + 1.0)).sqrt()).ln_1p(), (1, 1000)),
    row("atanh", Interval::atanh, |x| (0.5 * (2.0 * x.abs() / (1.0 - x.abs())).ln_1p()).copysign(x), (-1, 1)),
    row("exp", Interval::exp, f64::exp, (-300, 300)),
    row("log", Interval::log, f64::ln, (0, 1000)),
    row("sqrt", Interval::sqrt, f64::sqrt, (0, 1000)),
    row("abs", |x, _| Some(x.abs()), f64::abs, (-1000, 1000)),
    row("sat", |x, _| Some(x.sat()), |x| x.clamp(-1.0, 1.0), (-3, 3)),
    row("cube", |x, p| x.powi(3, p), |x| x * x * x, (-1000, 1000)),
];

const fn row(
    name: &'static str,
    enclose: fn(&Interval, Precision) -> Option<Interval>,
    value: fn(f64) -> f64,
    domain: (i64, i64),
) -> Unary {
    Unary { name, enclose, value, domain }
}

impl Unary {
    /// The point that divides the domain as 1 : 2^20/part - 1; a dyadic number, as is its `f64`.
    fn argument(&self, part: i64) -> Rational {
        let (from, to) = self.domain;
        ratio(from * (1 << 20) + part * (to - from), 1 << 20)
    }
}

/// Parts of a domain, the ends excluded; some of them next to the ends.
fn part() -> impl Strategy<Value = i64> {
    prop_oneof![4 => 1_i64..(1 << 20), 1 => 1_i64..9, 1 => (1_i64..9).prop_map(|n| (1 << 20) - n)]
}

/// Rational numbers from very small to very large.
fn wide() -> impl Strategy<Value = Rational> {
    let power = |n: i64, k: i32| Some(&ratio(n, 1) * &ratio(2, 1).pow(k)?);
    prop_oneof![
        4 => (-1000_i64..1000, 1_i64..1000).prop_map(|(n, d)| ratio(n, d)),
        1 => (-9_i64..9, -400_i32..400).prop_filter_map("too large", move |(n, k)| power(n, k)),
    ]
}

fn ratio(n: i64, d: i64) -> Rational {
    Rational::new(n, d).unwrap_or(Rational::ZERO)
}

fn bits(bits: u32) -> Precision {
    Precision::new(bits)
}

fn point(q: &Rational, precision: u32) -> Interval {
    Interval::from_rational(q, bits(precision)).expect("a rational number has an enclosure")
}

fn number(n: i64) -> Interval {
    point(&ratio(n, 1), 128)
}

/// Between two rational numbers.
fn between(a: &Rational, b: &Rational, precision: u32) -> Interval {
    point(a, precision).hull(&point(b, precision))
}

fn contains(whole: &Interval, part: &Interval) -> bool {
    whole.lo <= part.lo && part.hi <= whole.hi
}

fn meets(a: &Interval, b: &Interval) -> bool {
    a.lo <= b.hi && b.lo <= a.hi
}
