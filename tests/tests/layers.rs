//! Which layer may use which: read off the sources.

use std::path::{Path, PathBuf};

/// Every Rust file below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found
}

/// Lines of code of a file, without comments and without its tests.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a source file");
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

#[test]
fn layers_use_only_those_above_them() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pebo-gen/src");
    // Each layer with those that it may use, itself included.
    let allowed: &[(&str, &[&str])] = &[
        ("source", &["source"]),
        ("cas", &["cas"]),
        ("model", &["model", "source"]),
        ("plant", &["plant", "model", "cas", "source"]),
        ("analysis", &["analysis", "plant", "cas", "source"]),
        ("program", &["program", "cas"]),
        ("emit", &["emit", "program", "analysis", "plant", "cas"]),
        ("report", &["report", "analysis", "plant", "cas", "source"]),
        ("simulate", &["simulate", "program", "analysis", "plant", "model", "cas", "source"]),
    ];
    for (layer, uses) in allowed {
        let found = files(&source.join(layer));
        assert!(!found.is_empty(), "the layer {layer} has no files");
        for path in
            found.iter().filter(|p| !p.ends_with("tests.rs") && !p.components().any(|c| c.as_os_str() == "tests"))
        {
            for rest in code(path).split("crate::").skip(1) {
                let used: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                assert!(uses.contains(&used.as_str()), "{} uses crate::{used}", path.display());
            }
        }
    }
}

#[test]
fn foreign_crates_stay_in_their_layer() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pebo-gen/src");
    let owners: [(&str, &[&str]); 7] = [
        // Code that is written, and code that is read.
        ("quote", &["emit", "model"]),
        ("granit_parser", &["model"]),
        ("serde_yaml", &["model"]),
        ("annotate_snippets", &["source"]),
        ("dashu_int", &["cas"]),
        // The emitter names it in the code it writes.
        ("pebo_runtime", &["simulate", "emit"]),
        ("clap", &["cli"]),
    ];
    for path in files(&source) {
        let layer = path.strip_prefix(&source).expect("below the sources").components().next();
        let layer = layer.map(|c| c.as_os_str().to_string_lossy().into_owned()).unwrap_or_default();
        for (foreign, layers) in owners {
            let used =
                code(&path).contains(&format!("use {foreign}::")) || code(&path).contains(&format!(" {foreign}::"));
            assert!(!used || layers.contains(&layer.as_str()), "{} uses {foreign}", path.display());
        }
    }
}
