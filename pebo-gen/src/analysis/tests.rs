//! Verdicts that were wrong once, each on the smallest plant that showed it.

use crate::analysis::Derivation;
use crate::analysis::Excitation;
use crate::analysis::Outcome;
use crate::analysis::Verdict;
use crate::cas::Expr;
use crate::model::Model;
use crate::plant::Plant;
use crate::source::{Code, Source};

fn derive(lines: &str) -> (Plant, Derivation) {
    let text = format!("model: m\n{lines}\n");
    let model = Model::parse(&Source::new("m", text.as_str()).unwrap()).unwrap();
    let plant = Plant::resolve(&model).unwrap();
    let derivation = Derivation::derive(&plant);
    (plant, derivation)
}

fn codes(derivation: &Derivation) -> Vec<Code> {
    derivation.diagnostics.iter().map(|diagnostic| diagnostic.code).collect()
}

#[test]
fn an_angle_that_is_seen_up_to_half_its_period_is_not_determined() {
    let lines = "x: [q]\ny: [a]\nu: [w]\nf_x: {q: w}\nf_y: {a: sin(2*q)}\nphi: [2*q]";
    let (_, half) = derive(&format!("{lines}\nangles: {{q: 2*pi}}"));
    assert_eq!((half.outcome, codes(&half)), (Outcome::Rejected, vec![Code::UnknownUpToTurns]));
    let (_, whole) = derive(&format!("{lines}\nangles: {{q: pi}}"));
    assert_eq!(whole.outcome, Outcome::Accepted);
}

#[test]
fn a_state_that_a_turn_of_another_moves_is_not_determined() {
    let (_, derivation) = derive(
        "x: [q, p]\ny: [a, b]\nu: [w, v]\nf_x: {q: w, p: 2*q*w + v}\nf_y: {a: sin(q), b: p - q^2}\n\
         phi: [q, p - q^2]\nangles: {q: 2*pi}",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Rejected, vec![Code::UnknownUpToTurns]));
}

#[test]
fn functions_of_theta_with_proportional_factors_are_one_unknown() {
    let (plant, derivation) = derive("x: [a, b]\ny: [y]\nu: [u, v]\nf_x: {a: u, b: v}\nf_y: {y: a + b^2}\nphi: [a, b]");
    assert_eq!(derivation.outcome, Outcome::Accepted);
    let regression = derivation.regression.result.as_ref().unwrap();
    let print = |exprs: &[Expr]| -> Vec<String> { exprs.iter().map(|e| plant.arena.print(*e)).collect() };
    assert_eq!(print(&regression.eta), ["theta1 + theta2^2", "theta2"]);
    // In eta alone: emitted code has no theta to read.
    assert_eq!(print(&regression.theta), ["eta1 - eta2^2", "eta2"]);
}

#[test]
fn a_rate_that_an_unmeasured_signal_moves_is_not_used() {
    let lines = "x: [a]\ny: [y, s]\nu: [u]\nw: [w]\nf_x: {a: u + w}\nphi: [a - s]";
    let (_, other) = derive(&format!("{lines}\nf_y: {{y: a + s, s: w}}"));
    assert_eq!(other.outcome, Outcome::Accepted);
    assert_eq!(other.regression.result.unwrap().rows, [0]);
    let (_, none) =
        derive("x: [a]\ny: [y, s]\nu: [u]\nw: [w, v]\nf_x: {a: u + w}\nphi: [a - s]\nf_y: {y: a + v, s: w}");
    assert_eq!((none.outcome, none.regression.verdict), (Outcome::Rejected, Verdict::Refuted));
    assert!(none.diagnostics[0].message.contains("unmeasured signal v"), "{}", none.diagnostics[0].message);
}

#[test]
fn a_generalised_cascade_with_a_nonlinear_output_is_not_refuted() {
    let (_, derivation) =
        derive("x: [a, b]\ny: [y]\nu: [w, u]\nf_x: {a: w*b + u, b: -w*a}\nf_y: {y: a^2}\nphi: [a, b]");
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::RegressionUndecided]));
}

