//! Observers from build scripts.
//!
//! In: model files. Out: a Rust file for each, and one that declares them as modules; or their diagnostics.

use std::fmt::{self, Debug, Display, Formatter};
use std::path::{Path, PathBuf};

use crate::derived::derive_within;
use crate::emit::Scalar;
use pebo_cas::Budget;
use pebo_design::source::{Colour, Source, render};

/// Writes the observers of model files, from a crate's build script.
///
/// In `build.rs`, with `pebo-gen` (`default-features = false, features = ["yaml"]`) among the build dependencies:
///
/// ```no_run
/// pebo_gen::Builder::new().compile(&["models/cuk.yaml"])?;
/// # Ok::<(), pebo_gen::BuildError>(())
/// ```
///
/// In the crate, which depends on `pebo-runtime`:
///
/// ```text
/// include!(concat!(env!("OUT_DIR"), "/pebo.rs"));     // declares `pub mod cuk`
/// ```
#[derive(Clone, Debug)]
pub struct Builder {
    out_dir: Option<PathBuf>,
    scalar: Scalar,
    rerun: bool,
    format: bool,
    include_file: String,
    limit: f64,
}

/// A model that was written.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BuiltModel {
    /// The model's name, which is the module's.
    pub model: String,
    /// The name of the type in it that implements `Model`.
    pub type_name: String,
    /// The file that was written.
    pub path: PathBuf,
}

/// The reason that a build script wrote nothing: the generator's diagnostics, as both `Display` and `Debug`, so that a
/// build script that unwraps shows them as they are.
pub struct BuildError(String);

impl Default for Builder {
    fn default() -> Self {
        Self::new()
    }
}

impl Builder {
    /// For `f64`, into cargo's `OUT_DIR`, formatted, run again when a model file changes.
    pub fn new() -> Self {
        Self {
            out_dir: None,
            scalar: Scalar::F64,
            rerun: true,
            format: true,
            include_file: "pebo.rs".to_owned(),
            limit: Budget::SECONDS,
        }
    }

    /// Writes into this folder, which is created if it is missing.
    #[must_use]
    pub fn out_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(folder.into());
        self
    }

    /// The floating-point type of the written code.
    #[must_use]
    pub fn scalar(mut self, scalar: Scalar) -> Self {
        self.scalar = scalar;
        self
    }

    /// Tells cargo, or does not, to run the build script again when a model file changes. Not for programs that are no
    /// build scripts.
    #[must_use]
    pub fn emit_rerun_if_changed(mut self, tell: bool) -> Self {
        self.rerun = tell;
        self
    }

    /// Lays the code out as rustfmt does, or writes it without line breaks.
    #[must_use]
    pub fn format(mut self, format: bool) -> Self {
        self.format = format;
        self
    }

    /// The name of the file that declares the modules, instead of `pebo.rs`.
    #[must_use]
    pub fn include_file(mut self, name: impl Into<String>) -> Self {
        self.include_file = name.into();
        self
    }

    /// The work that a model may take, in seconds of a machine of today: 10 unless this says otherwise. It is counted
    /// in steps and not by the clock, so that a verdict does not depend on the machine.
    #[must_use]
    pub fn limit(mut self, seconds: f64) -> Self {
        self.limit = seconds;
        self
    }

    /// Checks every model, then writes each to `NAME.rs`, and a file that declares them all.
    ///
    /// # Errors
    /// If a model is not accepted, or a file cannot be read or written. All models are looked at first: nothing is
    /// written if one of them is refused, and each tells what is wrong with it.
    pub fn compile(&self, models: &[impl AsRef<Path>]) -> Result<Vec<BuiltModel>, BuildError> {
        let folder = self.folder()?;
        let (mut texts, mut refused) = (Vec::new(), Vec::new());
        for path in models {
            match self.one(path.as_ref()) {
                Ok((model, type_name, text)) => {
                    let built = BuiltModel { path: folder.join(format!("{model}.rs")), model, type_name };
                    texts.push((built, text));
                }
                Err(BuildError(text)) => refused.push(text),
            }
        }
        for (index, (built, _)) in texts.iter().enumerate() {
            if texts[..index].iter().any(|(before, _)| before.model == built.model) {
                refused.push(format!("two models are called `{0}`\nhelp: rename one: `model: {0}_2`\n", built.model));
            }
        }
        if !refused.is_empty() {
            return Err(BuildError(refused.join("\n")));
        }
        let mut index = String::new();
        for (built, text) in &texts {
            write(&built.path, text)?;
            // An absolute path: relative ones start at the file that includes this one.
            let path = built.path.display().to_string();
            index.extend([format!("#[path = {path:?}]\n"), format!("pub mod {};\n", built.model)]);
        }
        write(&folder.join(&self.include_file), &index)?;
        Ok(texts.into_iter().map(|(built, _)| built).collect())
    }

    fn folder(&self) -> Result<PathBuf, BuildError> {
        let folder = self.out_dir.clone().or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from));
        let folder = folder.ok_or_else(|| {
            BuildError("there is no folder to write to\nhelp: call `out_dir`, or run from a build script".to_owned())
        })?;
        let made = std::fs::create_dir_all(&folder).and_then(|()| std::path::absolute(&folder));
        made.map_err(|error| BuildError(format!("cannot make {}: {error}", folder.display())))
    }

    /// Name, type and code of a model.
    fn one(&self, path: &Path) -> Result<(String, String, String), BuildError> {
        let name = path.display().to_string();
        if self.rerun {
            println!("cargo::rerun-if-changed={name}");
        }
        let bytes = std::fs::read(path).map_err(|error| {
            let help = "paths are relative to the folder of the crate's Cargo.toml";
            BuildError(format!("cannot read {name}: {error}\nhelp: {help}\n"))
        })?;
        let source = Source::from_bytes(&name, bytes)
            .map_err(|diagnostic| BuildError(render(&[diagnostic], &Source::unread(&name), Colour::Never)))?;
        let refused = |diagnostics: Vec<_>| BuildError(render(&diagnostics, &source, Colour::Never));
        let derived = derive_within(&source, Budget::of_seconds(self.limit)).map_err(refused)?;
        let emitted = derived.admitted(self.scalar).map_err(refused)?;
        let text = if self.format { emitted.text } else { emitted.tokens.to_string() };
        Ok((derived.plant.name.clone(), emitted.type_name, text))
    }
}

/// Writes a file if its content would change: cargo and rustc look at the time it was written.
fn write(path: &Path, text: &str) -> Result<(), BuildError> {
    if std::fs::read(path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    std::fs::write(path, text).map_err(|error| BuildError(format!("cannot write {}: {error}\n", path.display())))
}

impl Display for BuildError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Debug for BuildError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "\n{}", self.0)
    }
}

impl std::error::Error for BuildError {}
