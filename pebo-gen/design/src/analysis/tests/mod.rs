//! Verdicts that were wrong once, each on the smallest plant that showed it.

mod cells;
mod known;
mod local;
mod monotone;
mod outputs;
mod seldom;
mod start;

use super::{Derivation, Excitation, Outcome, Verdict};
use crate::model::Model;
use crate::plant::Plant;
use crate::source::{Code, Source};
use pebo_cas::Expr;

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
fn an_angle_identified_up_to_half_its_period_is_not_determined() {
    let lines = "x: [q]\ny: [a]\nu: [w]\nf_x: {q: w}\nf_y: {a: sin(2*q)}\nphi: [2*q]";
    let (_, half) = derive(&format!("{lines}\nangles: {{q: 2*pi}}"));
    assert_eq!((half.outcome, codes(&half)), (Outcome::Rejected, vec![Code::UnknownUpToTurns]));
    let (_, whole) = derive(&format!("{lines}\nangles: {{q: pi}}"));
    assert_eq!((whole.outcome, codes(&whole)), (Outcome::Accepted, Vec::new()));
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
    assert_eq!(other.regression.result.unwrap().rows(), [0]);
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
fn a_sign_is_kept_where_code_computes_it() {
    // As a quotient of q and its absolute value it would be 0/0 at q = 0, where the author's formula has a value.
    for factor in ["2 + sign(q)*sqrt(abs(q))", "sign(q)*(1 - exp(-abs(q))) + 3", "sign(q)*max(abs(q) - 1, 0) + 1"] {
        let (plant, derivation) =
            derive(&format!("x: [p]\ny: [q]\nu: [v]\nf_x: {{p: v}}\nf_y: {{q: \"p*({factor})\"}}\nphi: [p]"));
        let regression = derivation.regression.result.unwrap();
        for formula in [regression.phi_0[0], regression.phi_1[0][0]] {
            let printed = plant.arena.print(formula);
            assert!(printed.contains("sign(q)") && !printed.contains("/q"), "{printed}");
        }
    }
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
    let printed = derivation.conditions.iter();
    printed.map(|(expr, relation)| format!("{} {}", plant.arena.print(*expr), relation.sign())).collect()
}

#[test]
fn conditions_of_the_regression_alone_are_listed() {
    // The rate of r is z1/q; the one state that is recovered needs no division.
    let lines = "x: [p, s]\ny: [q, r, v]\nu: [w]\nf_x: {p: w - p*w, s: w}\nf_y: {q: q*w, r: p, v: s}\nphi: [p*q, s]";
    let partial = derive(&format!("{lines}\nphi_left: {{s: z2}}"));
    assert_eq!((partial.1.outcome, conditions(&partial)), (Outcome::Accepted, vec!["q != 0".to_owned()]));
    let excluded = derive(&format!("{lines}\nphi_left: {{s: z2}}\nassume: [q > 0]"));
    assert_eq!((excluded.1.outcome, conditions(&excluded)), (Outcome::Accepted, Vec::new()));
}

#[test]
fn claims_without_a_point_of_the_domain_are_undecided() {
    let lines = "x: [p]\ny: [q]\nu: [w]\nf_x: {p: w}\nf_y: {q: p}\nphi: [p]";
    let (_, anywhere) = derive(&format!("{lines}\nassume: [sin(q) + cos(3*q) > 1]"));
    assert_eq!(anywhere.outcome, Outcome::Accepted);
    // There are such q, in intervals so short that none is drawn.
    let (_, nowhere) = derive(&format!("{lines}\nassume: [sin(q) + cos(41*q) > 1.9999999]"));
    assert_eq!((nowhere.outcome, codes(&nowhere)), (Outcome::Undecided, vec![Code::ContradictoryAssumptions]));
}

#[test]
fn parameters_have_the_strongest_of_their_conditions() {
    let lines = "x: [p]\ny: [q]\nu: [w]\nf_x: {p: (a + b + c + d + e)*w}\nf_y: {q: p}\nphi: [p]\n\
                 parameters: {a: null, b: null, c: null, d: -3, e: 0}";
    let conditions = |assume: &str| -> Vec<String> {
        let (plant, derivation) = derive(&format!("{lines}\nassume: [{assume}]"));
        let printed = derivation.conditions_on_parameters(&plant);
        printed.iter().map(|(expr, sign)| format!("{} {sign:?}", plant.arena.print(*expr))).collect()
    };
    let given = ["d Opposite(Positive)", "e Zero"];
    assert_eq!(conditions("q > 0"), ["a Any", "b Any", "c Any", given[0], given[1]]);
    assert_eq!(
        conditions("a >= 0, a > 0, b != 0, c <= 0"),
        ["a Is(Positive)", "b Is(NonZero)", "c Opposite(NonNegative)", given[0], given[1]]
    );
    assert_eq!(
        conditions("a > 0, c > 0, a - d > 0, a > c, q > a"),
        ["a Is(Positive)", "b Any", "c Is(Positive)", given[0], given[1], "a - c Is(Positive)"],
        "what follows from the signs is not asked again, and nothing of signals"
    );
}

/// The normal form would overflow, lose its digits or divide by zero, and the author's own formula does not.
#[test]
fn results_are_in_the_functions_and_divisors_that_the_author_wrote() {
    let printed = |lines: &str| -> (Vec<String>, Vec<String>) {
        let (plant, derivation) = derive(lines);
        assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
        let print = |e: &Expr| plant.arena.print(*e);
        let h = derivation.cascade.result.unwrap().h.iter().map(print).collect();
        (h, derivation.left_inverse.result.unwrap().x.iter().map(|(_, formula)| print(formula)).collect())
    };
    let (h, _) = printed(
        "parameters: {J: 2, k: 1, F: 1}\nx: [p]\ny: [q, w]\nu: [v]\nf_x: {p: (v - F*tanh(100*w) - k*p)/J}\n\
         f_y: {q: p, w: v}\nphi: [J*p + k*q]",
    );
    assert_eq!(h, ["v - F*tanh(100*w)"], "no quotient of exponentials, which overflow");
    let (h, _) = printed(
        "parameters: {J: 2, k: 1, T: 1}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: (v - T*sin(24*q) - k*p)/J}\nf_y: {q: p}\n\
         phi: [J*p + k*q]",
    );
    assert_eq!(h, ["v - T*sin(24*q)"], "no polynomial of degree 24");
    let (_, left) = printed(
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q >= 0]\nf_x: {p: v}\nf_y: {q: 0, s: p + p*sqrt(q)}\nphi: [p*(1 + sqrt(q))]",
    );
    assert_eq!(left, ["z1/(sqrt(q) + 1)"], "regular at q = 1");
    // A two-link arm with its mass at the tip: z are the tip's velocities, the momenta J' z.
    let (h, left) = printed(
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

#[test]
fn a_regression_under_a_generalised_cascade_has_the_extension_for_z() {
    let (plant, derivation) = derive(
        "parameters: [k, m]\nassume: [k > 0, m > 0, k != m]\nx: [a, b]\ny: [s]\nu: [u]\n\
         f_x: {a: u - k*a, b: u - m*b}\nphi: [a, b]\nidentities: [s - a - 2*b]",
    );
    let regression = derivation.regression.result.unwrap();
    let print = |e: &Expr| plant.arena.print(*e);
    assert_eq!(regression.phi_0.iter().map(print).collect::<Vec<_>>(), ["s - xi1 - 2*xi2"]);
    assert_eq!(regression.phi_1.concat().iter().map(print).collect::<Vec<_>>(), ["Psi11 + 2*Psi21", "Psi12 + 2*Psi22"]);
}

/// Only a relation of the components identifies theta, and no input adds to it.
#[test]
fn a_relation_alone_is_a_regression_under_a_generalised_cascade_too() {
    let (_, derivation) = derive("x: [a]\ny: [y]\nu: [u]\nf_x: {a: u - a}\nphi: [a, 2*a]");
    assert_eq!(derivation.regression.verdict, Verdict::Proved);
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Rejected, vec![Code::NeverIdentifiable]));
}

