//! Jumps of a function at its non-smooth points.
//!
//! In: a domain and a function with absolute values, signs, least and greatest values. Out: the borders at which the
//! function is not proved continuous, each with the difference of its one-sided values: `q*sign(q - 1)` jumps by 2 at q
//! = 1, and `abs(q - 1)` nowhere. A border that is not solved for a symbol is examined in normal forms.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::manifold::Manifold;
use super::zero::is_zero;
use crate::graph::conditions::Regularity;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;
use crate::tower::{Field, Obstacle};
use crate::{Arena, Domain, Facts, Relation};

/// A border, and the jump of a function across it.
#[derive(Clone, Copy, Debug)]
pub struct Jump {
    /// The expression that is zero at the border.
    pub border: Expr,
    /// The difference of the values on both sides, at the border; none at a pole under a bounded function.
    pub by: Option<Expr>,
}

impl Domain {
    /// The jumps of a function that are not excluded, at borders that vary.
    pub fn jumps(&self, arena: &Arena, expr: Expr, varies: impl Fn(Expr) -> bool) -> Result<Vec<Jump>, Obstacle> {
        let mut jumps = Vec::new();
        let is_open = |border: &Expr| {
            let signed = |side: Expr| self.implies(arena, side, Relation::NonNegative);
            varies(*border) && !signed(*border) && !signed(arena.neg(*border))
        };
        for border in self.dividers(arena, &[expr])?.into_iter().filter(is_open) {
            let pieces = |is_above: bool| with_pieces(arena, expr, (border, is_above));
            let [above, below] =
                [self.on_side(arena, pieces(true), border), self.on_side(arena, pieces(false), arena.neg(border))];
            let symbols = vec![BTreeSet::new(), arena.symbols_of(&[border]), BTreeSet::new()];
            let wall = Manifold::new(arena, &self.facts, vec![border], symbols).determined();
            let by = arena.sub(arena.substitute(above, &wall), arena.substitute(below, &wall));
            if !is_zero(arena, by, self) && !self.vanishes_with(arena, by, border).unwrap_or(false) {
                jumps.push(Jump { border, by: Some(by) });
            }
        }
        let poles = bounded_poles(arena, expr).into_iter().filter(is_open);
        jumps.extend(poles.map(|border| Jump { border, by: None }));
        Ok(jumps)
    }

    /// The function where an expression is positive, in its normal form if it has one.
    fn on_side(&self, arena: &Arena, expr: Expr, positive: Expr) -> Expr {
        let mut domain = self.clone();
        domain.facts.assume(positive, Relation::Positive);
        let [branch] = domain.analytic(arena, &[expr])[..] else { return expr };
        let normal = || {
            let field = Field::over(arena, &domain.facts, &[branch])?;
            Ok::<_, Obstacle>(field.show(&field.fraction(branch)?))
        };
        normal().unwrap_or(branch)
    }

    /// True if a function has a border for a factor of its numerator.
    fn vanishes_with(&self, arena: &Arena, expr: Expr, border: Expr) -> Result<bool, Obstacle> {
        let field = Field::over(arena, &self.facts, &[expr, border])?;
        let (fraction, border) = (field.fraction(expr)?, field.fraction(border)?);
        Ok(fraction.numerator().div_exact(border.numerator(), field.limit())?.is_some())
    }
}

/// A function with each table that has a point at a border as the polynomial on one side: that a border is positive does
/// not say which piece holds far from it.
fn with_pieces(arena: &Arena, expr: Expr, (border, is_above): (Expr, bool)) -> Expr {
    let mut pieces: FxHashMap<Expr, Expr> = FxHashMap::default();
    for call in arena.postorder(&[expr]) {
        let Some((table, argument)) = Pieces::of(arena, call) else { continue };
        for (at, knot) in table.knots.iter().enumerate() {
            let quotient = arena.div(arena.sub(argument, arena.number(knot.clone())), border);
            let normal = || {
                let field = Field::over(arena, &Facts::new(), &[quotient])?;
                Ok::<_, Obstacle>(field.show(&field.fraction(quotient)?))
            };
            if let Some(factor) = normal().ok().and_then(|normal| arena.as_number(normal)) {
                let piece = at + usize::from((factor.signum() > 0) == is_above);
                pieces.insert(call, table.branch(arena, piece, argument));
            }
        }
    }
    arena.replace(expr, &pieces)
}

