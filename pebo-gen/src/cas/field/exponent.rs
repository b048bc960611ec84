//! Exponentials and logarithms.
//!
//! Exponents are split like angles: `exp(2*a + b)` becomes a polynomial in exponentials of basis
//! arguments; the exponential of a multiple of a logarithm becomes a power. The logarithm of a product
//! is split only where the factors are known to be positive.

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;
use crate::cas::rational::Rational;

use super::fraction::{Fraction, primitive};
use super::sign::Sign;
use super::{Family, Field, Obstacle};

impl Field<'_> {
    /// The exponential of an argument.
    pub(super) fn exponential(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let mut total = Fraction::one();
        for (key, factor) in self.split(argument)? {
            let part = match self.arena.node(key) {
                Node::Call(Function::Log, inside) => {
                    let base = self.fraction(inside[0])?;
                    match factor.to_i64() {
                        Some(times) => self.pow(&base, times)?,
                        None => self.root(&base, &factor)?,
                    }
                }
                _ => self.basic_exponential(key, &factor)?,
            };
            total = self.mul(&total, &part)?;
        }
        Ok(total)
    }

    /// `exp(factor * key)` for a basis argument.
    pub(super) fn basic_exponential(&self, key: Expr, factor: &Rational) -> Result<Fraction, Obstacle> {
        let (unit, times) = self.multiple(Family::Exponent, key, factor)?;
        let argument = self.arena.scale(key, &unit);
        let kernel = self.entered(self.arena.call(Function::Exp, &[argument]), None, true);
        self.pow(&kernel, times)
    }

    /// The logarithm of an argument.
    pub(super) fn logarithm(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let (above, num) = primitive(&argument.num);
        let (below, den) = primitive(&argument.den);
        let (Some(top), Some(bottom)) = (self.sign(&num)?, self.sign(&den)?) else {
            return self.log_kernel(argument);
        };
        // Where the logarithm has a value, what is not negative is positive.
        let agree = top.is_positive_or_zero() == bottom.is_positive_or_zero();
        if top == Sign::Zero || !agree {
            return self.log_kernel(argument);
        }
        let oriented = |poly: Poly| if top == Sign::Negative { -&poly } else { poly };
        let mut total = self.sub(&self.log_of_positive(&oriented(num))?, &self.log_of_positive(&oriented(den))?)?;
        for (number, sign) in [(above, 1), (below, -1)] {
            for (prime, times) in prime_powers(&number) {
                let log = self.log_kernel(&Fraction::polynomial(Poly::constant(prime)))?;
                total = self.add(&total, &self.scale(&log, &Rational::from(sign * i64::from(times)))?)?;
            }
        }
        Ok(total)
    }

    /// The logarithm of a positive primitive polynomial: known positive kernels come out.
    fn log_of_positive(&self, poly: &Poly) -> Result<Fraction, Obstacle> {
        let mut total = Fraction::zero();
        let (powers, rest) = self.take_positive_kernels(poly)?;
        for (kernel, times) in powers {
            let expr = self.kernel(kernel);
            let log = match self.arena.node(expr) {
                Node::Call(Function::Exp, inside) => self.fraction(inside[0])?,
                // log(a^(1/q)) = log(a)/q: both have values where a is positive.
                Node::Product(product) if self.is_plain_root(expr) => {
                    let (base, exponent) = &product.factors[0];
                    self.scale(&self.logarithm(&self.fraction(*base)?)?, exponent)?
                }
                _ => self.log_kernel(&Fraction::polynomial(Poly::variable(kernel)))?,
            };
            total = self.add(&total, &self.scale(&log, &Rational::from(i64::from(times)))?)?;
        }
        let mut left = rest.clone();
        for (factor, times) in rest.square_free(self.limit())?.factors {
            // Of an even power, the magnitude counts; of an odd one, only what is positive comes out.
            let size = match self.sign(&factor)? {
                Some(Sign::Positive) => factor.clone(),
                Some(Sign::Negative) if times % 2 == 0 => -&factor,
                _ => continue,
            };
            if size == left {
                break;
            }
            if let Some(quotient) = left.div_exact(&factor.pow(times, self.limit())?, self.limit())? {
                left = quotient;
                let log = self.log_kernel(&Fraction::polynomial(size))?;
                total = self.add(&total, &self.scale(&log, &Rational::from(i64::from(times)))?)?;
            }
        }
        if !left.is_one() {
            total = self.add(&total, &self.log_kernel(&Fraction::polynomial(left))?)?;
        }
        Ok(total)
    }

    fn log_kernel(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        if argument.is_zero() {
            return Err(Obstacle::DivisionByZero);
        }
        let call = self.arena.call(Function::Log, &[self.show(argument)]);
        match self.arena.as_number(call) {
            Some(value) => Ok(Fraction::constant(&value)),
            None => Ok(self.entered(call, None, false)),
        }
    }

    /// Takes kernels that are known to be positive out of a polynomial's monomial content.
    pub(super) fn take_positive_kernels(&self, poly: &Poly) -> Result<(Vec<(u32, u32)>, Poly), Obstacle> {
        let mut powers = Vec::new();
        let mut rest = poly.clone();
        for &(variable, exponent) in poly.monomial_content().powers() {
            let factor = Poly::variable(variable);
            if self.sign(&factor)? == Some(Sign::Positive) {
                let power = factor.pow(exponent, self.limit())?;
                if let Some(quotient) = rest.div_exact(&power, self.limit())? {
                    rest = quotient;
                    powers.push((variable, exponent));
                }
            }
        }
        Ok((powers, rest))
    }
}

/// The prime factors of a positive integer, small ones by trial; what remains counts as one.
pub(super) fn prime_powers(number: &Integer) -> Vec<(Integer, u32)> {
    const LARGEST: i64 = 1000;
    let mut rest = number.abs();
    let mut powers = Vec::new();
    let mut candidate = 2;
    while candidate <= LARGEST && !rest.is_one() && !rest.is_zero() {
        let prime = Integer::from(candidate);
        let mut times = 0;
        while let Some(quotient) = rest.div_exact(&prime) {
            rest = quotient;
            times += 1;
        }
        if times > 0 {
            powers.push((prime, times));
        }
        candidate += 1;
    }
    if !rest.is_one() && !rest.is_zero() {
        powers.push((rest, 1));
    }
    powers
}
