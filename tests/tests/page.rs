//! The page of `pebo-gen report`, of a small model: to be read as its reader does.

use std::path::Path;

use pebo_gen::source::Source;
use pebo_gen::{Request, answer};

/// The explanation of the proof, without the style, and without the code, which has snapshots of its own.
#[test]
fn page_of_the_pendulum() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/pendulum.yaml");
    let text = std::fs::read_to_string(path).expect("a model");
    let answer = answer(&Source::new("pendulum.yaml", text).expect("a text"), &Request::new().page());
    let page = answer.page.expect("it is accepted");
    let (_, body) = page.split_once("<body>").expect("a body");
    let (explained, code) = body.split_once("<section id=\"code\">").expect("it is accepted");
    assert!(code.contains("pub struct Pendulum"));
    insta::with_settings!({ omit_expression => true, prepend_module_to_snapshot => false }, {
        insta::assert_snapshot!("pendulum_page", explained);
    });
}
