//! Identifiability where the plant starts at known values.
//!
//! In: a regression that does not identify all unknowns. Out: the decision on the others, where the extension starts at
//! phi and some components of theta, or functions of them, are therefore zero; the fewest that this takes. Sufficient at
//! the start itself: the rows with their derivatives are looked at where the known states have their values.

use std::collections::BTreeMap;

use crate::analysis::design::{Claim, Excitation, Identifiability, Regression, Verdict};
use crate::analysis::left_inverse::checking::at_phi;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::linear::rank::full_rank;
use pebo_cas::{Expr, Symbol};

use super::problem::ObservabilityProblem;

type Decision = (Claim<Identifiability>, Vec<Diagnostic>);

/// Decides how the outputs identify the unknowns of a problem.
type ByOutputs<'a> = &'a dyn Fn(&ObservabilityProblem<'_>, &mut Vec<Diagnostic>) -> Claim<Identifiability>;

/// The decision with the known start; none where that fixes no unknown.
pub(super) fn decided(problem: &ObservabilityProblem<'_>, by_outputs: ByOutputs<'_>) -> Option<Decision> {
    let mut fixed = fixed(problem.plant, problem.regression);
    if fixed.is_empty() {
        return None;
    }
    let mut decision = without(problem, &fixed, by_outputs);
    // An unknown that the outputs show needs no start.
    for position in fixed.clone() {
        if decision.0.verdict != Verdict::Proved || fixed.len() == 1 {
            break;
        }
        let fewer: Vec<usize> = fixed.iter().copied().filter(|other| *other != position).collect();
        let other = without(problem, &fewer, by_outputs);
        if other.0.verdict == Verdict::Proved {
            (fixed, decision) = (fewer, other);
        }
    }
    if let Some(result) = &mut decision.0.result {
        result.by_start = fixed;
    }
    Some(decision)
}

/// The positions of unknowns that are zero where the extension starts at phi.
fn fixed(plant: &Plant, regression: &Regression) -> Vec<usize> {
    let arena = &plant.arena;
    let zeros = plant.known_components().into_iter().map(|(component, _)| (plant.theta[component], arena.zero()));
    let zeros: BTreeMap<Symbol, Expr> = zeros.collect();
    let is_fixed = |eta: &Expr| !zeros.is_empty() && arena.is_zero(arena.substitute(*eta, &zeros));
    (0..regression.eta.len()).filter(|position| is_fixed(&regression.eta[*position])).collect()
}

/// The decision on the other unknowns.
fn without(problem: &ObservabilityProblem<'_>, fixed: &[usize], by_outputs: ByOutputs<'_>) -> Decision {
    let plant = problem.plant;
    let rest = problem.regression.without(plant, fixed);
    let others = ObservabilityProblem { regression: &rest, ..*problem };
    if rest.eta.is_empty() {
        let result = Identifiability { everywhere_else: true, ..Identifiability::new(Excitation::Instant) };
        return (Claim { verdict: Verdict::Proved, result: Some(result) }, Vec::new());
    }
    let mut found = Vec::new();
    let claim = by_outputs(&others, &mut found);
    if claim.verdict == Verdict::Proved && !is_identified_from_start(&others) {
        return (Claim { verdict: Verdict::Undecided, result: None }, vec![undecided(plant)]);
    }
    (claim, found)
}

/// Tests whether almost every start with the known values identifies the unknowns: at other values more may be shown.
fn is_identified_from_start(problem: &ObservabilityProblem<'_>) -> bool {
    let &ObservabilityProblem { plant, domain, .. } = problem;
    let arena = &plant.arena;
    let mut start: BTreeMap<Symbol, Expr> = plant.known.iter().map(|(state, value)| (*state, value.expr)).collect();
    for (component, value) in plant.known_components() {
        start.extend([(plant.chi[component], value), (plant.xi[component], value), (plant.z[component], value)]);
    }
    let Ok(observed) = problem.solve() else { return false };
    let there: Vec<Vec<Expr>> = observed.stack.iter().map(|row| arena.substitute_all(row, &start)).collect();
    there == observed.stack || full_rank(arena, domain, &there, problem.unknowns())
}

fn undecided(plant: &Plant) -> Diagnostic {
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "whether the outputs identify the unknowns from the known start is undecided",
    )
    .label("with other values at the start they do")
    .help("measure another output, or leave out of `known` what the outputs show")
}