/// The difference of two outputs makes b observable; c alone is hidden.
#[test]
fn a_refusal_counts_observable_combinations_of_outputs() {
    let (_, derivation) = derive(
        "x: [a, b, c]\ny: [p, q, r]\nu: [u]\nw: [w]\nf_x: {a: u, b: u, c: u}\n\
         f_y: {p: a, q: w, r: w + b}\nphi: [a, b, c]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Rejected, vec![Code::NeverIdentifiable]));
    assert!(derivation.diagnostics[0].primary.text.ends_with("moves along (0, 0, 1)"), "{:?}", derivation.diagnostics);
    let (_, derivation) =
        derive("x: [a, b]\ny: [p, q, r]\nu: [u]\nw: [w]\nf_x: {a: u, b: u}\nf_y: {p: a, q: w, r: w + b}\nphi: [a, b]");
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()));
}

#[test]
fn a_zero_of_a_combination_of_outputs_is_listed() {
    let (_, derivation) =
        derive("x: [a]\ny: [q, r]\nu: [u, v]\nw: [w]\nf_x: {a: v}\nf_y: {q: w, r: w + u*a}\nphi: [a]");
    assert_eq!(derivation.outcome, Outcome::Accepted);
    assert_eq!(derivation.identifiability.result.unwrap().singular_where, ["u = 0"]);
}

