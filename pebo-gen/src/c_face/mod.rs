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

use crate::emit::{Emitted, Scalar};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;

use module::Module;
use names::{field_names, prefix};

pub(crate) use samples::Samples;

/// The files of a crate with a C face.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
#[non_exhaustive]
pub struct CProject {
    /// The path of each file in the folder of the crate, its parts joined by `/`, and its text.
    pub files: Vec<(String, String)>,
}

/// What all files are written from.
struct Face<'a> {
    plant: &'a Plant,
    scalar: Scalar,
    /// The emitted module.
    module: Module,
    /// The name in front of all that the header declares.
    prefix: String,
    x: Vec<Signal>,
    y: Vec<Signal>,
    u: Vec<Signal>,
    parameters: Vec<Signal>,
    /// The words of 64 bits that an observer takes at most.
    words: usize,
    samples: &'a Samples,
}

/// A field of a structure on both sides.
struct Signal {
    /// Its name in C: the author's, if C has no other use for it.
    c: String,
    /// Its name in the emitted module.
    rust: String,
    /// Its name in the model.
    written: String,
    unit: Option<String>,
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

impl Face<'_> {
    /// A text with the names of this face for those between at signs.
    fn filled(&self, template: &str, more: &[(&str, &str)]) -> String {
        let upper = self.prefix.to_uppercase();
        let words = self.words.to_string();
        let library = self.library();
        let own = [
            ("name", self.prefix.as_str()),
            ("NAME", &upper),
            ("model", &self.plant.name),
            ("version", env!("CARGO_PKG_VERSION")),
            ("scalar", self.scalar.name()),
            ("c_scalar", self.c_scalar()),
            ("words", &words),
            ("library", &library),
        ];
        let all = more.iter().chain(&own);
        all.fold(template.to_owned(), |text, (name, value)| text.replace(&format!("@{name}@"), value))
    }

    /// The name of the crate and of its library, in lower case as Rust wants it.
    fn library(&self) -> String {
        format!("{}_observer", self.prefix.to_lowercase())
    }

    /// The floating-point type in C.
    fn c_scalar(&self) -> &'static str {
        match self.scalar {
            Scalar::F32 => "float",
            Scalar::F64 => "double",
        }
    }

    /// A number as a literal of C, rounded to the scalar.
    fn c_literal(&self, value: f64) -> String {
        match self.scalar {
            #[expect(clippy::cast_possible_truncation, reason = "rounded to the scalar of the face")]
            Scalar::F32 => format!("{:?}f", value as f32),
            Scalar::F64 => format!("{value:?}"),
        }
    }
}
