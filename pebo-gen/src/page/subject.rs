//! What a page is about.

use crate::analysis::Derivation;
use crate::emit::Emitted;
use crate::plant::Plant;
use crate::source::{Diagnostic, Source};

/// What a page is about.
#[derive(Debug)]
pub(crate) struct Subject<'a> {
    pub(crate) source: &'a Source,
    pub(crate) plant: &'a Plant,
    pub(crate) derivation: &'a Derivation,
    pub(crate) diagnostics: &'a [Diagnostic],
    /// The code for `f64`, if the model is accepted.
    pub(crate) emitted: Option<&'a Emitted>,
    /// The closed loop, if the model describes one.
    #[cfg(feature = "simulate")]
    pub(crate) run: Option<Loop<'a>>,
}

impl Subject<'_> {
    /// What the plant is, in its author's words.
    pub(super) fn title(&self) -> &str {
        self.plant.title.as_deref().unwrap_or(&self.plant.name)
    }
}

/// A run of the closed loop.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) struct Loop<'a> {
    /// The figure as SVG.
    pub(crate) figure: &'a str,
    /// When it ended, in seconds.
    pub(crate) end: f64,
    pub(crate) errors: Vec<Errors<'a>>,
}

/// The error of the estimate of a state.
#[cfg(feature = "simulate")]
#[derive(Debug)]
pub(crate) struct Errors<'a> {
    pub(crate) state: &'a str,
    /// When the run began.
    pub(crate) start: f64,
    /// When it ended.
    pub(crate) end: f64,
}
