//! The arrangement of a formula in print: the order of summands, and the denominator.
//!
//! In: a sum or a product of the graph. Out: its parts in the order of writing, signs apart. Every printer writes these
//! parts, each in its own notation.

use crate::Rational;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Product, Sum};

/// A summand without its sign.
#[derive(Clone, Debug)]
pub(crate) enum Summand {
    /// A positive number.
    Number(Rational),
    /// An expression as it is.
    Expr(Expr),
    /// A product with a positive coefficient.
    Product(Product),
}

/// A factor of a numerator or a denominator.
#[derive(Clone, Debug)]
pub(crate) enum Factor<'a> {
    /// A positive number.
    Number(Rational),
    /// A base with a positive exponent.
    Power(Expr, &'a Rational),
}

/// The summands, each with true if it is subtracted; the first is not, if any is not.
pub(crate) fn summands(arena: &Arena, sum: &Sum) -> Vec<(bool, Summand)> {
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

/// Numerator and denominator, without the sign.
pub(crate) fn quotient<'a>(arena: &Arena, product: &'a Product) -> (Vec<Factor<'a>>, Vec<Factor<'a>>) {
    let coefficient = product.coefficient.abs();
    let (mut numerator, mut denominator) = (Vec::new(), Vec::new());
    if arena.notation().as_fraction(&coefficient) {
        for (part, side) in [(coefficient.numerator(), &mut numerator), (coefficient.denominator(), &mut denominator)] {
            if !part.is_one() {
                side.push(Factor::Number(part.clone().into()));
            }
        }
    } else {
        numerator.push(Factor::Number(coefficient));
    }
    for (base, exponent) in &product.factors {
        if exponent.is_negative() {
            denominator.push(Factor::Power(*base, exponent));
        } else {
            numerator.push(Factor::Power(*base, exponent));
        }
    }
    (numerator, denominator)
}

/// True if the exponent, sign apart, is that of a square root.
pub(crate) fn is_root(exponent: &Rational) -> bool {
    Rational::new(1, 2).as_ref() == Some(exponent)
}
