//! The conditions under which the formulas have values, less those that the assumptions discharge.
//!
//! In: what the plant's formulas ask of their parts. Out: what remains to be seen to, by factors: the
//! proofs hold wherever these hold.

use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr, Node};
use crate::plant::Plant;

/// What the proofs rest on besides the assumptions, each once.
pub(super) fn remaining(plant: &Plant, domain: &Domain) -> Vec<(Expr, Relation)> {
    let arena = &plant.arena;
    let mut remaining: Vec<(Expr, Relation)> = Vec::new();
    for condition in &plant.conditions {
        let parts = match condition.relation {
            Relation::NonZero => factors(arena, condition.expr),
            _ => vec![condition.expr],
        };
        for part in parts {
            let entry = (part, condition.relation);
            if !remaining.contains(&entry) && !domain.shows(arena, part, condition.relation) {
                remaining.push(entry);
            }
        }
    }
    remaining
}

/// The factors of a product that must not vanish.
fn factors(arena: &Arena, expr: Expr) -> Vec<Expr> {
    match arena.node(expr) {
        Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
        _ => vec![expr],
    }
}
