//! The C face on the command line: the files of a crate in a folder, or none.
#![cfg(all(feature = "cli", feature = "simulate"))]

use std::path::{Path, PathBuf};

use super::cli::{CUK, Folder, model, run, text};

/// The files of a crate, by their paths in its folder.
fn crate_files(folder: &Path) -> Vec<(PathBuf, String)> {
    let paths = ["Cargo.toml", "CMakeLists.txt", "Makefile", "README.md", "example/main.c", "src/lib.rs"];
    let named = ["include/cuk.h", "src/cuk.rs"];
    let read = |path: &str| (PathBuf::from(path), std::fs::read_to_string(folder.join(path)).expect(path));
    paths.into_iter().chain(named).map(read).collect()
}

#[test]
fn a_c_face_is_a_crate_in_a_folder() {
    let folder = Folder::new();
    let place = folder.path("deep/cuk");
    let to = place.display().to_string();
    let output = run(&[CUK, "--c", &to, "--scalar", "f32"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty());
    assert!(text(&output.stderr).starts_with("cuk: accepted"));
    let first = crate_files(&place);
    // The module is what the same call writes to a file.
    assert_eq!(first[7].1, text(&run(&[CUK, "--scalar", "f32"]).stdout));
    // Files of ours are replaced, and others left alone.
    std::fs::write(place.join("Makefile"), "old").expect("a file");
    std::fs::write(place.join("mine.c"), "mine").expect("a file");
    assert_eq!(run(&[CUK, "--c", &to, "--scalar", "f32"]).status.code(), Some(0));
    assert_eq!(crate_files(&place), first);
    assert_eq!(std::fs::read_to_string(place.join("mine.c")).expect("a file"), "mine");
}

#[test]
fn a_refused_c_face_writes_nothing() {
    let folder = Folder::new();
    let refused = folder.file("m.yaml", model("f_y", "f_y: {y1: a*x1^2}"));
    let malformed = folder.file("n.yaml", model("f_y", "f_y: {y1: a*x3}"));
    // Without a simulation there is nothing to work the settings of its observer out from.
    let bare = folder.file("bare.yaml", model("model", "model: bare"));
    let file = folder.file("taken", "a file");
    let place = folder.path("crate");
    let to = place.display().to_string();
    let cases: [(&[&str], i32, &str); 6] = [
        (&[&refused, "--c", &to], 1, "regression"),
        (&[&malformed, "--c", &to], 2, "unknown-name"),
        (&[&bare, "--c", &to], 1, "`bare` has no observer to put behind a C face"),
        (&[CUK, "--c", &file], 2, "it is a file, and a folder is expected"),
        (&[CUK, "--c", &to, "-o", &to], 2, "cannot be used with"),
        (&[CUK, CUK, "--c", &to], 2, "`--c` writes the crate of one model"),
    ];
    for (arguments, status, message) in cases {
        let output = run(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
        assert!(!place.exists(), "{arguments:?}");
    }
    assert_eq!(std::fs::read_to_string(file).expect("a file"), "a file");
}
