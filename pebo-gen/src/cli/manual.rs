//! What describes the command line to shells, to `man` and to programs.

use std::io::{self, Write as _};

use clap::CommandFactory as _;

use super::arguments::{Arguments, CompletionsOptions};
use super::{Ending, terminal};

pub(super) fn completions(options: &CompletionsOptions) -> Ending {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), "pebo-gen", &mut script);
    print(&script)
}

pub(super) fn page() -> Ending {
    let mut page = Vec::new();
    match clap_mangen::Man::new(Arguments::command()).render(&mut page) {
        Ok(()) => print(&page),
        Err(error) => refused(&error),
    }
}

pub(super) fn schema() -> Ending {
    print(pebo_gen::report::SCHEMA.as_bytes())
}

/// To standard output; a reader that went away is no error of ours.
fn print(text: &[u8]) -> Ending {
    match io::stdout().lock().write_all(text) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => refused(&error),
        _ => Ending::Accepted,
    }
}

fn refused(error: &io::Error) -> Ending {
    terminal::say(&format!("error[cannot-write]: cannot write to standard output: {error}\n"));
    Ending::Malformed
}
