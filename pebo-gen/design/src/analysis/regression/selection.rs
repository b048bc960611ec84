//! Selections from the pool of equations, in the order in which they are tried.

use std::cell::OnceCell;

use super::equation::Equation;
use super::pool::{Pool, Rest};
use super::separation::is_separable;
use super::trial::Trial;
use crate::analysis::design::{RegressionKind, Verdict};
use crate::plant::{Plant, RelationForm};

/// A selection of equations.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Selection {
    /// All rates that no unmeasured signal moves.
    Rates,
    /// The same, those with an unknown below times their denominators.
    Cleared,
    /// Of these, the ones that are affine in phi as formulas in x.
    ClearedAffine,
    /// Combinations of outputs from whose rates unmeasured signals cancel.
    Combinations,
    /// Identities, or else relations among the components of the transform.
    OfStates,
    /// Combinations of outputs whose rates are affine in phi.
    AffineCombinations,
    /// Relations under the derivative.
    Differentiated,
    /// The rates that are affine in phi, without others.
    AffineRates,
    /// The rates that are functions of theta, without others.
    SeparableRates,
    /// The identities that are affine in phi.
    AffineIdentities,
    /// The first regression and what else is affine in z.
    MoreLinear,
    /// The first regression and all other equations.
    More,
}

use Selection::{
    AffineCombinations, AffineIdentities, AffineRates, Cleared, ClearedAffine, Combinations, Differentiated, More,
    MoreLinear, OfStates, Rates, SeparableRates,
};

impl Selection {
    /// Selections for a first regression, which the others build on; then the others.
    pub(super) fn order(plant: &Plant) -> (&'static [Self], &'static [Self]) {
        match plant.relation_form {
            Some((RelationForm::Differentiated, _)) => (&[], &[Differentiated]),
            Some((RelationForm::Static, _)) => (&[OfStates, Rates], &[AffineIdentities, MoreLinear, More]),
            None => (
                &[Rates, Cleared, ClearedAffine, Combinations, OfStates, AffineCombinations],
                &[Differentiated, AffineRates, SeparableRates, AffineIdentities, OfStates, MoreLinear, More],
            ),
        }
    }

    /// The equations, beside a first regression that does not identify the unknowns, if there is one; empty where the
    /// selection is none, or not a new one.
    pub(super) fn equations(self, pool: &Pool<'_>, given: Option<&Trial>, rest: &OnceCell<Rest>) -> Vec<Equation> {
        let plant = pool.premises.plant;
        let has_identities = !plant.identities.is_empty();
        let rest = |given: &Trial| rest.get_or_init(|| pool.without(&given.equations));
        match (self, given) {
            (Rates, _) => pool.unmoved().map(|rate| rate.in_z().cloned()).collect::<Option<_>>().unwrap_or_default(),
            (Cleared | ClearedAffine, None) if pool.has_curved() => {
                let [mut cleared, others] = pool.cleared();
                match (self, others.is_empty()) {
                    (Cleared, _) => cleared.extend(others),
                    (_, true) => cleared.clear(),
                    (_, false) => {}
                }
                if cleared.is_empty() { cleared } else { [cleared, pool.affine()].concat() }
            }
            (Combinations, None) if pool.unmoved().next().is_none() => {
                let outputs: Vec<usize> = pool.rates.iter().map(|rate| rate.output).collect();
                pool.combinations(&outputs).into_iter().collect::<Option<_>>().unwrap_or_default()
            }
            (OfStates, None) => {
                let without_rates = pool.unmoved().next().is_none() || plant.wants(RelationForm::Static);
                let is_open = without_rates || has_identities && pool.has_curved();
                if is_open { usable(pool, pool.of_states()) } else { Vec::new() }
            }
            (OfStates, Some(given)) if has_identities && given.identifiability.verdict == Verdict::Refuted => {
                usable(pool, pool.of_states())
            }
            (AffineCombinations, None) if pool.has_curved() => pool.affine_combinations(),
            (Differentiated, given) if given.is_none_or(|given| is_long(plant, given)) => {
                let equations = pool.differentiated();
                if equations.iter().all(Equation::is_linear) { equations } else { Vec::new() }
            }
            (AffineRates, None) => pool.affine(),
            (SeparableRates, None) => {
                let of_rate = |rate: &_| Some(super::pool::Rate::in_z(rate)?.clone());
                let known = pool.unmoved().filter_map(of_rate);
                known.filter(|equation| is_separable(&pool.premises, equation.rate)).collect()
            }
            (AffineIdentities, _) if has_identities => {
                let affine = pool.of_states().iter().filter(|equation| equation.is_linear()).cloned();
                let affine: Vec<Equation> = affine.collect();
                if affine.len() < pool.of_states().len() { affine } else { Vec::new() }
            }
            (MoreLinear, Some(given)) if !rest(given).linear.is_empty() => {
                [given.equations.as_slice(), &rest(given).linear].concat()
            }
            (More, Some(given)) if !rest(given).curved.is_empty() => {
                [given.equations.as_slice(), &rest(given).linear, &rest(given).curved].concat()
            }
            _ => Vec::new(),
        }
    }
}

/// The equations from which a regression may be made: under a generalised cascade those that are affine in z.
fn usable(pool: &Pool<'_>, equations: &[Equation]) -> Vec<Equation> {
    let is_generalised = pool.premises.cascade.lambda.is_some();
    equations.iter().filter(|equation| !is_generalised || equation.is_linear()).cloned().collect()
}

/// Tests whether a relation as it holds at every instant adds unknowns to theta.
pub(super) fn is_long(plant: &Plant, trial: &Trial) -> bool {
    trial.regression.kind == RegressionKind::Static && trial.regression.eta.len() > plant.theta.len()
}
