//! The meaning of a model.
//!
//! ```text
//! Model -> names resolved, numbers exact, formulas in one arena -> Plant
//! ```
//!
//! Holds after: every name in a formula is declared and permitted there, every formula has a value as far as its
//! constants decide, and each equation keeps the span of its source. A model by class has become the same equations,
//! with the spans of the class's fields.

pub mod class;
mod conditions;
mod contradiction;
mod formula;
mod known;
mod own;
mod parts;
mod period;
#[allow(clippy::module_inception)]
mod plant;
mod resolve;
mod scope;
pub mod settings;
mod shown;
mod start;
mod terms;
mod unmeasured;
mod values;

pub use crate::model::CascadeClass;
pub use class::{Class, Proposal};
pub use formula::lower;
pub use parts::{Assumption, Formula, Output, Parameter, State};
pub use plant::{Noisier, Plant, RelationForm, TransformOrigin};
pub use scope::Scope;
pub use settings::Settings;

/// A matrix of formulas.
pub type Matrix = pebo_cas::linear::Matrix<pebo_cas::Expr>;
