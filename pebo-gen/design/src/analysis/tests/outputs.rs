//! The outputs of a regression: each that says something has an equation, and one that has none is named.

use super::derive;
use crate::analysis::{Excitation, Outcome, RegressionKind, UnusedReason};

/// The kind of an accepted plant's regression, the names of the outputs of its rows, and the outputs without a row.
fn regressed(lines: &str) -> (RegressionKind, Vec<String>, Vec<(String, UnusedReason)>) {
    let (plant, derivation) = derive(lines);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}: {:?}", derivation.diagnostics);
    let regression = derivation.regression.result.expect("proved");
    let name = |output: usize| plant.arena.name(plant.y[output].symbol);
    let rows = regression.sources.iter().map(|outputs| outputs.iter().map(|o| name(*o)).collect::<Vec<_>>().join("+"));
    let unused = regression.unused.iter().map(|unused| (name(unused.output), unused.reason));
    (regression.kind, rows.collect(), unused.collect())
}

#[test]
fn a_value_stands_beside_the_rates_of_other_outputs() {
    let plant = "x: [a]\ny: [r, s]\nu: [v, k]\nf_x: {a: 0}\nf_y: {r: k*a - r}\ng_y: {s: 3*a + v}\nphi: [a]";
    assert_eq!(regressed(plant), (RegressionKind::Implicit, vec!["r".into(), "s".into()], Vec::new()));
    // The rate alone loses rank at k = 0.
    let (_, derivation) = derive(plant);
    let identified = derivation.identifiability.result.unwrap();
    assert!(
        identified.kind == Excitation::Instant && identified.singular_where.is_empty() && identified.everywhere_else
    );
}

#[test]
fn a_value_that_is_linear_times_an_unknown_stands_for_its_rate() {
    let plant = "parameters: [p]\nx: [a]\ny: [q]\nu: [v]\nf_x: {a: \"-a^2*max(0, v + p)\"}\ng_y: {q: a}\nphi: [1/a]\n\
                 assume: [a > 0]";
    assert_eq!(regressed(plant), (RegressionKind::Static, vec!["q".into()], Vec::new()));
    let (_, derivation) = derive(plant);
    assert_eq!(derivation.identifiability.result.unwrap().kind, Excitation::Instant);
}

#[test]
fn an_output_without_a_row_is_named_with_the_reason() {
    let unused = |outputs: &str| {
        let lines = format!("x: [a]\ny: [r, s]\nu: [v]\nw: [d]\nf_x: {{a: 0}}\n{outputs}\nphi: [a]");
        let (_, rows, unused) = regressed(&lines);
        assert_eq!(rows, ["r"], "{outputs}");
        unused
    };
    let curved = unused("f_y: {r: v*a - r}\ng_y: {s: sin(a*v)}");
    assert_eq!(curved, [("s".into(), UnusedReason::Nonlinear)]);
    assert_eq!(unused("f_y: {r: v*a - r, s: a*d}"), [("s".into(), UnusedReason::Hidden)]);
    // A known rate says nothing of the unknowns; neither does an output that only drives the plant.
    assert_eq!(unused("f_y: {r: v*a - r*s}"), []);
}

#[test]
fn a_reciprocal_among_the_components_multiplies_a_rate() {
    let plant = "parameters: [p]\nx: [a, b]\ny: [q]\nu: [v]\n\
                 f_x: {a: -a^2*(v - p), b: (1/a + v*q)/(3 + sign(b - p))}\n\
                 f_y: {q: a*(v - (2 + sat(v))*(3*b + abs(b - p)))}\nphi: [1/a, 3*b + abs(b - p)]";
    assert_eq!(regressed(plant), (RegressionKind::Implicit, vec!["q".into()], Vec::new()));
}

#[test]
fn a_value_that_identifies_over_time_needs_no_rate_of_its_own() {
    // The rate of y1 is x1: it would say nothing of what moves x1, and count the noise of y1 twice.
    let plant = "x: [x1, x2]\ny: [y1, y2]\nf_x: {x1: 0, x2: x1}\nf_y: {y2: x1 + x2}\ng_y: {y1: x1 + x2}\nphi: [x1, x2]";
    assert_eq!(regressed(plant).1, ["y2", "y1"]);
}

