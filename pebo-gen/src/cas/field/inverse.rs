//! Inverse trigonometric functions as kernels: one kernel for an argument, its opposite and its complement.
//!
//! `asin` and `atan` are odd, `acos(-a) = pi - acos(a)`, `asin(a) + acos(a) = pi/2`; for a positive a,
//! `atan(a) + atan(1/a) = pi/2`, and `atan2(y, x)` is `atan(y/x)` for x > 0, `pi/2 - atan(x/y)` for
//! y > 0 and `-pi/2 - atan(x/y)` for y < 0.

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::rational::half;

use super::fraction::{Fraction, negated};
use super::sign::Sign;
use super::{Field, Obstacle};

impl Field<'_> {
    /// An inverse trigonometric function at arguments whose normal form is known.
    pub(super) fn inverse_function(&self, expr: Expr) -> Result<Fraction, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else {
            return Ok(self.entered(expr, None, false));
        };
        let first = self.fraction(arguments[0])?;
        if function == Function::Atan2 {
            return self.direction(expr, &first, &self.fraction(arguments[1])?);
        }
        let opposed = first.num.leading_coefficient().is_negative();
        let argument = if opposed { negated(&first) } else { first };
        let value = self.inverse_of(function, &argument)?;
        match (opposed, function) {
            (false, _) => Ok(value),
            (true, Function::Acos) => self.sub(&self.fraction(self.arena.pi())?, &value),
            _ => Ok(negated(&value)),
        }
    }

    /// The function at an argument whose leading coefficient is positive.
    fn inverse_of(&self, function: Function, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let other = match function {
            Function::Asin => Some((Function::Acos, argument.clone())),
            Function::Acos => Some((Function::Asin, argument.clone())),
            _ if !argument.is_zero() && self.is_positive(argument)? => {
                Some((Function::Atan, self.div(&Fraction::one(), argument)?))
            }
            _ => None,
        };
        if let Some((complement, argument)) = other {
            let call = self.arena.call(complement, &[self.show(&argument)]);
            if self.numbers.borrow().contains_key(&call) {
                return self.sub(&self.right_angle()?, &self.entered(call, None, false));
            }
        }
        let call = self.arena.call(function, &[self.show(argument)]);
        match self.arena.as_number(call) {
            Some(value) => Ok(Fraction::constant(&value)),
            None => Ok(self.entered(call, None, false)),
        }
    }

    fn right_angle(&self) -> Result<Fraction, Obstacle> {
        self.scale(&self.fraction(self.arena.pi())?, &half())
    }

    /// `atan2(y, x)`: an `atan` where the sign of one of them is known.
    fn direction(&self, expr: Expr, y: &Fraction, x: &Fraction) -> Result<Fraction, Obstacle> {
        let atan = |ratio: &Fraction| -> Result<Fraction, Obstacle> {
            let opposed = ratio.num.leading_coefficient().is_negative();
            let value = self.inverse_of(Function::Atan, &if opposed { negated(ratio) } else { ratio.clone() })?;
            Ok(if opposed { negated(&value) } else { value })
        };
        if self.is_positive(x)? {
            return atan(&self.div(y, x)?);
        }
        let quarter = match self.sign_of(y)? {
            Some(Sign::Positive) => self.right_angle()?,
            Some(Sign::Negative) => negated(&self.right_angle()?),
            _ => return Ok(self.entered(self.tidy_call(expr)?, None, false)),
        };
        self.sub(&quarter, &atan(&self.div(x, y)?)?)
    }
}
