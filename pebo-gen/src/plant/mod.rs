//! What a model means.
//!
//! ```text
//! Model -> names resolved, numbers exact, formulas in one arena -> Plant
//! ```
//!
//! Holds after: every name in a formula is declared where it may stand, every formula has a value as far
//! as its constants tell, and each equation keeps the span of its source.

mod conditions;
mod formula;
#[allow(clippy::module_inception)]
mod plant;
mod resolve;
mod scope;

pub use formula::lower;
pub use plant::{Assumption, Formula, Output, Parameter, Plant, State};
pub use scope::Scope;
