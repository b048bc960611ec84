//! No dependency needs a newer compiler than the one that the project declares. Clippy checks the project's own code
//! (`incompatible_msrv`); cargo alone would notice a dependency with the declared compiler, and not with a newer one.

use std::process::Command;

use serde_json::Value;

/// The parts of a version, so that they compare as numbers.
fn version(text: &str) -> Vec<u32> {
    text.split('.').map(|part| part.parse().expect("a number")).collect()
}

/// Packages that ask for a newer compiler than this.
fn newer(metadata: &Value, declared: &str) -> Vec<String> {
    let packages = metadata["packages"].as_array().expect("a list");
    let asked = packages.iter().filter_map(|package| Some((package, package["rust_version"].as_str()?)));
    asked
        .filter(|(_, asked)| version(asked) > version(&format!("{declared}.0")))
        .map(|(package, asked)| format!("{} {} asks for Rust {asked}", package["name"], package["version"]))
        .collect()
}

#[test]
fn dependencies_build_with_the_declared_compiler() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let command = ["metadata", "--format-version", "1", "--locked"];
    let output = Command::new(env!("CARGO")).args(command).current_dir(folder).output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(metadata["packages"].as_array().is_some_and(|packages| packages.len() > 50));
    assert_eq!(newer(&metadata, env!("CARGO_PKG_RUST_VERSION")), [""; 0]);
    // nalgebra needs the declared one.
    assert!(newer(&metadata, "1.88").iter().any(|line| line.contains("nalgebra")));
}
