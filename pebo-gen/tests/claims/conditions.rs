//! Conditions of the claims: listed, discharged, or met.

use pebo_cas::Relation;
use pebo_cas::graph::conditions::Regularity;
use pebo_gen::analysis::{Equilibrium, Outcome, Verdict};
use pebo_gen::derive;
use pebo_gen::source::{Code, Source};

use super::derived;

#[test]
fn conditions_are_listed_unless_the_assumptions_discharge_them() {
    let remaining = |assume: &str| {
        let plant = derived(&format!(
            "x: [x]\ny: [y, r]\nu: [u]\nparameters: {{m: 2, k: null}}\nassume: [{assume}]\n\
             f_x: {{x: u/(m*k*r^2)}}\nf_y: {{y: x*sqrt(r) + r/r, r: u}}\nphi: [x]"
        ));
        let arena = &plant.plant.arena;
        let shown = |(e, relation): &(_, Relation)| format!("{} {relation:?}", arena.print(*e));
        plant.derivation.conditions.iter().map(shown).collect::<Vec<_>>()
    };
    // m has a value, so its sign is known; the cancelled r of r/r is remembered.
    assert_eq!(remaining("k > 0"), ["r Positive"]);
    assert_eq!(remaining("k != 0, r >= 0"), ["r NonZero"]);
    assert_eq!(remaining("k < 0, r > 0"), Vec::<String>::new());
}

/// No rule of algebra knows the sign of `u^3 - u + exp(-u)`; enclosures over the assumed box do.
#[test]
fn conditions_are_discharged_by_enclosures_over_the_assumed_box() {
    let remaining = |assume: &str| {
        let plant = derived(&format!(
            "x: [x]\ny: [y]\nu: [u]\nassume: [{assume}]\n\
             f_x: {{x: sqrt(u^3 - u + exp(-u))}}\nf_y: {{y: x*(2 + sin(3*u))}}\nphi: [x]"
        ));
        plant.derivation.conditions.len()
    };
    assert_eq!(remaining("0 < u < 1"), 0);
    // At u = -2 the radicand is 1.4, at u = -3 it is -3.9.
    assert_eq!(remaining("-3 < u < 1"), 1);
    assert_eq!(remaining("u > 0"), 1);
}

/// Facts about absolute values, greatest and least values are used, and those that hold for any arguments.
#[test]
fn conditions_are_discharged_by_bounds_of_absolute_values() {
    let remaining = |assume: &str, rate: &str| {
        let plant = derived(&format!(
            "x: [p]\ny: [q]\nu: [v]\nassume: ['{assume}']\nf_x: {{p: '{rate}'}}\nf_y: {{q: p}}\nphi: [p]"
        ));
        let arena = &plant.plant.arena;
        let shown = |(e, relation): &(_, Relation)| format!("{} {}", arena.print(*e), relation.sign());
        plant.derivation.conditions.iter().map(shown).collect::<Vec<_>>()
    };
    for (assume, rate) in [
        ("abs(q) < 1", "v/sqrt(1 - q^2)"),
        ("max(q, v) < 1", "v/(q - 1) + 1/(1 - v)"),
        ("min(q, v) > 0", "sqrt(q) + log(v)"),
        ("v > 0", "v/max(q, 1)"),
        ("v > 0", "v/(2 + sat(q)) - 1/(max(q, v) + max(q, 1))"),
    ] {
        assert_eq!(remaining(assume, rate), Vec::<String>::new(), "{assume}, {rate}");
    }
    assert_eq!(remaining("abs(q) > 1", "v/(1 - q)"), ["1 - q != 0"]);
    assert_eq!(remaining("max(q, v) > 0", "v/q"), ["q != 0"]);
    assert_eq!(remaining("v > 0", "v/(1 + max(q, -1))"), ["max(q, -1) + 1 != 0"]);
    assert_eq!(remaining("v > 0", "v/(1 + sat(q))"), ["sat(q) + 1 != 0"]);
    // A sign computes zero where its argument is zero, and proofs leave that out.
    assert_eq!(remaining("v > 0", "v/(2 + sign(q))"), ["q != 0"]);
}

