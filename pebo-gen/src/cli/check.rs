//! `pebo-gen check`: the verdict on each model.

use std::io::{self, Write as _};
use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::report;

use super::arguments::{CheckOptions, Format};
use super::{Ending, files, terminal};

pub(super) fn run(options: &CheckOptions) -> Ending {
    options
        .models
        .iter()
        .map(|model| {
            one(model, options.format).unwrap_or_else(|unwritten| {
                terminal::say(&format!("error[cannot-write]: cannot write to standard output: {unwritten}\n"));
                Ending::Malformed
            })
        })
        .max()
        .unwrap_or(Ending::Malformed)
}

fn one(path: &Path, format: Format) -> io::Result<Ending> {
    let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let source = match files::read(path) {
        Ok(source) => source,
        Err(unread) => {
            let (source, diagnostic) = *unread;
            if format == Format::Json {
                print(&report::malformed(&stem, &[diagnostic], &source))?;
            } else {
                terminal::report(&[diagnostic], &source);
            }
            return Ok(Ending::Malformed);
        }
    };
    match pebo_gen::derive(&source) {
        Ok(derived) => {
            let (plant, derivation) = (&derived.plant, &derived.derivation);
            if format == Format::Json {
                print(&report::check(plant, derivation, &source))?;
            } else {
                print(report::summary(plant, derivation).trim_end())?;
                terminal::report(&derivation.diagnostics, &source);
            }
            Ok(if derivation.outcome == Outcome::Accepted { Ending::Accepted } else { Ending::Refused })
        }
        Err(diagnostics) => {
            if format == Format::Json {
                print(&report::malformed(&stem, &diagnostics, &source))?;
            } else {
                terminal::report(&diagnostics, &source);
            }
            Ok(Ending::Malformed)
        }
    }
}

/// A line to standard output; a reader that went away is no error of ours.
fn print(line: &str) -> io::Result<()> {
    match writeln!(io::stdout().lock(), "{line}").and_then(|()| io::stdout().flush()) {
        Err(gone) if gone.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}
