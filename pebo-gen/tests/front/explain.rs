//! `pebo-gen explain`: every code has a story, and an example that provokes it.
#![cfg(all(feature = "cli", feature = "simulate", unix))]

use std::path::Path;
use std::process::Command;

use pebo_gen::model::Model;
use pebo_gen::model::rust::TokenSpans;
use pebo_gen::source::Code;
use proc_macro2::TokenStream;

const PROGRAM: &str = env!("CARGO_BIN_EXE_pebo-gen");

/// The program's output for a command of a shell, on both streams.
fn said(command: &str, folder: &Path) -> String {
    let programs = Path::new(PROGRAM).parent().expect("a folder").display();
    let path = format!("{programs}:{}", std::env::var("PATH").unwrap_or_default());
    let shell = Command::new("sh").args(["-c", command]).current_dir(folder).env("PATH", path).output();
    let output = shell.expect("a shell");
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// The output for an example of any kind.
fn answer(example: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    if let Some(command) = example.strip_prefix("$ ") {
        return said(command, folder.path());
    }
    if example.starts_with("#[pebo_model]") {
        let module: syn::ItemMod = syn::parse_str(example).expect("a module");
        let refused = Model::read_rust(TokenStream::new(), &module, &mut TokenSpans::new()).expect_err("a mistake");
        return refused.iter().map(|diagnostic| format!("[{}]", diagnostic.code.name())).collect::<Vec<_>>().join("\n");
    }
    std::fs::write(folder.path().join("model.yaml"), example).expect("a file");
    // Some mistakes are those of a simulation alone.
    said("pebo-gen check model.yaml; pebo-gen simulate model.yaml", folder.path())
}

#[test]
fn every_example_provokes_its_code() {
    for code in Code::ALL {
        let answer = answer(code.example());
        assert!(answer.contains(&format!("[{}]", code.name())), "{}:\n{}\n{answer}", code.name(), code.example());
    }
}

#[test]
fn every_code_is_explained_with_its_example_and_the_paper() {
    for code in Code::ALL {
        let story = said(&format!("pebo-gen explain {}", code.name()), Path::new("."));
        for part in [code.title(), code.explanation()].into_iter().chain(code.example().lines()).chain(code.paper()) {
            assert!(story.contains(part), "{}: no `{part}` in\n{story}", code.name());
        }
    }
    for code in [Code::CascadeRefuted, Code::LeftInverseRefuted, Code::RegressionNonlinear, Code::NeverIdentifiable] {
        assert!(code.paper().is_some_and(|place| place.starts_with("Section 2.")), "{}", code.name());
    }
}
