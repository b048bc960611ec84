//! The table of layers and the known circles among files hold for the sources.
//!
//! `cargo run -p tests --example modules` prints the graph.

#[path = "../modules/graph/mod.rs"]
mod graph;

use std::path::Path;

use graph::Graph;

/// The circles among files: the file whose documentation says why they are one thing, and how many they are. To add a
/// row is to have found no other way.
const CIRCLES: &[(&str, usize)] = &[("emit/layout/mod.rs", 3), ("model/rust/functions.rs", 2), ("program/lower.rs", 4)];

fn generator() -> Graph {
    Graph::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../pebo-gen"))
}

#[test]
fn no_arrow_runs_back() {
    assert_eq!(generator().back(), [""; 0]);
}

#[test]
fn foreign_crates_stay_in_their_layer() {
    assert_eq!(generator().strays(), [""; 0]);
}

#[test]
fn every_circle_is_known_and_says_why_it_is_one_thing() {
    let graph = generator();
    let circles = graph.circles();
    let said = circles.iter().map(|circle| (graph.reason(circle).map_or("", |(file, _)| file), circle.len()));
    assert_eq!(said.collect::<Vec<_>>(), CIRCLES, "\n{graph}");
}

/// Small sources, each with the number of arrows that the reader of the graph finds.
#[test]
fn arrows_are_read_off_every_way_to_name_something() {
    let uses: &[(&str, usize)] = &[
        ("use crate::plant::Thing;", 1),
        ("use crate::plant;", 1),
        ("fn f() -> crate::plant::Thing { loop {} }", 1),
        ("fn f() { println!(\"{}\", crate::plant::VALUE) }", 1),
        ("use super::plant::{Thing, VALUE};", 1),
        // Defined elsewhere and exported again within the layer: the arrow leads to the definition.
        ("use crate::plant::Inner;", 1),
        ("pub(crate) fn f() {}", 0),
        ("// crate::plant::Thing", 0),
        ("#[cfg(test)]\nmod tests { use crate::plant::Thing; }", 0),
    ];
    for (text, expected) in uses {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| {
            let path = folder.path().join("src").join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, text).expect("a file");
        };
        write("lib.rs", "mod cas;\nmod plant;");
        write("plant/mod.rs", "mod inner;\npub use inner::Inner;\npub struct Thing;\npub const VALUE: u8 = 0;");
        write("plant/inner.rs", "pub struct Inner;");
        write("cas.rs", text);
        let graph = Graph::read(folder.path());
        assert_eq!((graph.back().len(), graph.circles().len()), (*expected, 0), "{text}\n{graph}");
        // With an arrow back from there it is a circle.
        write("plant/mod.rs", "use crate::cas::f;\npub struct Thing;\npub const VALUE: u8 = 0;");
        let circles = Graph::read(folder.path()).circles().len();
        assert_eq!(circles, *expected, "{text}");
    }
}
