//! Signs of differences of two exponentials by their exponents, and of logarithms by their arguments.

use crate::Rational;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::poly::{Monomial, Poly};

use super::{Sign, Signs};
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

impl Signs<'_, '_> {
    /// The sign of `p exp(a) - q exp(b)` for numbers p, q > 0: positive if `p >= q` and `a >= b`, not both equal, and
    /// negative if both are the other way round.
    pub(super) fn by_exponents(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        let mut terms = poly.terms();
        let (Some(first), Some(second), None) = (terms.next(), terms.next(), terms.next()) else { return Ok(None) };
        if first.1.is_negative() == second.1.is_negative() {
            return Ok(None);
        }
        let (positive, negative) = if first.1.is_negative() { (second, first) } else { (first, second) };
        let (Some(a), Some(b)) = (self.field.exponent_of(&positive.0)?, self.field.exponent_of(&negative.0)?) else {
            return Ok(None);
        };
        let size = positive.1.clone().cmp(&negative.1.abs());
        let ahead = self.field.sub(&a, &b)?;
        Ok(match (self.of(&ahead)?, size) {
            (Some(Sign::Zero), std::cmp::Ordering::Equal) => Some(Sign::Zero),
            (Some(Sign::Positive), std::cmp::Ordering::Greater | std::cmp::Ordering::Equal)
            | (Some(Sign::NonNegative | Sign::Zero), std::cmp::Ordering::Greater) => Some(Sign::Positive),
            (Some(Sign::NonNegative), std::cmp::Ordering::Equal) => Some(Sign::NonNegative),
            (Some(Sign::Negative), std::cmp::Ordering::Less | std::cmp::Ordering::Equal)
            | (Some(Sign::Zero), std::cmp::Ordering::Less) => Some(Sign::Negative),
            _ => None,
        })
    }

    /// The sign of a logarithm: that of its argument's distance from 1.
    pub(super) fn by_logarithm(&self, argument: Expr) -> Option<Sign> {
        let argument = self.field.fraction(argument).ok()?;
        self.of(&self.field.sub(&argument, &Fraction::one()).ok()?).ok()?
    }
}

impl Field<'_> {
    /// The `a` of a product of exponentials that is `exp(a)`; none if there is another factor.
    fn exponent_of(&self, monomial: &Monomial) -> Result<Option<Fraction>, Obstacle> {
        let mut total = Fraction::zero();
        for &(kernel, power) in monomial.powers() {
            let Node::Call(Function::Exp, argument) = self.arena.node(self.kernel(kernel)) else { return Ok(None) };
            let argument = self.fraction(argument[0])?;
            total = self.add(&total, &self.scale(&argument, &Rational::from(i64::from(power)))?)?;
        }
        Ok(Some(total))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::{Facts, Relation};

    #[test]
    fn exponentials_are_in_the_order_of_their_exponents() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        facts.assume(a, Relation::Positive);
        facts.assume(arena.sub(c, b), Relation::NonNegative);
        let exp = |e| arena.call(Function::Exp, &[e]);
        let twice = |e| arena.scale(e, &Rational::from(2));
        let one = arena.one();
        let cases = [
            (arena.sub(exp(a), one), Some(Sign::Positive)),
            (arena.sub(one, exp(twice(a))), Some(Sign::Negative)),
            (arena.sub(exp(arena.neg(a)), one), Some(Sign::Negative)),
            (arena.sub(twice(exp(a)), one), Some(Sign::Positive)),
            (arena.sub(exp(a), arena.number(2)), None),
            (arena.sub(exp(c), exp(b)), Some(Sign::NonNegative)),
            (arena.sub(exp(arena.add(a, c)), exp(b)), Some(Sign::Positive)),
            (arena.sub(exp(b), one), None),
            (arena.call(Function::Log, &[arena.add(one, a)]), Some(Sign::Positive)),
            (arena.call(Function::Log, &[a]), None),
        ];
        for (expr, expected) in cases {
            let field = Field::over(&arena, &facts, &[expr]).unwrap();
            let sign = field.signs().of(&field.fraction(expr).unwrap()).unwrap();
            assert_eq!(sign, expected, "{}", arena.print(expr));
        }
    }
}
