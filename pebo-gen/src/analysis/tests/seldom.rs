//! What few plants show: each was seen by no test until a small fault was put there (`tests/mutants`).

use super::{codes, conditions, derive};
use crate::analysis::{Derivation, Outcome, Verdict};
use crate::cas::budget::Budget;
use crate::model::Model;
use crate::plant::Plant;
use crate::source::{Code, Source};

#[test]
fn a_sign_that_is_listed_shows_what_does_not_vanish() {
    let found = derive("x: [p]\ny: [r]\nu: [v]\nf_x: {p: v/(r + 1) + log(r)}\nf_y: {r: p}\nphi: [p]");
    assert_eq!((found.1.outcome, conditions(&found)), (Outcome::Accepted, vec!["r > 0".to_owned()]));
}

/// The second vanishes where the first does, which the first, with a denominator of any sign, does not show.
#[test]
fn what_vanishes_together_is_listed_once() {
    let found = derive("x: [p]\ny: [r]\nu: [v]\nf_x: {p: v/(1/r - 1) + 1/(r - 1)}\nf_y: {r: p}\nphi: [p]");
    assert_eq!(
        (found.1.outcome, conditions(&found)),
        (Outcome::Accepted, vec!["1/r - 1 != 0".to_owned(), "r != 0".to_owned()])
    );
}

#[test]
fn what_the_cascade_alone_asks_is_listed() {
    let found =
        derive("x: [a, b]\ny: [q, r]\nu: [v]\nf_x: {a: v, b: a}\nf_y: {q: 0, r: b}\nphi: [a*q, b]\nphi_left: {b: z2}");
    assert_eq!((found.1.outcome, conditions(&found)), (Outcome::Accepted, vec!["q != 0".to_owned()]));
}

/// The rates of q and s together tell of b, but not by any combination.
#[test]
fn what_outputs_may_show_that_no_regression_uses_is_not_refuted() {
    let (_, derivation) = derive(
        "x: [a, b]\ny: [p, q, s]\nu: [u]\nw: [w]\nf_x: {a: u, b: u}\nf_y: {p: a, q: w, s: w^2 + b}\nphi: [a, b]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
}

#[test]
fn theta_may_be_identified_where_its_functions_are_not() {
    let (_, derivation) = derive("x: [a]\ny: [y]\nu: [u]\nf_x: {a: 0}\nf_y: {y: a^2 + u}\nphi: [a]");
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
    let said = derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("theta itself can be identified near almost every value"), "{said}");
}

/// The factor of a^2 is zero, which no rule of algebra shows.
#[test]
fn what_could_not_be_decided_of_theta_is_said() {
    let zero = "((2 + sqrt(5))^(1/3) - (sqrt(5) - 2)^(1/3) - 1)";
    let (_, derivation) =
        derive(&format!("x: [a]\ny: [y]\nu: [u]\nf_x: {{a: 0}}\nf_y: {{y: {zero}*a^2 + u}}\nphi: [a]"));
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
    let said = derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("it could not be decided whether theta itself can be identified"), "{said}");
}

#[test]
fn a_turn_that_moves_a_state_by_a_constant_is_a_warning() {
    let (_, derivation) = derive(
        "parameters: [k]\nassume: [k > 0]\nx: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\n\
         f_y: {a: sin(q/k), b: cos(q/k)}\nphi: [q/k]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, vec![Code::UnknownUpToTurns]));
}

/// The rate of b is zero, which no rule of algebra shows.
#[test]
fn an_identity_that_stays_open_is_not_covered_by_one_that_is_proved() {
    let (_, derivation) = derive(
        "x: [p]\ny: [a, b, c]\nu: [v]\nf_x: {p: v}\n\
         f_y: {a: p, b: (2 + sqrt(5))^(1/3) - (sqrt(5) - 2)^(1/3) - 1, c: 0}\nphi: [p]\nidentities: [b, c]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentityUndecided]));
}

#[test]
fn the_claim_in_which_the_budget_ends_is_the_last_that_is_told_of() {
    let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\n";
    let model = Model::parse(&Source::new("m", text).unwrap()).unwrap();
    let plant = Plant::resolve_within(&model, Budget::unlimited()).unwrap();
    plant.arena.budget().take(u64::MAX);
    let derivation = Derivation::derive(&plant);
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::LimitReached]));
    assert_eq!(derivation.left_inverse.verdict, Verdict::Skipped);
}

#[test]
fn the_way_back_asks_of_estimates_what_no_value_of_theirs_grants() {
    let asked = |phi: &str, left: &str| -> Vec<String> {
        let (plant, derivation) = derive(&format!(
            "x: [p]\ny: [q, r]\nu: [v]\nf_x: {{p: v}}\nf_y: {{q: p, r: v}}\nphi: [{phi}]\nphi_left: {{p: {left}}}"
        ));
        let asked = derivation.asked_of_estimates(&plant);
        asked.iter().map(|(expr, relation)| format!("{} {}", plant.arena.print(*expr), relation.sign())).collect()
    };
    assert_eq!(asked("p", "z1"), Vec::<String>::new());
    assert_eq!(asked("exp(p)", "log(z1)"), ["z1 > 0"]);
}

#[test]
fn known_terms_are_as_the_author_wrote_them() {
    let (plant, derivation) =
        derive("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: exp(q)*(p + q) + (q + 1)^2*(p + 3)}\nphi: [p]");
    let regression = derivation.regression.result.unwrap();
    assert_eq!(plant.arena.print(regression.phi_0[0]), "exp(q)*(q + chi1) + (q + 1)^2*(chi1 + 3)");
}

#[test]
fn an_identity_is_a_regression_where_the_rates_are_none() {
    let lines = "x: [a]\ny: [q, s]\nu: [u]\nf_x: {a: u}\nf_y: {q: tanh(a)}\nphi: [a]";
    assert_eq!(derive(lines).1.outcome, Outcome::Rejected);
    assert_eq!(derive(&format!("{lines}\nidentities: [s - a^2]")).1.outcome, Outcome::Accepted);
}
