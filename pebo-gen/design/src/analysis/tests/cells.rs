//! Non-smooth plants: what holds on each cell of the domain, on its walls, and for parameters of other signs.

use super::{codes, conditions, derive};
use crate::analysis::{Outcome, Verdict};
use crate::source::Code;

/// The report on a plant's trajectories.
fn trajectories(lines: &str) -> Vec<String> {
    let (plant, derivation) = derive(lines);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
    let result = derivation.identifiability.result.as_ref().expect("proved");
    result.trajectories.as_ref().expect("over time").lines(&plant)
}

fn lists(lines: &str, expected: &[&str]) {
    let report = trajectories(lines);
    for line in expected {
        assert!(report.iter().any(|other| other == line), "{line}: {report:#?}");
    }
}

#[test]
fn the_order_of_thresholds_is_a_condition_if_parameters_of_another_order_identify_nothing() {
    let threshold = "x: [k]\ny: [r]\nu: [a]\nf_x: {k: 0}\nf_y: {r: \"k*max(sat(a) - b, 0)\"}\nphi: [k]";
    assert_eq!(conditions(&derive(&format!("parameters: {{b: 0.5}}\n{threshold}"))), ["1 - b > 0"]);
    for parameters in ["{b: 2}", "[b]"] {
        let (_, derivation) = derive(&format!("parameters: {parameters}\n{threshold}"));
        assert_ne!(derivation.outcome, Outcome::Accepted, "{parameters}");
    }
    let limited = "parameters: {lo: 1, hi: 2}\nx: [k, d]\ny: [r]\nu: [a]\nf_x: {k: 0, d: 0}\n\
                   f_y: {r: \"k*min(max(a, lo), hi) + d\"}\nphi: [k, d]";
    assert_eq!(conditions(&derive(limited)), ["hi - lo > 0"]);
}

#[test]
fn cells_that_the_sign_of_a_parameter_decides_are_listed_for_each_sign() {
    lists(
        "parameters: [p]\nx: [a, b]\ny: [q]\nu: [v]\nf_x: {a: 0, b: 0}\nf_y: {q: \"a*max(0, v/p) + q*b\"}\nphi: [a, b]",
        &["while `p > 0` and `v < 0`, only `z2` is identified", "while `p < 0` and `v > 0`, only `z2` is identified"],
    );
    // With a threshold of another value there would be another cell: it has no point at this one.
    lists(
        "parameters: {p: 2}\nx: [a]\ny: [q]\nu: [v]\nf_x: {a: 0}\nf_y: {q: \"a*max(0, v - p) + abs(v - 1)\"}\nphi: [a]",
        &["while `p - v > 0`, nothing is identified"],
    );
}

#[test]
fn trajectories_on_walls_between_cells_are_listed() {
    let size = "x: [p, q]\ny: [v]\nu: [i]\nf_x: {p: \"-abs(v)*q\", q: 0}\nf_y: {v: \"p*abs(v) + q + i\"}\nphi: [p, q]";
    lists(size, &["while the plant rests and `v = 0`, only `z2` is identified"]);
    let input = "x: [p, q]\ny: [v, w]\nu: [u]\nf_x: {p: \"-max(u, 0)*p + w*q\", q: 0}\n\
                 f_y: {v: \"u*p + abs(v)*q\", w: u - w}\nphi: [p, q]";
    lists(
        input,
        &["while `v > 0` and `u = 0`, only `z2` is identified", "while `v = 0` and `u = 0`, nothing is identified"],
    );
    // No formula divides by what is zero there.
    let moved = "x: [p, q]\ny: [v, w]\nf_x: {p: 0, q: 0}\nf_y: {v: \"abs(v)*p + max(w, 0)*q\", w: v}\nphi: [p, q]";
    lists(moved, &["while `w < 0` and the plant rests, nothing is identified"]);
}

#[test]
fn many_cells_along_a_signal_that_an_input_sets_identify_together() {
    let dead_zone = "parameters: {d: 1}\nassume: [d > 0]\nx: [a, b]\ny: [q]\nu: [w]\nf_x: {a: 0, b: 0}\n\
                     f_y: {q: \"a*max(0, q - d) + b*min(0, q + d) + w\"}\nphi: [a, b]";
    lists(
        dead_zone,
        &[
            "while `d - q > 0` and `d + q > 0`, nothing is identified",
            "while `d + q < 0`, only `z2` is identified",
            "while `d - q < 0`, only `z1` is identified",
        ],
    );
    // Without an input nothing shows that a trajectory passes the dead zone.
    let free = dead_zone.replace("u: [w]\n", "").replace(" + w", "");
    assert!(codes(&derive(&free).1).contains(&Code::IdentifiabilityUndecided));
    let steps = "x: [k, l, m]\ny: [v]\nu: [a]\nf_x: {k: 0, l: 0, m: 0}\n\
                 f_y: {v: \"k*max(a, 0) + l*max(a - 1, 0) + m*max(a - 2, 0)\"}\nphi: [k, l, m]";
    let report = trajectories(steps);
    assert!(report[0].ends_with("keep the inputs varying"), "{report:#?}");
}