#[test]
fn the_energy_of_a_generalised_cascade_may_hold_parameters_without_values() {
    let (_, derivation) = derive(
        "x: [i, v]\ny: [s]\nu: [d, e]\nparameters: [L, C]\nassume: [L > 0, C > 0]\n\
         f_x: {i: (e - (1 - d)*v)/L, v: (1 - d)*i/C}\nf_y: {s: i}\nphi: [i, v]",
    );
    assert_eq!(derivation.outcome, Outcome::Accepted);
}

#[test]
fn the_fundamental_matrix_is_never_singular() {
    let (_, derivation) =
        derive("x: [c, s]\ny: [p, q]\nu: [v, w]\nf_x: {c: -w*s, s: w*c}\nf_y: {p: v*c, q: v*s}\nphi: [c, s]");
    assert_eq!(derivation.identifiability.result.unwrap().singular_where, ["v = 0"]);
}

#[test]
fn values_of_parameters_that_hide_an_unknown_are_refuted() {
    let (_, zero) = derive("x: [a]\ny: [y]\nu: [u]\nparameters: {k: 0}\nf_x: {a: u}\nf_y: {y: k*a}\nphi: [a]");
    let (_, equal) = derive(
        "x: [a, b]\ny: [y, s]\nu: [u]\nparameters: {k: 2, l: 2}\nf_x: {a: u, b: u}\n\
         f_y: {y: a + k*b, s: a + l*b}\nphi: [a, b]",
    );
    for derivation in [zero, equal] {
        assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Rejected, vec![Code::NeverIdentifiable]));
        assert_eq!(derivation.identifiability.result.unwrap().kind, Excitation::Never);
    }
}

fn conditions((plant, derivation): &(Plant, Derivation)) -> Vec<String> {
    let shown = derivation.conditions.iter();
    shown.map(|(expr, relation)| format!("{} {}", plant.arena.print(*expr), relation.sign())).collect()
}

#[test]
fn what_the_regression_alone_asks_is_listed() {
    // The rate of r is z1/q; the one state that is recovered needs no division.
    let lines = "x: [p, s]\ny: [q, r, v]\nu: [w]\nf_x: {p: w - p*w, s: w}\nf_y: {q: q*w, r: p, v: s}\nphi: [p*q, s]";
    let partial = derive(&format!("{lines}\nphi_left: {{s: z2}}"));
    assert_eq!((partial.1.outcome, conditions(&partial)), (Outcome::Accepted, vec!["q != 0".to_owned()]));
    let excluded = derive(&format!("{lines}\nphi_left: {{s: z2}}\nassume: [q > 0]"));
    assert_eq!((excluded.1.outcome, conditions(&excluded)), (Outcome::Accepted, Vec::new()));
}

#[test]
fn claims_about_no_point_that_was_found_stay_open() {
    let lines = "x: [p]\ny: [q]\nu: [w]\nf_x: {p: w}\nf_y: {q: p}\nphi: [p]";
    let (_, anywhere) = derive(&format!("{lines}\nassume: [sin(q) + cos(3*q) > 1]"));
    assert_eq!(anywhere.outcome, Outcome::Accepted);
    // There are such q, in intervals so short that none is drawn.
    let (_, nowhere) = derive(&format!("{lines}\nassume: [sin(q) + cos(41*q) > 1.9999999]"));
    assert_eq!((nowhere.outcome, codes(&nowhere)), (Outcome::Undecided, vec![Code::ContradictoryAssumptions]));
}

