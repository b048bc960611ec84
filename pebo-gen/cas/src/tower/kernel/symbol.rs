//! Symbols on a manifold: a symbol that an equation determines is no variable of its own.
//!
//! ```text
//! s = middle                       s is that expression
//! (s - middle)^degree = n/d        d*(s - middle) is a kernel, whose power is n*d^(degree - 1)
//! ```

use crate::graph::expr::{Expr, Symbol};
use crate::poly::Poly;

use super::AlgebraicRelation;
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

impl Field<'_> {
    /// A symbol: a kernel, or its value by an exact step of the manifold.
    pub(in crate::tower) fn of_symbol(&self, expr: Expr, symbol: Symbol) -> Result<Fraction, Obstacle> {
        let Some(step) = self.steps.get(&symbol) else { return Ok(self.entered(expr, None, false)) };
        let middle = self.fraction(step.middle)?;
        let Some(root) = &step.root else { return Ok(middle) };
        let radicand = self.fraction(root.radicand)?;
        let mut value = radicand.num;
        for _ in 1..root.degree {
            value = self.reduce(&value.mul(&radicand.den, self.limit())?)?;
        }
        if value.is_zero() {
            return Ok(middle);
        }
        let denominator = self.show_polynomial(&radicand.den);
        let kernel = self.arena.mul(denominator, self.arena.sub(expr, step.middle));
        let relation = AlgebraicRelation { degree: root.degree, value };
        let offset = self.quotient(&Poly::variable(self.enter(kernel, Some(relation), false)), &radicand.den)?;
        self.add(&middle, &offset)
    }
}
