//! The C face of an emitted observer: a crate that builds a static library, with its header, build files and example.
//!
//! ```text
//! Emitted -> Module (its items) -> size, names -> lib.rs, NAME.h, main.c, build files
//! ```
//!
//! In: the plant, its derivation, the emitted module with an observer of the model's settings, and samples for the
//! example. Out: the texts of all files, by their paths. No date, no absolute path: the same model gives the same texts.

mod build_files;
mod example;
mod face;
mod faults;
mod header;
mod module;
mod names;
mod samples;
mod size;
mod subject;

use crate::emit::{Emitted, Scalar};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;

use module::Module;
use names::{field_names, prefix};
use subject::{Face, Signal};

pub(crate) use samples::Samples;

/// The files of a crate with a C face.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct CProject {
    /// The path of each file in the folder of the crate, its parts joined by `/`, and its text.
    pub files: Vec<(String, String)>,
}

impl CProject {
    /// The files for an emitted module; none if it has no observer, because the model's settings are incomplete.
    pub(crate) fn of(
        plant: &Plant,
        derivation: &Derivation,
        (emitted, scalar): (&Emitted, Scalar),
        samples: &Samples,
    ) -> Option<Self> {
        let module = Module::of(emitted)?;
        let words = size::words(&module, scalar)?;
        let recovered = derivation.left_inverse.result.as_ref()?.x.iter().map(|(state, _)| *state).collect::<Vec<_>>();
        let outputs: Vec<_> = plant.y.iter().map(|output| output.symbol).collect();
        let parameters: Vec<_> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let signals = |symbols: &[_], fields: &[String]| -> Option<Vec<Signal>> {
            let written: Vec<String> = symbols.iter().map(|symbol| plant.arena.name(*symbol)).collect();
            let units = symbols.iter().map(|symbol| plant.units.get(symbol).cloned());
            let names = field_names(&written).into_iter().zip(fields).zip(written).zip(units);
            let signal = |(((c, rust), written), unit): (((String, &String), String), _)| Signal {
                c,
                rust: rust.clone(),
                written,
                unit,
            };
            (symbols.len() == fields.len()).then(|| names.map(signal).collect())
        };
        let face = Face {
            plant,
            scalar,
            prefix: prefix(&plant.name),
            x: signals(&recovered, &module.x)?,
            y: signals(&outputs, &module.y)?,
            u: signals(&plant.u, &module.u)?,
            parameters: signals(&parameters, &module.parameters)?,
            words,
            samples,
            module,
        };
        let name = &face.prefix;
        let files = vec![
            ("Cargo.toml".to_owned(), build_files::manifest(&face)),
            ("src/lib.rs".to_owned(), face::text(&face)),
            (format!("src/{name}.rs"), emitted.text.clone()),
            (format!("include/{name}.h"), header::text(&face)),
            ("Makefile".to_owned(), build_files::makefile(&face)),
            ("CMakeLists.txt".to_owned(), build_files::cmake(&face)),
            ("example/main.c".to_owned(), example::text(&face)),
            ("README.md".to_owned(), build_files::readme(&face)),
        ];
        Some(Self { files })
    }
}
