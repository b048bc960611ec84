//! Roots of fractions.
//!
//! `sqrt(n/d)` with a positive d becomes `sqrt(n*d)/d`; of the radicand, even powers and known
//! positive kernels come out, and what is left is a kernel r with the relation `r^q = radicand`. Where
//! the sign of a part is not known, the root stays whole, which is correct but may leave two kernels
//! that are related: then an identity among them is not seen.

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;
use crate::cas::rational::Rational;

use super::exponent::prime_powers;
use super::fraction::{Fraction, primitive};
use super::kernel::Relation;
use super::sign::Sign;
use super::{Field, Obstacle};

impl Field<'_> {
    /// `base ^ exponent` for an exponent that is not an integer; the positive real power.
    pub(super) fn root(&self, base: &Fraction, exponent: &Rational) -> Result<Fraction, Obstacle> {
        if base.is_zero() {
            return if exponent.is_negative() { Err(Obstacle::DivisionByZero) } else { Ok(Fraction::zero()) };
        }
        let degree = exponent.denominator().to_i64().and_then(|q| u32::try_from(q).ok()).ok_or(Obstacle::TooLarge)?;
        let times = exponent.numerator().to_i64().ok_or(Obstacle::TooLarge)?;
        let bottom = self.sign(&base.den)?;
        let flipped = match bottom {
            Some(Sign::Positive) => base.clone(),
            Some(Sign::Negative) => Fraction { num: -&base.num, den: -&base.den },
            _ => return self.pow(&self.whole_root(base, degree)?, times),
        };
        // (n/d)^(1/q) = (n d^(q-1))^(1/q) / d
        let cleared = flipped.den.pow(degree - 1, self.limit())?;
        let radicand = self.reduce(&flipped.num.mul(&cleared, self.limit())?)?;
        let above = self.root_of_polynomial(&radicand, degree)?;
        let root = self.div(&above, &Fraction::polynomial(flipped.den))?;
        self.pow(&root, times)
    }

    /// A root whose parts have unknown signs: `r = d * (n/d)^(1/q)` has `r^q = n d^(q-1)`.
    fn whole_root(&self, base: &Fraction, degree: u32) -> Result<Fraction, Obstacle> {
        let value = self.reduce(&base.num.mul(&base.den.pow(degree - 1, self.limit())?, self.limit())?)?;
        let exponent = Rational::new(1, i64::from(degree)).ok_or(Obstacle::DivisionByZero)?;
        let shown = self.arena.power(self.show(base), &exponent);
        let den = self.show(&Fraction::polynomial(base.den.clone()));
        let kernel = self.arena.mul(den, shown);
        let root = self.entered(kernel, Some(Relation { degree, value }), false);
        self.div(&root, &Fraction::polynomial(base.den.clone()))
    }

    /// The positive root of a polynomial.
    fn root_of_polynomial(&self, radicand: &Poly, degree: u32) -> Result<Fraction, Obstacle> {
        let (content, mut rest) = primitive(radicand);
        let mut total = Fraction::one();
        for (prime, times) in prime_powers(&content) {
            total = self.mul(&total, &self.root_of_number(&prime, times, degree)?)?;
        }
        let (powers, without) = self.take_positive_kernels(&rest)?;
        rest = without;
        for (kernel, times) in powers {
            total = self.mul(&total, &self.root_of_kernel(kernel, times, degree)?)?;
        }
        let (outside, inside) = self.take_powers(&rest, degree)?;
        total = self.mul(&total, &outside)?;
        if inside.is_one() {
            return Ok(total);
        }
        let last = self.root_of_rest(&inside, degree)?;
        self.mul(&total, &last)
    }

    /// `(prime^times)^(1/degree)`
    fn root_of_number(&self, prime: &Integer, times: u32, degree: u32) -> Result<Fraction, Obstacle> {
        let whole = Fraction::polynomial(Poly::constant(prime.pow(times / degree)));
        self.kernel_root(&Poly::constant(prime.clone()), times % degree, degree).and_then(|r| self.mul(&whole, &r))
    }

    /// `(kernel^times)^(1/degree)` for a positive kernel.
    fn root_of_kernel(&self, kernel: u32, times: u32, degree: u32) -> Result<Fraction, Obstacle> {
        let poly = Poly::variable(kernel);
        if let Node::Call(Function::Exp, inside) = self.arena.node(self.kernel(kernel)) {
            let share = Rational::new(i64::from(times), i64::from(degree)).ok_or(Obstacle::DivisionByZero)?;
            return self.exponential(&self.scale(&self.fraction(inside[0])?, &share)?);
        }
        let whole = Fraction::polynomial(poly.pow(times / degree, self.limit())?);
        self.kernel_root(&poly, times % degree, degree).and_then(|r| self.mul(&whole, &r))
    }

    /// `(radicand^(1/degree))^times` as a power of one kernel; the radicand positive and not a power.
    fn kernel_root(&self, radicand: &Poly, times: u32, degree: u32) -> Result<Fraction, Obstacle> {
        if times == 0 {
            return Ok(Fraction::one());
        }
        let exponent = Rational::new(1, i64::from(degree)).ok_or(Obstacle::DivisionByZero)?;
        let shown = self.arena.power(self.show(&Fraction::polynomial(radicand.clone())), &exponent);
        // A root is zero where its radicand is: positive by nature is only that of a number.
        let positive = radicand.is_constant();
        let root = self.entered(shown, Some(Relation { degree, value: radicand.clone() }), positive);
        self.pow(&root, i64::from(times))
    }

    /// Takes full powers out of the square-free decomposition: what stands outside and inside.
    fn take_powers(&self, poly: &Poly, degree: u32) -> Result<(Fraction, Poly), Obstacle> {
        let mut outside = Fraction::one();
        let mut inside = poly.clone();
        for (factor, multiplicity) in poly.square_free(self.limit())?.factors {
            let times = multiplicity / degree;
            if times == 0 || factor.is_constant() {
                continue;
            }
            // (f^(k q) g)^(1/q) = |f|^k g^(1/q) for an even q; for an odd one g must be known non-negative,
            // which the sign of f shows.
            let size = match self.sign(&factor)? {
                Some(Sign::Positive | Sign::NonNegative) => Some(factor.clone()),
                Some(Sign::Negative) if degree.is_multiple_of(2) => Some(-&factor),
                _ if degree.is_multiple_of(2) && times.is_multiple_of(2) => Some(factor.clone()),
                _ => None,
            };
            let taken = factor.pow(times * degree, self.limit())?;
            let Some(rest) = inside.div_exact(&taken, self.limit())? else { continue };
            match size {
                Some(size) => {
                    let power = Fraction::polynomial(self.reduce(&size.pow(times, self.limit())?)?);
                    outside = self.mul(&outside, &power)?;
                    inside = rest;
                }
                None if degree == 2 => {
                    let magnitude = self.magnitude(&factor)?;
                    outside = self.mul(&outside, &self.pow(&magnitude, i64::from(times))?)?;
                    inside = rest;
                }
                None => {}
            }
        }
        Ok((outside, inside))
    }

    /// `|poly|`: by its sign where that is known, else the product of the magnitudes of its parts.
    pub(super) fn magnitude(&self, poly: &Poly) -> Result<Fraction, Obstacle> {
        match self.sign(poly)? {
            Some(sign) if sign.is_positive_or_zero() => return Ok(Fraction::polynomial(poly.clone())),
            Some(_) => return Ok(Fraction::polynomial(-poly)),
            None => {}
        }
        let parts = poly.square_free(self.limit())?;
        let mut total = Fraction::polynomial(Poly::constant(parts.content.abs()));
        for (factor, times) in parts.factors {
            let mut rest = factor.clone();
            let mut pieces = Vec::new();
            for &(variable, exponent) in factor.monomial_content().powers() {
                let power = Poly::variable(variable).pow(exponent, self.limit())?;
                if let Some(quotient) = rest.div_exact(&power, self.limit())? {
                    rest = quotient;
                    pieces.push((Poly::variable(variable), exponent));
                }
            }
            pieces.push((rest, 1));
            for (piece, exponent) in pieces {
                let size = self.size(&piece)?;
                total = self.mul(&total, &self.pow(&size, i64::from(exponent) * i64::from(times))?)?;
            }
        }
        Ok(total)
    }

    /// `|poly|` for what does not split: by its sign where that is known, else a kernel whose square is known.
    fn size(&self, poly: &Poly) -> Result<Fraction, Obstacle> {
        match self.sign(poly)? {
            Some(sign) if sign.is_positive_or_zero() => return Ok(Fraction::polynomial(poly.clone())),
            Some(_) => return Ok(Fraction::polynomial(-poly)),
            None => {}
        }
        let shown = self.show(&Fraction::polynomial(poly.clone()));
        let value = self.reduce(&poly.mul(poly, self.limit())?)?;
        let kernel = self.arena.call(Function::Abs, &[shown]);
        Ok(self.entered(kernel, Some(Relation { degree: 2, value }), false))
    }

    /// The root of a primitive polynomial without powers: over an earlier radicand where one divides it.
    ///
    /// Where `sqrt(g)` and `sqrt(g m)` have values, g and g m are not negative, so m is not negative
    /// either and `sqrt(g m) = sqrt(g) sqrt(m)`.
    fn root_of_rest(&self, inside: &Poly, degree: u32) -> Result<Fraction, Obstacle> {
        let mut rest = inside.clone();
        let mut total = Fraction::one();
        for (kernel, radicand) in self.roots(degree) {
            if radicand.is_constant() || radicand.variables().len() > rest.variables().len() {
                continue;
            }
            if let Some(quotient) = rest.div_exact(&radicand, self.limit())? {
                total = self.mul(&total, &Fraction::polynomial(Poly::variable(kernel)))?;
                rest = quotient;
            }
        }
        if let Some(value) = rest.to_constant() {
            let constant = Fraction::constant(&Rational::from(value.clone()));
            if value.is_one() {
                return Ok(total);
            }
            let exponent = Rational::new(1, i64::from(degree)).ok_or(Obstacle::DivisionByZero)?;
            return if value.is_negative() {
                Err(Obstacle::Kernel(format!("the root of {value}")))
            } else {
                self.mul(&total, &self.root(&constant, &exponent)?)
            };
        }
        let root = self.kernel_root(&rest, 1, degree)?;
        self.mul(&total, &root)
    }

    /// The root kernels of a degree, with their radicands.
    fn roots(&self, degree: u32) -> Vec<(u32, Poly)> {
        let kernels = self.kernels.borrow();
        (0..)
            .zip(kernels.iter())
            .filter(|(_, kernel)| self.is_plain_root(kernel.expr))
            .filter_map(|(number, kernel)| {
                let relation = kernel.relation.as_ref().filter(|relation| relation.degree == degree)?;
                Some((number, relation.value.clone()))
            })
            .collect()
    }

    pub(super) fn is_plain_root(&self, expr: Expr) -> bool {
        match self.arena.node(expr) {
            Node::Product(product) => {
                product.coefficient.is_one()
                    && matches!(product.factors.as_slice(), [(_, exponent)] if exponent.numerator().is_one() && !exponent.is_integer())
            }
            _ => false,
        }
    }
}
