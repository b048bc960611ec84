//! Absolute values: for a product, the product of the absolute values of its parts.

use crate::Rational;
use crate::graph::function::Function;
use crate::poly::Poly;

use super::AlgebraicRelation;
use crate::tower::fraction::{Fraction, primitive};
use crate::tower::sign::Sign;
use crate::tower::{Field, Obstacle};

impl Field<'_> {
    /// The absolute value of a fraction.
    pub(in crate::tower) fn absolute(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let numerator = self.absolute_polynomial(argument.numerator())?;
        self.div(&numerator, &self.absolute_polynomial(argument.denominator())?)
    }

    /// `|poly|`: by its sign if that is known, else part by part.
    fn absolute_polynomial(&self, poly: &Poly) -> Result<Fraction, Obstacle> {
        for signed in [poly.clone(), -poly] {
            if self.signs().of_polynomial(&signed)?.is_some_and(Sign::is_positive_or_zero) {
                return Ok(Fraction::polynomial(signed));
            }
        }
        let (content, rest) = primitive(poly);
        let product = self.product_of(&rest)?;
        let factor = Rational::new(content, product.divisor).ok_or(Obstacle::DivisionByZero)?;
        let mut total = Fraction::constant(&factor);
        for (part, times) in product.powers {
            total = self.mul(&total, &self.pow(&self.size(&part)?, i64::from(times))?)?;
        }
        Ok(total)
    }

    /// `|part|`: by its sign if that is known, else a kernel with a known square.
    pub(in crate::tower) fn size(&self, part: &Poly) -> Result<Fraction, Obstacle> {
        for signed in [part.clone(), -part] {
            if self.signs().of_part(&signed)?.is_some_and(Sign::is_positive_or_zero) {
                return Ok(Fraction::polynomial(signed));
            }
        }
        self.signs().leave_open(part);
        let kernel = self.arena.call(Function::Abs, &[self.show_polynomial(part)]);
        let value = self.reduce(&part.mul(part, self.limit())?)?;
        Ok(self.entered(kernel, Some(AlgebraicRelation { degree: 2, value }), false))
    }
}
