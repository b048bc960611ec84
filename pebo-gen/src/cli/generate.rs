//! `pebo-gen MODEL`: the verdict to standard error, the Rust code to a file or standard output.

use std::path::Path;

use pebo_gen::Standing;

use super::arguments::{GenerateOptions, Limit};
use super::{files, terminal};

pub(super) fn run(options: &GenerateOptions, limit: Limit) -> Standing {
    let several = options.models.len() > 1;
    if several && options.output.as_deref().is_none_or(|output| !output.is_dir()) {
        terminal::say(
            "error: several models need a folder to write to\n  = help: make it, and name it with `-o FOLDER`\n",
        );
        return Standing::Malformed;
    }
    let standings = options.models.iter().map(|model| one(model, options, limit));
    standings.max().unwrap_or(Standing::Malformed)
}

fn one(path: &Path, options: &GenerateOptions, limit: Limit) -> Standing {
    let (source, answer) = files::answer(path, limit.ask().emit(options.scalar));
    terminal::say(&answer.summary);
    terminal::report(&answer.diagnostics, &source);
    let Some(emitted) = answer.emitted else { return answer.standing };
    let output = match options.output.as_deref() {
        Some(folder) if folder.is_dir() => folder.join(format!("{}.rs", answer.report.model)),
        Some(file) => file.to_owned(),
        None => Path::new("-").to_owned(),
    };
    match files::write(&output, &emitted.text) {
        Ok(()) => answer.standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Standing::Malformed
        }
    }
}
