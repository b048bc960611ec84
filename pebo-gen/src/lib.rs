//! Proves parameter-estimation-based observers and emits them as Rust.
//!
//! ```text
//! Source -> Model -> Plant -> Derivation -> Emitted
//! ```
//!
//! A model file describes a plant and a candidate transform (Ortega, Bobtsov, Pyrkin and Aranovskiy
//! 2015). [`derive()`] proves or refutes its claims one by one; [`Derived::emit`] writes the observer if all
//! are proved. [`answer()`] is both in one call, with all that front ends show, as one value that serialises.

#[cfg(feature = "answer")]
mod answer;
#[cfg(feature = "yaml")]
mod builder;
#[cfg(feature = "simulate")]
mod c_face;
#[cfg(feature = "answer")]
mod certificate;
#[cfg(all(feature = "cli", feature = "simulate"))]
pub mod cli;
mod derived;
pub mod emit;
#[cfg(feature = "answer")]
mod page;
pub mod report;
#[cfg(feature = "simulate")]
pub mod simulate;

#[cfg(feature = "answer")]
pub use answer::{Answer, Request, Section, Solution, Stage, Standing, TypesetFormulas, answer, solve};
#[cfg(feature = "simulate")]
pub use answer::{FinalError, Run, RunRequest, Tape, fitted, replay};
#[cfg(feature = "yaml")]
pub use builder::{BuildError, Builder, BuiltModel};
#[cfg(feature = "simulate")]
pub use c_face::CProject;
pub use derived::Derived;
#[cfg(feature = "yaml")]
pub use derived::{derive, derive_within};

pub use pebo_design::{analysis, model, plant, search, source};

/// The package's front page, whose example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod front_page {}
