//! The expression graph: its nodes, their construction, derivatives, values and domain conditions.

pub(crate) mod arena;
mod build;
pub mod conditions;
mod derivative;
pub mod enclosure;
pub(crate) mod expr;
pub mod facts;
pub mod function;
