//! Formulas as sums of products of hidden symbols, with coefficients in what is known.

use std::collections::BTreeSet;

use crate::cas::field::{Field, Obstacle};
use crate::cas::rational::Rational;
use crate::cas::{Expr, Symbol};

use super::question::Question;

/// A product of hidden symbols with its coefficient.
pub(super) struct Term {
    pub(super) product: Expr,
    pub(super) coefficient: Expr,
}

/// The terms of a formula; none where hidden symbols stand in functions or in a sum below a fraction bar.
pub(super) fn terms(
    question: &Question<'_>,
    formula: Expr,
    hidden: &BTreeSet<Symbol>,
) -> Result<Option<Vec<Term>>, Obstacle> {
    let arena = question.arena;
    let field = Field::over(arena, &question.domain.facts, &[formula])?;
    let fraction = field.fraction(formula)?;
    let kernels: Vec<u32> = field.kernels_of(hidden).into_iter().collect();
    if kernels.iter().any(|kernel| arena.as_symbol(field.kernel(*kernel)).is_none()) {
        return Ok(None);
    }
    let [(below, rest)] = &fraction.denominator().collect(&kernels)[..] else { return Ok(None) };
    let power = |powers: &[(u32, u32)], sign: i64| {
        let factors = powers
            .iter()
            .map(|(kernel, exponent)| (field.kernel(*kernel), Rational::from(sign * i64::from(*exponent))));
        arena.multiply(&Rational::ONE, factors)
    };
    let divisor = power(below.powers(), -1);
    let mut terms = Vec::new();
    for (monomial, coefficient) in fraction.numerator().collect(&kernels) {
        let product = arena.mul(power(monomial.powers(), 1), divisor);
        terms.push(Term { product, coefficient: field.show(&field.quotient(&coefficient, rest)?) });
    }
    Ok(Some(terms))
}
