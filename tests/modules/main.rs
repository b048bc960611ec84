//! The figures of a checkout's module graph: `cargo run -p tests --example modules [CHECKOUT]`.

mod graph;

use std::path::PathBuf;

fn main() {
    let workspace = || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
    let checkout = std::env::args_os().nth(1).map_or_else(workspace, PathBuf::from);
    println!("{}", graph::Graph::read(&checkout.join("pebo-gen")));
}
