//! The outputs of a regression: each by the equation that says most, and none left out that says something.
//!
//! In: a regression that identifies the unknowns. Out: the regression in which an output that is given by its value
//! stands by that value, and outputs that it leaves out are added, by their values or else by their rates; and the
//! outputs that remain unused, with the reason. A rate says less than the value: it has lost the constants, and the
//! sensor's noise is differentiated. What is redundant is weighted by the noise of the sensors.

use std::collections::BTreeSet;

use super::cleared;
use super::combined::{joined, of_regression};
use super::equation::Equation;
use super::implicit;
use super::linear::decompose;
use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, UnusedOutput, UnusedReason};
use crate::plant::Plant;
use crate::plant::matrix::dot;
use crate::source::Diagnostic;
use pebo_cas::{Arena, Domain, Expr, Symbol};

/// A choice of equations for the outputs.
pub(in crate::analysis) struct OutputChoice {
    /// The regressions with it, the preferred first: without the rates of outputs that are given by value, then with
    /// them.
    pub(in crate::analysis) regressions: Vec<Claim<Regression>>,
    /// The outputs without a usable equation.
    pub(in crate::analysis) unused: Vec<UnusedOutput>,
    /// The outputs that these regressions have and the given one leaves out.
    pub(in crate::analysis) added: Vec<usize>,
}

/// The regressions with an equation for each output that has a usable one; no regressions if the given one is that
/// already.
pub(in crate::analysis) fn with_all_outputs(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    regression: &Regression,
    found: &mut Vec<Diagnostic>,
) -> OutputChoice {
    let used: BTreeSet<usize> = regression.sources.iter().flatten().copied().collect();
    let (mut added, mut unused) = (Vec::new(), Vec::new());
    for output in (0..plant.y.len()).filter(|output| !used.contains(output)) {
        match equation(plant, domain, left_inverse, output) {
            Ok(equation) => added.extend(equation),
            Err(reason) => unused.push(UnusedOutput { output, reason }),
        }
    }
    let of_added = added.iter().flat_map(|equation| equation.outputs.clone()).collect();
    let Some(given) = of_regression(plant, domain, cascade, regression) else {
        return OutputChoice { regressions: Vec::new(), unused, added: of_added };
    };
    let by_value = |output: &usize| given.iter().any(|e| plant.arena.is_zero(e.primitive) && e.outputs == [*output]);
    let mut values = Vec::new();
    if plant.relation_form.is_none() {
        let moving = used.iter().filter(|output| plant.y[**output].moves_with_value() && !by_value(output));
        values.extend(moving.filter_map(|output| Some((*output, value(plant, domain, *output)?))));
    }
    if values.is_empty() && added.is_empty() {
        return OutputChoice { regressions: Vec::new(), unused, added: of_added };
    }
    let is_replaced = |equation: &Equation| {
        let [output] = equation.outputs.as_slice() else { return false };
        values.iter().any(|(replaced, _)| replaced == output)
    };
    let kept: Vec<Equation> = given.iter().filter(|equation| !is_replaced(equation)).cloned().collect();
    let values: Vec<Equation> = values.iter().map(|(_, equation)| equation.clone()).collect();
    let mut join = |equations: &[Equation]| joined(plant, domain, cascade, left_inverse, equations, found);
    let mut regressions = Vec::from_iter(join(&[kept, values.clone(), added.clone()].concat()));
    if !values.is_empty() {
        regressions.extend(join(&[given, values, added].concat()));
    }
    OutputChoice { regressions, unused, added: of_added }
}

/// The equation of an output, linear in z: of its value, or else of its rate; none if it says nothing of z.
fn equation(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    output: usize,
) -> Result<Option<Equation>, UnusedReason> {
    let arena = &plant.arena;
    let unmeasured: BTreeSet<Symbol> = plant.w.iter().copied().collect();
    let declared = &plant.y[output];
    if let Some(equation) = value(plant, domain, output) {
        return Ok(Some(equation));
    }
    let Some(rate) = declared.rate else {
        let Some(value) = declared.value else { return Ok(None) };
        if !arena.depends_on(value.expr, &plant.hidden()) {
            return Ok(None);
        }
        let is_hidden = arena.depends_on(value.expr, &unmeasured);
        return Err(if is_hidden { UnusedReason::Hidden } else { UnusedReason::Nonlinear });
    };
    if arena.depends_on(rate.expr, &unmeasured) {
        return Err(UnusedReason::Hidden);
    }
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    if let Ok(Some(row)) = decompose(plant, domain, left_inverse, (output, rate.expr)) {
        let says_something = row.factors.iter().any(|factor| !arena.is_zero(*factor));
        let rate = arena.add(row.known, dot(arena, &row.factors, &z));
        let equation = Equation { primitive: arena.of_symbol(declared.symbol), rate, outputs: vec![output] };
        return Ok(says_something.then_some(equation));
    }
    let in_z = left_inverse.map(|inverse| arena.substitute(rate.expr, &inverse.x.iter().copied().collect()));
    match in_z.map(|in_z| implicit::affine_equation(plant, domain, (output, in_z))) {
        Some(Ok(Some(equation))) => Ok(Some(equation)),
        _ => Err(UnusedReason::Nonlinear),
    }
}

/// The equation of an output's value, if that is linear in z and depends on it.
fn value(plant: &Plant, domain: &Domain, output: usize) -> Option<Equation> {
    let arena = &plant.arena;
    let declared = &plant.y[output];
    let difference = arena.sub(arena.of_symbol(declared.symbol), declared.value?.expr);
    let rows = cleared::rows(plant, domain, difference).ok()?;
    let row = rows.into_iter().find(|row| row[1..].iter().any(|factor| !arena.is_zero(*factor)))?;
    Some(Equation::instant(arena, in_z(arena, &plant.z, &row), vec![output]))
}

fn in_z(arena: &Arena, z: &[Symbol], row: &[Expr]) -> Expr {
    let z: Vec<Expr> = z.iter().map(|s| arena.of_symbol(*s)).collect();
    arena.add(row[0], dot(arena, &row[1..], &z))
}
