//! Logarithms that exist wherever what they are of is not zero.

use pebo_cas::{Arena, Domain, Expr, Function, Relation};

/// The logarithm of the magnitude, without a sign to it where the domain tells.
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