#[test]
fn values_that_are_linear_in_theta_are_so_in_any_order() {
    let plant = "x: [x1, x2]\ny: [y1, y2]\nf_x: {x1: x2, x2: 0}\ng_y: {y1: x2, y2: x1}\nphi: [x1, x2]";
    let (plant, derivation) = derive(plant);
    assert!(derivation.regression.result.expect("proved").is_linear(&plant));
}

/// Outputs that are angles, of which nobody knows the turn, and the verdict.
#[test]
fn the_turn_of_an_output_changes_states_by_periods_alone() {
    let heading = "x: [psi, o]\ny: [s]\nu: [r]\nf_x: {psi: r - o, o: 0}\ng_y: {s: psi}\nphi: [psi, o]";
    let torsion = |force: &str| {
        format!("x: [v]\ny: [q]\nu: [w]\nangles: {{q: 2*pi}}\nf_x: {{v: w - {force}}}\nf_y: {{q: v}}\nphi: [v]")
    };
    let arm = |value: &str| {
        format!("x: [a]\ny: [s]\nu: [w]\nangles: {{s: 2*pi, a: 2*pi}}\nf_x: {{a: w}}\ng_y: {{s: {value}}}\nphi: [a]")
    };
    let friction =
        "x: [v, b]\ny: [q]\nu: [w]\nangles: {q: 2*pi}\nf_x: {v: w - b*v, b: 0}\nf_y: {q: v}\nphi: [v + b*q, b]";
    let radar = "x: [p, q, v, w]\ny: [r, b]\nassume: [p > 0]\nangles: {b: 2*pi}\nf_x: {p: v, q: w, v: 0, w: 0}\n\
                 g_y: {r: sqrt(p^2 + q^2), b: \"atan2(q, p)\"}\nphi: [v, w]";
    let cases = [
        // The value of a bearing has no turns, and the observer takes its sine and cosine alone.
        (format!("{radar}\nphi_left: {{p: r*cos(b), q: r*sin(b), v: z1, w: z2}}"), Outcome::Accepted),
        (format!("{heading}\nangles: {{s: 2*pi, psi: 2*pi}}"), Outcome::Accepted),
        (format!("{heading}\nangles: {{psi: 2*pi}}"), Outcome::Accepted),
        // The state is no angle, or the force is another one after a turn.
        (format!("{heading}\nangles: {{s: 2*pi}}"), Outcome::Undecided),
        (torsion("4*q"), Outcome::Undecided),
        (torsion("4*sin(q/2)"), Outcome::Undecided),
        (torsion("4*sin(q)"), Outcome::Accepted),
        // A turn of the output is half a one of the state.
        (arm("2*a"), Outcome::Undecided),
        (arm("a"), Outcome::Accepted),
        (arm("-a"), Outcome::Accepted),
        // The step of the coordinate depends on the friction.
        (friction.to_owned(), Outcome::Accepted),
        // A trajectory a turn back leaves the domain.
        (format!("{friction}\nassume: [q > -4]"), Outcome::Undecided),
    ];
    for (lines, expected) in cases {
        let (_, derivation) = derive(&lines);
        assert_eq!(derivation.outcome, expected, "{lines}");
    }
}

#[test]
fn values_that_are_not_linear_stand_in_combinations_that_are() {
    let ranges = "x: [p, q]\ny: [r, s, t]\nu: [v, w]\nf_x: {p: v, q: w}\nphi: [p, q]\n\
                  g_y: {r: p^2 + q^2, s: (p - 1)^2 + q^2, t: p^2 + (q - 1)^2}";
    assert_eq!(regressed(ranges), (RegressionKind::Implicit, vec!["r".into(), "r+s".into(), "r+t".into()], Vec::new()));
    let (_, derivation) = derive(ranges);
    let identified = derivation.identifiability.result.unwrap();
    assert!(identified.kind == Excitation::Instant && identified.singular_where.is_empty());
}

