//! Signs of sums with a square root or an absolute value, by the difference of the squares of both parts.

use crate::poly::Poly;

use super::{Sign, Signs};
use crate::tower::Obstacle;

/// More terms are not squared.
const MOST_TERMS: usize = 16;

impl Signs<'_, '_> {
    /// The sign of `a + c s` with a square root s: that of `c` if `c^2 s^2 > a^2`, that of `a` if less.
    pub(in crate::tower) fn by_root(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if poly.term_count() > MOST_TERMS { Ok(None) } else { self.nested(|| self.by_squares(poly)) }
    }

    fn by_squares(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        for &variable in poly.variables() {
            let square = {
                let kernels = self.field.round.kernels.borrow();
                let relation = kernels[variable].relation.as_ref().filter(|relation| relation.degree == 2);
                relation.map(|relation| relation.value.clone())
            };
            let Some(square) = square.filter(|_| poly.degree(variable) == 1) else { continue };
            if !self.of_kernel(variable).is_some_and(Sign::is_positive_or_zero) {
                continue;
            }
            let (mut rest, mut factor) = (Poly::zero(), Poly::zero());
            for (exponent, coefficient) in poly.coefficients_in(variable) {
                *(if exponent == 0 { &mut rest } else { &mut factor }) = coefficient;
            }
            let limit = self.field.limit();
            let ahead = &factor.mul(&factor, limit)?.mul(&square, limit)? - &rest.mul(&rest, limit)?;
            let (leading, sign) = match self.of_polynomial(&ahead)? {
                Some(sign @ (Sign::Positive | Sign::NonNegative | Sign::Zero)) => (factor, sign),
                Some(Sign::Negative) => (rest, Sign::Positive),
                None => continue,
            };
            // A part whose square is the larger one is not zero.
            match (self.of_polynomial(&leading)?, sign) {
                (Some(Sign::Positive | Sign::NonNegative), Sign::Positive) => return Ok(Some(Sign::Positive)),
                (Some(Sign::Negative), Sign::Positive) => return Ok(Some(Sign::Negative)),
                (Some(Sign::Positive | Sign::NonNegative), _) => return Ok(Some(Sign::NonNegative)),
                _ => {}
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::expr::Expr;
    use crate::tower::Field;
    use crate::{Arena, Facts, Rational, Relation};

    #[test]
    fn the_larger_square_decides() {
        let arena = Arena::new();
        let [p, q, a] = ["p", "q", "a"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        facts.assume(q, Relation::Positive);
        facts.assume(a, Relation::Positive);
        let square = |e: Expr| arena.mul(e, e);
        let length = |of: &[Expr]| arena.sqrt(arena.sum(of.iter().map(|e| square(*e))));
        let twice = |e| arena.scale(e, &Rational::from(2));
        let range = length(&[p, q]);
        let cases = [
            (arena.add(p, range), Some(Sign::Positive)),
            (arena.sub(p, range), Some(Sign::Negative)),
            (arena.sub(q, range), None),
            (arena.sub(range, twice(q)), None),
            (arena.sub(arena.add(q, a), length(&[q, a])), Some(Sign::Positive)),
            (arena.sub(length(&[q, a]), arena.add(q, a)), Some(Sign::Negative)),
            (arena.sub(twice(range), p), Some(Sign::Positive)),
            (arena.add(arena.mul(p, range), square(q)), None),
        ];
        for (expr, expected) in cases {
            let field = Field::over(&arena, &facts, &[expr]).unwrap();
            let sign = field.signs().of(&field.fraction(expr).unwrap()).unwrap();
            assert_eq!(sign, expected, "{}", arena.print(expr));
        }
        // Without q > 0 the sum may be zero: at p < 0 and q = 0.
        let field = Field::over(&arena, &Facts::new(), &[range, p]).unwrap();
        let sum = field.fraction(arena.add(p, range)).unwrap();
        assert_eq!(field.signs().of(&sum).unwrap(), Some(Sign::NonNegative));
    }
}
