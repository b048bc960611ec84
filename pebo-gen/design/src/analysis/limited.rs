//! A claim within the budget of the command.
//!
//! When the budget ends, a derivation may lack a condition, another class of cascade, or an output that identifies the
//! unknowns. The claim in whose time it ended is therefore undecided, whatever its result.

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};

use super::design::{Claim, Verdict};
use super::left_inverse::checking::at_phi;

/// The claim that is proved or refuted in time; undecided if the budget ended with it, and skipped if it had before.
pub(super) fn limited<T>(
    plant: &Plant,
    phase: &str,
    found: &mut Vec<Diagnostic>,
    prove: impl FnOnce(&mut Vec<Diagnostic>) -> Claim<T>,
) -> Claim<T> {
    if is_said(found) {
        return Claim::skipped();
    }
    let mut said = Vec::new();
    let claim = prove(&mut said);
    if plant.arena.budget().is_exhausted() {
        return unfinished(plant, phase, found);
    }
    found.append(&mut said);
    claim
}

/// Tests whether the budget ended since the last claim was proved or refuted in time.
pub(super) fn ended(plant: &Plant, found: &[Diagnostic]) -> bool {
    plant.arena.budget().is_exhausted() && !is_said(found)
}

/// The claim in whose time the budget ended.
pub(super) fn unfinished<T>(plant: &Plant, phase: &str, found: &mut Vec<Diagnostic>) -> Claim<T> {
    found.push(Diagnostic::limit_reached(phase, at_phi(plant)));
    Claim { verdict: Verdict::Undecided, result: None }
}

fn is_said(found: &[Diagnostic]) -> bool {
    found.iter().any(|diagnostic| diagnostic.code == Code::LimitReached)
}
