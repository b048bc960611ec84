//! The paper's misprints: the printed formula is refused, the right one is derived.
//!
//! The formulas on both sides are those of the paper's Sections 4 and 5.

use pebo_cas::Expr;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_gen::analysis::{Outcome, Verdict};
use pebo_gen::model::formula::{Estimates, SpanMap, parse_formula};
use pebo_gen::plant::{Scope, lower};
use pebo_gen::source::{Code, Source};
use pebo_gen::{Derived, derive};

const CASE_1: &str = include_str!("../../models/cuk.yaml");
const CASE_2: &str = include_str!("../../models/cuk_case2.yaml");
const PMSM: &str = include_str!("../models/pmsm.yaml");

fn derived(text: &str) -> Derived {
    derive(&Source::new("model", text).expect("a text")).expect("a model")
}

/// A formula over the names of a derivation: states, outputs, inputs, parameters, chi and theta.
fn expr(derived: &Derived, text: &str) -> Expr {
    let arena = &derived.plant.arena;
    let formula = parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused).expect(text);
    let mut scope = Scope::new();
    let own: Vec<_> = derived.plant.chi.iter().chain(&derived.plant.theta).collect();
    for (name, _) in formula.names() {
        let symbol = own.iter().find(|symbol| arena.name(***symbol) == name);
        scope.define(name, arena.of_symbol(symbol.map_or_else(|| arena.symbol(name), |symbol| **symbol)));
    }
    lower(arena, &scope, &formula).expect(text)
}

fn difference(derived: &Derived, result: Expr, text: &str) -> Answer {
    let arena = &derived.plant.arena;
    decide(arena, arena.sub(result, expr(derived, text)), &derived.plant.domain())
}

/// The derived result equals the corrected formula and differs from the printed one.
fn corrects(derived: &Derived, result: Expr, printed: &str, correct: &str) {
    let right = difference(derived, result, correct);
    assert!(right.is_zero(), "derived {}, not {correct}: {right:?}", derived.plant.arena.print(result));
    let wrong = difference(derived, result, printed);
    assert!(matches!(wrong, Answer::NonZero(_)), "{printed}: {wrong:?}");
}

#[test]
fn cuk_case_1_is_as_printed() {
    let cuk = derived(CASE_1);
    let regression = cuk.derivation.regression.result.as_ref().expect("a regression");
    let printed = ["((1 - d)*chi1 + d*chi2)/C2", "chi2/C4 - G/C4*v4"];
    for (row, printed) in regression.phi_0.iter().zip(printed) {
        assert!(difference(&cuk, *row, printed).is_zero());
    }
    let printed = [["(1 - d)/C2", "d/C2"], ["0", "1/C4"]];
    for (row, printed) in regression.phi_1.iter().flatten().zip(printed.iter().flatten()) {
        assert!(difference(&cuk, *row, printed).is_zero());
    }
}

/// The set U of case I: entries of `Phi_1' Phi_1`, each times C2^2.
#[test]
fn cuk_case_1_excitation() {
    let cuk = derived(CASE_1);
    let arena = &cuk.plant.arena;
    let phi_1 = &cuk.derivation.regression.result.as_ref().expect("a regression").phi_1;
    let gram = |i: usize, j: usize| {
        let product = arena.sum(phi_1.iter().map(|row| arena.mul(row[i], row[j])));
        arena.mul(product, expr(&cuk, "C2^2"))
    };
    corrects(&cuk, gram(0, 0), "1 - d", "(1 - d)^2");
    assert!(difference(&cuk, gram(0, 1), "d*(1 - d)").is_zero());
    assert!(difference(&cuk, gram(1, 1), "d^2 + C2^2/C4^2").is_zero());
}

#[test]
fn cuk_case_2_phi_0() {
    let cuk = derived(CASE_2);
    let regression = cuk.derivation.regression.result.as_ref().expect("a regression");
    corrects(&cuk, regression.phi_0[1], "-d*v2/L3 - chi2/L3 - G*L3/C4*i3", "-d*v2/L3 - chi2/L3 - G/C4*i3");
}

