//! `pebo-gen report`: the verdict to standard error, the page to a file or standard output.
//!
//! A model that is refused has a page too, which explains why; the exit status is that of the verdict.

use std::path::Path;

use crate::Standing;

use super::arguments::ReportOptions;
use super::budget::Limit;
use super::{files, progress, terminal};

pub(super) fn run(options: &ReportOptions, limit: Option<Limit>) -> Standing {
    let (source, answer) = files::answer(&options.model, progress::request(limit).page());
    terminal::say(&answer.summary);
    terminal::report(&answer.diagnostics, &source);
    let Some(page) = answer.page else { return answer.standing };
    match files::write(options.output.as_deref().unwrap_or(Path::new("-")), &page) {
        Ok(()) => answer.standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Standing::Malformed
        }
    }
}
