//! Commands that belong to the interface and are not written yet.

use pebo_gen::source::{Code, Diagnostic, Source, Span};

use super::{Ending, terminal};

/// Says so, and what to do until then.
pub(super) fn refuse(command: &str, instead: &str) -> Ending {
    let message = format!("`pebo-gen {command}` is not written yet");
    let diagnostic = Diagnostic::error(Code::NotYet, Span::NOWHERE, message).help(instead);
    terminal::report(&[diagnostic], &Source::unread(format!("pebo-gen {}", env!("CARGO_PKG_VERSION"))));
    Ending::Malformed
}
