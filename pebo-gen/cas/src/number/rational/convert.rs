//! Rational numbers from decimal text and from machine numbers, and back.
//!
//! Text and `f64` convert exactly; the way back to `f64` rounds once, to nearest, ties to even.

use std::fmt;

use super::Repr;
use crate::{Integer, Rational};

/// Longer numerals, and larger exponents of ten, are refused: a few characters must not cost
/// gigabytes. Every finite `f64` is well inside.
const MAX_DECIMALS: usize = 5_000;

/// The reason why a text is not an accepted number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InvalidDecimal {
    /// Not of the form `digits.digits e exponent`.
    Malformed,
    /// More digits or a larger exponent than the 5000 that are accepted.
    TooLarge,
}

impl fmt::Display for InvalidDecimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Malformed => "not a decimal number",
            Self::TooLarge => "more than 5000 decimal places",
        })
    }
}

impl std::error::Error for InvalidDecimal {}

impl Rational {
    /// The exact value of decimal text such as `12`, `-0.5`, `.25`, `3.` or `10e-3`.
    pub fn from_decimal(text: &str) -> Result<Self, InvalidDecimal> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, decimal_exponent(exponent)?),
            None => (text, 0),
        };
        let unsigned = mantissa.strip_prefix(['+', '-']).unwrap_or(mantissa);
        let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
        let digits = [whole, fraction].concat();
        if digits.len() > MAX_DECIMALS {
            return Err(InvalidDecimal::TooLarge);
        }
        if digits.starts_with(['+', '-']) {
            return Err(InvalidDecimal::Malformed);
        }
        let absolute = Integer::from_digits(&digits).ok_or(InvalidDecimal::Malformed)?;
        let value = if mantissa.starts_with('-') { -absolute } else { absolute };
        // Both are at most MAX_DECIMALS.
        let shift = exponent - i32::try_from(fraction.len()).unwrap_or(i32::MAX);
        let scale = Integer::from(10).pow(shift.unsigned_abs());
        let number = if shift < 0 { Self::new(value, scale) } else { Self::new(&value * &scale, Integer::ONE) };
        number.ok_or(InvalidDecimal::Malformed)
    }

    /// The exact value of a finite number: an integer times a power of two.
    pub fn from_f64_exact(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let biased = u32::try_from((bits >> 52) & 0x7ff).unwrap_or(0);
        let fraction = bits & ((1 << 52) - 1);
        // Subnormal numbers have no hidden bit and the exponent of the smallest normal ones.
        let mantissa = if biased == 0 { fraction } else { fraction | 1 << 52 };
        let absolute = Integer::from(mantissa);
        let signed = if value < 0.0 { -absolute } else { absolute };
        let biased = biased.max(1);
        if biased >= 1075 {
            Self::new(signed.shl(biased - 1075), Integer::ONE)
        } else {
            Self::new(signed, Integer::ONE.shl(1075 - biased))
        }
    }

    /// The nearest `f64`, ties to even; infinite where it is out of range.
    pub fn to_f64(&self) -> f64 {
        const EXACT: u64 = 1 << 53;
        if let Repr::Small(n, d) = &self.0
            && n.unsigned_abs() <= EXACT
            && d.get().unsigned_abs() <= EXACT
        {
            #[expect(clippy::cast_precision_loss, reason = "both are exact below 2^53")]
            return *n as f64 / d.get() as f64;
        }
        let (n, d) = (self.numerator().abs(), self.denominator());
        let absolute = round_quotient(&n, &d);
        if self.is_negative() { -absolute } else { absolute }
    }
}

fn decimal_exponent(text: &str) -> Result<i32, InvalidDecimal> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(InvalidDecimal::Malformed);
    }
    match text.parse::<i32>() {
        Ok(exponent) if exponent.unsigned_abs() as usize <= MAX_DECIMALS => Ok(exponent),
        _ => Err(InvalidDecimal::TooLarge),
    }
}

/// `n / d` rounded once, for `n >= 0` and `d > 0`.
fn round_quotient(n: &Integer, d: &Integer) -> f64 {
    if n.is_zero() {
        return 0.0;
    }
    let (Ok(up), Ok(down)) = (i64::try_from(n.bits()), i64::try_from(d.bits())) else {
        return f64::NAN;
    };
    // Scaled so that the integer quotient has 65 or 66 bits.
    let shift = 65 - (up - down);
    if shift < -2000 {
        return f64::INFINITY;
    }
    if shift > 2000 {
        return 0.0;
    }
    let by = u32::try_from(shift.unsigned_abs()).unwrap_or(0);
    let scaled = if shift >= 0 { n.shl(by).div_rem(d) } else { n.div_rem(&d.shl(by)) };
    let (quotient, remainder) = scaled.unwrap_or((Integer::ZERO, Integer::ZERO));
    let (bits, dropped) = quotient.leading_bits();
    let sticky = bits | u64::from(!remainder.is_zero());
    scale_rounded(sticky, i64::try_from(dropped).unwrap_or(0) - shift)
}

/// `bits * 2^exponent` rounded to nearest; `bits` has its highest bit set, and its lowest is the sticky bit of all
/// lower ones.
fn scale_rounded(bits: u64, exponent: i64) -> f64 {
    // A subnormal result keeps fewer bits: its last one is 2^-1074.
    let drop = (-1074 - exponent).max(11);
    if drop > 64 {
        return 0.0;
    }
    let wide = u128::from(bits);
    let (kept, rest) = (wide >> drop, wide & ((1 << drop) - 1));
    let half = 1_u128 << (drop - 1);
    let up = rest > half || (rest == half && kept & 1 == 1);
    let rounded = kept + u128::from(up);
    #[expect(clippy::cast_precision_loss, reason = "at most 53 bits, or the power 2^53")]
    let mantissa = rounded as f64;
    // Two factors, for one power of two alone may be out of range. Both products are exact.
    let power = i32::try_from(exponent + drop).unwrap_or(i32::MAX);
    let half = power / 2;
    mantissa * 2.0_f64.powi(half) * 2.0_f64.powi(power - half)
}
