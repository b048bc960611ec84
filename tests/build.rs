//! Emits every model of the project and of these tests, in both scalars, for the tests to compile and run.

use std::fmt::Write as _;
use std::path::PathBuf;

use pebo_gen::emit::Scalar;
use pebo_gen::{BuildError, Builder};

fn main() -> Result<(), BuildError> {
    let mut models = Vec::new();
    for folder in ["../models", "models"] {
        println!("cargo::rerun-if-changed={folder}");
        let paths = std::fs::read_dir(folder).expect(folder).flatten().map(|entry| entry.path());
        models.extend(paths.filter(|path| path.extension().is_some_and(|e| e == "yaml")));
    }
    models.sort();
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let mut root = String::new();
    let mut table =
        String::from("/// Model, scalar, evaluation.\npub const ALL: &[(&str, &str, crate::Evaluate)] = &[\n");
    let mut sizes = String::from(
        "/// Model, scalar, bytes of the observer with the model's settings.\npub const SIZES: &[(&str, &str, usize)] = &[\n",
    );
    for (scalar, name) in [(Scalar::F64, "f64"), (Scalar::F32, "f32")] {
        for built in Builder::new().out_dir(out.join(name)).scalar(scalar).compile(&models)? {
            let (model, type_name) = (&built.model, &built.type_name);
            writeln!(root, "#[path = {:?}]\npub mod {model}_{name};", built.path.display().to_string())
                .expect("a string");
            let code = std::fs::read_to_string(&built.path).expect("what was written");
            if code.contains("pub type Tuned") {
                writeln!(sizes, "    ({model:?}, {name:?}, size_of::<{model}_{name}::Tuned>()),").expect("a string");
            }
            writeln!(table, "    ({model:?}, {name:?}, evaluated!({model}_{name}::{type_name})),").expect("a string");
        }
    }
    table.push_str("];\n");
    sizes.push_str("];\n");
    std::fs::write(out.join("emitted.rs"), root + &table + &sizes).expect("OUT_DIR can be written to");
    Ok(())
}