/// The state is a quotient of components, and the value of the output is affine in them.
#[test]
fn a_value_is_affine_without_the_division_of_a_left_inverse() {
    let tyre = "parameters: {V: 20}\nx: [v, c]\nassume: [c > 0]\ny: [a, r]\nu: [d]\n\
                f_x: {v: c*(d - v) - V*r, c: 0}\nf_y: {r: c*d - r}\ng_y: {a: c*(d - v)}\nphi: [c, c*v]";
    let (_, derivation) = derive(tyre);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{:?}", derivation.diagnostics);
}

#[test]
fn a_distance_is_linear_by_the_bearing_that_goes_with_it() {
    let radar = "parameters: {lx: 3}\nx: [p, q, v, w]\ny: [r, b]\nassume: [p > lx]\nf_x: {p: v, q: w, v: 0, w: 0}\n\
                 g_y: {r: sqrt((lx - p)^2 + q^2), b: \"atan2(q, p - lx)\"}\nphi: [p, q, v, w]";
    let (_, derivation) = derive(radar);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{:?}", derivation.diagnostics);
    assert!(derivation.regression.result.is_some_and(|regression| regression.unused.is_empty()));
}

#[test]
fn functions_whose_values_outputs_give_are_known_in_rates() {
    let resolver = "x: [q, v, l]\ny: [c, s]\nu: [w]\nangles: {q: 2*pi}\nf_x: {q: v, v: w - l, l: 0}\n\
                    g_y: {c: cos(q), s: sin(q)}\nphi: [v, l, cos(q), sin(q)]";
    let (_, derivation) = derive(resolver);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{:?}", derivation.diagnostics);
    // In a denominator too.
    let crank = "x: [q, v]\ny: [c]\nu: [w]\nangles: {q: 2*pi}\nassume: [cos(q) > 0]\nf_x: {q: w, v: v/cos(q)}\n\
                 g_y: {c: cos(q)}\nphi: [v]";
    let (plant, derivation) = derive(crank);
    let lambda = derivation.cascade.result.and_then(|cascade| cascade.lambda).expect("generalised");
    assert_eq!(plant.arena.print(lambda[0][0]), "1/c");
    // The value times a parameter, with an offset.
    let diode = "parameters: {k: 2}\nx: [a, b]\ny: [i]\nu: [w]\nf_x: {a: b, b: w}\ng_y: {i: k*(exp(a) - 1)}\n\
                 phi: [b, exp(a)]";
    let (plant, derivation) = derive(diode);
    let cascade = derivation.cascade.result.expect("proved");
    let lambda = cascade.lambda.expect("generalised");
    assert_eq!(plant.arena.print(lambda[1][0]), "(k + i)/k");
}

#[test]
fn a_turn_that_the_assumptions_decide_is_named_with_the_period_to_declare() {
    let plant = |lines: &str| {
        format!("x: [b]\ny: [s, c]\nu: [w]\n{lines}\nf_x: {{b: w}}\nf_y: {{s: sin(b), c: cos(b)}}\nphi: [b]")
    };
    let (_, derivation) = derive(&plant("assume: [-1 < b < 1]"));
    let help = derivation.diagnostics[0].help.as_ref().expect("what to declare");
    assert!(derivation.outcome == Outcome::Undecided && help.contains("`angles: {b: 2*pi}`"), "{help}");
    let (_, declared) = derive(&plant("assume: [-1 < b < 1]\nangles: {b: 2*pi}"));
    assert_eq!(declared.outcome, Outcome::Accepted);
}

#[test]
fn an_identity_that_says_what_a_value_says_is_counted_once() {
    let plant = "x: [px, py, vx, vy]\ny: [r, be]\nassume: [px > 0]\nf_x: {px: vx, py: vy, vx: 0, vy: 0}\n\
                 phi: [px, py, vx, vy]\nidentities: [r - px*cos(be) - py*sin(be)]\n\
                 g_y: {r: sqrt(px^2 + py^2), be: \"atan2(py, px)\"}";
    let (_, derivation) = derive(plant);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{:?}", derivation.diagnostics);
    // The distance and the bearing, and no third.
    assert_eq!(derivation.regression.result.unwrap().sources.len(), 2);
}
