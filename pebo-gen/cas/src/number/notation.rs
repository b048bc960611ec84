//! Notation of numbers: the author's, or else an engineer's.
//!
//! In: the decimals of the model's formulas as they are written, and exact numbers. Out: `8.875` if the author wrote
//! that and not `71/8`, `22.9e-6` and not `2.29e-5`; numbers that only a derivation has remain fractions if their
//! denominators are small (`x/2`), and others are decimals if these are exact (`9.81*m`).

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use crate::Rational;

/// The length of the longest notation that is kept.
const LONGEST: usize = 24;

/// The decimals of a model's formulas.
#[derive(Default, Debug)]
pub struct Notation {
    /// The author's text of an absolute value that is no integer, the first if there are several.
    written: RefCell<FxHashMap<Rational, String>>,
}

impl Notation {
    /// Keeps a decimal of a formula as it is written there.
    pub fn keep(&self, value: &Rational, text: &str) {
        let mut text = text.strip_prefix('-').unwrap_or(text).to_ascii_lowercase();
        // In Rust and on paper there is a digit on either side of the point.
        if text.starts_with('.') {
            text.insert(0, '0');
        }
        let has_digits = text.split('.').all(|part| part.starts_with(|c: char| c.is_ascii_digit()));
        let is_small = text.split_once('e').is_none_or(|(_, exponent)| exponent.starts_with('-'));
        if !value.is_integer() && has_digits && is_small && text.len() <= LONGEST {
            self.written.borrow_mut().entry(value.abs()).or_insert(text);
        }
    }

    /// True if an absolute value reads better as a fraction than as a decimal.
    pub(crate) fn as_fraction(&self, absolute: &Rational) -> bool {
        const LARGEST_DENOMINATOR: i64 = 12;
        let written = self.written.borrow();
        if written.contains_key(absolute) {
            return false;
        }
        // An author of decimals has tenths and no fifths.
        let in_tenths = || !written.is_empty() && absolute.denominator().div_exact(&5.into()).is_some();
        let is_small = absolute.denominator().to_i64().is_some_and(|d| d <= LARGEST_DENOMINATOR);
        (is_small && !in_tenths()) || short_decimal(absolute).is_none()
    }

    /// The decimal of an absolute value: the author's, or the exact one if it is short.
    pub(crate) fn decimal(&self, absolute: &Rational) -> Option<String> {
        self.written.borrow().get(absolute).cloned().or_else(|| short_decimal(absolute))
    }
}

/// The exact decimal of a non-negative number, if it is short: of few places, or of no more digits than a number in
/// double precision has and no longer than the fraction.
fn short_decimal(value: &Rational) -> Option<String> {
    const FEW_PLACES: u32 = 12;
    const MOST_PLACES: u32 = 60;
    const MOST_DIGITS: usize = 17;
    // A divisor of 10^60 has no more bits.
    const MOST_BITS: u64 = 200;
    if value.denominator().bits() > MOST_BITS {
        return None;
    }
    let places = (0..=MOST_PLACES).find(|places| {
        Rational::from(10).pow(i32::try_from(*places).unwrap_or(0)).is_some_and(|scale| (value * &scale).is_integer())
    })?;
    let scale = Rational::from(10).pow(i32::try_from(places).ok()?)?;
    let digits = (value * &scale).to_string();
    let text = in_places(&digits, usize::try_from(places).ok()?);
    let is_short = digits.len() <= MOST_DIGITS && text.len() <= value.to_string().len();
    (places <= FEW_PLACES || is_short).then_some(text)
}

/// A whole number, one with many zeros behind it with an exponent.
pub(crate) fn whole(value: &Rational) -> String {
    const MOST_ZEROS: usize = 6;
    let digits = value.to_string();
    let significant = digits.trim_end_matches('0');
    let zeros = digits.len() - significant.len();
    let (sign, significant) = significant.strip_prefix('-').map_or(("", significant), |rest| ("-", rest));
    if zeros <= MOST_ZEROS || significant.is_empty() {
        return digits;
    }
    let (head, tail) = significant.split_at(1);
    let point = if tail.is_empty() { "" } else { "." };
    format!("{sign}{head}{point}{tail}e{}", zeros + tail.len())
}

/// Digits with so many of them behind the point.
fn in_places(digits: &str, width: usize) -> String {
    // Leading zeros beyond a few read better as an exponent: 2.2e-5.
    let significant = digits.trim_end_matches('0');
    if digits.len() + 3 <= width {
        let exponent = width - digits.len() + 1;
        let (head, tail) = significant.split_at(1);
        let point = if tail.is_empty() { "" } else { "." };
        return format!("{head}{point}{tail}e-{exponent}");
    }
    let padded = format!("{digits:0>width$}", width = width + 1);
    let (whole, fraction) = padded.split_at(padded.len() - width);
    if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(notation: &Notation, numerator: i64, denominator: i64) -> String {
        let value = Rational::new(numerator, denominator).unwrap();
        if notation.as_fraction(&value) { value.to_string() } else { notation.decimal(&value).unwrap() }
    }

    #[test]
    fn decimals_are_printed_as_the_author_wrote_them() {
        let notation = Notation::default();
        let fractions = [(71, 8), (1, 2), (3, 10), (1, 3), (1, 5)];
        for (n, d) in fractions {
            assert_eq!(shown(&notation, n, d), format!("{n}/{d}"), "nothing is written yet");
        }
        assert_eq!(shown(&notation, 981, 100), "9.81");
        for text in ["8.875", "22.9e-6", "-1.50E-3", "2.0", "12", ".5", "0.25"] {
            notation.keep(&Rational::from_decimal(text).unwrap(), text);
        }
        assert_eq!(shown(&notation, 71, 8), "8.875");
        assert_eq!(shown(&notation, 229, 10_000_000), "22.9e-6");
        assert_eq!(shown(&notation, 3, 2000), "1.50e-3");
        assert_eq!(shown(&notation, 1, 4), "0.25");
        assert_eq!(shown(&notation, 1, 2), "0.5");
        // The author wrote neither, but his decimals include tenths.
        assert_eq!(shown(&notation, 3, 4), "3/4");
        assert_eq!(shown(&notation, 3, 10), "0.3");
        assert_eq!(shown(&notation, 1, 3), "1/3");
    }
}
