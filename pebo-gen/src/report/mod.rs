//! What was found, for programs and for people.
//!
//! In: a plant and what was derived of it. Out: one JSON object (design: schema 1), or a few lines of
//! text. Formulas are in the model file's grammar.

mod expansion;
#[cfg(feature = "yaml")]
mod json;
mod remarks;
mod text;

use crate::analysis::Verdict;
use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr};

#[cfg(feature = "yaml")]
pub use json::{check, malformed};
pub use text::summary;

/// The JSON schema of the objects that [`check`] and [`malformed`] give.
pub const SCHEMA: &str = include_str!("check.schema.json");

/// A verdict in a word.
fn name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Proved => "proved",
        Verdict::Refuted => "refuted",
        Verdict::Undecided => "undecided",
        Verdict::Skipped => "skipped",
    }
}

/// Comparisons with zero, as a reader would write them.
fn conditions(arena: &Arena, conditions: &[(Expr, Relation)]) -> Vec<String> {
    conditions.iter().map(|(expr, relation)| format!("{} {}", arena.print(*expr), relation.sign())).collect()
}