#[test]
fn equilibria_are_listed_too_where_inputs_have_to_vary() {
    let cell = "x: [a, E, r]\ny: [V]\nu: [I]\nf_x: {a: 0, E: 0, r: 0}\nf_y: {V: E - a*V - r*I}\nphi: [a, E, r]";
    lists(
        cell,
        &[
            "while `I` is constant, only `z1`, `z2 - I*z3` are identified",
            "while the plant rests, only `z2 - V*z1 - I*z3` is identified",
        ],
    );
}

#[test]
fn a_transform_is_inverted_on_each_cell() {
    let cases = [
        ("v/(2 + sign(a))", "2*a + abs(a)", "min(z1/3, z1)"),
        ("v/(1 + (sign(a + 1) - sign(a - 1))/2)", "a + sat(a)", "min(max(z1 - 1, z1/2), z1 + 1)"),
        ("v", "a + sign(a)", "z1 - sign(z1)"),
    ];
    for (rate, phi, expected) in cases {
        let lines = format!("x: [a]\ny: [q]\nu: [v]\nf_x: {{a: \"{rate}\"}}\nf_y: {{q: \"{phi}\"}}\nphi: [\"{phi}\"]");
        let (plant, derivation) = derive(&lines);
        assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
        let (_, formula) = derivation.left_inverse.result.as_ref().expect("proved").x[0];
        assert_eq!(plant.arena.print(formula), expected);
    }
    // Two states have the same transform.
    let folded = "x: [a]\ny: [q]\nu: [v]\nf_x: {a: v/(1 - 2*sign(a))}\nf_y: {q: a}\nphi: [\"a - 2*abs(a)\"]";
    assert_ne!(derive(folded).1.left_inverse.verdict, Verdict::Proved);
}

#[test]
fn a_rate_of_an_unknown_inverse_is_not_refuted() {
    let of = |rate: &str| {
        let lines = format!("x: [b]\ny: [q]\nf_x: {{b: 1/(1 + 3*b^2)}}\nf_y: {{q: {rate}}}\nphi: [b + b^3]");
        derive(&lines).1.regression.verdict
    };
    assert_eq!(of("exp(b + b^3)"), Verdict::Undecided);
    assert_eq!(of("1/(b + b^3)"), Verdict::Proved, "linear in phi times the rate");
}

#[test]
fn jumps_are_reported_whatever_the_rates_are() {
    for (rate, phi) in [("v/(2 + sign(q))", "a*(2 + sign(q))"), ("v", "a + atan(1/q)")] {
        let (plant, derivation) =
            derive(&format!("x: [a]\ny: [q]\nu: [v]\nf_x: {{a: \"{rate}\"}}\nf_y: {{q: a}}\nphi: [\"{phi}\"]"));
        let jumps = derivation.jumps(&plant);
        assert_eq!(jumps.iter().map(|jump| plant.arena.print(jump.1)).collect::<Vec<_>>(), ["q"], "{phi}");
    }
}

/// Between two thresholds there is no cell where these are equal.
#[test]
fn thresholds_that_coincide_are_a_condition_if_the_other_cells_identify_less() {
    let static_inputs = |parameters: &str, formula: &str| {
        derive(&format!(
            "parameters: {parameters}\nx: [k, m]\ny: [r]\nu: [a]\nf_x: {{k: 0, m: 0}}\nf_y: {{r: \"{formula}\"}}\n\
             phi: [k, m]"
        ))
    };
    for (parameters, formula, expected) in [
        ("{w: 2, s: 1}", "k*max(a - w, 0) + m*max(a - s, 0)", &["w - s != 0"][..]),
        ("{w: 2}", "k*sat(a) + m*sat(a/w)", &["w - 1 != 0"]),
        // Two thresholds that are numbers, and one that need not differ from either.
        ("{w: 2}", "k*max(a, 0) + m*max(a - 1, 0) + max(a, w)", &[]),
        // Without its wall a cell is empty or the whole domain.
        ("{w: 2, s: 1}", "k*max((w - s)*a - 1, 0) + m", &["w - s != 0"]),
        // Combined by both cells: of their rows, and not of the walls.
        ("{w: 1, s: 2, v: 3}", "(w*k + s*m)*max(a, 0) + (s*k + v*m)*min(a, 0)", &["w*v - s^2 != 0"]),
    ] {
        assert_eq!(conditions(&static_inputs(parameters, formula)), expected, "{formula}");
    }
    for (parameters, formula) in [
        ("{w: 1, s: 1}", "k*max(a - w, 0) + m*max(a - s, 0)"),
        ("{w: 1}", "k*(max(a, w) - max(a, 1)) + m"),
        ("{w: 0.1, s: 0.1}", "k*sat(a/w) + m*sat(a/s)"),
    ] {
        assert_ne!(static_inputs(parameters, formula).1.outcome, Outcome::Accepted, "{formula}");
    }
}

/// A statement on a cell is none on its border, where the plant may rest.
#[test]
fn an_equilibrium_on_the_border_of_a_cell_is_listed() {
    lists(
        "x: [w2, k]\ny: [th, w1]\nu: [T]\nf_x: {w2: \"k*max(th, 0)\", k: 0}\n\
         f_y: {th: w1 - w2, w1: \"T - k*max(th, 0)\"}\nphi: [w2 + w1, k]",
        &["while `th < 0`, only `z1` is identified", "while the plant rests and `th = 0`, only `z1` is identified"],
    );
}