/// A regression in several functions of an unknown has the denominator of the output's value, without its conjugate.
#[test]
fn a_regression_has_the_denominator_of_the_value_of_an_output() {
    for (factor, listed) in [("1 + abs(q)", vec!["q != 0"]), ("1 + sqrt(q)", vec![])] {
        let plant = derived(&format!(
            "x: [p, b]\ny: [q, m]\nu: [v]\nassume: ['{}']\nf_x: {{p: v - p^2, b: 0}}\nf_y: {{q: v}}\n\
             g_y: {{m: '({factor})*p + b'}}\nphi: [b, b^2]",
            if listed.is_empty() { "q > 0" } else { "v > 0" }
        ));
        assert_eq!(plant.derivation.outcome, Outcome::Accepted);
        let shown = |(e, relation): &(_, Relation)| format!("{} {}", plant.plant.arena.print(*e), relation.sign());
        assert_eq!(plant.derivation.conditions.iter().map(shown).collect::<Vec<_>>(), listed);
    }
}

/// Identifiability of five equal phases takes too long to decide: the verdict says so, and no condition forbids them.
#[test]
fn values_of_parameters_that_were_not_worked_out_are_no_conditions() {
    let list = |of: &dyn Fn(usize) -> String, between: &str| (1..=5).map(of).collect::<Vec<_>>().join(between);
    let plant = derived(&format!(
        "parameters: [C, G, E, {}]\nx: [{}]\ny: [v]\nu: [{}]\nassume: [C > 0, G > 0, {}]\nf_x: {{{}}}\n\
         f_y: {{v: ({} - G*v)/C}}\nphi: [{}]",
        list(&|k| format!("L{k}, R{k}"), ", "),
        list(&|k| format!("i{k}"), ", "),
        list(&|k| format!("d{k}"), ", "),
        list(&|k| format!("L{k} > 0, R{k} > 0, 0 < d{k} < 1"), ", "),
        list(&|k| format!("i{k}: (E - R{k}*i{k} - (1 - d{k})*v)/L{k}"), ", "),
        list(&|k| format!("(1 - d{k})*i{k}"), " + "),
        list(&|k| format!("i{k}"), ", "),
    ));
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    let identifiability = plant.derivation.identifiability.result.as_ref().expect("an answer");
    assert!(identifiability.constants.is_empty() && plant.derivation.conditions.is_empty());
    assert!(
        !identifiability.trajectories.as_ref().expect("motions").parameters,
        "it is said that they were not worked out"
    );
}

/// Three angular momenta of a spherical pendulum for two states: no two of them give both states everywhere, all three
/// do.
#[test]
fn more_components_than_states_recover_the_states_everywhere() {
    let plant = derived(
        "parameters: [g, l, m]\nx: [pt, pp]\ny: [th, ph]\nassume: [l > 0, m > 0, sin(th) != 0]\n\
         f_x: {pt: pp^2*cos(th)/(m*l^2*sin(th)^3) - m*g*l*sin(th), pp: 0}\n\
         f_y: {th: pt/(m*l^2), ph: pp/(m*l^2*sin(th)^2)}\n\
         phi: [pt*cos(ph) - pp*cos(th)*sin(ph)/sin(th), -pp*cos(th)*cos(ph)/sin(th) - pt*sin(ph), pp]",
    );
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    assert!(plant.derivation.conditions.is_empty());
    let inverse = plant.derivation.left_inverse.result.as_ref().expect("a left inverse");
    let formulas: Vec<String> = inverse.x.iter().map(|(_, formula)| plant.plant.arena.print(*formula)).collect();
    assert_eq!(formulas, ["z1*cos(ph) - z2*sin(ph)", "z3"]);
}

/// Beside a heading that is known by its sine and cosine, two rows hold the second coordinate, and one of them does
/// wherever the vehicle heads.
#[test]
fn states_beside_known_ones_are_recovered_by_all_components_that_hold_them() {
    let plant = derived(
        "x: [px, py, th]\ny: [s]\nu: [v, w]\nangles: {th: 2*pi}\nf_x: {px: v*cos(th), py: v*sin(th), th: w}\n\
         g_y: {s: px^2 + py^2 + v*px}\n\
         phi: [px, cos(th), sin(th), px^2 + py^2, px*cos(th) + py*sin(th), py*cos(th) - px*sin(th)]",
    );
    assert_eq!(plant.derivation.outcome, Outcome::Accepted, "{:?}", plant.derivation.diagnostics);
    assert!(plant.derivation.conditions.is_empty(), "{:?}", plant.derivation.conditions);
}