/// The words of the first refusal.
fn refusal(lines: &str) -> String {
    let (_, derivation) = derive(lines);
    assert_eq!(derivation.outcome, Outcome::Rejected, "{lines}");
    let first = &derivation.diagnostics[0];
    let also: Vec<&str> = first.secondary.iter().map(|label| &*label.text).collect();
    [also.join("\n"), first.notes.join("\n"), first.help.as_deref().unwrap_or_default().to_owned()].join("\n")
}

#[test]
fn a_transform_is_not_mended_into_one_without_states() {
    let words = |phi: &str| {
        refusal(&format!("x: [a]\ny: [y]\nu: [u]\nclass: pebo\nf_x: {{a: u + 3*a}}\nf_y: {{y: a}}\nphi: [{phi}]"))
    };
    assert!(words("a").contains("use `a - 3*y`"), "{}", words("a"));
    assert!(!words("y").contains("use `"), "{}", words("y"));
}

#[test]
fn a_term_is_blamed_with_the_factor_that_phi_gives_it() {
    let words =
        |phi: &str| refusal(&format!("x: [a]\ny: [y]\nu: [u]\nf_x: {{a: u - a^2}}\nf_y: {{y: a}}\nphi: [{phi}]"));
    assert!(words("a").starts_with("it comes from this term of a'\n"), "{}", words("a"));
    assert!(words("2*a").starts_with("it comes from this term of a', times `2` from phi\n"), "{}", words("2*a"));
}

#[test]
fn curvature_is_found_in_z_where_z_moves_freely() {
    let words =
        |phi: &str| refusal(&format!("x: [a]\ny: [y]\nu: [u]\nf_x: {{a: u}}\nf_y: {{y: exp(-a^2)}}\nphi: [{phi}]"));
    assert!(words("a").contains("as a function of z, this rate has a second derivative"), "{}", words("a"));
    assert!(words("a, 2*a").contains("no affine function of phi has the values"), "{}", words("a, 2*a"));
}

#[test]
fn the_remainder_of_a_linear_plant_is_its_unobservable_row() {
    let (plant, derivation) = derive("x: [a, b]\ny: [y]\nclass: pebo\nlti: {A11: [[1, 0], [0, 2]], A21: [[3, 0]]}");
    let residual = derivation.cascade.result.unwrap().residual;
    assert_eq!(residual.iter().map(|e| plant.arena.print(*e)).collect::<Vec<_>>(), ["0", "2*b"]);
}

