//! The outputs of a regression: each by the equation that says most, and none left out that says something.
//!
//! In: a regression that identifies the unknowns. Out: the regression in which an output that is given by its value
//! stands by that value, or by a combination of values that is linear, and outputs that it leaves out are added, by their
//! values or else by their rates; and the outputs that remain unused, with the reason. A rate says less than the value:
//! it has lost the constants, and the sensor's noise is differentiated. What is redundant is weighted by the noise of the
//! sensors.

use std::collections::BTreeSet;

use super::cancelling::{Combination, of_values};
use super::cleared::value;
use super::equation::Equation;
use super::pool::Pool;
use super::trial::Trial;
use crate::analysis::affine::{self, Row};
use crate::analysis::design::{UnusedOutput, UnusedReason};

/// The trial with each output by the equation that says most, where that takes no excitation that the given one does
/// not need; else the given. A rate that identifies at once what its value identifies over time says nothing more: it
/// counts the value's noise twice, and not what disturbs the value.
pub(super) fn completed(pool: &Pool<'_>, mut given: Trial) -> Trial {
    let (premises, plant) = (&pool.premises, pool.premises.plant);
    let used: BTreeSet<usize> = given.regression.sources.iter().flatten().copied().collect();
    let (mut added, mut unused) = (Vec::new(), Vec::new());
    for output in (0..plant.y.len()).filter(|output| !used.contains(output)) {
        match equation(pool, output) {
            Ok(equation) => added.extend(equation),
            Err(reason) => unused.push(UnusedOutput { output, reason }),
        }
    }
    let stands_alone = |equation: &Equation, output: usize| equation.outputs == [output];
    let own = |output| given.equations.iter().filter(move |equation| stands_alone(equation, output));
    let is_by_value = |output| own(output).count() > 0 && own(output).all(|equation| equation.is_instant(premises));
    let moving = used.iter().copied().filter(|output| plant.y[*output].moves_with_value() && !is_by_value(*output));
    let moving = moving.filter(|_| plant.relation_form.is_none());
    let (mut values, mut curved) = (Vec::new(), Vec::new());
    for output in moving {
        value(premises, output).map_or_else(|| curved.push(output), |equation| values.push(equation));
    }
    values.extend(combined_values(pool, &curved));
    // A combination stands for its last output, which is in no other one. An identity may say what a value says.
    let stands_for = |value: &Equation, equation: &Equation| {
        value.outputs == equation.outputs || value.outputs.last().is_some_and(|last| equation.outputs == [*last])
    };
    let is_another = |equation: &&Equation| !values.iter().any(|value| value.is_same(equation, premises));
    let is_kept = |equation: &&Equation| !values.iter().any(|value| stands_for(value, equation));
    let others: Vec<Equation> = given.equations.iter().filter(is_another).cloned().collect();
    let mut kept = vec![others.iter().filter(is_kept).cloned().collect(), others];
    // Without the rates of outputs that are given by value, then with them.
    kept.truncate(1 + usize::from(!values.is_empty()));
    if !values.is_empty() || !added.is_empty() {
        for kept in kept {
            let trial = Trial::of(premises, [kept, values.clone(), added.clone()].concat());
            let wanted = |trial: &Trial| trial.is_identified() && (!given.is_at_once() || trial.is_by_itself());
            if let Some(mut trial) = trial.ok().filter(wanted) {
                trial.regression.unused = unused;
                return trial;
            }
        }
    }
    let unproved = |output| UnusedOutput { output, reason: UnusedReason::Unproved };
    unused.extend(added.into_iter().flat_map(|equation| equation.outputs).map(unproved));
    given.regression.unused = unused;
    given
}

/// Combinations of the values of outputs that are linear in z although the values are not: the squares of two ranges
/// less one another.
fn combined_values(pool: &Pool<'_>, outputs: &[usize]) -> Vec<Equation> {
    let premises = &pool.premises;
    let row = |combination: &Combination| {
        let error = premises.arena().sub(combination.output, combination.formula);
        affine::of(premises.plant, &premises.domain.without_equations(), error).ok()?
    };
    let says_something = |row: &Row| row[1..].iter().any(|factor| !premises.arena().is_zero(*factor));
    let equation = |combination: Combination| {
        let row = row(&combination).filter(says_something)?;
        Some(Equation::instant(premises, premises.of_row(&row), combination.outputs))
    };
    let found = if outputs.len() > 1 { of_values(premises, outputs) } else { Ok(Vec::new()) };
    found.unwrap_or_default().into_iter().filter_map(equation).collect()
}

/// The equation of an output, linear in z: of its value, or else of its rate; none if it says nothing of z.
fn equation(pool: &Pool<'_>, output: usize) -> Result<Option<Equation>, UnusedReason> {
    let (premises, declared) = (&pool.premises, &pool.premises.plant.y[output]);
    if let Some(equation) = value(premises, output) {
        return Ok(Some(equation));
    }
    let formula = declared.rate.or(declared.value.filter(|value| premises.is_hidden(value.expr)));
    let Some(formula) = formula else { return Ok(None) };
    if premises.is_moved(formula.expr) {
        return Err(UnusedReason::Hidden);
    }
    let is_own = |equation: &&Equation| equation.is_linear() && equation.outputs == [output];
    if let Some(cleared) = pool.cleared().iter().find(is_own) {
        return Ok(Some(cleared.clone()));
    }
    let rate = pool.affine().find(is_own).ok_or(UnusedReason::Nonlinear)?;
    let mut factors = rate.factors.iter().flatten().flatten();
    let says_something = factors.any(|factor| !premises.arena().is_zero(*factor));
    Ok(says_something.then(|| rate.clone()))
}
