//! Emits the models for `f32`, as a user's build script does, and puts the memory map where the linker looks.

use std::path::{Path, PathBuf};

use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;

fn main() {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let mut modules = String::new();
    for model in ["../../models/cuk_case2.yaml", "../../models/motor.yaml", "../models/pmsm.yaml", "arm.yaml"] {
        println!("cargo::rerun-if-changed={model}");
        let text = std::fs::read_to_string(model).expect("a model");
        let source = Source::new(model, text).expect("a text");
        let derived = pebo_gen::derive(&source).unwrap_or_else(|d| panic!("{model}: {}", d[0].message));
        let emitted = derived.emit(Scalar::F32).unwrap_or_else(|e| panic!("{model}: {e}"));
        let name = Path::new(model).file_stem().expect("a file").to_string_lossy().into_owned();
        let file = out.join(format!("{name}.rs"));
        std::fs::write(&file, emitted.text).expect("OUT_DIR can be written to");
        modules += &format!("#[path = {:?}]\npub mod {name};\n", file.display().to_string());
    }
    std::fs::write(out.join("emitted.rs"), modules).expect("OUT_DIR can be written to");
    println!("cargo::rerun-if-changed=memory.x");
    std::fs::copy("memory.x", out.join("memory.x")).expect("OUT_DIR can be written to");
    println!("cargo::rustc-link-search={}", out.display());
}
