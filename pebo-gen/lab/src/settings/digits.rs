//! Rounds derived floating-point numbers to exact ones for settings.

use pebo_cas::Rational;

/// A number in four digits, if it is within the range of computation.
pub(super) fn rounded(value: f64) -> Option<Rational> {
    const RANGE: std::ops::Range<f64> = 1e-100..1e100;
    if value == 0.0 {
        return Some(Rational::from(0));
    }
    RANGE.contains(&value.abs()).then(|| Rational::from_decimal(&format!("{value:.3e}")).ok())?
}