/// An output that no regression uses does not spoil those that are used.
#[test]
fn a_regression_that_identifies_need_not_use_all_outputs() {
    let (_, derivation) = derive(
        "x: [a, b]\ny: [p, q, r, s]\nu: [u]\nw: [w]\nf_x: {a: u, b: u}\n\
         f_y: {p: a, q: w, r: w + b, s: w^2}\nphi: [a, b]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()));
}

#[test]
fn a_claim_settled_by_an_identity_is_not_refused() {
    let (_, derivation) = derive(
        "x: [a, b]\ny: [c, d]\nu: [u, v]\nf_x: {a: u, b: v}\nf_y: {c: v}\nphi: [a, b]\n\
         identities: [(a - c)^2 + (b - d)^2 - 4]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()));
}

#[test]
fn combinations_of_outputs_under_a_generalised_cascade_see_theta_through_psi() {
    let (plant, derivation) = derive(
        "x: [a, b]\ny: [p, q, r]\nu: [u]\nw: [w]\nf_x: {a: u - a, b: u - 2*b}\n\
         f_y: {p: a, q: w, r: w + 3*b}\nphi: [a, b]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()));
    let rows = derivation.regression.result.unwrap().phi_1;
    let printed: Vec<String> = rows.concat().iter().map(|e| plant.arena.print(*e)).collect();
    assert_eq!(printed, ["Psi11", "Psi12", "-3*Psi21", "-3*Psi22"]);
}

#[test]
fn a_cascade_that_is_refused_says_what_remains_and_that_no_other_would_do() {
    let words = refusal("x: [a]\ny: [y]\nu: [u]\nf_x: {a: u - a^2}\nf_y: {y: a}\nphi: [a]");
    assert!(words.contains("but `-a^2` remains in z1'"), "{words}");
    assert!(words.contains("not of the form Lambda(y, u) phi + h(y, u) either"), "{words}");
}

#[test]
fn a_wrong_left_inverse_is_mended_for_its_own_state() {
    let words = refusal(
        "x: [a, b]\ny: [c, d]\nu: [u]\nf_x: {a: u, b: u}\nf_y: {c: a, d: b}\nphi: [2*a, 3*b]\n\
         phi_left: {a: z1/2, b: z2}",
    );
    assert!(words.contains("use `b: z2/3`"), "{words}");
}

/// Point masses at the joints of a planar arm, relative angles: its inertia matrix.
fn inertia_of_arm(links: usize) -> String {
    let angle = |low: usize, high: usize| (low + 1..=high).map(|k| format!("q{k}")).collect::<Vec<_>>().join(" + ");
    // The masses from a joint on weigh as many as there are.
    let term = |a: usize, b: usize| {
        let (low, high) = (a.min(b), a.max(b));
        let cosine = if low == high { "1".to_owned() } else { format!("cos({})", angle(low, high)) };
        format!("{}*l{a}*l{b}*{cosine}", links + 1 - high)
    };
    let entry = |i: usize, j: usize| {
        let pairs = (i..=links).flat_map(|a| (j..=links).map(move |b| (a, b)));
        pairs.map(|(a, b)| term(a, b)).collect::<Vec<_>>().join(" + ")
    };
    let row = |i: usize| format!("[{}]", (1..=links).map(|j| entry(i, j)).collect::<Vec<_>>().join(", "));
    format!("[{}]", (1..=links).map(row).collect::<Vec<_>>().join(", "))
}

#[test]
fn an_arm_whose_inverse_nobody_reads_is_refuted_at_points() {
    let links = 5;
    let list = |name: &str| format!("[{}]", (1..=links).map(|k| format!("{name}{k}")).collect::<Vec<_>>().join(", "));
    let unit = |i: usize| (1..=links).map(|j| if i == j { "1" } else { "0" }).collect::<Vec<_>>().join(", ");
    let identity = (1..=links).map(|i| format!("[{}]", unit(i))).collect::<Vec<_>>().join(", ");
    let (plant, derivation) = derive(&format!(
        "parameters: {}\nx: {}\ny: {}\nu: {}\nmechanical: {{M: {}, G: [{identity}], T: [{identity}]}}",
        list("l"),
        list("p"),
        list("q"),
        list("t"),
        inertia_of_arm(links)
    ));
    assert_eq!(derivation.cascade.verdict, Verdict::Refuted);
    let cascade = derivation.cascade.result.expect("residuals");
    let printed: Vec<String> = cascade.residual.iter().map(|residual| plant.arena.print(*residual)).collect();
    assert_eq!(printed[0], "0", "the momentum of the base is of use");
    assert!(printed[1..].iter().all(|residual| residual.contains("q1'") && residual.len() < 5000), "{printed:?}");
    let witness = cascade.witness.expect("points");
    assert!(witness.compared.is_some_and(|compared| compared.points.len() == 2));
    assert_eq!(derivation.left_inverse.verdict, Verdict::Proved);
}

/// By exponentials, as the normal form has it, a hyperbolic tangent overflows where it is 1.
#[test]
fn known_functions_beside_functions_of_theta_are_kept_as_written() {
    let (plant, derivation) =
        derive("x: [a]\ny: [y]\nu: [u]\nf_x: {a: u}\nf_y: {y: tanh(5*u) + exp(a)*cosh(u)}\nphi: [a]");
    let regression = derivation.regression.result.unwrap();
    let printed = [regression.phi_0[0], regression.phi_1[0][0]].map(|expr| plant.arena.print(expr));
    assert!(printed[0].contains("tanh(5*u)") && !printed[0].contains("exp"), "{printed:?}");
    assert!(printed[1].contains("cosh(u)"), "{printed:?}");
}
