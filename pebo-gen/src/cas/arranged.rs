//! How the parts of a formula are arranged where it is written: which summand comes first, what stands below the line.
//!
//! In: a sum or a product of the graph. Out: its parts in the order of writing, signs apart. Every printer writes
//! these parts, each in its own notation.

use super::arena::Arena;
use super::expr::{Expr, Node, Product, Sum};
use super::rational::Rational;

/// A summand without its sign.
#[derive(Clone, Debug)]
pub(super) enum Summand {
    /// A positive number.
    Number(Rational),
    /// An expression as it is.
    Expr(Expr),
    /// A product with a positive coefficient.
    Product(Product),
}

/// A factor of a numerator or a denominator.
#[derive(Clone, Debug)]
pub(super) enum Factor<'a> {
    /// A positive number.
    Number(Rational),
    /// A base with a positive exponent.
    Power(Expr, &'a Rational),
}

/// The summands, each with whether it is subtracted; the first is not, if any is not.
pub(super) fn summands(arena: &Arena, sum: &Sum) -> Vec<(bool, Summand)> {
    let mut summands: Vec<(bool, Summand)> = Vec::with_capacity(sum.terms.len() + 1);
    for (term, coefficient) in &sum.terms {
        let scaled = match arena.node(*term) {
            Node::Product(product) => {
                Summand::Product(Product { coefficient: coefficient.abs(), factors: product.factors.clone() })
            }
            _ if coefficient.abs().is_one() => Summand::Expr(*term),
            _ => Summand::Product(Product { coefficient: coefficient.abs(), factors: vec![(*term, Rational::ONE)] }),
        };
        summands.push((coefficient.is_negative(), scaled));
    }
    if !sum.constant.is_zero() {
        let constant = (sum.constant.is_negative(), Summand::Number(sum.constant.abs()));
        // `1 - d`, but `x + 1`.
        let leads = !constant.0 && summands.first().is_some_and(|s| s.0);
        let at = if leads { 0 } else { summands.len() };
        summands.insert(at, constant);
    }
    if let Some(positive) = summands.iter().position(|s| !s.0) {
        summands[..=positive].rotate_right(1);
    }
    summands
}

/// What stands above and below the line, without the sign.
pub(super) fn quotient(product: &Product) -> (Vec<Factor<'_>>, Vec<Factor<'_>>) {
    let coefficient = product.coefficient.abs();
    let (mut above, mut below) = (Vec::new(), Vec::new());
    if as_fraction(&coefficient) {
        for (part, side) in [(coefficient.numerator(), &mut above), (coefficient.denominator(), &mut below)] {
            if !part.is_one() {
                side.push(Factor::Number(part.clone().into()));
            }
        }
    } else {
        above.push(Factor::Number(coefficient));
    }
    for (base, exponent) in &product.factors {
        if exponent.is_negative() {
            below.push(Factor::Power(*base, exponent));
        } else {
            above.push(Factor::Power(*base, exponent));
        }
    }
    (above, below)
}

/// Whether the exponent, sign apart, is that of a square root.
pub(super) fn is_root(exponent: &Rational) -> bool {
    Rational::new(1, 2).as_ref() == Some(exponent)
}

/// Whether the number reads better as a fraction than as a decimal.
pub(super) fn as_fraction(value: &Rational) -> bool {
    const LARGEST_DENOMINATOR: i64 = 12;
    value.denominator().to_i64().is_some_and(|d| d <= LARGEST_DENOMINATOR) || decimal(value).is_none()
}

/// The exact decimal of a non-negative number, if it is short: of few places, or of no more digits than a number in
/// double precision has and no longer than the fraction.
pub(super) fn decimal(value: &Rational) -> Option<String> {
    const FEW_PLACES: u32 = 12;
    const MOST_PLACES: u32 = 60;
    const MOST_DIGITS: usize = 17;
    // What divides 10^60 has no more bits.
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
pub(super) fn whole(value: &Rational) -> String {
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
