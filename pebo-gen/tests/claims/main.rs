//! Small plants for every verdict on every claim.

mod conditions;
mod fundamental;
mod implicit;
mod non_smooth;
mod refusals;
mod relations;
mod shapes;
mod table;
mod timed;

use pebo_gen::analysis::Verdict;
use pebo_gen::report::summary;
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};

fn derived(lines: &str) -> Derived {
    let text = format!("model: m\n{lines}\n");
    derive(&Source::new("m", text.as_str()).expect("a text")).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message))
}

#[test]
fn the_headline_speaks_of_the_claims_alone() {
    let said = |lines: &str| {
        let derived = derived(lines);
        summary(&derived.plant, &derived.derivation)
    };
    let undecided =
        said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: y + sin(y) - u*y}\nf_y: {y: x + exp(y)}\nphi: [x]\nassume: [y > 0]");
    assert!(undecided.starts_with("m: accepted: all four claims are proved\n"), "{undecided}");
    // An open remark is no open claim: it has no verdict.
    assert!(undecided.contains("\n  operating point           "), "{undecided}");
    let conditional = said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x/u}\nphi: [x]");
    let headline = "m: accepted: all four claims are proved where the conditions below hold\n";
    assert!(conditional.starts_with(headline), "{conditional}");
    assert!(conditional.contains("\n  conditions                u != 0\n"), "{conditional}");
}

/// A normal form writes `tanh` with exponentials and has `m^4 - 1` below the bar where the author has `1 - abs(m)*m`:
/// it overflows, or loses its digits at m = -1.
#[test]
fn a_derived_left_inverse_keeps_the_functions_of_the_outputs() {
    for (phi, assumed, expected) in [
        ("exp(x)*(1 - abs(m)*m)", "m != 1", "log(z1/(1 - m*abs(m)))"),
        ("2*tanh(m)*x", "m != 0", "z1/(2*tanh(m))"),
        ("cosh(m)*x^2", "x > 0", "sqrt(z1/cosh(m))"),
        // Not in powers of exp(m), though that is one function less.
        ("exp(m)*x^2 + tanh(2*m)", "x > 0", "sqrt((z1 - tanh(2*m))/exp(m))"),
        ("2*(sin(m) + 2)*x + tanh(2*m)", "x > 0", "(z1 - tanh(2*m))/(2*(sin(m) + 2))"),
        ("(1 + m^2)*x + min(m, 1)^3", "x > 0", "(z1 - min(m, 1)^3)/(m^2 + 1)"),
    ] {
        let derived = derived(&format!(
            "x: [x]\ny: [m, n]\nu: [u]\nassume: [{assumed}]\nf_x: {{x: 0}}\nf_y: {{m: 0, n: \"{phi}\"}}\nphi: [\"{phi}\"]"
        ));
        let inverse = derived.derivation.left_inverse.result.expect("a left inverse");
        assert_eq!(derived.plant.arena.print(inverse.x[0].1), expected, "{phi}");
    }
}

/// Both roots of a quadratic equation are candidates, and neither is right everywhere: the value of an output tells.
#[test]
fn outputs_complete_a_transform_that_alone_is_not_solved() {
    for (value, expected) in [("s - v", "w + z2"), ("1 + s - v", "w + z2 - 1"), ("2*v - 3*s", "(2*z2 - w)/3")] {
        let derived = derived(&format!(
            "x: [s, v]\ny: [w]\nu: [u]\nf_x: {{s: u, v: -u}}\ng_y: {{w: {value}}}\nphi: [s^2 + s, v]"
        ));
        let claim = derived.derivation.left_inverse;
        assert_eq!(claim.verdict, Verdict::Proved, "{value}");
        let inverse = claim.result.expect("a left inverse");
        assert_eq!(derived.plant.arena.print(inverse.x[0].1), expected, "{value}");
    }
}

/// Both are the same transform: samples of values would drive the plain one.
#[test]
fn a_plain_cascade_that_is_passed_over_is_named_with_the_way_to_it() {
    let plant = "x: [a]\ny: [s]\nu: [v]\nf_x: {a: v - a}\ng_y: {s: 2*a}\nphi: [a]";
    let said = |lines: &str| {
        let derived = derived(lines);
        summary(&derived.plant, &derived.derivation)
    };
    let preferred = said(plant);
    let note = "preferred to the plain cascade `z1' = (2*v - s)/2`, which each sample of `s` enters with all of its noise; \
                write `class: pebo` to have it";
    assert!(preferred.contains(note), "{preferred}");
    let plain = said(&format!("{plant}\nclass: pebo"));
    assert!(plain.contains("z1' = (2*v - s)/2") && !plain.contains("preferred"), "{plain}");
}
