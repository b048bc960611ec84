//! `pebo-gen replay`: recorded samples through the observer.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Cursor, Read, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::analysis::Outcome;
use crate::simulate::replay::FittedNumbers;
use crate::source::{Code, Diagnostic, Source, Span};
use crate::{Answer, Standing, Tape};

use super::arguments::ReplayOptions;
use super::budget::Limit;
use super::{files, progress, standard, terminal};

pub(super) fn run(options: &ReplayOptions, limit: Option<Limit>) -> Standing {
    if let Some(diagnostic) = options.plot.as_deref().and_then(files::not_a_figure) {
        return standard::refuse(diagnostic);
    }
    if files::is_standard(&options.model) && files::is_standard(&options.data) {
        let message = "model and recording cannot both be read from standard input";
        return standard::refuse(Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("name one of them"));
    }
    if options.fit.is_some() && files::is_standard(&options.model) {
        let message = "numbers cannot be fitted to a model on standard input, which is read twice";
        return standard::refuse(Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("name its file"));
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
    let mut settings = options.set.clone();
    let mut section = String::new();
    if let Some(sought) = &options.fit {
        let sought: Vec<String> =
            sought.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()).collect();
        let head = head(&mut recording).map_err(|error| unreadable(&options.data, &error))?;
        match fitted(options, limit, ((&name, &head), &sought)) {
            Ok(Some(found)) => {
                settings.extend(found.settings());
                section = found.section();
            }
            Ok(None) => {}
            Err(standing) => return Ok(standing),
        }
        recording = Box::new(Cursor::new(head).chain(recording));
    }
    let request = progress::replaying(limit, size);
    let mut file = options.csv.as_deref().map(files::GrowingFile::create).transpose()?;
    let (source, answer) = {
        let estimates = file.as_mut().map(|file| file as &mut dyn Write);
        let tape = Tape { name: &name, recording: &mut *recording, estimates };
        files::replay(&options.model, &settings, request, tape)
    };
    if answer.report.verdict != Outcome::Accepted {
        terminal::say(&answer.summary);
    }
    if let Some(replayed) = &answer.replay {
        files::summarise(&(replayed.text() + &section), options.csv.as_deref())?;
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
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    let size = file.metadata().ok().filter(std::fs::Metadata::is_file).map(|metadata| metadata.len());
    Ok((Box::new(file), size))
}

fn unreadable(path: &Path, error: &io::Error) -> Diagnostic {
    let message = format!("cannot read {}: {}", path.display(), standard::reason(error));
    Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("check the path and the permissions")
}

/// The rows to which numbers are fitted: standard deviations of more are hardly better known.
const FITTED_ROWS: usize = 4000;

/// The most bytes of them.
const FITTED_BYTES: usize = 16 << 20;

/// The header and the first rows.
fn head(recording: &mut Box<dyn Read>) -> io::Result<Vec<u8>> {
    // Without a buffer of its own the reader would lose what comes after.
    let rest = std::mem::replace(recording, Box::new(io::empty()));
    let mut lines = BufReader::new(rest);
    let mut head = Vec::new();
    for _ in 0..=FITTED_ROWS {
        let room = u64::try_from(FITTED_BYTES.saturating_sub(head.len())).unwrap_or_default();
        if lines.by_ref().take(room).read_until(b'\n', &mut head)? == 0 {
            break;
        }
    }
    *recording = Box::new(lines);
    Ok(head)
}

/// The numbers that make the first rows most likely; none where the model has no observer, of which the answer says why.
/// Otherwise the reasons are reported.
fn fitted(
    options: &ReplayOptions,
    limit: Option<Limit>,
    (rows, sought): ((&str, &[u8]), &[String]),
) -> Result<Option<FittedNumbers>, Standing> {
    let Ok(source) = files::read_with(&options.model, &options.set) else { return Ok(None) };
    let (begun, most) = (Instant::now(), limit.map(|limit| Duration::from_secs_f64(limit.0)));
    let mut watch = |_| match most {
        Some(most) if begun.elapsed() > most => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    crate::fitted(&source, &limit.unwrap_or_default().request(), (rows, sought), &mut watch).map_err(|found| {
        terminal::report(&found, &source);
        Standing::Malformed
    })
}
