//! The outputs of a regression: each by the equation that says most, and none left out that says something.
//!
//! In: a regression that identifies the unknowns. Out: the regression in which an output that is given by its value
//! stands by that value, and outputs that it leaves out are added, by their values or else by their rates; and the
//! outputs that remain unused, with the reason. A rate says less than the value: it has lost the constants, and the
//! sensor's noise is differentiated. What is redundant is weighted by the noise of the sensors.

use std::collections::BTreeSet;

use super::cleared::value;
use super::equation::Equation;
use super::pool::Pool;
use super::trial::Trial;
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
    let by_value = |output| given.equations.iter().any(|e| e.is_instant(premises) && stands_alone(e, output));
    let moving = used.iter().copied().filter(|output| plant.y[*output].moves_with_value() && !by_value(*output));
    let moving = moving.filter(|_| plant.relation_form.is_none());
    let values: Vec<Equation> = moving.filter_map(|output| value(premises, output)).collect();
    let is_kept = |equation: &&Equation| !values.iter().any(|value| value.outputs == equation.outputs);
    let mut kept = vec![given.equations.iter().filter(is_kept).cloned().collect(), given.equations.clone()];
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
