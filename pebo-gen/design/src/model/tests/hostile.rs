//! Input that nobody means well with: a diagnostic, soon, and no panic.

use std::time::{Duration, Instant};

use proptest::prelude::*;

use super::{CUK, parse};
use crate::model::Model;
use crate::source::{Code, Colour, Source, render};

/// A person's idea of a hang, on a machine however busy.
const HANG: Duration = Duration::from_secs(120);

/// The first diagnostic's code, in less time than a hang takes.
fn refused(text: &str) -> Code {
    let begin = Instant::now();
    let source = Source::new("hostile.yaml", text).expect("it is small enough");
    let found = Model::parse(&source).expect_err("it is no model");
    let picture = render(&found, &source, Colour::Never);
    assert!(begin.elapsed() < HANG, "{:?}", begin.elapsed());
    assert!(found.len() <= 40 && picture.len() < 100_000, "{} bytes", picture.len());
    found[0].code
}

fn with_rate(rate: &str) -> String {
    CUK.replace("(E - (1 - d)*v2)/L1", rate)
}

#[test]
fn texts_that_are_no_yaml() {
    let cases = [
        ("", Code::EmptyFile),
        ("# nothing\n", Code::EmptyFile),
        ("---\n...\n", Code::EmptyFile),
        ("null", Code::EmptyFile),
        ("cuk", Code::WrongShape),
        ("- model: cuk\n", Code::WrongShape),
        ("{{{{", Code::YamlSyntax),
        ("model: 'cuk", Code::YamlSyntax),
        ("model: m\nx:\n\t- a\n", Code::YamlSyntax),
        ("f_x:\n  a: - v\n", Code::YamlSyntax),
        ("%YAML 1.2\n---\nmodel: m\n", Code::YamlFeature),
        ("model: m\n---\nmodel: n\n", Code::YamlFeature),
        ("\0\u{1}\u{2}", Code::YamlSyntax),
    ];
    for (text, code) in cases {
        assert_eq!(refused(text), code, "{text:?}");
    }
}

#[test]
fn windows_files_are_read() {
    assert!(parse(&CUK.replace('\n', "\r\n")).is_ok());
    assert!(parse(&format!("\u{feff}{CUK}")).is_ok());
}

#[test]
fn depth() {
    let deep = |open: &str, close: &str| open.repeat(10_000) + "v2" + &close.repeat(10_000);
    assert_eq!(refused(&with_rate(&deep("(", ")"))), Code::FormulaTooDeep);
    assert_eq!(refused(&with_rate(&deep("-", ""))), Code::FormulaTooDeep);
    assert_eq!(refused(&with_rate(&deep("v2*", ""))), Code::FormulaTooDeep);
    assert!(parse(&with_rate(&deep("v2+", ""))).is_ok(), "a sum is not deep for being long");
    assert_eq!(refused(&with_rate(&deep("2^", ""))), Code::FormulaTooDeep);
    assert_eq!(refused(&with_rate(&deep("[", "]"))), Code::NestedTooDeep);
    assert_eq!(refused(&deep("- ", "")), Code::NestedTooDeep);
    assert_eq!(refused(&deep("{a: ", "}")), Code::NestedTooDeep);
}

#[test]
fn size() {
    assert_eq!(refused(&with_rate("v2^1000000000")), Code::ExponentTooLarge);
    assert_eq!(refused(&with_rate("1e999999999")), Code::NumberTooLarge);
    assert_eq!(refused(&with_rate(&"9".repeat(30_000))), Code::NumberTooLarge);
    assert_eq!(refused(&with_rate(&"v".repeat(500_000))), Code::FormulaTooLarge);
    assert_eq!(refused(&"x".repeat(1_000_000)), Code::WrongShape);
    assert_eq!(refused(&"[".repeat(1_000_000)), Code::NestedTooDeep);
    assert_eq!(refused(&format!("x: [{}]", "a,".repeat(400_000))), Code::TooManyValues);
    assert_eq!(refused(&"x: [a]\n".repeat(5_000)), Code::DuplicateKey);
    assert_eq!(refused(&format!("[{}", "(a,".repeat(300_000))), Code::TooManyValues);
    let ten_megabytes = Source::new("big.yaml", "a".repeat(10_000_000));
    assert_eq!(ten_megabytes.map_err(|found| found.code), Err(Code::FileTooLarge));
}

#[test]
fn nearest_names_among_thousands() {
    let names = |prefix: &str| -> Vec<String> { (0..5000).map(|i| format!("{prefix}{i:05}")).collect() };
    let text = format!(
        "model: m\nx: [{}]\ny: [v]\nphi: [v]\nf_x: {{{}: 0}}\n",
        names("a").join(", "),
        names("b").join(": 0, ")
    );
    assert_eq!(refused(&text), Code::MissingEntry);
}

#[test]
fn an_alias_bomb() {
    let mut lines = vec!["a: &a [x, x, x, x, x, x, x, x, x]".to_owned()];
    for (name, last) in ('b'..='z').zip('a'..) {
        lines.push(format!("{name}: &{name} [{}]", vec![format!("*{last}"); 9].join(", ")));
    }
    let found = parse(&lines.join("\n")).expect_err("it is no model");
    assert!(found.iter().any(|found| found.code == Code::YamlFeature));
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(source) = Source::from_bytes("m", bytes)
            && let Err(found) = Model::parse(&source)
        {
            prop_assert!(!found.is_empty());
            render(&found, &source, Colour::Always);
        }
    }

    #[test]
    fn no_text_panics(text in "[a-cxy:{}\\[\\],\"'|>&*!%#?~ \n\t0-9()é-]{0,120}") {
        let source = Source::new("m", text).expect("it is small");
        if let Err(found) = Model::parse(&source) {
            prop_assert!(!found.is_empty());
            render(&found, &source, Colour::Never);
        }
    }

    /// A model with a piece cut out and another put in is still read to its end.
    #[test]
    fn no_change_to_a_model_panics(
        at in 0..CUK.len(),
        length in 0..40_usize,
        piece in "[a-z0-9:{}\\[\\],\"'*& \n()+^-]{0,12}",
    ) {
        let end = (at + length).min(CUK.len());
        let source = Source::new("m", format!("{}{piece}{}", &CUK[..at], &CUK[end..]));
        let source = source.expect("it is small");
        if let Err(found) = Model::parse(&source) {
            prop_assert!(!found.is_empty());
            for diagnostic in &found {
                prop_assert!(source.text().get(diagnostic.primary.span.range()).is_some());
            }
            render(&found, &source, Colour::Never);
        }
    }
}