/// The zeros of denominators in the arguments of bounded functions: `atan(1/r)` jumps where r changes its sign, while
/// `1/r` leaves all bounds.
fn bounded_poles(arena: &Arena, expr: Expr) -> Vec<Expr> {
    let bounded = [Function::Atan, Function::Tanh, Function::Sat, Function::Sign, Function::Sin, Function::Cos];
    let arguments = arena.postorder(&[expr]).into_iter().filter_map(|node| match arena.node(node) {
        Node::Call(function, arguments) if bounded.contains(&function) => Some(arguments.to_vec()),
        _ => None,
    });
    let arguments: Vec<Expr> = arguments.flatten().collect();
    let conditions = arena.domain_conditions(&arguments, Regularity::Defined).into_iter();
    conditions.filter(|(_, relation)| *relation == Relation::NonZero).map(|(denominator, _)| denominator).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rational;
    use crate::graph::function::pieces::through;

    /// At each point of a table, not at the first alone.
    #[test]
    fn slopes_of_tables_jump_where_lines_meet() {
        let arena = Arena::new();
        let q = arena.variable("q");
        let points = [(0, 0), (1, 1), (2, 3), (3, 3)].map(|(at, value)| (Rational::from(at), Rational::from(value)));
        let of = |is_cubic: bool, order: usize, argument: Expr| {
            let table = Pieces { order, ..through(&points, is_cubic).unwrap() };
            let jumps = Domain::default().jumps(&arena, table.call(&arena, argument), |_| true).unwrap();
            let by = |jump: &Jump| format!("{}: {}", arena.print(jump.border), arena.print(jump.by.unwrap()));
            jumps.iter().map(by).collect::<Vec<String>>()
        };
        assert_eq!(of(false, 0, q), [""; 0]);
        assert_eq!(of(false, 1, q), ["q - 1: 1", "q - 2: -2"]);
        assert_eq!(of(false, 1, arena.scale(q, &Rational::from(-2))), ["2*q + 1: -1", "q + 1: 2"]);
        // The last piece is level, as is what follows.
        assert_eq!((of(true, 0, q).len(), of(true, 1, q).len(), of(true, 2, q).len()), (0, 0, 3));
    }

    #[test]
    fn continuous_non_smooth_functions_have_no_jump() {
        let arena = Arena::new();
        let [p, q, c] = ["p", "q", "c"].map(|name| arena.variable(name));
        let call = |function, argument| arena.call(function, &[argument]);
        let away = arena.sub(q, c);
        let (sign, size) = (call(Function::Sign, away), call(Function::Abs, away));
        let shown = |expr: Expr| {
            let jumps = Domain::default().jumps(&arena, expr, |_| true).unwrap();
            jumps
                .iter()
                .map(|jump| jump.by.map_or_else(|| "a pole".to_owned(), |by| arena.print(by)))
                .collect::<Vec<_>>()
                .join(", ")
        };
        for smooth in [arena.mul(p, q), size, arena.mul(away, sign), arena.mul(p, call(Function::Log, size))] {
            let bent = arena.call(Function::Max, &[q, c]);
            assert_eq!(shown(arena.add(arena.mul(p, bent), arena.mul(q, arena.mul(size, smooth)))), "");
        }
        assert_eq!(shown(sign), "2");
        assert_eq!(shown(arena.mul(q, sign)), "2*c");
        assert_eq!(shown(arena.add(p, arena.mul(p, sign))), "2*p");
        // The domain condition of a quotient does not hide it.
        assert_eq!(shown(arena.mul(p, arena.add(arena.number(crate::Rational::from(2)), sign))), "2*p");
        assert_eq!(shown(call(Function::Atan, arena.div(p, away))), "a pole");
        assert_eq!(shown(arena.div(p, away)), "");
        // No symbol is affine.
        let wave = call(Function::Cos, q);
        assert_eq!(shown(call(Function::Abs, wave)), "");
        assert!(!shown(arena.mul(call(Function::Sin, q), call(Function::Sign, wave))).is_empty());
    }
}
