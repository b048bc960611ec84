//! `pebo-gen MODEL`: the verdict to standard error, the Rust code to a file or standard output.

use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::Scalar;
use pebo_gen::report;

use super::arguments::{GenerateOptions, ScalarName};
use super::{Ending, files, terminal};

pub(super) fn run(options: &GenerateOptions) -> Ending {
    let path = options.model.as_deref().unwrap_or(Path::new("-"));
    let Some((source, derived)) = files::derive(path) else { return Ending::Malformed };
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
    match files::write(options.output.as_deref().unwrap_or(Path::new("-")), &emitted.text) {
        Ok(()) => Ending::Accepted,
        Err(diagnostic) => {
            terminal::report(&[diagnostic], &source);
            Ending::Malformed
        }
    }
}
