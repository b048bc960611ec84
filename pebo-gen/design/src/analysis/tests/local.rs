//! Regressions to first order, for models that ask for them.

use super::{codes, derive};
use crate::analysis::{Outcome, Regression, Verdict};
use crate::plant::Plant;
use crate::source::Code;
use pebo_cas::Expr;

fn printed(plant: &Plant, exprs: &[Expr]) -> Vec<String> {
    exprs.iter().map(|e| plant.arena.print(*e)).collect()
}

/// Both sides of the local regression of a plant, as printed.
fn sides(lines: &str) -> (Plant, Regression) {
    let (plant, derivation) = derive(&format!("{lines}\nregression: local"));
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()), "{lines}");
    assert!(derivation.can_rebase(&plant), "the extension has to follow the estimate: {lines}");
    let regression = derivation.regression.result.unwrap();
    (plant, regression)
}

/// The extension stands for z on the known side, and the factors are the slopes there.
#[test]
fn sides_are_those_where_the_extension_is() {
    let (plant, plain) =
        sides("x: [n]\ny: [v]\nu: [F]\nassume: [v > 0]\nf_x: {n: 0}\nf_y: {v: F - exp(n*v)}\nphi: [n]");
    assert_eq!(plain.parameterisation(&plant), "local");
    assert_eq!(printed(&plant, &plain.phi_0), ["F - exp(v*chi1)"]);
    assert_eq!(printed(&plant, &plain.phi_1[0]), ["-v*exp(v*chi1)"]);
    // With a fundamental matrix, and beside a rate an output by its value.
    let (plant, mixed) = sides(
        "x: [p, n]\ny: [v, s]\nu: [F]\nf_x: {p: v*n - p, n: 0}\nf_y: {v: F - exp(p)}\ng_y: {s: n^3 + v}\nphi: [p, n]",
    );
    assert_eq!(printed(&plant, &mixed.phi_0), ["F - exp(xi1)", "s - v - xi2^3"]);
    assert_eq!(printed(&plant, &mixed.phi_1[0]), ["-Psi11*exp(xi1)", "-Psi12*exp(xi1)"]);
    assert_eq!((mixed.rows(), mixed.instants(&plant.arena)), (Vec::new(), 1));
}

/// Each piece of a table is a cell, with points between its ends: also a narrow one, and with assumptions.
#[test]
fn straight_pieces_beside_an_unknown_factor_of_an_input_identify_it() {
    let table = "points: [[0, 3.0], [0.1, 3.3], [0.2, 3.5], [1, 4.2]], interpolation: linear";
    let lines = format!(
        "parameters: {{Q: 9000}}\nx: [s, R]\ny: [V]\nu: [I]\nassume: [0 < s < 1]\ndefine: {{ocv: {{table: s, {table}}}}}\n\
         f_x: {{s: -I/Q, R: 0}}\ng_y: {{V: ocv - R*I}}\nphi: [s, R]"
    );
    let (plant, regression) = sides(&lines);
    assert_eq!(printed(&plant, &regression.phi_1[0]), ["ocv_slope(chi1)", "-I"]);
}

/// What is linear is exact, whatever the model asks for.
#[test]
fn linear_equations_are_no_local_ones() {
    let (plant, derivation) =
        derive("x: [a]\ny: [y]\nu: [u]\nf_x: {a: u}\nf_y: {y: (1 + u^2)*a}\nphi: [a]\nregression: local");
    let regression = derivation.regression.result.unwrap();
    assert_eq!((derivation.outcome, regression.parameterisation(&plant)), (Outcome::Accepted, "linear"));
}

/// Without a slope that identifies the unknown there is none, and without being asked for neither.
#[test]
fn what_no_slope_shows_is_not_accepted() {
    let hidden = "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: 0, b: 0}\nf_y: {y: exp((a + b)*u) - u}\nphi: [a, b]";
    let (_, derivation) = derive(&format!("{hidden}\nregression: local"));
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Rejected, vec![Code::NeverIdentifiable]));
    let moved = "x: [a]\ny: [y]\nu: [u]\nw: [w]\nf_x: {a: 0}\nf_y: {y: exp(a*u) + w}\nphi: [a]";
    let (_, derivation) = derive(&format!("{moved}\nregression: local"));
    assert_eq!(derivation.outcome, Outcome::Rejected);
    let (_, derivation) = derive("x: [n]\ny: [v]\nu: [F]\nf_x: {n: 0}\nf_y: {v: F - exp(n*v)}\nphi: [n]");
    assert_ne!(derivation.regression.verdict, Verdict::Proved);
    assert!(codes(&derivation).iter().all(|code| *code != Code::NeverIdentifiable));
}

/// An estimate may lie where the equation has no value: that is said, and is no condition on the plant.
#[test]
fn estimates_without_a_value_are_listed() {
    let (plant, derivation) = derive(
        "x: [m, k]\ny: [s, c]\nassume: [s > 0, c > 0, m > 0, k > 0]\nf_x: {m: 0, k: 0}\nf_y: {s: -m*s*c/(k + s), c: m*s*c/(k + s) - c}\n\
         phi: [m, k]\nregression: local",
    );
    assert_eq!((derivation.outcome, derivation.conditions.len()), (Outcome::Accepted, 0));
    let asked = derivation.conditions_on_estimates(&plant);
    assert_eq!(printed(&plant, &asked.iter().map(|(part, _)| *part).collect::<Vec<_>>()), ["s + z2"]);
    // Both outputs say something: neither is left out.
    assert_eq!(derivation.regression.result.unwrap().rows(), [0, 1]);
}
