//! Jumps of a function at its non-smooth points.
//!
//! In: a domain and a function with absolute values, signs, least and greatest values. Out: the borders at which the
//! function is not proved continuous, each with the difference of its one-sided values: `q*sign(q - 1)` jumps by 2 at q
//! = 1, and `abs(q - 1)` nowhere. A border in which no symbol is affine is examined in normal forms.

use super::zero::decide;
use crate::graph::expr::Expr;
use crate::tower::{Field, Obstacle};
use crate::{Arena, Domain, Relation};

/// A border, and the jump of a function across it.
#[derive(Clone, Copy, Debug)]
pub struct Jump {
    /// The expression that is zero at the border.
    pub border: Expr,
    /// The difference of the values on both sides, at the border.
    pub by: Expr,
}

impl Domain {
    /// The jumps of a function that are not excluded, at borders that vary.
    pub fn jumps(&self, arena: &Arena, expr: Expr, varies: impl Fn(Expr) -> bool) -> Result<Vec<Jump>, Obstacle> {
        let mut jumps = Vec::new();
        for border in self.dividers(arena, &[expr])?.into_iter().filter(|border| varies(*border)) {
            let signed = |side: Expr| self.implies(arena, side, Relation::NonNegative);
            if signed(border) || signed(arena.neg(border)) {
                continue;
            }
            let [above, below] = [self.on_side(arena, expr, border)?, self.on_side(arena, expr, arena.neg(border))?];
            let by = match crossing(arena, border) {
                Some(place) => {
                    let at = |side: Expr| arena.substitute(side, &[place].into());
                    arena.sub(at(above), at(below))
                }
                None => arena.sub(above, below),
            };
            if !decide(arena, by, self).is_zero() && !self.vanishes_with(arena, by, border)? {
                jumps.push(Jump { border, by });
            }
        }
        Ok(jumps)
    }

    /// The function where an expression is positive, in its normal form.
    fn on_side(&self, arena: &Arena, expr: Expr, positive: Expr) -> Result<Expr, Obstacle> {
        let mut domain = self.clone();
        domain.facts.assume(positive, Relation::Positive);
        let field = Field::over(arena, &domain.facts, &[expr])?;
        Ok(field.show(&field.fraction(expr)?))
    }

    /// True if a function has a border for a factor of its numerator.
    fn vanishes_with(&self, arena: &Arena, expr: Expr, border: Expr) -> Result<bool, Obstacle> {
        let field = Field::over(arena, &self.facts, &[expr, border])?;
        let (fraction, border) = (field.fraction(expr)?, field.fraction(border)?);
        Ok(fraction.numerator().div_exact(border.numerator(), field.limit())?.is_some())
    }
}

/// The symbol in which a border is affine, and its value there.
fn crossing(arena: &Arena, border: Expr) -> Option<(crate::Symbol, Expr)> {
    arena.symbols_of(&[border]).into_iter().find_map(|symbol| {
        let slope = arena.derivative(border, symbol);
        if !arena.symbols_of(&[slope]).is_empty() || arena.is_zero(slope) {
            return None;
        }
        let rest = arena.substitute(border, &[(symbol, arena.zero())].into());
        Some((symbol, arena.neg(arena.div(rest, slope))))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Function;

    #[test]
    fn continuous_non_smooth_functions_have_no_jump() {
        let arena = Arena::new();
        let [p, q, c] = ["p", "q", "c"].map(|name| arena.variable(name));
        let call = |function, argument| arena.call(function, &[argument]);
        let away = arena.sub(q, c);
        let (sign, size) = (call(Function::Sign, away), call(Function::Abs, away));
        let shown = |expr: Expr| {
            let jumps = Domain::default().jumps(&arena, expr, |_| true).unwrap();
            jumps.iter().map(|jump| arena.print(jump.by)).collect::<Vec<_>>().join(", ")
        };
        for smooth in [arena.mul(p, q), size, arena.mul(away, sign), arena.mul(p, call(Function::Log, size))] {
            let bent = arena.call(Function::Max, &[q, c]);
            assert_eq!(shown(arena.add(arena.mul(p, bent), arena.mul(q, arena.mul(size, smooth)))), "");
        }
        assert_eq!(shown(sign), "2");
        assert_eq!(shown(arena.mul(q, sign)), "2*c");
        assert_eq!(shown(arena.add(p, arena.mul(p, sign))), "2*p");
        // No symbol is affine.
        let wave = call(Function::Cos, q);
        assert_eq!(shown(call(Function::Abs, wave)), "");
        assert!(!shown(arena.mul(call(Function::Sin, q), call(Function::Sign, wave))).is_empty());
    }
}
