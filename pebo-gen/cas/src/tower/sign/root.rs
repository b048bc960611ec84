//! Signs of sums with a root or an absolute value, by the difference of the powers of both parts.

use crate::poly::Poly;

use super::{Sign, Signs};
use crate::tower::Obstacle;

/// More terms are not squared.
const MOST_TERMS: usize = 16;

/// The most terms that a power is multiplied out to.
const MOST_IN_POWER: u32 = 64;

impl Signs<'_, '_> {
    /// The sign of `a + c s` with a root s of degree n: that of `c` if `c^n s^n > |a|^n`, that of `a` if less.
    pub(in crate::tower) fn by_root(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if poly.term_count() > MOST_TERMS { Ok(None) } else { self.nested(|| self.by_squares(poly)) }
    }

    fn by_squares(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        for &variable in poly.variables() {
            let power = {
                let kernels = self.field.round.kernels.borrow();
                kernels[variable].relation.as_ref().map(|relation| (relation.degree, relation.value.clone()))
            };
            let exponent = poly.degree(variable);
            let Some((degree, power)) = power.filter(|_| exponent > 0) else { continue };
            if !self.of_kernel(variable).is_some_and(Sign::is_positive_or_zero) {
                continue;
            }
            let (mut rest, mut factor, mut between) = (Poly::zero(), Poly::zero(), false);
            for (own, coefficient) in poly.coefficients_in(variable) {
                match own {
                    0 => rest = coefficient,
                    _ if own == exponent => factor = coefficient,
                    _ => between = true,
                }
            }
            let limit = self.field.limit();
            if between {
                continue;
            }
            if (degree, exponent) != (2, 1) {
                match self.by_powers((&factor, &rest), degree, (&power, exponent))? {
                    Some(sign) => return Ok(Some(sign)),
                    None => continue,
                }
            }
            let ahead = &factor.mul(&factor, limit)?.mul(&power, limit)? - &rest.mul(&rest, limit)?;
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

    /// The sign of `rest + factor s^m` with parts of opposite signs, for `s >= 0` with this n-th power.
    fn by_powers(
        &self,
        (factor, rest): (&Poly, &Poly),
        n: u32,
        (power, m): (&Poly, u32),
    ) -> Result<Option<Sign>, Obstacle> {
        let limit = self.field.limit();
        let is_short = |part: &Poly, n| {
            let terms = u32::try_from(part.term_count()).unwrap_or(u32::MAX);
            terms.checked_pow(n).is_some_and(|terms| terms <= MOST_IN_POWER)
        };
        if !is_short(factor, n) || !is_short(rest, n) || !is_short(power, m) {
            return Ok(None);
        }
        let (Some(leads), Some(lags)) = (self.of_polynomial(factor)?, self.of_polynomial(rest)?) else {
            return Ok(None);
        };
        let (of_root, of_rest) = match (leads, lags) {
            (Sign::Positive, Sign::Negative) => (factor.clone(), -rest),
            (Sign::Negative, Sign::Positive | Sign::NonNegative) => (-factor, rest.clone()),
            _ => return Ok(None),
        };
        let ahead = &of_root.pow(n, limit)?.mul(&power.pow(m, limit)?, limit)? - &of_rest.pow(n, limit)?;
        let ahead = if leads == Sign::Positive { ahead } else { -&ahead };
        self.of_polynomial(&self.field.reduce(&ahead)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::expr::Expr;
    use crate::tower::Field;
    use crate::{Arena, Facts, Rational, Relation};

    #[test]
    fn roots_are_ordered_as_what_is_under_them() {
        let arena = Arena::new();
        let [p, q] = ["p", "q"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        for positive in [q, arena.sub(p, q)] {
            facts.assume(positive, Relation::Positive);
        }
        let ratio = |above, below, exponent: Rational| arena.power(arena.div(above, below), &exponent);
        let part = |above: i64, below: i64| &Rational::from(above) / &Rational::from(below);
        let less_than_one = |expr| arena.sub(arena.one(), expr);
        let cases = [
            (less_than_one(ratio(q, p, part(2, 7))), Some(Sign::Positive)),
            (less_than_one(ratio(q, p, part(1, 3))), Some(Sign::Positive)),
            (less_than_one(ratio(p, q, part(1, 3))), Some(Sign::Negative)),
            (less_than_one(arena.power(q, &part(1, 3))), None),
        ];
        for (expr, expected) in cases {
            let field = Field::over(&arena, &facts, &[expr]).unwrap();
            let sign = field.signs().of(&field.fraction(expr).unwrap()).unwrap();
            assert_eq!(sign, expected, "{}", arena.print(expr));
        }
    }

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
