//! Diagnostics on the terminal: coloured if it is one and the user did not refuse, as wide as it is.

use std::io::Write as _;

use crate::source::{Colour, Diagnostic, Source, render_within};
use anstream::ColorChoice;

/// Writes diagnostics to standard error.
pub(super) fn report(diagnostics: &[Diagnostic], source: &Source) {
    if !diagnostics.is_empty() {
        say(&render_within(diagnostics, source, colour(), width()));
    }
}

/// Writes text to standard error; if that is closed, nobody can be told.
pub(super) fn say(text: &str) {
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}

fn colour() -> Colour {
    match anstream::AutoStream::choice(&std::io::stderr()) {
        ColorChoice::Never => Colour::Never,
        _ => Colour::Always,
    }
}

/// The columns of the terminal, or those that the user says it has; a file has no width.
fn width() -> Option<usize> {
    let said = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    said.or_else(|| terminal_size::terminal_size_of(std::io::stderr()).map(|(width, _)| usize::from(width.0)))
}