/// `sqrt(x)^2` is x only where it exists: a point with a negative x must not count against the claim.
#[test]
fn points_without_a_value_refute_nothing() {
    let plant = derived("x: [p]\ny: [x]\nu: [u]\nf_x: {p: u + p*(sqrt(x)^2 - abs(x))}\nf_y: {x: p}\nphi: [p]");
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    let conditions: Vec<String> =
        plant.derivation.conditions.iter().map(|(e, r)| format!("{} {r:?}", plant.plant.arena.print(*e))).collect();
    assert_eq!(conditions, ["x NonNegative"]);
}

/// A root in a denominator can vanish: it remains a condition, and with it there is a value wherever it holds.
#[test]
fn a_root_below_a_fraction_bar_is_a_condition() {
    let plant = derived("x: [p]\ny: [r]\nu: [u]\nassume: [r >= 0]\nf_x: {p: u/sqrt(r)}\nf_y: {r: p}\nphi: [p]");
    let conditions: Vec<String> =
        plant.derivation.conditions.iter().map(|(e, r)| format!("{} {r:?}", plant.plant.arena.print(*e))).collect();
    assert_eq!(conditions, ["r Positive"]);
    let free = derived("x: [p]\ny: [r]\nu: [u]\nf_x: {p: u/sqrt(r)}\nf_y: {r: p/sqrt(r)}\nphi: [p]");
    assert_eq!(free.derivation.outcome, Outcome::Accepted, "nothing is assumed of the radicand");
}

/// Listed conditions of plants whose formulas have no value, or no derivative, somewhere.
const LISTED: &[(&str, &str, Outcome, &[&str])] = &[
    (
        "a root is not differentiated at zero",
        "x: [p]\ny: [q]\nassume: [p >= 0]\nf_x: {p: -sqrt(p)}\nf_y: {q: sqrt(p)}\nphi: [sqrt(p)]",
        Outcome::Accepted,
        &["p > 0"],
    ),
    (
        "nor is one behind a definition",
        "define: {level: sqrt(p), twice: 2*level}\nx: [p]\ny: [q]\nassume: [p >= 0]\nf_x: {p: -sqrt(p)}\n\
         f_y: {q: sqrt(p)}\nphi: [twice]",
        Outcome::Accepted,
        &["p > 0"],
    ),
    (
        "a power above one is",
        "x: [p]\ny: [q]\nu: [v]\nassume: [q >= 0]\nf_x: {p: v - 3/2*sqrt(q)*p}\nf_y: {q: p}\nphi: [p + q^(3/2)]",
        Outcome::Accepted,
        &[],
    ),
    (
        "what a derived left inverse divides by",
        "x: [p]\ny: [q, r]\nu: [v, w]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]",
        Outcome::Accepted,
        &["q != 0"],
    ),
    (
        "and what a given one divides by, each factor once",
        "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v}\nf_y: {q: p*r, r: 0}\nphi: [p]\n\
         phi_left: {p: z1*(q*r - q + 1)/(q*r - q) - z1/(q*r - q)}",
        Outcome::Accepted,
        &["q != 0", "r - 1 != 0"],
    ),
    (
        "values of parameters at which an implicit rate tells nothing",
        "parameters: {a: 1, b: 2}\nx: [p]\ny: [q]\nassume: [p > 0]\nf_x: {p: 0}\nf_y: {q: (p + a)/(1 + b*p)}\nphi: [p]",
        Outcome::Accepted,
        &["a*b - 1 != 0"],
    ),
    (
        "an excluded denominator is not listed",
        "x: [p]\ny: [q, r]\nu: [v, w]\nassume: [q < 0]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]",
        Outcome::Accepted,
        &[],
    ),
    (
        "nor one that is never zero",
        "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v/(1 + r^2) + v/cosh(q)}\nf_y: {q: p/(2 + sin(q)), r: p}\nphi: [p]",
        Outcome::Accepted,
        &[],
    ),
    (
        "a tangent is asked for its cosine",
        "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\nphi_left: {p: z1 + tan(q) - sin(q)/cos(q)}",
        Outcome::Accepted,
        &["cos(q) != 0"],
    ),
    (
        "a normal form does not divide by what the author does not",
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q > 0]\nf_x: {p: v}\nf_y: {q: 0, s: p*q}\nphi: [p*(1 + sqrt(q))]",
        Outcome::Accepted,
        &[],
    ),
    (
        "nor does it in h",
        "x: [p]\ny: [q, w]\nu: [v]\nf_x: {p: v - w*sqrt(1 + w^2)/(1 + sqrt(1 + w^2)) - p}\nf_y: {q: p, w: v}\n\
         phi: [p + q]",
        Outcome::Accepted,
        &[],
    ),
    (
        "the extension may be anywhere, whatever the range of phi",
        "x: [p]\ny: [q]\nu: [v]\nassume: [0.1 < p, p < 3]\nf_x: {p: v/sin(p)}\nf_y: {q: cos(p)}\nphi: [cos(p)]",
        Outcome::Accepted,
        &[],
    ),
];

