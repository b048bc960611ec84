//! Reads a model, resolves its meaning, and proves its claims.
//!
//! ```text
//! Source -> Model -> Plant -> Derivation -> Program
//! ```
//!
//! In: a model file, or a module of plain Rust. Out: its plant, the transform, which is searched for where the model
//! has none, the four claims with their verdicts, and straight-line code for the computed formulas. A crate of its own,
//! so that those who write, run or print an observer cannot change what is proved of it.

pub mod analysis;
pub mod model;
pub mod plant;
pub mod program;
pub mod search;
pub mod source;
