//! Straight-line code: the computation of the derived formulas.
//!
//! ```text
//! Expr -> stage (separate constants) -> factor -> lower -> Program -> cost, interpret, emit
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
pub mod lower;
mod numbers;
mod oriented;
mod product;
mod reuse;
mod sharing;
mod signs;
mod spread;
pub mod stage;
mod straight;

#[cfg(test)]
mod tests;

pub use cost::Cost;
pub use guards::GuardedProgram;
pub use interpret::Interpreter;
pub use lower::{UndeclaredSymbol, lower};
pub use stage::{StagedPrograms, Task, stage};
pub use straight::{Constant, Operand, Operation, Program};
