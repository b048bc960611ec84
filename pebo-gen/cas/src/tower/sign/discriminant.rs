//! Signs of polynomials that are quadratic in a power of a variable, by the discriminant: as a sum of squares, or as a
//! product of two factors, where the discriminant is a square.

use crate::Integer;
use crate::poly::Poly;

use super::{Sign, Signs};
use crate::tower::Obstacle;

impl Signs<'_, '_> {
    /// The sign of `a v^(2k) + b v^k + c` with `a` and `4 a c - b^2` of known signs, as `(x + b)^2 + 1` written out.
    pub(in crate::tower) fn by_discriminant(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        const MOST_TERMS: usize = 40;
        if poly.term_count() > MOST_TERMS { Ok(None) } else { self.nested(|| self.as_quadratic(poly)) }
    }

    fn as_quadratic(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        for &variable in poly.variables() {
            // Also in a power of the variable.
            let degree = poly.degree(variable);
            let (mut a, mut b, mut c) = (Poly::zero(), Poly::zero(), Poly::zero());
            let mut quadratic = degree.is_multiple_of(2);
            for (exponent, coefficient) in poly.coefficients_in(variable) {
                match exponent {
                    0 => c = coefficient,
                    _ if exponent == degree => a = coefficient,
                    _ if 2 * exponent == degree => b = coefficient,
                    _ => quadratic = false,
                }
            }
            if !quadratic {
                continue;
            }
            if c.is_zero() {
                continue;
            }
            let Some(upward) = self.of_polynomial(&a)? else { continue };
            let four = Integer::from(4);
            let minus_discriminant = &a.mul(&c, self.field.limit())?.scale(&four) - &b.mul(&b, self.field.limit())?;
            let root = (-&minus_discriminant).sqrt_exact(self.field.limit())?;
            if let Some(root) = root.filter(|root| !root.is_zero()) {
                match self
                    .of_factors((&a, &b, &root), &Poly::variable(variable).pow(degree / 2, self.field.limit())?)?
                {
                    Some(sign) if upward == Sign::Positive => return Ok(Some(sign)),
                    Some(sign) if upward == Sign::Negative => return Ok(sign.negated()),
                    _ => continue,
                }
            }
            if b.is_zero() {
                continue;
            }
            // 4 a poly = (2 a v^k + b)^2 + minus_discriminant; a = 0 implies b != 0 or minus_discriminant = 0.
            let least = match self.of_polynomial(&minus_discriminant)? {
                Some(Sign::Positive) => Sign::Positive,
                Some(Sign::NonNegative | Sign::Zero)
                    if matches!(upward, Sign::Positive | Sign::Negative)
                        || self.of_polynomial(&c)?.is_some_and(Sign::is_positive_or_zero) =>
                {
                    Sign::NonNegative
                }
                _ => continue,
            };
            return Ok(match (upward, least) {
                (Sign::Negative, Sign::Positive) => Some(Sign::Negative),
                (Sign::Negative, _) => None,
                (_, least) => Some(least),
            });
        }
        Ok(None)
    }

    /// The sign of `(2 a v + b)^2 - root^2`, by those of its two factors.
    fn of_factors(&self, (a, b, root): (&Poly, &Poly, &Poly), v: &Poly) -> Result<Option<Sign>, Obstacle> {
        let middle = &a.mul(v, self.field.limit())?.scale(&Integer::from(2)) + b;
        let (Some(below), Some(above)) =
            (self.of_polynomial(&(&middle - root))?, self.of_polynomial(&(&middle + root))?)
        else {
            return Ok(None);
        };
        Ok(below.times(above))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tower::Field;
    use crate::{Arena, Expr, Facts, Relation};

    #[test]
    fn the_difference_of_squares_has_two_factors() {
        let arena = Arena::new();
        let [p, e, x] = ["p", "e", "x"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        for positive in [p, e, x, arena.sub(arena.div(e, x), p)] {
            facts.assume(positive, Relation::Positive);
        }
        let square = |of: Expr| arena.mul(of, of);
        let cases = [
            (arena.sub(square(arena.div(e, x)), square(p)), Some(Sign::Positive)),
            (arena.sub(square(p), square(arena.div(e, x))), Some(Sign::Negative)),
            (arena.sub(arena.one(), square(arena.div(arena.mul(x, p), e))), Some(Sign::Positive)),
            (arena.sub(square(p), square(x)), None),
        ];
        for (expr, expected) in cases {
            let field = Field::over(&arena, &facts, &[expr]).unwrap();
            let sign = field.signs().of(&field.fraction(expr).unwrap()).unwrap();
            assert_eq!(sign, expected, "{}", arena.print(expr));
        }
    }
}
