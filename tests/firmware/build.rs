//! Takes the modules that `run` had the generator write, and puts the memory map where the linker looks.

use std::path::PathBuf;

fn main() {
    let folder = |name: &str| PathBuf::from(std::env::var_os(name).unwrap_or_else(|| panic!("{name} is set by `run`")));
    let (out, modules) = (folder("OUT_DIR"), folder("FIRMWARE_MODULES"));
    println!("cargo::rerun-if-env-changed=FIRMWARE_MODULES");
    println!("cargo::rerun-if-changed={}", modules.display());
    let mut declarations = String::new();
    let mut files: Vec<PathBuf> = std::fs::read_dir(&modules)
        .expect("a folder of modules")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    for file in files {
        let name = file.file_stem().expect("a file").display().to_string();
        declarations += &format!("#[path = {:?}]\npub mod {name};\n", file.display().to_string());
    }
    std::fs::write(out.join("emitted.rs"), declarations).expect("OUT_DIR can be written to");
    println!("cargo::rerun-if-changed=memory.x");
    std::fs::copy("memory.x", out.join("memory.x")).expect("OUT_DIR can be written to");
    println!("cargo::rustc-link-search={}", out.display());
}
