//! Signs of polynomials that are quadratic in a power of a variable, by the discriminant.

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
            if b.is_zero() || c.is_zero() {
                continue;
            }
            let Some(upward) = self.of_polynomial(&a)? else { continue };
            let four = Integer::from(4);
            let minus_discriminant = &a.mul(&c, self.field.limit())?.scale(&four) - &b.mul(&b, self.field.limit())?;
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
}
