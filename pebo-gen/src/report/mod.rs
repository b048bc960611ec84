//! Reports of derivations and searches, for programs and for people.
//!
//! In: a plant and its derivation. Out: one JSON object (design: schema 1), or a few lines of text. Formulas are in the
//! model file's grammar.

mod expansion;
mod growth;
#[cfg(feature = "answer")]
mod json;
pub(crate) mod notes;
pub(crate) mod remarks;
#[cfg(feature = "answer")]
mod search;
mod text;

use pebo_cas::{Arena, Expr, Relation};

#[cfg(feature = "answer")]
pub use json::Report;
#[cfg(feature = "answer")]
pub use search::{SearchReport, search_summary};
pub use text::summary;

/// The JSON schema of a [`Report`].
#[cfg(feature = "answer")]
pub const CHECK_SCHEMA: &str = include_str!("check.schema.json");

/// The JSON schema of a [`SearchReport`].
#[cfg(feature = "answer")]
pub const SOLVE_SCHEMA: &str = include_str!("solve.schema.json");

#[cfg(feature = "answer")]
fn printed(arena: &Arena, exprs: &[Expr]) -> Vec<String> {
    exprs.iter().map(|e| arena.print(*e)).collect()
}

/// Comparisons with zero, as a reader would write them.
fn conditions(arena: &Arena, conditions: &[(Expr, Relation)]) -> Vec<String> {
    conditions.iter().map(|(expr, relation)| format!("{} {}", arena.print(*expr), relation.sign())).collect()
}
