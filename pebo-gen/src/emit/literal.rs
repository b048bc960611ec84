//! Exact numbers as Rust literals, and back.
//!
//! A literal stands for the rational that its decimal digits spell; the compiler rounds it once, to
//! the target scalar. A number without a short decimal is a quotient of two literals.

use pebo_cas::{Integer, Rational};

/// The floating-point type of the emitted code.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[non_exhaustive]
pub enum Scalar {
    /// Single precision.
    F32,
    /// Double precision.
    #[default]
    F64,
}

impl Scalar {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::F64, Self::F32];

    /// The type of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scalar| scalar.name() == name)
    }

    /// The name of the type.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// The number neither overflows nor, unless it is zero, underflows.
    pub(super) fn holds(self, value: &Rational) -> bool {
        let (smallest, largest) = match self {
            Self::F32 => (f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)),
            Self::F64 => (f64::MIN_POSITIVE, f64::MAX),
        };
        let magnitude = value.to_f64().abs();
        value.is_zero() || (smallest..=largest).contains(&magnitude)
    }

    /// Every decimal of so many digits is distinct in the type; more digits are not.
    pub(super) fn digits(self) -> usize {
        match self {
            Self::F32 => 6,
            Self::F64 => 15,
        }
    }
}

/// Decimals with more digits are written as quotients.
const MOST_DIGITS: usize = 17;

/// The shortest literal that spells the absolute value exactly, if one of reasonable length does.
pub(super) fn literal(value: &Rational) -> Option<String> {
    let (digits, exponent) = scientific(&value.abs())?;
    let places = i32::try_from(digits.len()).ok()?;
    // The decimal point is after `point` digits.
    let point = places + exponent;
    let mantissa = match digits.split_at(1) {
        (head, "") => head.to_owned(),
        (head, tail) => format!("{head}.{}", group_fraction(tail)),
    };
    let floating = format!("{mantissa}e{}", point - 1);
    let plain = if exponent >= 0 {
        let zeros = "0".repeat(usize::try_from(exponent).ok()?);
        format!("{}.0", group_whole(&format!("{digits}{zeros}")))
    } else if point > 0 {
        let (whole, fraction) = digits.split_at(usize::try_from(point).ok()?);
        format!("{}.{}", group_whole(whole), group_fraction(fraction))
    } else {
        let zeros = "0".repeat(usize::try_from(-point).ok()?);
        format!("0.{}", group_fraction(&format!("{zeros}{digits}")))
    };
    // An engineer reads 0.0447 and 12000.0 as they stand, 2.2e-5 and 1.5e9 with an exponent.
    let readable = (-3..=6).contains(&point);
    Some(if readable { plain } else { floating })
}

/// The literal of an integer, of any length.
pub(super) fn whole(value: &Integer) -> String {
    format!("{}.0", group_whole(&value.to_string()))
}

/// The number of digits that matter.
pub(super) fn significant(value: &Rational) -> usize {
    scientific(&value.abs()).map_or(0, |(digits, _)| digits.len())
}

/// The exact value of a literal of [`literal`]'s form.
pub(super) fn read(text: &str) -> Option<Rational> {
    Rational::from_decimal(&text.replace('_', "")).ok()
}

/// Digits without trailing zeros, and the power of ten that they are multiplied with.
fn scientific(value: &Rational) -> Option<(String, i32)> {
    let mut denominator = value.denominator();
    let mut places = 0_i32;
    for prime in [2, 5] {
        let mut power = 0;
        while let Some(quotient) = denominator.div_exact(&prime.into()) {
            denominator = quotient;
            power += 1;
        }
        places = places.max(power);
    }
    if !denominator.is_one() {
        return None;
    }
    let digits = (value * &Rational::from(10).pow(places)?).to_string();
    let trimmed = digits.trim_end_matches('0');
    let zeros = i32::try_from(digits.len() - trimmed.len()).ok()?;
    match trimmed {
        "" => Some(("0".to_owned(), 0)),
        _ if trimmed.len() > MOST_DIGITS => None,
        _ => Some((trimmed.to_owned(), zeros - places)),
    }
}

/// Long runs of digits in groups of three.
fn group_fraction(digits: &str) -> String {
    grouped(digits, 0)
}

fn group_whole(digits: &str) -> String {
    grouped(digits, digits.len() % 3)
}

fn grouped(digits: &str, lead: usize) -> String {
    const LONGEST_RUN: usize = 5;
    if digits.len() <= LONGEST_RUN {
        return digits.to_owned();
    }
    let (lead, rest) = digits.split_at(lead);
    let mut groups: Vec<&str> = Vec::new();
    if !lead.is_empty() {
        groups.push(lead);
    }
    let mut rest = rest;
    while !rest.is_empty() {
        let (group, after) = rest.split_at(rest.len().min(3));
        groups.push(group);
        rest = after;
    }
    groups.join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_are_short_and_exact() {
        for (text, expected) in [
            ("0", "0.0"),
            ("12", "12.0"),
            ("10e-3", "0.01"),
            ("22e-6", "2.2e-5"),
            ("22.9e-6", "2.29e-5"),
            ("0.0447", "0.0447"),
            ("123456", "123_456.0"),
            ("1e9", "1e9"),
            ("12345678", "1.234_567_8e7"),
            ("3.14159265", "3.141_592_65"),
            ("0.5", "0.5"),
        ] {
            let value = Rational::from_decimal(text).unwrap();
            let literal = literal(&value).unwrap();
            assert_eq!(literal, expected);
            assert_eq!(read(&literal), Some(value));
        }
    }

    #[test]
    fn a_number_without_a_short_decimal_has_no_literal() {
        assert_eq!(literal(&Rational::new(1, 3).unwrap()), None);
        let power = Rational::from(2).pow(-200).unwrap();
        assert_eq!(literal(&power), None);
    }

    #[test]
    fn a_scalar_holds_what_it_can_represent() {
        let tiny = Rational::from_decimal("1e-50").unwrap();
        assert!(Scalar::F64.holds(&tiny) && !Scalar::F32.holds(&tiny));
        assert!(!Scalar::F64.holds(&Rational::from_decimal("1e400").unwrap()));
    }
}
