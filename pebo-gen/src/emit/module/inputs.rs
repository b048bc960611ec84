//! What the items of a module are made of.

use pebo_cas::{Expr, Rational};
use pebo_design::analysis::{Derivation, Sign};
use pebo_design::plant::{Plant, Settings};
use pebo_design::program::{Program, StagedPrograms};

use super::abbreviation::Abbreviations;
use crate::emit::accuracy::Accuracy;
use crate::emit::definition::Definitions;
use crate::emit::literal::Scalar;

/// The inputs of the items.
pub(in crate::emit) struct Module<'a> {
    pub(in crate::emit) plant: &'a Plant,
    pub(in crate::emit) derivation: &'a Derivation,
    pub(in crate::emit) definitions: &'a Definitions<'a>,
    pub(in crate::emit) staged: &'a StagedPrograms,
    /// The conditions on the parameters.
    pub(in crate::emit) asked: &'a [(Expr, Sign)],
    /// The settings of the observer, if the model has them.
    pub(in crate::emit) settings: Option<&'a Settings<Rational>>,
    /// From the parameters to the values in these conditions.
    pub(in crate::emit) checked: Program,
    pub(in crate::emit) scalar: Scalar,
    /// The model may be re-based.
    pub(in crate::emit) rebase: bool,
    /// The digits that the functions keep.
    pub(in crate::emit) accuracy: &'a Accuracy,
    /// Names for parts of the formulas in the documentation.
    pub(in crate::emit) abbreviations: &'a Abbreviations,
}
