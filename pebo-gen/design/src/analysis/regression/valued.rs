//! Outputs given by value, each as the equation of its value.
//!
//! In: a dynamic regression. Out: the regression in which outputs with a value under `g_y` stand by that value, where
//! it is affine in z, and the others by their rates; none if there is no such output. A rate says less than the value:
//! it has lost the constants, and the sensor's noise is differentiated.

use crate::analysis::affine;
use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::plant::Plant;
use crate::plant::matrix::dot;
use crate::source::Diagnostic;
use pebo_cas::{Domain, Expr};

use super::combined::{joined, of_regression};
use super::equation::Equation;
use super::static_relation::from_identities;

/// The regression with values in place of the rates that follow from them.
pub(in crate::analysis) fn by_values(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    regression: &Regression,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    if regression.kind != RegressionKind::Dynamic {
        return None;
    }
    let values: Vec<Option<Expr>> = regression.rows.iter().map(|output| value_in_z(plant, domain, *output)).collect();
    if values.iter().all(Option::is_none) {
        return None;
    }
    if values.iter().all(Option::is_some) && values.len() == plant.identities.len() {
        let claim = from_identities(plant, domain, cascade, left_inverse, found);
        return (claim.verdict == Verdict::Proved).then_some(claim);
    }
    let rates = of_regression(plant, cascade, regression)?;
    let equations: Vec<Equation> = rates
        .into_iter()
        .zip(values)
        .map(|(rate, value)| value.map_or(rate, |rate| Equation { primitive: plant.arena.zero(), rate }))
        .collect();
    joined(plant, domain, cascade, left_inverse, &equations, found)
}

/// An affine function of z that vanishes by an output's value and depends on z.
fn value_in_z(plant: &Plant, domain: &Domain, output: usize) -> Option<Expr> {
    let arena = &plant.arena;
    let output = &plant.y[output];
    let value = output.value.filter(|_| output.moves_with_value())?;
    // On its own manifold the difference is 0, an affine function of anything: its equation in z is found elsewhere.
    let everywhere = domain.without_equations();
    let row = affine::of(plant, &everywhere, arena.sub(arena.of_symbol(output.symbol), value.expr)).ok()??;
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let depends = row[1..].iter().any(|factor| !arena.is_zero(*factor));
    depends.then(|| arena.add(row[0], dot(arena, &row[1..], &z)))
}
