//! Expressions as text and as `MathML`.

mod arrangement;
pub mod letter;
pub mod mathml;
mod text;
