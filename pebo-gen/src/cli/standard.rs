//! Standard output: everything is written, or there is a diagnostic.

use std::io::{self, Write as _};

use crate::Standing;
use crate::source::{Code, Diagnostic, Source, Span};

use super::terminal;

/// Writes all of a text. A reader that went away is no error of ours.
pub(super) fn write(text: &[u8]) -> Result<(), Diagnostic> {
    let mut output = io::stdout().lock();
    match output.write_all(text).and_then(|()| output.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(unwritten(&error)),
        _ => Ok(()),
    }
}

/// Writes all of a text, and gives the outcome.
pub(super) fn print(text: &[u8]) -> Standing {
    match write(text) {
        Ok(()) => Standing::Accepted,
        Err(diagnostic) => refuse(diagnostic),
    }
}

/// Says that standard output could not be written.
pub(super) fn refuse(diagnostic: Diagnostic) -> Standing {
    terminal::report(&[diagnostic], &Source::unread("standard output"));
    Standing::Malformed
}

/// The diagnostic of a failed write.
pub(super) fn unwritten(error: &io::Error) -> Diagnostic {
    let message = format!("cannot write to standard output: {}", reason(error));
    Diagnostic::error(Code::CannotWrite, Span::NOWHERE, message)
        .help("send the output to where there is room for it, or name a file if the command takes one")
}

/// The operating system's reason, without the number it puts behind it.
pub(super) fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let plain = text.split(" (os error").next().unwrap_or(&text);
    let mut letters = plain.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}
