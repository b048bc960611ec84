//! Entries that rows of the table share: derivatives, conditions and forms in terms of other functions, built from the
//! arguments, and two values that the standard library computes with fewer digits.

use crate::graph::arena::Arena;
use crate::graph::expr::Expr;
use crate::number::rational::half;
use crate::{Rational, Relation};

use super::kind::Function;

/// Comparisons with zero.
pub type Conditions = Vec<(Expr, Relation)>;

/// `a^2`
pub(super) fn square(arena: &Arena, a: Expr) -> Expr {
    arena.power(a, &Rational::from(2))
}

/// `1/a`
pub(super) fn recip(arena: &Arena, a: Expr) -> Expr {
    arena.power(a, &Rational::from(-1))
}

/// `1 - a^2`
pub(super) fn beyond(arena: &Arena, a: Expr) -> Expr {
    arena.sub(arena.one(), square(arena, a))
}

/// `1/sqrt(1 - a^2)`
pub(super) fn inverse_circle(arena: &Arena, a: Expr) -> Expr {
    recip(arena, arena.sqrt(beyond(arena, a)))
}

/// The inverse hyperbolic cosine; near 1 the standard library's loses the digits of `a - 1`.
pub(super) fn acosh(a: f64) -> f64 {
    let above = a - 1.0;
    (above + (above * (a + 1.0)).sqrt()).ln_1p()
}

/// The inverse hyperbolic tangent; near -1 the standard library's loses the digits of `1 + a`.
pub(super) fn atanh(a: f64) -> f64 {
    let size = a.abs();
    (0.5 * (2.0 * size / (1.0 - size)).ln_1p()).copysign(a)
}

/// `sqrt(a^2 + 1)`
pub(super) fn hypotenuse(arena: &Arena, a: Expr) -> Expr {
    arena.sqrt(arena.add(square(arena, a), arena.one()))
}

/// `sqrt(a^2 - 1)`
pub(super) fn leg(arena: &Arena, a: Expr) -> Expr {
    arena.sqrt(arena.neg(beyond(arena, a)))
}

/// `a - 1`
pub(super) fn above_one(arena: &Arena, a: Expr) -> Expr {
    arena.sub(a, arena.one())
}

/// `a^2 + b^2`
pub(super) fn radius(arena: &Arena, a: &[Expr]) -> Expr {
    arena.add(square(arena, a[0]), square(arena, a[1]))
}

/// No condition, for a function that has a value everywhere.
pub(super) fn nothing(_: &Arena, _: &[Expr]) -> Conditions {
    Vec::new()
}

/// For an inverse sine or cosine: an argument within [-1, 1].
pub(super) fn within_one(arena: &Arena, a: &[Expr]) -> Conditions {
    vec![(beyond(arena, a[0]), Relation::NonNegative)]
}

/// For their derivatives, and for an inverse hyperbolic tangent: an argument strictly within.
pub(super) fn strictly_within_one(arena: &Arena, a: &[Expr]) -> Conditions {
    vec![(beyond(arena, a[0]), Relation::Positive)]
}

/// For the larger and the smaller of two: that they differ.
pub(super) fn apart(arena: &Arena, a: &[Expr]) -> Conditions {
    vec![(arena.sub(a[0], a[1]), Relation::NonZero)]
}

/// `|a - b|`
pub(super) fn distance(arena: &Arena, a: &[Expr]) -> Expr {
    arena.call(Function::Abs, &[arena.sub(a[0], a[1])])
}

/// `a + 1` and `a - 1`
pub(super) fn edges(arena: &Arena, a: Expr) -> [Expr; 2] {
    [arena.add(a, arena.one()), arena.sub(a, arena.one())]
}

/// `a/2`
pub(super) fn half_of(arena: &Arena, a: Expr) -> Expr {
    arena.scale(a, &half())
}

/// One for the selected argument and zero for the other; the first is selected if `lead` is positive.
pub(super) fn shares(arena: &Arena, lead: Expr) -> Vec<Expr> {
    let sign = arena.call(Function::Sign, &[lead]);
    vec![half_of(arena, arena.add(arena.one(), sign)), half_of(arena, arena.sub(arena.one(), sign))]
}
