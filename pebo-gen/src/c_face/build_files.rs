//! The files that build the crate: Cargo's manifest, one file for make, one for `CMake`, and how to use them.

use super::subject::Face;

const MANIFEST: &str = include_str!("templates/Cargo.toml.in");
const MAKEFILE: &str = include_str!("templates/Makefile");
const CMAKE: &str = include_str!("templates/CMakeLists.txt");
const README: &str = include_str!("templates/README.md");

/// `Cargo.toml`.
pub(super) fn manifest(face: &Face<'_>) -> String {
    face.filled(MANIFEST, &[("oldest", env!("CARGO_PKG_RUST_VERSION"))])
}

/// `Makefile`.
pub(super) fn makefile(face: &Face<'_>) -> String {
    face.filled(MAKEFILE, &[])
}

/// `CMakeLists.txt`.
pub(super) fn cmake(face: &Face<'_>) -> String {
    face.filled(CMAKE, &[])
}

/// `README.md`.
pub(super) fn readme(face: &Face<'_>) -> String {
    let title = face.plant.title.as_deref().unwrap_or(&face.plant.name);
    face.filled(README, &[("title", title), ("oldest", env!("CARGO_PKG_RUST_VERSION"))])
}
