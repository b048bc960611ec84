//! Inverse trigonometric functions of sines and cosines: the angle that went in, where the facts keep
//! it on the principal branch.
//!
//! `asin(sin(a)) = a` holds for -pi/2 <= a <= pi/2 and nowhere else; so with `acos` on [0, pi],
//! `atan(tan(a))` on (-pi/2, pi/2) and `atan2(r sin(a), r cos(a))` with r > 0 on (-pi, pi].

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::poly::Poly;
use crate::cas::rational::{Rational, half};

use super::fraction::Fraction;
use super::sign::Sign;
use super::{Field, Obstacle};

impl Field<'_> {
    /// The angle whose sine and cosine make up the arguments, if it is provably on the principal branch.
    pub(super) fn angle_within(&self, expr: Expr) -> Result<Option<Fraction>, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else { return Ok(None) };
        let first = self.fraction(arguments[0])?;
        let second = match arguments.get(1) {
            Some(argument) => Some(self.fraction(*argument)?),
            None => None,
        };
        for (angle, cos, sin) in self.basis_angles() {
            let (sin, cos) = (Fraction::polynomial(Poly::variable(sin)), Fraction::polynomial(Poly::variable(cos)));
            let fits = match (function, &second) {
                (Function::Asin, _) => first == sin,
                (Function::Acos, _) => first == cos,
                (Function::Atan, _) => first == self.div(&sin, &cos)?,
                (Function::Atan2, Some(other)) => self.points_along((&first, other), (&sin, &cos))?,
                _ => false,
            };
            if fits && self.on_principal_branch(function, &angle)? {
                return Ok(Some(angle));
            }
        }
        Ok(None)
    }

    /// The angles that have kernels, with those of cosine and sine.
    fn basis_angles(&self) -> Vec<(Fraction, u32, u32)> {
        let calls: Vec<(u32, Expr)> = {
            let kernels = self.kernels.borrow();
            (0..)
                .zip(kernels.iter())
                .filter_map(|(number, kernel)| match self.arena.node(kernel.expr) {
                    Node::Call(Function::Cos, arguments) => Some((number, arguments[0])),
                    _ => None,
                })
                .collect()
        };
        let with_sine = |(cos, angle): (u32, Expr)| {
            let sine = self.arena.call(Function::Sin, &[angle]);
            let sin = self.numbers.borrow().get(&sine).copied()?;
            Some((self.fraction(angle).ok()?, cos, sin))
        };
        calls.into_iter().filter_map(with_sine).collect()
    }

    /// Whether (y, x) is a positive multiple of (sin, cos).
    fn points_along(
        &self,
        (y, x): (&Fraction, &Fraction),
        (sin, cos): (&Fraction, &Fraction),
    ) -> Result<bool, Obstacle> {
        let across = self.sub(&self.mul(y, cos)?, &self.mul(x, sin)?)?;
        let along = self.add(&self.mul(x, cos)?, &self.mul(y, sin)?)?;
        Ok(across.is_zero() && self.sign_of(&along)? == Some(Sign::Positive))
    }

    fn on_principal_branch(&self, function: Function, angle: &Fraction) -> Result<bool, Obstacle> {
        let pi = self.fraction(self.arena.pi())?;
        let quarter = self.scale(&pi, &half())?;
        let (low, high) = match function {
            Function::Asin | Function::Atan => (quarter.opposite(), quarter),
            Function::Acos => (Fraction::constant(&Rational::ZERO), pi),
            _ => (pi.opposite(), pi),
        };
        // At an end where the function jumps, the sign must be strict: -pi for atan2, both for atan.
        let above = self.sign_of(&self.sub(angle, &low)?)?;
        let below = self.sign_of(&self.sub(&high, angle)?)?;
        let strict = matches!(function, Function::Atan | Function::Atan2);
        let holds = |sign: Option<Sign>, strict: bool| match sign {
            Some(Sign::Positive) => true,
            Some(Sign::NonNegative | Sign::Zero) => !strict,
            _ => false,
        };
        Ok(holds(above, strict) && holds(below, function == Function::Atan))
    }
}
