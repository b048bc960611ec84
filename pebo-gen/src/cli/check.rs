//! `pebo-gen check`: the verdict on each model.

use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::report;
use pebo_gen::source::Diagnostic;

use super::arguments::{CheckOptions, Format, Limit};
use super::{Ending, files, standard, terminal};

pub(super) fn run(options: &CheckOptions, limit: Limit) -> Ending {
    options
        .models
        .iter()
        .map(|model| one(model, options.format, limit).unwrap_or_else(standard::refuse))
        .max()
        .unwrap_or(Ending::Malformed)
}

fn one(path: &Path, format: Format, limit: Limit) -> Result<Ending, Diagnostic> {
    let stem = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let source = match files::read(path) {
        Ok(source) => source,
        Err(unread) => {
            let (source, diagnostic) = *unread;
            if format == Format::Json {
                line(&report::malformed(&stem, &[diagnostic], &source))?;
            } else {
                terminal::report(&[diagnostic], &source);
            }
            return Ok(Ending::Malformed);
        }
    };
    match pebo_gen::derive_within(&source, limit.budget()) {
        Ok(derived) => {
            let (plant, derivation) = (&derived.plant, &derived.derivation);
            if format == Format::Json {
                line(&report::check(plant, derivation, &source))?;
            } else {
                line(report::summary(plant, derivation).trim_end())?;
                terminal::report(&derivation.diagnostics, &source);
            }
            Ok(if derivation.outcome == Outcome::Accepted { Ending::Accepted } else { Ending::Refused })
        }
        Err(diagnostics) => {
            if format == Format::Json {
                line(&report::malformed(&stem, &diagnostics, &source))?;
            } else {
                terminal::report(&diagnostics, &source);
            }
            Ok(Ending::of_unread(&diagnostics))
        }
    }
}

fn line(text: &str) -> Result<(), Diagnostic> {
    standard::write(format!("{text}\n").as_bytes())
}
