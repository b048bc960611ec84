//! Arithmetic of quotients of polynomials over kernels.
//!
//! In: numerators and denominators. Out: canonical fractions: coprime, the denominator's leading
//! coefficient positive, powers of algebraic kernels reduced by their relations, and a short
//! denominator free of every kernel with a quadratic relation (it is cleared by the conjugate). Over
//! kernels that are otherwise independent, a fraction is zero if and only if its numerator is, and
//! equal fractions with short denominators are stored equally.

use crate::Rational;
use crate::poly::{Poly, steps};

use super::fraction::Fraction;
use super::{Field, Obstacle};

/// The greatest number of terms of a denominator that its conjugate multiplies: longer ones grow excessively.
const MOST_CLEARED: usize = 16;

impl Field<'_> {
    /// The canonical fraction of two polynomials over the kernels.
    pub fn quotient(&self, num: &Poly, den: &Poly) -> Result<Fraction, Obstacle> {
        self.limit().spend(steps(num.term_count() + den.term_count()))?;
        let mut num = self.reduce(num)?;
        if den.is_one() {
            return Ok(Fraction::polynomial(num));
        }
        let mut den = self.reduce(den)?;
        if den.is_zero() {
            return Err(Obstacle::DivisionByZero);
        }
        while den.term_count() <= MOST_CLEARED
            && let Some(conjugate) = self.conjugate(&den)?
        {
            num = self.reduce(&num.mul(&conjugate, self.limit())?)?;
            den = self.reduce(&den.mul(&conjugate, self.limit())?)?;
            if den.is_zero() {
                return Err(Obstacle::DivisionByZero);
            }
        }
        if num.is_zero() {
            return Ok(Fraction::zero());
        }
        if !den.is_one() {
            let common = num.gcd(&den, self.limit())?;
            if !common.is_one() {
                num = exact(num.div_exact(&common, self.limit())?)?;
                den = exact(den.div_exact(&common, self.limit())?)?;
            }
            if den.leading_coefficient().is_negative() {
                num = -&num;
                den = -&den;
            }
        }
        Ok(Fraction { num, den })
    }

    /// The numerators over the least common denominator, and that.
    pub fn over_common_denominator<'f>(
        &self,
        fractions: impl IntoIterator<Item = &'f Fraction> + Clone,
    ) -> Result<(Vec<Poly>, Poly), Obstacle> {
        let mut denominators = fractions.clone().into_iter().map(|fraction| &fraction.den);
        let common = denominators.try_fold(Poly::one(), |common, other| common.lcm(other, self.limit()))?;
        let over = |fraction: &Fraction| {
            let missing = exact(common.div_exact(&fraction.den, self.limit())?)?;
            self.reduce(&fraction.num.mul(&missing, self.limit())?)
        };
        let numerators = fractions.into_iter().map(over).collect::<Result<_, Obstacle>>()?;
        Ok((numerators, common))
    }

    /// `a + b`.
    pub fn add(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Obstacle> {
        if a.is_zero() {
            return Ok(b.clone());
        }
        if b.is_zero() {
            return Ok(a.clone());
        }
        if let Some((a, b)) = numbers(a, b) {
            return self.of_number(&(&a + &b));
        }
        if a.den == b.den {
            return self.quotient(&(&a.num + &b.num), &a.den);
        }
        // Over the least common denominator, so that intermediate results stay small.
        let common = a.den.gcd(&b.den, self.limit())?;
        let left = exact(a.den.div_exact(&common, self.limit())?)?;
        let right = exact(b.den.div_exact(&common, self.limit())?)?;
        let num = &a.num.mul(&right, self.limit())? + &b.num.mul(&left, self.limit())?;
        let den = a.den.mul(&right, self.limit())?;
        self.quotient(&num, &den)
    }

    /// `a - b`.
    pub fn sub(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Obstacle> {
        self.add(a, &b.opposite())
    }

    /// `a * b`.
    pub fn mul(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Obstacle> {
        if a.is_one() {
            return Ok(b.clone());
        }
        if b.is_one() {
            return Ok(a.clone());
        }
        if a.is_zero() || b.is_zero() {
            return Ok(Fraction::zero());
        }
        if let Some((a, b)) = numbers(a, b) {
            return self.of_number(&(&a * &b));
        }
        let num = a.num.mul(&b.num, self.limit())?;
        let den = a.den.mul(&b.den, self.limit())?;
        self.quotient(&num, &den)
    }

    /// `a / b`.
    pub fn div(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Obstacle> {
        let num = a.num.mul(&b.den, self.limit())?;
        let den = a.den.mul(&b.num, self.limit())?;
        self.quotient(&num, &den)
    }

    /// The fraction of a computed number.
    fn of_number(&self, value: &Rational) -> Result<Fraction, Obstacle> {
        self.limit().spend(1 + value.bits() / 64)?;
        Ok(Fraction::constant(value))
    }

    /// `factor * a`.
    pub fn scale(&self, a: &Fraction, factor: &Rational) -> Result<Fraction, Obstacle> {
        self.mul(a, &Fraction::constant(factor))
    }

    /// `a ^ exponent` for an integer exponent.
    pub fn pow(&self, a: &Fraction, exponent: i64) -> Result<Fraction, Obstacle> {
        if exponent == 1 {
            return Ok(a.clone());
        }
        let times = u32::try_from(exponent.unsigned_abs()).map_err(|_| Obstacle::TooLarge)?;
        let num = self.repeated_product(&a.num, times)?;
        let den = self.repeated_product(&a.den, times)?;
        if exponent < 0 { self.quotient(&den, &num) } else { self.quotient(&num, &den) }
    }

    /// A power, reduced at each step, so that relations keep it small.
    fn repeated_product(&self, base: &Poly, times: u32) -> Result<Poly, Obstacle> {
        if times == 0 || base.is_one() {
            return Ok(Poly::one());
        }
        let mut result = base.clone();
        for bit in (0..u32::BITS - 1 - times.leading_zeros()).rev() {
            result = self.reduce(&result.mul(&result, self.limit())?)?;
            if times >> bit & 1 == 1 {
                result = self.reduce(&result.mul(base, self.limit())?)?;
            }
        }
        Ok(result)
    }

    /// Replaces powers of algebraic kernels by their relations, the last kernel first: relations
    /// lead to earlier kernels only.
    pub(in crate::tower) fn reduce(&self, poly: &Poly) -> Result<Poly, Obstacle> {
        let mut poly = poly.clone();
        let kernels = self.round.kernels.borrow();
        let mut above = u32::MAX;
        loop {
            let next = poly.variables().iter().rev().copied().find(|&variable| {
                variable < above
                    && kernels[variable].relation.as_ref().is_some_and(|r| poly.degree(variable) >= r.degree)
            });
            let Some(variable) = next else { return Ok(poly) };
            if let Some(relation) = &kernels[variable].relation {
                poly = poly.reduce_power(variable, relation.degree, &relation.value, self.limit())?;
            }
            above = variable;
        }
    }

    /// True unless two polynomials provably vanish together on nothing but lower-dimensional sets: their multiples that
    /// are free of roots have no factor in common.
    pub fn may_vanish_together(&self, a: &Poly, b: &Poly) -> Result<bool, Obstacle> {
        let (a, b) = (self.cleared(a)?, self.cleared(b)?);
        let kernels = self.round.kernels.borrow();
        let algebraic = |poly: &Poly| poly.variables().iter().any(|v| kernels[*v].relation.is_some());
        // A relation of roots that were not cleared may hide a common factor.
        let hidden = !a.is_constant() && !b.is_constant() && (algebraic(&a) || algebraic(&b));
        Ok(hidden || !a.gcd(&b, self.limit())?.is_constant())
    }

    /// The denominator of the inverse: it vanishes wherever the polynomial does.
    fn cleared(&self, poly: &Poly) -> Result<Poly, Obstacle> {
        Ok(self.quotient(&Poly::one(), poly)?.den)
    }

    /// The factor that clears the last quadratic kernel from a denominator.
    pub(in crate::tower) fn conjugate(&self, den: &Poly) -> Result<Option<Poly>, Obstacle> {
        let kernels = self.round.kernels.borrow();
        let algebraic = den
            .variables()
            .iter()
            .rev()
            .copied()
            .find(|&variable| kernels[variable].relation.as_ref().is_some_and(|relation| relation.degree == 2));
        let Some(variable) = algebraic else { return Ok(None) };
        // A reduced denominator holds the kernel once at most: den = a + b v, conjugate a - b v.
        let flipped = den.terms().map(|(monomial, coefficient)| {
            let has = monomial.exponent(variable) > 0;
            (monomial, if has { -coefficient } else { coefficient.clone() })
        });
        let conjugate = Poly::from_terms(flipped)?;
        if conjugate == -den {
            // den = b v: the kernel itself is enough
            return Ok(Some(Poly::variable(variable)));
        }
        Ok(Some(conjugate))
    }
}

/// Both values, if they are numbers: then no polynomial is needed.
fn numbers(a: &Fraction, b: &Fraction) -> Option<(Rational, Rational)> {
    Some((a.to_constant()?, b.to_constant()?))
}

/// The quotient of a division that the gcd guarantees.
fn exact(quotient: Option<Poly>) -> Result<Poly, Obstacle> {
    quotient.ok_or(Obstacle::TooLarge)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Facts;

    #[test]
    fn polynomials_vanish_together_where_they_have_a_factor_in_common() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let root = arena.sqrt(x);
        let cube_root = arena.power(x, &Rational::new(1, 3).unwrap());
        let sums = [root, cube_root].map(|root| arena.add(root, y));
        let exprs = [x, y, arena.mul(x, y), arena.add(x, y), sums[0], arena.one(), sums[1]];
        let field = Field::over(&arena, &Facts::new(), &exprs).unwrap();
        let together = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|index| field.fraction(exprs[index]).unwrap().num);
            field.may_vanish_together(&a, &b).unwrap()
        };
        assert!(!together(0, 1) && !together(0, 3) && !together(3, 5));
        assert!(together(0, 2) && together(2, 1) && together(3, 3));
        assert!(!together(4, 5) && !together(5, 6) && !together(6, 5), "a number vanishes nowhere");
        assert!(together(6, 0), "what the cube root hides is not known");
    }
}
