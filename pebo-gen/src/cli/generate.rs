//! `pebo-gen MODEL`: the verdict to standard error, the Rust code to a file or standard output, or a crate around it to a
//! folder.

use std::path::{Path, PathBuf};

use crate::Standing;
use crate::source::nearest;
use clap::CommandFactory as _;

use super::arguments::{Arguments, GenerateOptions};
use super::budget::Limit;
use super::{files, terminal};

pub(super) fn run(options: &GenerateOptions, limit: Limit) -> Standing {
    if let Some((word, command)) = options.models.first().and_then(|first| misspelt(first)) {
        terminal::say(&format!(
            "error: there is no command and no file `{word}`\n  = help: did you mean `{command}`?\n"
        ));
        return Standing::Malformed;
    }
    let several = options.models.len() > 1;
    if several && options.c.is_some() {
        terminal::say(
            "error: `--c` writes the crate of one model\n  = help: call pebo-gen for each model, with a folder of its own\n",
        );
        return Standing::Malformed;
    }
    if several && options.output.as_deref().is_none_or(|output| !output.is_dir()) {
        terminal::say(
            "error: several models need a folder to write to\n  = help: make it, and name it with `-o FOLDER`\n",
        );
        return Standing::Malformed;
    }
    let standings = options.models.iter().map(|model| one(model, options, limit));
    standings.max().unwrap_or(Standing::Malformed)
}

/// A misspelt command in the position of a model file, and the command that it resembles.
fn misspelt(path: &Path) -> Option<(&str, String)> {
    let word = path.to_str().filter(|_| !path.exists())?;
    let commands = Arguments::command();
    let names: Vec<&str> = commands.get_subcommands().map(clap::Command::get_name).collect();
    Some((word, nearest(word, names)?.to_owned()))
}

fn one(path: &Path, options: &GenerateOptions, limit: Limit) -> Standing {
    let request = limit.request().emit(options.scalar);
    let request = if options.c.is_some() { request.c_project() } else { request };
    let (source, answer) = files::answer(path, request);
    terminal::say(&answer.summary);
    terminal::report(&answer.diagnostics, &source);
    let Some(emitted) = answer.emitted else { return answer.standing };
    let written = match (options.c.as_deref(), answer.c_project) {
        (Some(folder), Some(project)) => files::write_all(folder, &project.files),
        (Some(_), None) => return answer.standing,
        (None, _) => files::write(&output(options, &answer.report.model), &emitted.text),
    };
    match written {
        Ok(()) => answer.standing,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Standing::Malformed
        }
    }
}

/// Where the code of a model of this name goes.
fn output(options: &GenerateOptions, model: &str) -> PathBuf {
    match options.output.as_deref() {
        Some(folder) if folder.is_dir() => folder.join(format!("{model}.rs")),
        Some(file) => file.to_owned(),
        None => PathBuf::from("-"),
    }
}
