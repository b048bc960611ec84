//! `pebo-gen certificate`: the verdict to standard error, the script to a file or standard output.

use std::path::Path;

use crate::Standing;

use super::arguments::CertificateOptions;
use super::budget::Limit;
use super::{files, terminal};

pub(super) fn run(options: &CertificateOptions, limit: Limit) -> Standing {
    let (source, answer) = files::answer(&options.model, limit.request().certificate());
    terminal::say(&answer.summary);
    terminal::report(&answer.diagnostics, &source);
    let Some(script) = answer.certificate else { return answer.standing };
    match files::write(options.output.as_deref().unwrap_or(Path::new("-")), &script) {
        Ok(()) => answer.standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Standing::Malformed
        }
    }
}
