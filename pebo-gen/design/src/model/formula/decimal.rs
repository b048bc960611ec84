//! Exact decimals.

use crate::source::{Code, Diagnostic, Span, quoted};

/// No number that a model needs has more digits.
const DIGIT_LIMIT: usize = 400;

/// Beyond it the emitted code could not hold the number.
const EXPONENT_LIMIT: i64 = 308;

/// A number as written: digits, perhaps a point, perhaps an exponent, perhaps a minus sign.
///
/// It is exact: `0.1` is one tenth. Holds: at most 400 digits, exponent between -308 and 308.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decimal {
    text: String,
}

/// A number taken apart: `digits * 10^exponent`, negated where `negative`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DecimalParts {
    /// True if there is a minus sign.
    pub negative: bool,
    /// Decimal digits, at least one.
    pub digits: String,
    /// Power of ten.
    pub exponent: i32,
}

impl Decimal {
    /// Reads `text` at `span`.
    pub fn parse(text: &str, span: Span) -> Result<Self, Diagnostic> {
        let Some((mantissa, exponent)) = split(text) else {
            let message = format!("{} is not a number", quoted(text));
            return Err(Diagnostic::error(Code::MalformedNumber, span, message).help(mended(text)));
        };
        let refuse = |what: &str, help: &str| {
            let message = format!("{} has {what}", quoted(text));
            Err(Diagnostic::error(Code::NumberTooLarge, span, message).help(help))
        };
        if mantissa.len() > DIGIT_LIMIT {
            return refuse("too many digits", "write at most 400 digits");
        }
        // An exponent that does not fit the integer type is as much out of range.
        match exponent.parse::<i64>() {
            Ok(exponent) if exponent.abs() <= EXPONENT_LIMIT => Ok(Self { text: text.to_owned() }),
            _ => refuse("an exponent out of range", "keep the exponent between -308 and 308"),
        }
    }

    /// The number 0.
    pub fn zero() -> Self {
        Self { text: "0".to_owned() }
    }

    /// As written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The exact value, taken apart.
    pub fn parts(&self) -> DecimalParts {
        let (mantissa, exponent) = split(&self.text).unwrap_or(("0", "0"));
        let (negative, mantissa) = match mantissa.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, mantissa),
        };
        let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len());
        let digits = mantissa.replace('.', "");
        // Both are bounded where the number was read.
        let shift = i32::try_from(decimals).unwrap_or(0);
        DecimalParts { negative, digits, exponent: exponent.parse::<i32>().unwrap_or(0) - shift }
    }

    /// The nearest floating-point number.
    pub fn to_f64(&self) -> f64 {
        self.text.parse().unwrap_or(f64::NAN)
    }
}

/// Units that numbers are written with, and the powers of ten of the prefixes before them.
const UNITS: [&str; 21] = [
    "H", "F", "A", "V", "W", "s", "m", "Ohm", "ohm", "Ω", "Hz", "N", "Nm", "J", "Pa", "C", "Wb", "K", "S", "rad", "Ah",
];
const PREFIXES: [(&str, i32); 10] =
    [("p", -12), ("n", -9), ("u", -6), ("µ", -6), ("μ", -6), ("m", -3), ("k", 3), ("K", 3), ("M", 6), ("G", 9)];

/// Longer texts are not written again.
const SHORT: usize = 40;

/// A correction for a text that is no number.
fn mended(text: &str) -> String {
    const HELP: &str = "write a decimal, as 12, 0.5 or 22e-6";
    let text = text.trim();
    if text.len() > SHORT {
        return HELP.to_owned();
    }
    let point = text.replacen(',', ".", 1);
    if point != text && split(&point).is_some() {
        return format!("a decimal has a point: write `{point}`");
    }
    let end = text.rfind(|c: char| c.is_ascii_digit() || c == '.').map_or(0, |at| at + 1);
    let (number, unit) = (&text[..end], text[end..].trim());
    if unit.is_empty() || split(number).is_none() {
        return HELP.to_owned();
    }
    if unit == "%" {
        return format!("write a share of 1, as `0.5` for 50 %: `{number}e-2`");
    }
    let scaled = PREFIXES.iter().find_map(|(prefix, power)| {
        let rest = unit.strip_prefix(prefix)?.trim();
        (rest.is_empty() || UNITS.contains(&rest)).then_some(power)
    });
    let prefixed = scaled.filter(|_| !number.contains(['e', 'E'])).map(|power| format!("{number}e{power}"));
    match (UNITS.contains(&unit), prefixed) {
        (false, Some(number)) => format!("write `{number}`: a number has no unit and no prefix"),
        (true, None) => format!("write `{number}`: a number has no unit, which belongs under `units`"),
        // As of `5m`, metres or a thousandth.
        (true, Some(other)) => {
            format!("write `{number}`, or `{other}` if that is meant: a number has no unit and no prefix")
        }
        (false, None) => format!("{HELP}; a number has no unit, which belongs under `units`"),
    }
}

/// Mantissa and exponent of a text that has the form of a number.
fn split(text: &str) -> Option<(&str, &str)> {
    let (mantissa, exponent) = match text.find(['e', 'E']) {
        Some(at) => (&text[..at], &text[at + 1..]),
        None => (text, "0"),
    };
    let unsigned = mantissa.strip_prefix('-').unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let power = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    let formed = digits(whole)
        && digits(fraction)
        && !(whole.is_empty() && fraction.is_empty())
        && digits(power)
        && !power.is_empty();
    formed.then_some((mantissa, exponent))
}
