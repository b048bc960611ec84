//! The command line: from arguments to an exit status.
//!
//! In: the arguments of a call. Out: files and text on the standard streams, and the outcome, which is the exit status.
//! Files, colour and progress are here; everything else is [`answer`](crate::answer()). It stands in the library so that
//! what brings the program along, as the Python wheel does, calls it and needs no second one.

mod arguments;
mod budget;
mod certificate;
mod check;
mod explain;
mod files;
mod generate;
mod manual;
mod progress;
mod replay;
mod report;
mod simulate;
mod solve;
mod standard;
mod terminal;

use std::ffi::OsString;
use std::io::Write as _;

use crate::Standing;

use arguments::{Arguments, Command};

pub use budget::Limit;

/// Runs the command of a call, whose first argument is the program's name. What it prints is written when it returns.
pub fn run(call: impl IntoIterator<Item = OsString>) -> Standing {
    let arguments = match Arguments::of(call) {
        Ok(arguments) => arguments,
        Err(answer) => return said(&answer),
    };
    match arguments.command {
        Some(Command::Check(options)) => check::run(&options, arguments.limit.unwrap_or_default()),
        Some(Command::Simulate(options)) => simulate::run(&options, arguments.limit),
        Some(Command::Replay(options)) => replay::run(&options, arguments.limit),
        Some(Command::Explain(options)) => explain::run(&options),
        Some(Command::Completions(options)) => manual::completions(&options),
        Some(Command::Man) => manual::page(),
        Some(Command::Schema(options)) => manual::schema(&options),
        Some(Command::Solve(options)) => solve::run(&options, arguments.limit.unwrap_or_default()),
        Some(Command::Report(options)) => report::run(&options, arguments.limit),
        Some(Command::Certificate(options)) => certificate::run(&options, arguments.limit.unwrap_or_default()),
        None => generate::run(&arguments.generate, arguments.limit.unwrap_or_default()),
    }
}

/// Prints the parser's answer: help and version to standard output, mistakes to standard error.
fn said(answer: &clap::Error) -> Standing {
    match answer.print().and_then(|()| std::io::stdout().flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => standard::refuse(standard::unwritten(&error)),
        _ if answer.use_stderr() => Standing::Malformed,
        _ => Standing::Accepted,
    }
}
