//! What was found, for programs and for people.
//!
//! In: a plant and what was derived of it. Out: one JSON object (design: schema 1), or a few lines of
//! text. Formulas are in the model file's grammar.

mod json;
mod text;

pub use json::{check, malformed};
pub use text::summary;
