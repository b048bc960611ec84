//! Sine and cosine of split angles.
//!
//! An angle is split into integer multiples of basis angles; sines and cosines of multiples and sums
//! follow by the addition theorems. Rational multiples of pi are exact where they have roots of two
//! and three, and inverse functions cancel (`sin(atan2(a, b)) = a / sqrt(a^2 + b^2)`).

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::poly::Poly;
use crate::cas::rational::{Rational, half};

use super::fraction::{Fraction, negated};
use super::kernel::Relation;
use super::{Family, Field, Obstacle};

/// Sine and cosine of one angle.
type Pair = (Fraction, Fraction);

impl Field<'_> {
    /// Sine and cosine of an argument.
    pub(super) fn angle(&self, argument: &Fraction) -> Result<Pair, Obstacle> {
        // The sine of a sum of n angles has 2^(n-1) terms: a longer sum is one angle, which is still
        // the same kernel wherever it occurs.
        const MOST_SUMMANDS: usize = 10;
        let mut parts = self.split(argument)?;
        if parts.len() > MOST_SUMMANDS {
            parts = vec![self.undivided(argument)?];
        }
        let mut total = (Fraction::zero(), Fraction::one());
        for (key, factor) in parts {
            let pair = match self.arena.node(key) {
                Node::Pi => self.multiple_of_pi(&factor)?,
                _ => self.multiple_of(key, &factor)?,
            };
            total = self.sum_of_angles(&total, &pair)?;
        }
        Ok(total)
    }

    /// Sine and cosine of a sum, from those of the summands.
    fn sum_of_angles(&self, a: &Pair, b: &Pair) -> Result<Pair, Obstacle> {
        let sin = self.add(&self.mul(&a.0, &b.1)?, &self.mul(&a.1, &b.0)?)?;
        let cos = self.sub(&self.mul(&a.1, &b.1)?, &self.mul(&a.0, &b.0)?)?;
        Ok((sin, cos))
    }

    /// Sine and cosine of `factor * key`.
    fn multiple_of(&self, key: Expr, factor: &Rational) -> Result<Pair, Obstacle> {
        let (unit, times) = self.multiple(Family::Angle, key, factor)?;
        let basic = match self.inverse(key, &unit)? {
            Some(pair) => pair,
            None => self.basic(self.arena.scale(key, &unit)),
        };
        let (sin, cos) = self.repeated(&basic, times.unsigned_abs())?;
        Ok(if times < 0 { (negated(&sin), cos) } else { (sin, cos) })
    }

    /// The kernels of a basis angle.
    fn basic(&self, angle: Expr) -> Pair {
        let cos = self.enter(self.arena.call(Function::Cos, &[angle]), None, false);
        let square = Poly::variable(cos);
        // sin^2 = 1 - cos^2; squaring one variable cannot exceed any limit
        let value = square.mul(&square, &self.work).map(|square| &Poly::one() - &square);
        let relation = value.ok().map(|value| Relation { degree: 2, value });
        let sin = self.entered(self.arena.call(Function::Sin, &[angle]), relation, false);
        (sin, Fraction::polynomial(Poly::variable(cos)))
    }

    /// Sine and cosine of `times` as much, by repeated doubling.
    fn repeated(&self, basic: &Pair, times: u64) -> Result<Pair, Obstacle> {
        let mut total = (Fraction::zero(), Fraction::one());
        for bit in (0..u64::BITS - times.leading_zeros()).rev() {
            total = self.sum_of_angles(&total, &total)?;
            if times >> bit & 1 == 1 {
                total = self.sum_of_angles(&total, basic)?;
            }
        }
        Ok(total)
    }

    /// Sine and cosine of an inverse trigonometric function, taken a whole number of times.
    fn inverse(&self, key: Expr, unit: &Rational) -> Result<Option<Pair>, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(key) else { return Ok(None) };
        if !matches!(function, Function::Asin | Function::Acos | Function::Atan | Function::Atan2) {
            return Ok(None);
        }
        if !unit.is_integer() {
            // Half an inverse angle has no rational sine; the basis angle is the whole one.
            return Ok(None);
        }
        let a = self.fraction(arguments[0])?;
        let complement = |a: &Fraction| -> Result<Fraction, Obstacle> {
            self.root(&self.sub(&Fraction::one(), &self.pow(a, 2)?)?, &half())
        };
        let pair = match function {
            Function::Asin => (a.clone(), complement(&a)?),
            Function::Acos => (complement(&a)?, a.clone()),
            Function::Atan => {
                let radius = self.root(&self.add(&Fraction::one(), &self.pow(&a, 2)?)?, &half())?;
                (self.div(&a, &radius)?, self.div(&Fraction::one(), &radius)?)
            }
            _ => {
                let b = self.fraction(arguments[1])?;
                let radius = self.root(&self.add(&self.pow(&a, 2)?, &self.pow(&b, 2)?)?, &half())?;
                (self.div(&a, &radius)?, self.div(&b, &radius)?)
            }
        };
        let times = unit.to_i64().ok_or(Obstacle::TooLarge)?;
        Ok(Some(self.repeated(&pair, times.unsigned_abs())?))
    }

    /// Sine and cosine of a rational multiple of pi.
    fn multiple_of_pi(&self, factor: &Rational) -> Result<Pair, Obstacle> {
        let quarters = Rational::from((factor * &Rational::from(2)).floor());
        let rest = factor - &(&quarters * &half());
        let root_of = |n: i64| self.root(&Fraction::constant(&Rational::from(n)), &half());
        let half_of = |f: &Fraction| self.scale(f, &half());
        let fraction = (rest.numerator().to_i64(), rest.denominator().to_i64());
        let first = match fraction {
            (Some(0), _) => (Fraction::zero(), Fraction::one()),
            (Some(1), Some(6)) => (Fraction::constant(&half()), half_of(&root_of(3)?)?),
            (Some(1), Some(4)) => (half_of(&root_of(2)?)?, half_of(&root_of(2)?)?),
            (Some(1), Some(3)) => (half_of(&root_of(3)?)?, Fraction::constant(&half())),
            _ => self.basic(self.arena.scale(self.arena.pi(), &rest)),
        };
        let (sin, cos) = first;
        Ok(match quarters.numerator().rem_u64(4) {
            0 => (sin, cos),
            1 => (cos, negated(&sin)),
            2 => (negated(&sin), negated(&cos)),
            _ => (negated(&cos), sin),
        })
    }
}
