//! The README is true. Its model, commands and outputs are run by `pebo-gen/tests/manual`, as those of the manual are;
//! here are the tests that need the workspace.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

const README: &str = include_str!("../../README.md");

fn file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    std::fs::read_to_string(path).expect("a file of the project")
}

/// The README's fenced blocks of a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    README.split(fence.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// CI runs the commands as they are, in a clean checkout. A mistake that it found once is found here at once: without
/// one default among the programs of the workspace, `cargo run` does not know which is meant.
#[test]
fn the_commands_of_the_readme_mean_one_program() {
    let commands: Vec<&str> = blocks("sh").iter().flat_map(|block| block.lines()).collect();
    assert_eq!(commands, ["cargo run --release -- models/cuk.yaml", "cargo test"]);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--no-deps", "--format-version", "1", "--offline"]);
    let found = cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("..")).output().expect("cargo");
    let workspace: Value = serde_json::from_slice(&found.stdout).expect("the workspace");
    let packages = workspace["packages"].as_array().expect("packages");
    let named: Vec<&str> = packages.iter().filter_map(|package| package["default_run"].as_str()).collect();
    assert_eq!(named, ["pebo-gen"]);
    // `cargo test` is for every member.
    assert_eq!(workspace["workspace_default_members"], workspace["workspace_members"]);
    assert_eq!(packages.len(), workspace["workspace_members"].as_array().map_or(0, Vec::len));
}

/// It is for someone who has five minutes and never heard of observers of this kind.
#[test]
fn it_is_short_and_begins_in_plain_words() {
    assert!(README.lines().count() <= 120, "{} lines", README.lines().count());
    let beginning = README.split("## ").next().expect("a beginning");
    assert_eq!(beginning.matches(". ").count() + 1, 3, "three sentences: {beginning}");
    for letter in ["phi", "theta", "chi", "Lambda", "Psi", "`"] {
        assert!(!beginning.contains(letter), "{letter}: {beginning}");
    }
}

/// Its model is that of the crate whose code it shows.
#[test]
fn the_model_is_that_of_the_example() {
    assert_eq!(blocks("yaml drive.yaml"), [file("tests/examples/drive/drive.yaml")]);
}
