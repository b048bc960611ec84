//! Straight-line code: how the derived formulas are computed.
//!
//! ```text
//! Expr -> stage (what depends on parameters alone, apart) -> factor -> lower -> Program -> cost, interpret, emit
//! ```
//!
//! In: expressions of the algebra. Out: a [`Program`], whose value is that of the expressions up to
//! rounding, in an order of operations that depends on the expressions alone.

mod angles;
mod cost;
mod factor;
mod fixed;
mod guards;
mod interpret;
mod lower;
mod numbers;
mod oriented;
mod product;
mod reuse;
mod sharing;
mod signs;
mod spread;
mod stage;
mod straight;

#[cfg(test)]
mod tests;

pub use cost::Cost;
pub(crate) use guards::Guarded;
pub(crate) use interpret::Interpreter;
pub(crate) use lower::{Undeclared, lower};
pub(crate) use stage::{Staged, Task, stage};
pub(crate) use straight::{Constant, Operand, Operation, Program};
