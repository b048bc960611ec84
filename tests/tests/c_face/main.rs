//! The C face: its texts, the memory that it sets aside, and its programs beside the Rust observer, bit by bit.

mod program;
mod size;

use std::path::{Path, PathBuf};

use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;
use pebo_gen::{CProject, Request, answer};

/// A file of the workspace.
fn workspace(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The text of a model file, with settings of a call.
fn source(path: &Path, settings: &[&str]) -> Source {
    let text = std::fs::read_to_string(path).expect("a model");
    Source::new("model", text).and_then(|source| source.set(settings)).expect("a small model")
}

/// The crate for a model.
fn project(path: &str, settings: &[&str], scalar: Scalar) -> CProject {
    let answer = answer(&source(&workspace(path), settings), &Request::new().emit(scalar).c_project());
    answer.c_project.unwrap_or_else(|| panic!("{path}: {:?}", answer.diagnostics))
}

/// The text of a file of a crate.
fn file<'a>(project: &'a CProject, path: &str) -> &'a str {
    let found = project.files.iter().find(|file| file.0 == path);
    found.map_or_else(|| panic!("no file {path}"), |file| file.1.as_str())
}

#[test]
fn texts_of_a_model() {
    let project = project("models/cuk.yaml", &[], Scalar::F64);
    insta::with_settings!({ omit_expression => true, prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("cuk_c_header", file(&project, "include/cuk.h"));
        insta::assert_snapshot!("cuk_c_lib", file(&project, "src/lib.rs"));
    });
}

/// The emitted module is the one that a file has, and no text knows where it was written.
#[test]
fn the_module_is_that_of_a_file_and_texts_are_the_same_every_time() {
    let source = source(&workspace("models/dc_motor.yaml"), &[]);
    let request = Request::new().emit(Scalar::F32).c_project();
    let [first, second] = [answer(&source, &request), answer(&source, &request)];
    let project = first.c_project.expect("the settings are complete");
    assert_eq!(file(&project, "src/dc_motor.rs"), first.emitted.expect("it is accepted").text);
    assert_eq!(Some(&project), second.c_project.as_ref());
    for (path, text) in &project.files {
        let is_blank =
            |part: &str| !part.is_empty() && part.chars().all(|letter| letter.is_alphabetic() || letter == '_');
        assert!(!text.split('@').skip(1).any(is_blank), "{path} has a blank that is not filled");
        assert!(!text.contains(env!("CARGO_MANIFEST_DIR")), "{path} has a path of this machine");
    }
}
