//! `pebo-gen solve`: the transforms of a plant.

use std::cell::OnceCell;
use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use crate::analysis::Class;
use crate::source::{Code, Diagnostic, Source, Span};
use crate::{Stage, Standing};
use indicatif::ProgressBar;

use super::arguments::{Format, SolveOptions};
use super::budget::Limit;
use super::{files, standard, terminal};

/// A shorter search shows no progress.
const PATIENCE: Duration = Duration::from_millis(500);

pub(super) fn run(options: &SolveOptions, limit: Limit) -> Standing {
    one(options, limit).unwrap_or_else(standard::refuse)
}

fn one(options: &SolveOptions, limit: Limit) -> Result<Standing, Diagnostic> {
    let class = Class::from_name(options.class.name());
    let (source, solution) = files::solve(&options.model, class, limit.request().watch(watch(limit)));
    match options.format {
        Format::Json => standard::write(format!("{}\n", solution.report.line()).as_bytes())?,
        Format::Human => {
            if !solution.summary.is_empty() {
                standard::write(solution.summary.as_bytes())?;
            }
            terminal::report(&solution.diagnostics, &source);
        }
    }
    let (Some(output), Standing::Accepted) = (&options.output, solution.standing) else { return Ok(solution.standing) };
    let written = match solution.filled {
        Some(text) => files::write(output, &text),
        None => Err(unwritten(&source)),
    };
    Ok(match written {
        Ok(()) => solution.standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Standing::Malformed
        }
    })
}

/// Ends the search at the limit, and shows at a terminal that it goes on.
fn watch(limit: Limit) -> impl Fn(Stage) -> ControlFlow<()> {
    let (started, ends) = (Instant::now(), limit.watch());
    let spinner: OnceCell<ProgressBar> = OnceCell::new();
    move |stage| {
        if started.elapsed() >= PATIENCE && std::io::stderr().is_terminal() {
            let spinner = spinner.get_or_init(|| {
                let spinner = ProgressBar::new_spinner();
                spinner.set_message("searching for phi");
                spinner
            });
            spinner.tick();
        }
        ends(stage)
    }
}

/// The diagnostic that the file's layout cannot take the key.
fn unwritten(source: &Source) -> Diagnostic {
    let message = format!("phi could not be written into {}", source.name());
    Diagnostic::error(Code::CannotWrite, Span::NOWHERE, message)
        .help("write each key of the model at the beginning of a line, and the phi shown above among them")
}
