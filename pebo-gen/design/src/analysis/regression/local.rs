//! The regression to first order in theta, of equations that need not be linear in functions of it.
//!
//! In: the pool of a plant's equations. Out: each output by its value or else by its rate, and the identities, where the
//! extension is z, with the slopes by theta there, if these identify theta along almost every trajectory; else with the
//! rates of all outputs, if these do, or if they never do. Then no observer recovers theta: the differentials of all
//! rates and values, along the plant, are those of all that outputs show. An observer that starts its extension again
//! from the estimate at every sample is recursive Gauss-Newton (Ljung, System identification, 1999, Section 11.4). It
//! converges from a neighbourhood, of which no size is proved.

use std::collections::BTreeSet;

use super::equation::{Equation, outputs_of};
use super::pool::Pool;
use super::trial::Trial;
use crate::analysis::design::{AtEstimate, Verdict};
use crate::plant::Formula;

/// The local regression, if it identifies theta or proves that nothing does.
pub(super) fn decided(pool: &Pool<'_>) -> Option<Trial> {
    let (premises, plant) = (&pool.premises, pool.premises.plant);
    let trial = |equations: Vec<Equation>| {
        // Where all are linear, an exact regression has them.
        let is_local = !equations.iter().all(Equation::is_linear);
        is_local.then(|| Trial::at_estimate(premises, equations, AtEstimate::Local).ok()).flatten()
    };
    let first = trial(equations(pool, Rates::OfOthers))?;
    if first.is_identified() {
        return Some(first);
    }
    // A value says nothing of what moves its output, where samples of that output stand for states in the cascade.
    let whole = trial(equations(pool, Rates::OfAll))?;
    let has_rate = |output: usize| pool.rates.iter().any(|rate| rate.output == output && rate.equation.is_some());
    let instants = instants(pool).count();
    let is_complete = (0..plant.y.len()).all(has_rate) && instants == plant.identities.len();
    let is_settled = whole.is_identified() || is_complete && whole.identifiability.verdict == Verdict::Refuted;
    is_settled.then_some(whole)
}

/// The outputs whose rates are taken.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Rates {
    /// Those that are not given by value.
    OfOthers,
    /// All.
    OfAll,
}

/// The identities and values of outputs as functions of z, and these rates, of which each says something of z.
pub(super) fn equations(pool: &Pool<'_>, rates: Rates) -> Vec<Equation> {
    let (arena, plant, unknown) = (pool.premises.arena(), pool.premises.plant, pool.premises.unknown());
    let instants: Vec<Equation> = instants(pool).collect();
    let by_value = |output: &usize| plant.y[*output].value.is_some();
    let values: BTreeSet<usize> =
        instants.iter().flat_map(|equation| &equation.outputs).copied().filter(by_value).collect();
    let is_known = |equation: &Equation| equation.outputs.iter().all(|output| values.contains(output));
    let taken = pool.unmoved().filter(|rate| rates == Rates::OfAll || !is_known(rate)).cloned();
    taken.chain(instants.iter().cloned()).filter(|equation| arena.depends_on(equation.rate, &unknown)).collect()
}

/// The identities, and the values of outputs, as functions of z.
fn instants<'a>(pool: &'a Pool<'_>) -> impl Iterator<Item = Equation> + 'a {
    let (premises, plant) = (&pool.premises, pool.premises.plant);
    // As they are written: the noise of a sensor is then in its row alone.
    plant.identities.iter().filter_map(move |identity: &Formula| {
        let in_z = premises.at_left_inverse(identity.expr).filter(|in_z| !premises.is_hidden(*in_z))?;
        Some(Equation::instant(premises, in_z, outputs_of(plant, identity)))
    })
}
