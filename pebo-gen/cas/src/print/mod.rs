//! Expressions as text and as MathML.

mod arranged;
pub mod letter;
pub mod mathml;
mod text;
