//! Logarithms that exist wherever what they are of is not zero.

use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr, Function};

/// The logarithm of the magnitude, without a sign to it where the domain tells.
pub(super) fn logarithm(arena: &Arena, domain: &Domain, base: Expr) -> Expr {
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
