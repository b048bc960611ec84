//! The subject of a page.

use crate::emit::Emitted;
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

/// A plant with its derivation, code and run.
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
    /// The author's title of the plant.
    pub(super) fn title(&self) -> &str {
        self.plant.title.as_deref().unwrap_or(&self.plant.name)
    }
}

/// The state of the closed loop.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) enum Run<'a> {
    /// It was not run: the model describes none.
    Not,
    /// It ended early: a diagnostic says why.
    Failed,
    /// It came to its end.
    Done(Loop<'a>),
}

/// A run of the closed loop.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) struct Loop<'a> {
    /// The figure as SVG.
    pub(crate) figure: &'a str,
    /// Its end, in seconds.
    pub(crate) end: f64,
    /// The table of errors with its headings; all rows have the same length.
    pub(crate) errors: Vec<Vec<String>>,
    /// Remarks beside the table.
    pub(crate) lines: Vec<String>,
}