#[test]
fn conditions_are_those_of_every_formula() {
    for (what, lines, outcome, expected) in LISTED {
        let found = derived(lines);
        assert_eq!(found.derivation.outcome, *outcome, "{what}: {:?}", found.derivation.diagnostics);
        let arena = &found.plant.arena;
        let listed: Vec<String> =
            found.derivation.conditions.iter().map(|(e, r)| format!("{} {}", arena.print(*e), r.sign())).collect();
        assert_eq!(listed, *expected, "{what}");
        if let (Outcome::Accepted, Some(regression)) = (outcome, &found.derivation.regression.result) {
            let rows = regression.phi_1.iter().flatten().chain(&regression.phi_0).copied();
            let rows: Vec<_> = rows.collect();
            for (part, _) in arena.domain_conditions(&rows, Regularity::Defined) {
                let used = arena.symbols_of(&[part]);
                assert!(!used.iter().any(|s| found.plant.is_of_extension(*s)), "{what}: {}", arena.print(part));
            }
        }
    }
}

/// A plant has no equilibrium where a formula of its observer has no value.
#[test]
fn an_operating_point_meets_the_conditions() {
    let found = derived("x: [p]\ny: [q, r]\nu: [v, w]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]");
    let Some(Equilibrium::At(point)) = found.derivation.operating_point(&found.plant) else {
        panic!("no operating point: {:?}", found.derivation.operating_point(&found.plant));
    };
    let arena = &found.plant.arena;
    assert!(!point.values.iter().any(|(s, value)| arena.name(*s) == "q" && arena.is_zero(*value)));
}

/// A parameter that is given as zero is zero: it multiplies to nothing, and nothing is divided by it.
#[test]
fn a_parameter_given_as_zero_is_zero() {
    let plant = |value: &str| {
        format!("parameters: {{a: {value}}}\nx: [p]\ny: [q]\nu: [v]\nf_x: {{p: v}}\nf_y: {{q: a*p}}\nphi: [a*p]")
    };
    assert_eq!(derived(&plant("0")).derivation.left_inverse.verdict, Verdict::Refuted);
    assert_eq!(derived(&plant("2")).derivation.outcome, Outcome::Accepted);
    let free = derived(&plant("null"));
    let arena = &free.plant.arena;
    let listed: Vec<String> = free.derivation.conditions.iter().map(|(e, _)| arena.print(*e)).collect();
    assert_eq!((free.derivation.outcome, listed), (Outcome::Accepted, vec!["a".to_owned()]));
    let divided = "model: m\nparameters: {a: 0}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v/a}\nf_y: {q: p}\nphi: [p]\n";
    let refused = derive(&Source::new("m", divided).expect("a text")).expect_err("a refusal");
    assert_eq!(refused[0].code, Code::DivisionByZero);
}

#[test]
fn a_condition_is_listed_once_in_its_plainest_form() {
    for (rate, expected) in [
        ("a + log(abs(i)) + 1/i", &["i != 0"][..]),
        ("a + 1/abs(i) + 1/i", &["i != 0"]),
        ("a + log(i^2) + log(abs(i))", &["i != 0"]),
        ("a + log(i) + 1/abs(i)", &["i > 0"]),
        ("a + log(i^2*abs(k))", &["i != 0", "k != 0"]),
        // Never zero, or never negative.
        ("a + log(i^2 + 1) + 1/(abs(i) + 2) + sqrt(abs(i*k))", &[]),
        ("a + log(i^2 + k^2)", &["i^2 + k^2 > 0"]),
    ] {
        let found = derived(&format!("x: [a]\ny: [v]\nu: [i, k]\nf_x: {{a: i}}\nf_y: {{v: {rate}}}\nphi: [a]"));
        assert_eq!(found.derivation.outcome, Outcome::Accepted, "{rate}");
        let arena = &found.plant.arena;
        let listed: Vec<String> =
            found.derivation.conditions.iter().map(|(e, r)| format!("{} {}", arena.print(*e), r.sign())).collect();
        assert_eq!(listed, expected, "{rate}");
    }
}
