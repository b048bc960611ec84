//! Diagnostics on the terminal: coloured where it is one and the user did not refuse.

use std::io::Write as _;

use anstream::ColorChoice;
use pebo_gen::source::{Colour, Diagnostic, Source, render};

/// Writes diagnostics to standard error.
pub(super) fn report(diagnostics: &[Diagnostic], source: &Source) {
    if !diagnostics.is_empty() {
        say(&render(diagnostics, source, colour()));
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
