//! Time in the formulas of a plant.

use crate::model::Model;
use crate::source::{Code, Source};

/// The names of the inputs, with the unit of `t` and the text at which it was found.
fn inputs(text: &str) -> (Vec<String>, Option<String>, Option<String>) {
    let source = Source::new("m", format!("model: m\n{text}\n")).expect("a text");
    let model = Model::parse(&source).unwrap_or_else(|found| panic!("{text}: {}", found[0].message));
    let unit = model.units.iter().find(|unit| unit.name.value == "t").map(|unit| unit.value.value.clone());
    let at = model.time.map(|span| source.slice(span).to_owned());
    (model.u.into_iter().map(|name| name.value).collect(), unit, at)
}

#[test]
fn a_formula_with_time_has_it_as_its_last_input() {
    let rest = "x: [p]\ny: [q]\nphi: [p]\nu: [f]";
    for (formulas, expected) in [
        ("f_x: {p: f + sin(3*t)}\nf_y: {q: p}", true),
        ("f_x: {p: f}\nf_y: {q: p*t}", true),
        ("f_x: {p: f}\ng_y: {q: p + t}", true),
        ("f_x: {p: f + g}\nf_y: {q: p}\ndefine: {g: exp(-t)}", true),
        ("f_x: {p: f}\nf_y: {q: p}\nassume: [1 > 0, 0 < t < 5]", true),
        ("f_x: {p: f}\nf_y: {q: p}\nsimulation: {control: {f: sin(t)}, define: {a: t}}", false),
        ("f_x: {p: f}\nf_y: {q: p}\nrecording: {t: t/1000, f: t}", false),
    ] {
        let found = inputs(&format!("{rest}\n{formulas}"));
        let declared = (vec!["f".to_owned(), "t".to_owned()], Some("s".to_owned()), Some("t".to_owned()));
        let none = (vec!["f".to_owned()], None, None);
        assert_eq!(found, if expected { declared } else { none }, "{formulas}");
    }
}

#[test]
fn a_declared_name_is_what_it_was_declared_as() {
    for (declared, inputs_then) in [
        ("x: [t]\ny: [q]\nf_x: {t: 0}\nf_y: {q: t}\nphi: [t]", vec![]),
        ("x: [p]\ny: [q]\nu: [t, f]\nf_x: {p: t + f}\nf_y: {q: p}\nphi: [p]", vec!["t", "f"]),
        ("parameters: {t: 2}\nx: [p]\ny: [q]\nf_x: {p: t}\nf_y: {q: p}\nphi: [p]", vec![]),
        ("define: {t: 2*q}\nx: [p]\ny: [q]\nf_x: {p: t}\nf_y: {q: p}\nphi: [p]", vec![]),
    ] {
        let (names, unit, at) = inputs(declared);
        assert_eq!((names, unit, at), (inputs_then.into_iter().map(str::to_owned).collect(), None, None), "{declared}");
    }
}

/// The first diagnostic of a model.
fn refused(text: &str) -> (Code, String) {
    let source = Source::new("m", format!("model: m\n{text}\n")).expect("a text");
    let found = Model::parse(&source).and_then(|model| crate::plant::Plant::resolve(&model).map(|_| ()));
    let found = found.expect_err(text);
    (found[0].code, format!("{} | {}", found[0].message, found[0].help.as_deref().unwrap_or_default()))
}

#[test]
fn where_time_cannot_be_an_input_a_diagnostic_says_what_to_do() {
    let plant = "x: [p]\ny: [q]\nf_x: {p: t}\nf_y: {q: p}\nphi: [p*t]";
    let (code, said) = refused(plant);
    assert_eq!(code, Code::MisplacedName);
    assert!(said.starts_with("phi(x, y) cannot depend on `t`"), "{said}");
    // Its matrices have a column for each input that the author declares.
    let (code, said) = refused("x: [p]\ny: [q]\nlti: {A11: [[t]], A21: [[1]]}");
    assert_eq!(code, Code::UnknownName);
    assert!(said.contains("add `time` to `u`"), "{said}");
    // With a simulation, `t` is the time there.
    let (code, said) =
        refused("x: [p]\ny: [q]\nu: [t]\nf_x: {p: t}\nf_y: {q: p}\nphi: [p]\nsimulation: {duration: 1, step: 0.1}");
    assert_eq!(code, Code::ReservedName);
    assert!(said.contains("if it is the time, remove the declaration"), "{said}");
    // Nobody gives the time a course of its own.
    let plant = "x: [p]\ny: [q]\nf_x: {p: t}\nf_y: {q: p}\nphi: [p]";
    let (code, _) = refused(&format!("{plant}\nsimulation: {{duration: 1, step: 0.1, control: {{t: 2*t}}}}"));
    assert_eq!(code, Code::UnknownEntry);
}