#[test]
fn cuk_case_2_needs_its_transform() {
    let text = CASE_2.lines().map(|line| if line.starts_with("phi:") { "phi: [i1, v4]\nclass: pebo" } else { line });
    let cuk = derived(&text.collect::<Vec<_>>().join("\n"));
    assert_eq!(cuk.derivation.outcome, Outcome::Rejected);
    let cascade = cuk.derivation.cascade.result.as_ref().expect("a residual");
    assert!(difference(&cuk, cascade.residual[1], "-(G/C4)*v4").is_zero());
    let refusal = cuk.derivation.diagnostics.iter().find(|d| d.code == Code::CascadeRefuted).expect("a refusal");
    assert!(refusal.notes.iter().any(|note| note.contains("-G*v4/C4")), "{:?}", refusal.notes);
    assert_eq!(refusal.help.as_deref(), Some("use `v4 - L3*G*i3/C4` for this component"));
}

#[test]
fn cuk_case_2_theta() {
    let cuk = derived(CASE_2);
    // theta = z - chi with z = phi, the third term being right as printed.
    assert!(difference(&cuk, cuk.plant.phi[1].expr, "v4 - G*L3/C4*i3").is_zero());
}

#[test]
fn pmsm_regression() {
    let motor = derived(PMSM);
    let regression = motor.derivation.regression.result.as_ref().expect("a regression");
    corrects(
        &motor,
        regression.phi_0[0],
        "-R/L*i1 - n_p*w*i2 + n_p*w*chi2 + v1",
        "-R/L*i1 - n_p*w*i2 + n_p*w/L*chi2 + v1/L",
    );
    corrects(
        &motor,
        regression.phi_0[1],
        "n_p*w*i1 - R/L*i2 + n_p*w*chi1 + v2",
        "n_p*w*i1 - R/L*i2 - n_p*w/L*chi1 + v2/L",
    );
    corrects(&motor, regression.phi_1[0][1], "n_p*w*chi2", "n_p*w/L");
    corrects(&motor, regression.phi_1[1][0], "n_p*w*chi1", "-n_p*w/L");
    assert!(motor.plant.arena.is_zero(regression.phi_1[0][0]));
}

#[test]
fn pmsm_position_is_an_angle() {
    assert_eq!(derived(PMSM).derivation.left_inverse.verdict, Verdict::Proved);
    // The printed left inverse loses the quadrant.
    let printed = format!("{PMSM}\nphi_left: {{q: atan((z2 - L*i2)/(z1 - L*i1))/n_p}}\n");
    let motor = derived(&printed);
    assert_eq!(motor.derivation.left_inverse.verdict, Verdict::Refuted);
    assert!(motor.derivation.diagnostics.iter().any(|d| d.code == Code::LeftInverseRefuted));
    // Without the period, also atan2 is only right on one turn.
    let plain = PMSM.lines().filter(|line| !line.starts_with("angles:")).collect::<Vec<_>>().join("\n");
    let plain = format!("{plain}\nphi_left: {{q: 'atan2(z2 - L*i2, z1 - L*i1)/n_p'}}\n");
    assert_eq!(derived(&plain).derivation.left_inverse.verdict, Verdict::Refuted);
}

/// Section 4: `T1 = -T2 A21 A11^-1` solves the cascade, here for a 2 + 1 system given as formulas.
#[test]
fn linear_plants_follow_the_equation_of_section_4() {
    let text = "model: linear\nx: [x1]\ny: [y1]\nu: [u1]\nparameters: {a: 2, b: 3, c: 5, d: 7}\n\
                f_x: {x1: a*x1 + b*y1 + u1}\nf_y: {y1: c*x1 + d*y1}\nphi: [x1 - a/c*y1]\n";
    let plant = derived(text);
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    let h = plant.derivation.cascade.result.as_ref().expect("h").h[0];
    assert!(difference(&plant, h, "(b - a*d/c)*y1 + u1").is_zero());
}
