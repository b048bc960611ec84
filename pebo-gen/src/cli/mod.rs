//! From arguments to an exit status.

mod arguments;
mod check;
mod explain;
mod files;
mod generate;
mod simulate;
mod terminal;

use std::process::ExitCode;

use clap::Parser as _;

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

/// Runs the command of the process's arguments.
pub(crate) fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let ending = match arguments.command {
        Some(Command::Check(options)) => check::run(&options),
        Some(Command::Simulate(options)) => simulate::run(&options),
        Some(Command::Explain(options)) => explain::run(&options),
        None => generate::run(&arguments.generate),
    };
    ExitCode::from(ending as u8)
}
