//! Refusals point at their causes: a component of the transform, a summand of a rate, a pair of assumptions.
#![cfg(feature = "yaml")]

use pebo_gen::analysis::Outcome;
use pebo_gen::derive;
use pebo_gen::source::{Code, Source};

/// A name, the lines of the model, the code, the underlined text, other underlined texts.
type Row = (&'static str, &'static str, Code, &'static str, &'static [&'static str]);

const TABLE: &[Row] = &[
    (
        "a summand below a fraction bar",
        "x: [a, b]\ny: [y]\nu: [u]\nparameters: {G: 3, C: 2}\nf_x: {a: u, b: (y - G*b^2)/C}\nf_y: {y: a}\nphi: [a, b]",
        Code::CascadeRefuted,
        "b",
        &["G*b^2"],
    ),
    (
        "a summand that only the transform's slope makes unknown",
        "x: [a]\ny: [y]\nu: [u]\nf_x: {a: u + 0*y}\nf_y: {y: a}\nphi: [sin(a)]",
        Code::CascadeRefuted,
        "sin(a)",
        &["u"],
    ),
    (
        "two summands that cancel, and one that stays",
        "x: [a]\ny: [y]\nu: [u]\nf_x: {a: u + a^3 - a^2}\nf_y: {y: a^3}\nphi: [a - y]",
        Code::CascadeRefuted,
        "a - y",
        &["a^2"],
    ),
    (
        "one bent summand of three",
        "x: [a]\ny: [y]\nu: [u]\nf_x: {a: u}\nf_y: {y: a + exp(-a^2) + u}\nphi: [a]",
        Code::RegressionNonlinear,
        "exp(-a^2)",
        &[],
    ),
    (
        "the summand with the unmeasured signal",
        "x: [a]\ny: [y]\nu: [u]\nw: [w]\nf_x: {a: u}\nf_y: {y: a + 2*w}\nphi: [a]",
        Code::RegressionNonlinear,
        "2*w",
        &[],
    ),
    (
        "a given left inverse",
        "x: [a]\ny: [y]\nu: [u]\nf_x: {a: u}\nf_y: {y: a}\nphi: [2*a]\nphi_left: {a: z1 + 1}",
        Code::LeftInverseRefuted,
        "z1 + 1",
        &[],
    ),
    (
        "the components that nothing tells apart",
        "x: [a, b, c]\ny: [y, s]\nu: [u]\nf_x: {a: u, b: u, c: u}\nf_y: {y: a, s: b + c}\nphi: [a, b, 2*c]",
        Code::NeverIdentifiable,
        "b",
        &["2*c"],
    ),
    (
        "two assumptions",
        "x: [a]\ny: [y]\nu: [u]\nassume: [u > 1, y > 0, 2*u < 1]\nf_x: {a: u}\nf_y: {y: a}\nphi: [a]",
        Code::ContradictoryAssumptions,
        "2*u < 1",
        &["u > 1"],
    ),
    (
        "two assumptions on a difference",
        "x: [a]\ny: [y]\nu: [u]\nassume: [y - u > pi, u - y >= -3]\nf_x: {a: u}\nf_y: {y: a}\nphi: [a]",
        Code::ContradictoryAssumptions,
        "u - y >= -3",
        &["y - u > pi"],
    ),
    (
        "an assumption and a value",
        "x: [a]\ny: [y]\nu: [u]\nparameters: {L: -1}\nassume: [L > 0]\nf_x: {a: u}\nf_y: {y: a}\nphi: [a]",
        Code::ContradictoryAssumptions,
        "L > 0",
        &["L"],
    ),
];

#[test]
fn refusals_point_at_their_cause() {
    for (what, lines, code, underlined, others) in TABLE {
        let text = format!("model: m\n{lines}\n");
        let source = Source::new("m.yaml", text.as_str()).expect("a text");
        let found = match derive(&source) {
            Ok(derived) => derived.derivation.diagnostics,
            Err(diagnostics) => diagnostics,
        };
        let hit = found.iter().find(|diagnostic| diagnostic.code == *code);
        let hit = hit.unwrap_or_else(|| panic!("{what}: {found:?}"));
        assert_eq!(source.slice(hit.primary.span), *underlined, "{what}: {hit:?}");
        let also: Vec<&str> = hit.secondary.iter().map(|label| source.slice(label.span)).collect();
        assert_eq!(also, *others, "{what}: {hit:?}");
        assert!(hit.help.is_some(), "{what}");
    }
}

/// Equal bounds exclude one another only where one of them is strict, and tight ranges are no contradiction.
#[test]
fn assumptions_that_can_hold_are_not_refused() {
    for assume in ["u >= 1, u <= 1", "0 < u < 1e-9", "u > 1, u != 2", "u - y > 0, y > 5", "3 < u < pi + 1"] {
        let text =
            format!("model: m\nx: [a]\ny: [y]\nu: [u]\nassume: [{assume}]\nf_x: {{a: y}}\nf_y: {{y: a}}\nphi: [a]\n");
        let refused = derive(&Source::new("m.yaml", text).expect("a text")).err().unwrap_or_default();
        assert!(refused.is_empty(), "{assume}: {refused:?}");
    }
    for assume in ["u >= 1, u < 1", "u > 3, u < 3", "1 > 2"] {
        let text =
            format!("model: m\nx: [a]\ny: [y]\nu: [u]\nassume: [{assume}]\nf_x: {{a: y}}\nf_y: {{y: a}}\nphi: [a]\n");
        let refused = derive(&Source::new("m.yaml", text).expect("a text")).err().unwrap_or_default();
        assert!(refused.iter().any(|d| d.code == Code::ContradictoryAssumptions), "{assume}: {refused:?}");
    }
}

/// Less plain contradictions are refused too, if algebra or an enclosure proves them; else the claims are undecided:
/// every claim about no values is true.
#[test]
fn a_domain_without_a_point_is_not_accepted() {
    let text = |assume: &str| {
        let text =
            format!("model: m\nx: [a]\ny: [y]\nu: [u]\nassume: [{assume}]\nf_x: {{a: u}}\nf_y: {{y: a}}\nphi: [a]\n");
        Source::new("m.yaml", text).expect("a text")
    };
    let empty =
        ["a^2 + y^2 < -1", "a > 0, y > 0, a*y < 0", "0 < u < 1, sin(u) > 1", "a^2 < 0", "sin(u)^2 + cos(u)^2 != 1"];
    for assume in empty {
        let refused = derive(&text(assume)).err().unwrap_or_default();
        assert!(refused.iter().any(|d| d.code == Code::ContradictoryAssumptions), "{assume}: {refused:?}");
    }
    // No rule shows that there is none.
    let derived = derive(&text("exp(a) < a")).expect("a model");
    assert_eq!(derived.derivation.outcome, Outcome::Undecided);
    assert!(derived.derivation.diagnostics.iter().any(|d| d.code == Code::ContradictoryAssumptions));
    let held = derive(&text("a > 0, y > 0, a*y > 0, 0 < u < 1e-6")).expect("a model");
    assert_eq!(held.derivation.outcome, Outcome::Accepted);
}
