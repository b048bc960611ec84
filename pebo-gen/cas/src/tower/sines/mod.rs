//! Sine and cosine of one angle: the relation `sin^2 + cos^2 = 1` of two kernels.
//!
//! The normal form has no square of a sine: `sin(q)^2` is `1 - cos(q)^2`. In: a polynomial in this form. Out: its powers
//! of sines ([`Field::without_sines`]), the same polynomial over squares of sines in place of those of cosines
//! ([`Field::with_sines`]), its square root, which half the angle shows ([`half_angle`]), and a fraction without the
//! sines that numerator and denominator have in common ([`common`]).

mod common;
mod half_angle;

use crate::Arena;
use crate::Rational;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::poly::Poly;

use super::fraction::Fraction;
use super::kernel::AlgebraicRelation;
use super::kernel::range::Pair;
use super::{Field, Obstacle};

/// A power of a sine that a polynomial holds as one of `1 - cos(q)^2`.
pub(in crate::tower) struct SinePower {
    pub(in crate::tower) sine: u32,
    pub(in crate::tower) cosine: u32,
    /// The even exponent.
    pub(in crate::tower) times: u32,
}

impl Field<'_> {
    /// The kernels of an angle.
    pub(in crate::tower) fn kernels_of_angle(&self, angle: Expr) -> Pair {
        let cos = self.enter(self.arena.call(Function::Cos, &[angle]), None, false);
        // Squaring one variable cannot exceed any limit.
        let relation = self.square_beside(cos).ok().map(|value| AlgebraicRelation { degree: 2, value });
        let sin = self.entered(self.arena.call(Function::Sin, &[angle]), relation, false);
        (sin, Fraction::polynomial(Poly::variable(cos)))
    }

    /// The sine kernel of the same angle, for a cosine kernel.
    fn sine_beside(&self, cosine: u32) -> Option<u32> {
        let Node::Call(Function::Cos, arguments) = self.arena.node(self.kernel(cosine)) else { return None };
        let sine = self.arena.call(Function::Sin, &arguments);
        self.round.kernels.borrow().number_of(sine)
    }

    /// The square of the one of sine and cosine, by the other.
    fn square_beside(&self, kernel: u32) -> Result<Poly, Obstacle> {
        Ok(&Poly::one() - &Poly::variable(kernel).pow(2, self.limit())?)
    }

    /// The polynomial without its factors `1 - cos(q)^2`, and these as powers of sines.
    pub(in crate::tower) fn without_sines(&self, poly: &Poly) -> Result<(Poly, Vec<SinePower>), Obstacle> {
        let (mut rest, mut powers) = (poly.clone(), Vec::new());
        for &cosine in poly.variables() {
            let Some(sine) = self.sine_beside(cosine) else { continue };
            let square = self.square_beside(cosine)?;
            let mut times = 0;
            while rest.degree(cosine) > 1
                && let Some(quotient) = rest.div_exact(&square, self.limit())?
            {
                rest = quotient;
                times += 2;
            }
            if times > 0 {
                powers.push(SinePower { sine, cosine, times });
            }
        }
        Ok((rest, powers))
    }

    /// The polynomial with squared cosines replaced by squared sines, if there are any.
    pub(in crate::tower) fn with_sines(&self, poly: &Poly) -> Result<Option<Poly>, Obstacle> {
        let mut other = poly.clone();
        for &cosine in poly.variables() {
            if let Some(sine) = self.sine_beside(cosine) {
                other = other.reduce_power(cosine, 2, &self.square_beside(sine)?, self.limit())?;
            }
        }
        Ok((other != *poly).then_some(other))
    }
}

impl Arena {
    /// `sin(q)`, from `cos(q)^2 - 1` or a multiple of it.
    pub(crate) fn sine_of_square(&self, expr: Expr) -> Option<Expr> {
        let Node::Sum(sum) = self.node(expr) else { return None };
        let [(term, slope)] = sum.terms.as_slice() else { return None };
        let Node::Product(product) = self.node(*term) else { return None };
        let [(base, power)] = product.factors.as_slice() else { return None };
        let Node::Call(Function::Cos, arguments) = self.node(*base) else { return None };
        let is_square = *power == Rational::from(2) && *slope == -&sum.constant;
        is_square.then(|| self.call(Function::Sin, &arguments))
    }
}
