//! A judge of formulas in floating point, independent of the algebra.

use std::collections::BTreeMap;

use pebo_cas::graph::function::Value;
use pebo_gen::model::formula::{Formula, Operator, Term};

use super::draw::Draw;

/// A point: symbols with values.
pub(crate) type Point = BTreeMap<&'static str, f64>;

/// The symbols of the cases.
pub(crate) const NAMES: [&str; 10] = ["x", "y", "z", "a", "b", "p", "q", "r", "t", "w"];

/// The verdict of sampling.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum SampledSign {
    /// Far from zero at some point, by much more than rounding.
    Differs,
    /// Zero up to rounding wherever it has a value.
    Vanishes,
    /// Neither is clear.
    Unclear,
}

/// A point at which the facts of all cases hold.
pub(crate) fn point(draw: &mut Draw) -> Point {
    let range = |name: &str| match name {
        "p" | "q" | "r" => (0.05, 2.5),
        "t" => (-0.95, 0.95),
        "w" => (0.05, 1.5),
        _ => (-2.0, 2.5),
    };
    NAMES
        .iter()
        .map(|name| {
            let (low, high) = range(name);
            (*name, draw.between(low, high))
        })
        .collect()
}

/// Evaluates at random points.
pub(crate) fn sample(formula: &Formula, draw: &mut Draw) -> SampledSign {
    let mut values = 0;
    let mut small = 0;
    for _ in 0..40 {
        let (value, error) = value(formula, &point(draw));
        if !value.is_finite() || !error.is_finite() {
            continue;
        }
        values += 1;
        if differs((value, error)) {
            return SampledSign::Differs;
        }
        if value.abs() <= 1e3 * error && error < 1e-4 {
            small += 1;
        }
    }
    if values >= 3 && small * 2 > values { SampledSign::Vanishes } else { SampledSign::Unclear }
}

/// The value is not zero, by much more than its rounding error.
pub(crate) fn differs((value, error): (f64, f64)) -> bool {
    value.is_finite() && value.abs() > 1e3 * error + 1e-9
}

/// The value as written with a bound for its rounding error, to first order.
pub(crate) fn value(formula: &Formula, point: &Point) -> (f64, f64) {
    let at = |f: &Formula| value(f, point);
    let (exact, carried) = match &formula.term {
        Term::Number(decimal) => return (decimal.to_f64(), 0.0),
        Term::Name(name) => return (point.get(name.as_str()).copied().unwrap_or(std::f64::consts::PI), 0.0),
        // Random formulas have no tables.
        Term::Estimate(_) | Term::Table(..) => (f64::NAN, 0.0),
        Term::Negative(operand) => {
            let (a, e) = at(operand);
            return (-a, e);
        }
        Term::Binary(operator, left, right) => {
            let ((a, e), (b, d)) = (at(left), at(right));
            match operator {
                Operator::Add => (a + b, e + d),
                Operator::Subtract => (a - b, e + d),
                Operator::Multiply => (a * b, a.abs() * d + b.abs() * e + d * e),
                Operator::Divide => (a / b, (e + (a / b).abs() * d) / (b.abs() - d).max(0.0)),
                // An integer power is its own case in powf, whatever the sign of the base.
                Operator::Power => both(f64::powf, (a, e), (b, d)),
            }
        }
        Term::Call(function, arguments) => {
            let row = function.row();
            match row.value {
                Value::Unary(f) => {
                    let (a, e) = at(&arguments[0]);
                    (f(a), spread(f, a, e))
                }
                Value::Binary(f) => both(f, at(&arguments[0]), at(&arguments[1])),
                Value::Tabulated(_) => (f64::NAN, 0.0),
            }
        }
    };
    (exact, carried + exact.abs() * 4.0 * f64::EPSILON)
}

/// The variation of a function over an error; not finite where that leaves its domain.
fn spread(f: fn(f64) -> f64, a: f64, error: f64) -> f64 {
    let reach = 2.0 * error + 4.0 * f64::EPSILON * a.abs();
    (f(a + reach) - f(a)).abs().max((f(a - reach) - f(a)).abs())
}

fn both(f: fn(f64, f64) -> f64, (a, e): (f64, f64), (b, d): (f64, f64)) -> (f64, f64) {
    let middle = f(a, b);
    let mut error: f64 = 0.0;
    for (down, over) in [(e, d), (-e, d), (e, -d), (-e, -d)] {
        let moved = (f(a + 2.0 * down, b + 2.0 * over) - middle).abs();
        if moved.is_nan() {
            return (middle, f64::INFINITY);
        }
        error = error.max(moved);
    }
    (middle, error)
}
