//! What a page is about.

use crate::emit::Emitted;
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

/// What a page is about.
#[derive(Debug)]
pub(crate) struct Subject<'a> {
    pub(crate) source: &'a Source,
    pub(crate) plant: &'a Plant,
    pub(crate) derivation: &'a Derivation,
    pub(crate) diagnostics: &'a [Diagnostic],
    /// The code for `f64`, if the model is accepted.
    pub(crate) emitted: Option<&'a Emitted>,
    /// The closed loop.
    #[cfg(feature = "simulate")]
    pub(crate) run: Run<'a>,
}

impl Subject<'_> {
    /// What the plant is, in its author's words.
    pub(super) fn title(&self) -> &str {
        self.plant.title.as_deref().unwrap_or(&self.plant.name)
    }
}

/// What is there of the closed loop.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) enum Run<'a> {
    /// It was not run, as nothing asks for it.
    Not,
    /// It did not come to its end: a diagnostic says why.
    Failed,
    /// It did.
    Done(Loop<'a>),
}

/// A run of the closed loop.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) struct Loop<'a> {
    /// The figure as SVG.
    pub(crate) figure: &'a str,
    /// When it ended, in seconds.
    pub(crate) end: f64,
    /// The table of errors with its headings: as many cells in each row.
    pub(crate) errors: Vec<Vec<String>>,
    /// What there is to say beside.
    pub(crate) lines: Vec<String>,
}
