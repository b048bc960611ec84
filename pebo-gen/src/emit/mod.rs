//! Rust for an accepted derivation.
//!
//! ```text
//! Derivation -> definitions -> program::stage -> tokens -> read back and compared -> text
//! ```
//!
//! In: a plant and its derivation, every claim proved. Out: the tokens and the text of one module
//! that depends on `pebo_runtime` alone. Holds after: the tokens were interpreted again, and each
//! function's value is, by the caller's zero test, what was derived.

mod check;
mod definition;
mod describe;
mod document;
mod error;
mod expression;
mod function;
mod layout;
mod literal;
mod module;
mod names;
mod parameters;
mod permission;
mod prose;
mod read_back;
mod value;

#[cfg(test)]
mod tests;

pub use error::EmitError;
pub use literal::Scalar;

use proc_macro2::TokenStream;

use crate::analysis::Derivation;
use crate::cas::{Arena, Expr};
use crate::plant::Plant;
use crate::program::{Task, Undeclared, lower, stage};
use definition::Definitions;
use module::Module;

/// An emitted module.
#[derive(Clone, Debug)]
pub struct Emitted {
    /// The items of the module, its documentation as inner attributes.
    pub tokens: TokenStream,
    /// The same as text, in rustfmt's layout.
    pub text: String,
    /// The name of the type that implements `Model`.
    pub type_name: String,
}

/// Emits the module for a derivation.
///
/// `is_zero` decides whether an expression is zero wherever the model is defined; an emission whose
/// tokens it cannot confirm is refused.
///
/// # Errors
/// [`EmitError`] says what stands against it.
pub fn emit(
    plant: &Plant,
    derivation: &Derivation,
    scalar: Scalar,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<Emitted, EmitError> {
    let arena = &plant.arena;
    let definitions = Definitions::of(plant, derivation)?;
    let parameters: Vec<_> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let tasks: Vec<Task> = definitions
        .functions
        .iter()
        .map(|definition| Task {
            arguments: definition.arguments.iter().flat_map(|&a| definitions.symbols(a)).collect(),
            outputs: definition.rows.concat(),
        })
        .collect();
    let undeclared = |undeclared: Undeclared| EmitError::Undeclared { symbol: arena.name(undeclared.0) };
    let staged = stage(arena, &parameters, &tasks).map_err(undeclared)?;
    let asked = derivation.asked_of_parameters(plant);
    let values: Vec<Expr> = asked.iter().map(|(value, _)| *value).collect();
    let checked = lower(arena, &parameters, &values).map_err(undeclared)?;
    let rebase = derivation.can_rebase(plant);
    let definitions = &definitions;
    let module = Module { plant, derivation, definitions, staged: &staged, asked: &asked, checked, scalar, rebase };
    let tokens = module.tokens()?;
    read_back::confirm(plant, definitions, &asked, scalar, &tokens, is_zero)?;
    let text = layout::text(&tokens)?;
    Ok(Emitted { tokens, text, type_name: names::camel(&plant.name) })
}
