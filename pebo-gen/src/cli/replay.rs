//! `pebo-gen replay`: recorded samples through the observer.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::source::{Code, Diagnostic, Source, Span};
use pebo_gen::{Answer, Standing, Tape};

use super::arguments::{Limit, ReplayOptions};
use super::{files, progress, standard, terminal};

pub(super) fn run(options: &ReplayOptions, limit: Option<Limit>) -> Standing {
    if let Some(diagnostic) = options.plot.as_deref().and_then(files::not_a_figure) {
        return standard::refuse(diagnostic);
    }
    if files::is_standard(&options.model) && files::is_standard(&options.data) {
        let message = "model and recording cannot both be read from standard input";
        return standard::refuse(Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("name one of them"));
    }
    match replayed(options, limit) {
        Ok(standing) => standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &Source::unread(options.data.display().to_string()));
            Standing::Malformed
        }
    }
}

fn replayed(options: &ReplayOptions, limit: Option<Limit>) -> Result<Standing, Diagnostic> {
    let (mut recording, size) = open(&options.data)?;
    let is_standard = files::is_standard(&options.data);
    let name = if is_standard { "standard input".to_owned() } else { options.data.display().to_string() };
    let request = progress::replaying(limit, size);
    let mut file = options.csv.as_deref().map(files::GrowingFile::create).transpose()?;
    let (source, answer) = {
        let estimates = file.as_mut().map(|file| file as &mut dyn Write);
        let tape = Tape { name: &name, recording: &mut *recording, estimates };
        files::replay(&options.model, &options.set, request, tape)
    };
    if answer.report.verdict != Outcome::Accepted {
        terminal::say(&answer.summary);
    }
    if let Some(replayed) = &answer.replay {
        standard::summarise(&replayed.text(), options.csv.as_deref())?;
    }
    terminal::report(&answer.diagnostics, &source);
    let Answer { standing, replay: Some(replayed), .. } = answer else { return Ok(answer.standing) };
    if let Some(file) = file {
        file.finish()?;
    }
    if let Some(path) = &options.plot {
        files::write(path, &replayed.figure)?;
    }
    Ok(standing)
}

/// The recording, and its bytes where the system knows them.
fn open(path: &Path) -> Result<(Box<dyn Read>, Option<u64>), Diagnostic> {
    if files::is_standard(path) {
        return Ok((Box::new(io::stdin()), None));
    }
    let refused = |error: &io::Error| {
        let message = format!("cannot read {}: {}", path.display(), standard::reason(error));
        Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("check the path and the permissions")
    };
    let file = File::open(path).map_err(|error| refused(&error))?;
    let size = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|metadata| metadata.len());
    Ok((Box::new(file), size))
}
