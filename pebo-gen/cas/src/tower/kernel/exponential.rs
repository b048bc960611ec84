//! Exponentials.
//!
//! Exponents are split like angles: `exp(2*a + b)` becomes a polynomial in exponentials of basis
//! arguments; the exponential of a multiple of a logarithm becomes a power.

use crate::Rational;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;

use crate::tower::fraction::Fraction;
use crate::tower::{Family, Field, Obstacle};

impl Field<'_> {
    /// The exponential of an argument.
    pub(in crate::tower) fn exponential(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let mut total = Fraction::one();
        for (key, factor) in self.split(Family::Exponent, argument)? {
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
    pub(in crate::tower) fn basic_exponential(&self, key: Expr, factor: &Rational) -> Result<Fraction, Obstacle> {
        let (unit, times) = self.multiple(Family::Exponent, key, factor)?;
        let argument = self.arena.scale(key, &unit);
        let kernel = self.entered(self.arena.call(Function::Exp, &[argument]), None, true);
        self.pow(&kernel, times)
    }
}
