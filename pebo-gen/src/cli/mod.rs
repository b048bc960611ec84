//! From arguments to an exit status.

mod arguments;
mod budget;
mod check;
mod explain;
mod files;
mod generate;
mod later;
mod manual;
mod simulate;
mod standard;
mod terminal;

use std::process::ExitCode;

use clap::Parser as _;
use pebo_gen::source::Diagnostic;

use arguments::{Arguments, Command};

/// How a run ended, as the exit status tells it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Ending {
    /// Accepted.
    Accepted = 0,
    /// The model was read, but a claim is refuted or undecided.
    Refused = 1,
    /// The input or the call is malformed.
    Malformed = 2,
}

impl Ending {
    /// Of a model of which no plant was made.
    fn of_unread(diagnostics: &[Diagnostic]) -> Self {
        if diagnostics.iter().all(|diagnostic| diagnostic.code.is_open()) { Self::Refused } else { Self::Malformed }
    }
}

/// Runs the command of the process's arguments.
pub(crate) fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(answer) => return ExitCode::from(said(&answer) as u8),
    };
    let ending = match arguments.command {
        Some(Command::Check(options)) => check::run(&options, arguments.limit.unwrap_or_default()),
        Some(Command::Simulate(options)) => simulate::run(&options, arguments.limit),
        Some(Command::Explain(options)) => explain::run(&options),
        Some(Command::Completions(options)) => manual::completions(&options),
        Some(Command::Man) => manual::page(),
        Some(Command::Schema(options)) => manual::schema(&options),
        Some(Command::Solve(_)) => later::refuse("solve", "write a candidate under `phi`, and let `check` judge it"),
        Some(Command::Report(_)) => later::refuse("report", "`pebo-gen check MODEL` prints what is derived as text"),
        Some(Command::Certificate(_)) => later::refuse("certificate", "`pebo-gen check MODEL` says what is proved"),
        None => generate::run(&arguments.generate, arguments.limit.unwrap_or_default()),
    };
    ExitCode::from(ending as u8)
}

/// Says what the parser of arguments has to say: help and version to standard output, mistakes to standard error.
fn said(answer: &clap::Error) -> Ending {
    match answer.print() {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => standard::refuse(standard::unwritten(&error)),
        _ if answer.use_stderr() => Ending::Malformed,
        _ => Ending::Accepted,
    }
}
