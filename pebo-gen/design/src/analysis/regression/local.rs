//! The regression to first order in theta, of equations that need not be linear in functions of it.
//!
//! In: the pool of a plant's equations. Out: each output by its value or else by its rate, and the identities, where the
//! extension is z, with the slopes by theta there; none unless these identify theta along almost every trajectory. An
//! observer that starts its extension again from the estimate at every sample then is recursive Gauss-Newton (Ljung,
//! System identification, 1999, Section 11.4). It converges from a neighbourhood, of which no size is proved.

use std::collections::BTreeSet;

use super::equation::{Equation, outputs_of};
use super::pool::Pool;
use super::trial::Trial;
use crate::plant::Formula;

/// The local regression, if it identifies theta.
pub(super) fn identified(pool: &Pool<'_>) -> Option<Trial> {
    let (premises, plant) = (&pool.premises, pool.premises.plant);
    // As they are written: the noise of a sensor is then in its row alone.
    let instant = |identity: &Formula| {
        let in_z = premises.at_left_inverse(identity.expr).filter(|in_z| !premises.is_hidden(*in_z))?;
        Some(Equation::instant(premises, in_z, outputs_of(plant, identity)))
    };
    let of_states: Vec<Equation> = plant.identities.iter().filter_map(instant).collect();
    let by_value = |output: &usize| plant.y[*output].value.is_some();
    let values: BTreeSet<usize> =
        of_states.iter().flat_map(|equation| &equation.outputs).copied().filter(by_value).collect();
    let is_known = |equation: &&Equation| equation.outputs.iter().all(|output| values.contains(output));
    let rates = pool.unmoved().filter(|rate| !is_known(rate)).cloned();
    let says_something = |equation: &Equation| premises.arena().depends_on(equation.rate, &premises.unknown());
    // Where all are linear, an exact regression has them.
    let equations: Vec<Equation> = rates.chain(of_states.iter().cloned()).filter(says_something).collect();
    if equations.iter().all(Equation::is_linear) {
        return None;
    }
    Trial::near_extension(premises, equations).ok().filter(Trial::is_identified)
}
