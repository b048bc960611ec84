//! Symmetries of a plant that no output shows.
//!
//! In: a plant. Out: a change of the unmeasured states, and of the unmeasured signals with them, under which inputs,
//! outputs and identities are the same: along a direction `a + B x` with constant a and B, by a constant vector, of
//! signs, or an exchange of states. Holds after: beside a trajectory there is another one with the same inputs and outputs, so that no observer
//! recovers the states that change, on a domain that contains both.

mod affine;
mod changes;
mod found;
mod preserved;
mod shifts;

use pebo_cas::tower::Obstacle;

use super::problem::Problem;
pub use found::{Symmetry, SymmetryKind};
use preserved::Formulas;

/// The first symmetry of the plant: along an affine direction, by a constant vector, of signs, an exchange; none
/// where there is none of them.
pub(super) fn symmetry(problem: &Problem<'_>) -> Result<Option<Symmetry>, Obstacle> {
    let Some(formulas) = Formulas::of(problem) else { return Ok(None) };
    if problem.arena.dividers(&formulas.all()).is_empty() {
        for along in [affine::direction, shifts::direction] {
            let found = along(problem, &formulas)?;
            if found.is_some() {
                return Ok(found);
            }
        }
    }
    Ok(changes::change(problem, &formulas))
}
