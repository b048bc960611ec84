//! From arguments to an exit status.

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

use std::process::ExitCode;

use pebo_gen::Standing;

use arguments::{Arguments, Command};

/// Runs the command of the process's arguments.
pub(crate) fn run() -> ExitCode {
    let arguments = match Arguments::of_process() {
        Ok(arguments) => arguments,
        Err(answer) => return ExitCode::from(said(&answer) as u8),
    };
    let standing = match arguments.command {
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
    };
    ExitCode::from(standing as u8)
}

/// Prints the parser's answer: help and version to standard output, mistakes to standard error.
fn said(answer: &clap::Error) -> Standing {
    match answer.print() {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => standard::refuse(standard::unwritten(&error)),
        _ if answer.use_stderr() => Standing::Malformed,
        _ => Standing::Accepted,
    }
}
