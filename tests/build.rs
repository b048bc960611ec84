//! Emits every model of the project and of these tests, in both scalars, for the tests to compile and run.
//!
//! This is what a user's build script does: read, derive, emit, write to `OUT_DIR`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;

fn main() {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let mut root = String::new();
    let mut table =
        String::from("/// Model, scalar, evaluation.\npub const ALL: &[(&str, &str, crate::Evaluate)] = &[\n");
    for folder in ["../models", "models"] {
        println!("cargo::rerun-if-changed={folder}");
        let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).expect(folder).flatten().map(|e| e.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|e| e == "yaml"));
        paths.sort();
        for path in paths {
            emit(&path, &out, &mut root, &mut table);
        }
    }
    table.push_str("];\n");
    std::fs::write(out.join("emitted.rs"), root + &table).expect("OUT_DIR can be written to");
}

fn emit(path: &Path, out: &Path, root: &mut String, table: &mut String) {
    println!("cargo::rerun-if-changed={}", path.display());
    let text = std::fs::read_to_string(path).expect("a model");
    let source = Source::new(path.display().to_string(), text).expect("a text");
    let derived = pebo_gen::derive(&source).unwrap_or_else(|d| panic!("{}: {}", path.display(), d[0].message));
    let model = &derived.plant.name;
    for (scalar, name) in [(Scalar::F64, "f64"), (Scalar::F32, "f32")] {
        let emitted = derived.emit(scalar).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let type_name = &emitted.type_name;
        let file = out.join(format!("{model}_{name}.rs"));
        std::fs::write(&file, &emitted.text).expect("OUT_DIR can be written to");
        writeln!(root, "#[path = {:?}]\npub mod {model}_{name};", file.display().to_string()).expect("a string");
        writeln!(
            table,
            "    ({model:?}, {name:?}, |point| crate::evaluate(&{model}_{name}::{type_name}::new(&{model}_{name}::Parameters::default()), point)),"
        )
        .expect("a string");
    }
}
