//! Logarithms that exist wherever their argument is not zero.

use pebo_cas::{Arena, Domain, Expr, Function, Relation};

/// The logarithm of the absolute value, or of the argument itself where the domain determines its sign.
pub(in crate::search) fn logarithm(arena: &Arena, domain: &Domain, base: Expr) -> Expr {
    let opposite = arena.neg(base);
    let argument = if domain.implies(arena, base, Relation::Positive) {
        base
    } else if domain.implies(arena, opposite, Relation::Positive) {
        opposite
    } else {
        arena.call(Function::Abs, &[base])
    };
    arena.call(Function::Log, &[argument])
}
