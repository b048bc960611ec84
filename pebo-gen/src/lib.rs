//! Proves parameter-estimation-based observers and emits them as Rust.
//!
//! ```text
//! Source -> Model -> Plant -> Derivation -> Programs -> text
//! ```
//!
//! A model file describes a plant and a candidate transform (Ortega, Bobtsov, Pyrkin and Aranovskiy
//! 2015). [`derive()`] says what is proved of it, claim by claim.

pub mod analysis;
pub mod cas;
pub mod model;
pub mod plant;
pub mod report;
pub mod source;

use analysis::Derivation;
use model::Model;
use plant::Plant;
use source::{Diagnostic, Source};

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

/// Derives the observer of a model file; the errors are those of a file that could not be read.
pub fn derive(source: &Source) -> Result<Derived, Vec<Diagnostic>> {
    let model = Model::parse(source)?;
    let plant = Plant::resolve(&model)?;
    let derivation = Derivation::derive(&plant);
    Ok(Derived { model, plant, derivation })
}