#[test]
fn parameters_are_asked_for_the_strongest_that_is_assumed_of_them() {
    let lines = "x: [p]\ny: [q]\nu: [w]\nf_x: {p: (a + b + c + d + e)*w}\nf_y: {q: p}\nphi: [p]\n\
                 parameters: {a: null, b: null, c: null, d: -3, e: 0}";
    let asked = |assume: &str| -> Vec<String> {
        let (plant, derivation) = derive(&format!("{lines}\nassume: [{assume}]"));
        let shown = derivation.asked_of_parameters(&plant);
        shown.iter().map(|(expr, sign)| format!("{} {sign:?}", plant.arena.print(*expr))).collect()
    };
    let given = ["d Opposite(Positive)", "e Zero"];
    assert_eq!(asked("q > 0"), ["a Any", "b Any", "c Any", given[0], given[1]]);
    assert_eq!(
        asked("a >= 0, a > 0, b != 0, c <= 0"),
        ["a Is(Positive)", "b Is(NonZero)", "c Opposite(NonNegative)", given[0], given[1]]
    );
    assert_eq!(
        asked("a > 0, c > 0, a - d > 0, a > c, q > a"),
        ["a Is(Positive)", "b Any", "c Is(Positive)", given[0], given[1], "a - c Is(Positive)"],
        "what follows from the signs is not asked again, and nothing of signals"
    );
}

/// Where the normal form would overflow, lose its digits or divide by zero, and the author's own formula does not.
#[test]
fn results_are_in_the_functions_and_divisors_that_the_author_wrote() {
    let shown = |lines: &str| -> (Vec<String>, Vec<String>) {
        let (plant, derivation) = derive(lines);
        assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
        let print = |e: &Expr| plant.arena.print(*e);
        let h = derivation.cascade.result.unwrap().h.iter().map(print).collect();
        (h, derivation.left_inverse.result.unwrap().x.iter().map(|(_, formula)| print(formula)).collect())
    };
    let (h, _) = shown(
        "parameters: {J: 2, k: 1, F: 1}\nx: [p]\ny: [q, w]\nu: [v]\nf_x: {p: (v - F*tanh(100*w) - k*p)/J}\n\
         f_y: {q: p, w: v}\nphi: [J*p + k*q]",
    );
    assert_eq!(h, ["v - F*tanh(100*w)"], "no quotient of exponentials, which overflow");
    let (h, _) = shown(
        "parameters: {J: 2, k: 1, T: 1}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: (v - T*sin(24*q) - k*p)/J}\nf_y: {q: p}\n\
         phi: [J*p + k*q]",
    );
    assert_eq!(h, ["v - T*sin(24*q)"], "no polynomial of degree 24");
    let (_, left) = shown(
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q >= 0]\nf_x: {p: v}\nf_y: {q: 0, s: p + p*sqrt(q)}\nphi: [p*(1 + sqrt(q))]",
    );
    assert_eq!(left, ["z1/(sqrt(q) + 1)"], "regular at q = 1");
    // A two-link arm with its mass at the tip: z are the tip's velocities, the momenta J' z.
    let (h, left) = shown(
        "parameters: {m: 0.8, a: 0.5, b: 0.35}\nx: [x1, x2]\ny: [p, q]\nu: [u, v]\n\
         assume: [m > 0, a > 0, b > 0, sin(q) > 0]\n\
         mechanical:\n  M: [[m*(a^2 + b^2 + 2*a*b*cos(q)), m*(b^2 + a*b*cos(q))], [m*(b^2 + a*b*cos(q)), m*b^2]]\n  \
         V: 0\n  G: [[1, 0], [0, 1]]\n  T: [[cos(p + q)/(a*sin(q)), sin(p + q)/(a*sin(q))], \
         [-(a*cos(p) + b*cos(p + q))/(a*b*sin(q)), -(a*sin(p) + b*sin(p + q))/(a*b*sin(q))]]",
    );
    assert_eq!(
        left,
        ["a*(z2*cos(p) - z1*sin(p)) + b*(z2*cos(p + q) - z1*sin(p + q))", "b*(z2*cos(p + q) - z1*sin(p + q))"]
    );
    assert!(h.iter().all(|h| !h.contains("cos(q)") && h.contains("/(a*sin(q))")), "1 - cos(q)^2 loses digits: {h:?}");
}
