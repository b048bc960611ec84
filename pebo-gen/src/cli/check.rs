//! `pebo-gen check`: the verdict on each model.

use std::path::Path;

use crate::Standing;
use crate::source::Diagnostic;

use super::arguments::{CheckOptions, Format};
use super::budget::Limit;
use super::{files, standard, terminal};

pub(super) fn run(options: &CheckOptions, limit: Limit) -> Standing {
    let one = |model| one(model, options.format, limit).unwrap_or_else(standard::refuse);
    options.models.iter().map(|model| one(model)).max().unwrap_or(Standing::Malformed)
}

fn one(path: &Path, format: Format, limit: Limit) -> Result<Standing, Diagnostic> {
    let (source, answer) = files::answer(path, limit.request());
    match format {
        Format::Json => line(&answer.report.line())?,
        Format::Human => {
            if !answer.summary.is_empty() {
                line(answer.summary.trim_end())?;
            }
            terminal::report(&answer.diagnostics, &source);
        }
    }
    Ok(answer.standing)
}

fn line(text: &str) -> Result<(), Diagnostic> {
    standard::write(format!("{text}\n").as_bytes())
}
