//! `pebo-gen MODEL`: the verdict to standard error, the Rust code to a file or standard output.

use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::Scalar;
use pebo_gen::report;

use super::arguments::{GenerateOptions, Limit, ScalarName};
use super::{Ending, files, terminal};

pub(super) fn run(options: &GenerateOptions, limit: Limit) -> Ending {
    let several = options.models.len() > 1;
    if several && options.output.as_deref().is_none_or(|output| !output.is_dir()) {
        terminal::say(
            "error: several models need a folder to write to\n  = help: make it, and name it with `-o FOLDER`\n",
        );
        return Ending::Malformed;
    }
    let endings = options.models.iter().map(|model| one(model, options, limit));
    endings.max().unwrap_or(Ending::Malformed)
}

fn one(path: &Path, options: &GenerateOptions, limit: Limit) -> Ending {
    let (source, derived) = match files::derive(path, limit) {
        Ok(read) => read,
        Err(ending) => return ending,
    };
    terminal::say(&report::summary(&derived.plant, &derived.derivation));
    terminal::report(&derived.derivation.diagnostics, &source);
    if derived.derivation.outcome != Outcome::Accepted {
        return Ending::Refused;
    }
    let scalar = match options.scalar {
        ScalarName::F64 => Scalar::F64,
        ScalarName::F32 => Scalar::F32,
    };
    let emitted = match derived.emit(scalar) {
        Ok(emitted) => emitted,
        Err(error) => {
            terminal::say(&format!("error: {} cannot be emitted: {error}\n", derived.plant.name));
            return Ending::Refused;
        }
    };
    let output = match options.output.as_deref() {
        Some(folder) if folder.is_dir() => folder.join(format!("{}.rs", derived.plant.name)),
        Some(file) => file.to_owned(),
        None => Path::new("-").to_owned(),
    };
    match files::write(&output, &emitted.text) {
        Ok(()) => Ending::Accepted,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Ending::Malformed
        }
    }
}
