//! Selections from the pool of equations, in the order in which they are tried.

use std::cell::OnceCell;

use super::equation::Equation;
use super::pool::{Pool, Rest};
use super::separation::is_separable;
use super::trial::Trial;
use crate::analysis::design::{RegressionKind, Verdict};
use crate::plant::{Plant, RelationForm};

/// Equations that belong together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// The rates that no unmeasured signal moves.
    Rates,
    /// The same, those with an unknown below times their denominators.
    Cleared,
    /// Combinations of outputs from whose rates unmeasured signals cancel.
    Combinations,
    /// Identities, or else relations among the components of the transform.
    OfStates,
    /// Combinations of outputs whose rates are affine in phi.
    AffineCombinations,
    /// Relations under the derivative.
    Differentiated,
    /// The first regression and all other equations.
    More,
}

/// Equations of one source that are used: a part only where that leaves others out.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// All.
    Whole,
    /// Those that are affine in z.
    Linear,
    /// Those that are sums of known signals times functions of theta.
    Separable,
}

/// A selection of equations.
pub(super) type Selection = (Source, Part);

use Part::{Linear, Separable, Whole};
use Source::{AffineCombinations, Cleared, Combinations, Differentiated, More, OfStates, Rates};

/// Selections for a first regression, which the others build on; then the others.
pub(super) fn order(plant: &Plant) -> (&'static [Selection], &'static [Selection]) {
    match plant.relation_form {
        Some((RelationForm::Differentiated, _)) => (&[], &[(Differentiated, Whole)]),
        Some((RelationForm::Static, _)) => {
            (&[(OfStates, Whole), (Rates, Whole)], &[(OfStates, Linear), (More, Linear), (More, Whole)])
        }
        None => (
            &[
                (Rates, Whole),
                (Cleared, Whole),
                (Cleared, Linear),
                (Combinations, Whole),
                (OfStates, Whole),
                (AffineCombinations, Whole),
            ],
            &[
                (Differentiated, Whole),
                (Rates, Linear),
                (Rates, Separable),
                (OfStates, Linear),
                (OfStates, Whole),
                (More, Linear),
                (More, Whole),
            ],
        ),
    }
}

/// The equations of a selection, beside a first regression that does not identify the unknowns, if there is one; empty
/// where it adds none.
pub(super) fn equations(
    (source, part): Selection,
    pool: &Pool<'_>,
    given: Option<&Trial>,
    rest: &OnceCell<Rest>,
) -> Vec<Equation> {
    let mut equations = source.equations(pool, given, rest);
    if part == Whole {
        return equations;
    }
    let before = equations.len();
    let is_given = |e: &Equation| source == More && given.is_some_and(|given| given.equations.contains(e));
    let is_separable = |e: &Equation| part == Separable && is_separable(&pool.premises, e.rate);
    equations.retain(|equation| equation.is_linear() || is_given(equation) || is_separable(equation));
    let is_new = equations.len() < before && (source != Cleared || equations.len() > pool.affine().count());
    if is_new { equations } else { Vec::new() }
}

impl Source {
    fn equations(self, pool: &Pool<'_>, given: Option<&Trial>, rest: &OnceCell<Rest>) -> Vec<Equation> {
        let plant = pool.premises.plant;
        let has_identities = !plant.identities.is_empty();
        let is_generalised = pool.premises.cascade.lambda.is_some();
        let is_open = |given: Option<&Trial>| match given {
            Some(given) => has_identities && given.identifiability.verdict == Verdict::Refuted,
            None if has_identities && pool.curved().next().is_some() => true,
            None => pool.unmoved().next().is_none() || plant.wants(RelationForm::Static),
        };
        match (self, given) {
            (Rates, None) => pool.unmoved().cloned().collect(),
            (Cleared, None) if !pool.cleared().is_empty() => {
                pool.cleared().iter().chain(pool.affine()).cloned().collect()
            }
            (Combinations, None) if pool.unmoved().next().is_none() => {
                let outputs: Vec<usize> = pool.rates.iter().map(|rate| rate.output).collect();
                pool.combinations(&outputs).into_iter().collect::<Option<_>>().unwrap_or_default()
            }
            (OfStates, given) if is_open(given) && (is_generalised || pool.premises.left_inverse.is_some()) => {
                // Under a generalised cascade there are no functions of theta.
                let is_usable = |e: &&Equation| e.is_linear() || !is_generalised;
                pool.of_states().iter().filter(is_usable).cloned().collect()
            }
            (AffineCombinations, None) if pool.curved().next().is_some() => {
                let (found, _) = pool.affine_combinations();
                let is_more = found.len() > pool.affine().count();
                found.iter().filter(|_| is_more).cloned().collect::<Option<_>>().unwrap_or_default()
            }
            (Differentiated, given) if given.is_none_or(|given| is_long(plant, given)) => pool.differentiated(),
            (More, Some(given)) => {
                let rest = rest.get_or_init(|| pool.without(&given.equations));
                let is_more = !rest.equations.is_empty();
                given.equations.iter().chain(&rest.equations).filter(|_| is_more).cloned().collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Tests whether a relation as it holds at every instant adds unknowns to theta.
pub(super) fn is_long(plant: &Plant, trial: &Trial) -> bool {
    trial.regression.kind == RegressionKind::Static && trial.regression.eta.len() > plant.theta.len()
}
