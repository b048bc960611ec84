//! Rust for an accepted derivation.
//!
//! ```text
//! Derivation -> definitions -> tasks -> program::stage -> accuracy -> tokens -> read back and compared -> text
//! ```
//!
//! In: a plant and its derivation, every claim proved. Out: the tokens and the text of one module
//! that depends on `pebo_runtime` alone. Holds after: the tokens were interpreted again, and each
//! function's value is, by the caller's zero test, the derived one.

mod accuracy;
mod definition;
mod error;
mod expression;
mod layout;
mod literal;
mod module;
mod names;
mod read_back;
mod table;

#[cfg(test)]
mod tests;

pub use accuracy::{Accuracy, Cause, Loss, Worst};
pub use error::EmitError;
pub use literal::Scalar;

pub use pebo_design::program::Cost;

use proc_macro2::TokenStream;

use definition::Definitions;
use definition::choice::Choice;
use module::Module;
use module::abbreviation::Abbreviations;
use pebo_cas::{Arena, Expr, Rational};
use pebo_design::analysis::Derivation;
use pebo_design::plant::{Plant, Settings};
use pebo_design::program::{UndeclaredSymbol, lower};

/// An emitted module. Serialises to its text and the name of its type.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "answer", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Emitted {
    /// The items of the module, its documentation as inner attributes.
    #[cfg_attr(feature = "answer", serde(skip))]
    pub tokens: TokenStream,
    /// The same as text, in rustfmt's layout.
    pub text: String,
    /// The name of the type that implements `Model`.
    pub type_name: String,
    /// The cost of each function: its name with its result, and the operations of one call.
    #[cfg_attr(feature = "answer", serde(skip))]
    pub costs: Vec<(String, Cost)>,
    /// The digits that the functions keep.
    pub accuracy: Accuracy,
}

/// Emits the module for a derivation.
///
/// With `settings` the module has a constructor of the observer that they describe. `is_zero` decides whether an
/// expression is zero wherever the model is defined; an emission whose tokens it cannot confirm is refused.
///
/// # Errors
/// [`EmitError`] has the obstacle.
pub fn emit(
    plant: &Plant,
    derivation: &Derivation,
    settings: Option<&Settings<Rational>>,
    scalar: Scalar,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<Emitted, EmitError> {
    let arena = &plant.arena;
    let definitions = Definitions::of(plant, derivation, settings)?;
    let parameters: Vec<_> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let undeclared = |undeclared: UndeclaredSymbol| EmitError::UndeclaredSymbol { symbol: arena.name(undeclared.0) };
    let (choice, accuracy) =
        definition::choice::choose(plant, derivation, (&parameters, scalar), &definitions, &is_zero)
            .map_err(undeclared)?;
    let Choice { definitions, staged, .. } = choice;
    if arena.budget().is_exhausted() {
        // A value without an enclosure was not measured.
        return Err(EmitError::LimitReached);
    }
    let lost = accuracy.of(scalar).find(|(_, worst)| worst.is_refused());
    if let Some((function, worst)) = lost {
        let (function, place) = (function.to_owned(), worst.place.clone());
        return Err(EmitError::Inaccurate {
            function,
            place,
            units: accuracy::told_units(worst.units),
            scalar: scalar.name(),
        });
    }
    let asked = derivation.conditions_on_parameters(plant);
    let values: Vec<Expr> = asked.iter().map(|(value, _)| *value).collect();
    let checked = lower(arena, &parameters, &values).map_err(undeclared)?;
    let (asked, checked) = module::check::with_guards(arena, asked, &checked, &staged);
    let rebase = derivation.can_rebase(plant);
    let definitions = &definitions;
    let (staged, asked_of) = (&staged, &asked);
    let abbreviations = Abbreviations::of(arena, &module::document::formulas(plant, definitions, staged));
    let module = Module {
        plant,
        derivation,
        definitions,
        staged,
        asked: asked_of,
        settings,
        checked,
        scalar,
        rebase,
        accuracy: &accuracy,
        abbreviations: &abbreviations,
    };
    let tokens = module.tokens()?;
    read_back::confirm(plant, definitions, (&asked, settings), scalar, &tokens, is_zero)?;
    let text = layout::text(&tokens)?;
    let costs = module::document::costs(definitions, staged);
    Ok(Emitted { tokens, text, type_name: names::camel(&plant.name), costs, accuracy })
}
