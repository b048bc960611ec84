//! The content of refusals: witness, points, mend, and open ends.

use pebo_cas::{Expr, Symbol};
use pebo_gen::analysis::Verdict;

use super::derived;
use super::table::{Answer::Accepted, rows};

#[test]
fn a_refusal_has_its_cause_and_its_mend() {
    for (what, lines, answer) in rows() {
        if matches!(answer, Accepted(_)) {
            continue;
        }
        for diagnostic in &derived(lines).derivation.diagnostics {
            assert!(diagnostic.help.is_some(), "{what}: {}", diagnostic.message);
            assert!(
                !diagnostic.primary.text.is_empty() || !diagnostic.notes.is_empty(),
                "{what}: {}",
                diagnostic.message
            );
        }
    }
}

#[test]
fn a_witness_is_a_point_where_the_residual_is_not_zero() {
    let plant = derived("x: [x]\ny: [y]\nu: [u]\nparameters: {g: 3}\nf_x: {x: u - g*x^2}\nf_y: {y: u}\nphi: [x]");
    let cascade = plant.derivation.cascade.result.as_ref().expect("a residual");
    let witness = cascade.witness.as_ref().expect("a witness");
    let value = |name: &str| {
        let symbol = plant.plant.arena.symbol(name);
        let (_, value) = witness.point.iter().find(|(s, _)| *s == symbol).expect("a coordinate");
        plant.plant.arena.as_number(*value).expect("a rational coordinate").to_f64()
    };
    assert_eq!(plant.plant.arena.print(cascade.residual[0]), "-g*x^2");
    let again = -value("g") * value("x") * value("x");
    // A product of small rationals, up to the rounding of two multiplications.
    assert!((again - witness.bounds.0).abs() < 1e-12 && (again - witness.bounds.1).abs() < 1e-12);
    assert!((value("g") - 3.0).abs() < f64::EPSILON);
}

/// Two points of the domain, which differ in x alone.
#[test]
fn a_refutation_compares_points_of_the_domain() {
    let plant = derived("x: [p]\ny: [y]\nu: [u]\nassume: [p > 3, u > 1]\nf_x: {p: u - p^2}\nf_y: {y: u}\nphi: [p]");
    let cascade = plant.derivation.cascade.result.as_ref().expect("a residual");
    let compared = cascade.witness.as_ref().and_then(|witness| witness.compared.as_ref()).expect("two points");
    let [here, there] = compared.points.as_slice() else { panic!("{compared:?}") };
    let value = |point: &[(Symbol, Expr)]| plant.plant.arena.as_number(point[0].1).expect("a rational").to_f64();
    let (here, there, u) = (value(here), value(there), value(&compared.known));
    assert!(here > 3.0 && there > 3.0 && u > 1.0);
    // The values are of small rationals, up to rounding.
    for (p, (low, high)) in [here, there].into_iter().zip(compared.values.iter().copied()) {
        let rate = u - p * p;
        assert!((rate - low).abs() < 1e-12 * rate.abs() && (rate - high).abs() < 1e-12 * rate.abs());
    }
    let said = plant.derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("z1' is about") && said.contains("with the same u = "), "{said}");
}

#[test]
fn claims_that_build_on_a_failed_one_are_skipped() {
    let plant = derived("x: [x]\ny: [y]\nu: [u]\nf_x: {x: u - x}\nf_y: {y: x*y}\nphi: [x*y]");
    assert_eq!(plant.derivation.cascade.verdict, Verdict::Refuted);
    assert_eq!(plant.derivation.regression.verdict, Verdict::Skipped);
    assert_eq!(plant.derivation.identifiability.verdict, Verdict::Skipped);
}
