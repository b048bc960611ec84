//! Sine and cosine of split angles.
//!
//! An angle is split into integer multiples of basis angles; sines and cosines of multiples and sums follow by the
//! addition theorems. Rational multiples of pi are exact if they have roots of two and three, and inverse functions
//! cancel (`sin(atan2(a, b)) = a / sqrt(a^2 + b^2)`).

use crate::graph::expr::{Expr, Node};
use crate::{Integer, Rational};

use super::range::{Pair, Range};
use crate::tower::fraction::Fraction;
use crate::tower::{Family, Field, Obstacle};

impl Field<'_> {
    /// Sine and cosine of an argument.
    pub(in crate::tower) fn angle(&self, argument: &Fraction) -> Result<Pair, Obstacle> {
        let mut total = (Fraction::zero(), Fraction::one());
        for (key, factor) in self.split(Family::Angle, argument)? {
            let pair = match self.arena.node(key) {
                Node::Pi => self.multiple_of_pi(&factor)?,
                _ => self.multiple_of(key, &factor)?,
            };
            total = self.sum_of_angles(&total, &pair)?;
        }
        self.remember_angle(argument, &total);
        Ok(total)
    }

    /// Sine and cosine of a sum, from those of the summands.
    pub(in crate::tower) fn sum_of_angles(&self, a: &Pair, b: &Pair) -> Result<Pair, Obstacle> {
        let sin = self.add(&self.mul(&a.0, &b.1)?, &self.mul(&a.1, &b.0)?)?;
        let cos = self.sub(&self.mul(&a.1, &b.1)?, &self.mul(&a.0, &b.0)?)?;
        Ok((sin, cos))
    }

    /// Sine and cosine of `factor * key`.
    fn multiple_of(&self, key: Expr, factor: &Rational) -> Result<Pair, Obstacle> {
        let (unit, times) = self.multiple(Family::Angle, key, factor)?;
        let basic = match self.inverse(key, &unit)? {
            Some(pair) => pair,
            None => self.kernels_of_angle(self.arena.scale(key, &unit)),
        };
        let (sin, cos) = self.repeated(&basic, times.unsigned_abs())?;
        Ok(if times < 0 { (sin.opposite(), cos) } else { (sin, cos) })
    }

    /// Sine and cosine of `times` the angle, by repeated doubling.
    pub(in crate::tower) fn repeated(&self, basic: &Pair, times: u64) -> Result<Pair, Obstacle> {
        let mut total = (Fraction::zero(), Fraction::one());
        for bit in (0..u64::BITS - times.leading_zeros()).rev() {
            total = self.sum_of_angles(&total, &total)?;
            if times >> bit & 1 == 1 {
                total = self.sum_of_angles(&total, basic)?;
            }
        }
        Ok(total)
    }

    /// Sine and cosine of an inverse trigonometric function in multiples of a unit.
    fn inverse(&self, key: Expr, unit: &Rational) -> Result<Option<Pair>, Obstacle> {
        const MOST_HALVINGS: u32 = 4;
        let Some(mut pair) = self.pair_of(key)? else { return Ok(None) };
        let halvings = unit.denominator().trailing_zeros();
        if unit.denominator() != Integer::from(1_i64 << halvings.min(MOST_HALVINGS)) {
            // The third of an inverse angle has no sine in radicals; the basis angle is that third.
            return Ok(None);
        }
        let Node::Call(function, arguments) = self.arena.node(key) else { return Ok(None) };
        let mut range = self.range_of_inverse(function, &arguments)?;
        for _ in 0..halvings {
            let Some(half) = self.half_of(&pair, &range)? else { return Ok(None) };
            pair = half;
            range = Range::right_half();
        }
        let times = unit.numerator().to_i64().ok_or(Obstacle::TooLarge)?;
        Ok(Some(self.repeated(&pair, times.unsigned_abs())?))
    }
}
