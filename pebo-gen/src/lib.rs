//! Proves parameter-estimation-based observers and emits them as Rust.
//!
//! ```text
//! Source -> Model -> Plant -> Derivation -> Emitted
//! ```
//!
//! A model file describes a plant and a candidate transform (Ortega, Bobtsov, Pyrkin and Aranovskiy
//! 2015). `derive` says what is proved of it, claim by claim; [`Derived::emit`] writes the observer
//! if everything is.

pub mod analysis;
#[cfg(feature = "yaml")]
mod builder;
pub mod cas;
pub mod emit;
pub mod model;
pub mod plant;
pub mod program;
pub mod report;
#[cfg(feature = "simulate")]
pub mod simulate;
pub mod source;

#[cfg(feature = "yaml")]
pub use builder::{BuildError, Builder, Built};

use analysis::Derivation;
use cas::budget::Budget;
use emit::{EmitError, Emitted, Scalar};
use model::Model;
use plant::Plant;
use source::Diagnostic;
#[cfg(feature = "yaml")]
use source::Source;

/// A model with everything that was derived of it.
#[derive(Debug)]
pub struct Derived {
    /// What was written.
    pub model: Model,
    /// What it means.
    pub plant: Plant,
    /// The claims, each with its verdict.
    pub derivation: Derivation,
}

/// Derives the observer of a model file within the usual budget of steps; the errors are those of a file that could
/// not be read, or whose class could not be expanded.
#[cfg(feature = "yaml")]
pub fn derive(source: &Source) -> Result<Derived, Vec<Diagnostic>> {
    derive_within(source, Budget::default())
}

/// The same within a budget, from which all that is asked of the model later draws too.
#[cfg(feature = "yaml")]
pub fn derive_within(source: &Source, budget: Budget) -> Result<Derived, Vec<Diagnostic>> {
    Derived::within(Model::parse(source)?, budget)
}

impl Derived {
    /// Derives the observer of a model, whoever read it, within the usual budget of steps.
    pub fn of(model: Model) -> Result<Self, Vec<Diagnostic>> {
        Self::within(model, Budget::default())
    }

    /// The same within a budget, from which all that is asked of the model later draws too.
    pub fn within(model: Model, budget: Budget) -> Result<Self, Vec<Diagnostic>> {
        let plant = Plant::resolve_within(&model, budget)?;
        let derivation = Derivation::derive(&plant);
        Ok(Self { model, plant, derivation })
    }

    /// Writes the observer as Rust, and proves that the written code computes what was derived.
    pub fn emit(&self, scalar: Scalar) -> Result<Emitted, EmitError> {
        let domain = self.plant.domain();
        let is_zero = |arena: &cas::Arena, expr| cas::zero::decide(arena, expr, &domain).is_zero();
        emit::emit(&self.plant, &self.derivation, scalar, is_zero)
    }

    /// The closed loop that the model file describes, ready to be run.
    #[cfg(feature = "simulate")]
    pub fn scenario(&self, overrides: &simulate::Overrides) -> Result<simulate::Scenario, Vec<Diagnostic>> {
        simulate::Scenario::resolve(&self.model, &self.plant, &self.derivation, overrides)
    }
}
