//! Identifiability at equilibria.
//!
//! In: a regression whose unknowns are identifiable. Out: added to its trajectories, the
//! identifiability on each component of the equilibria, cut into the cells on which the rows are analytic. An
//! equilibrium is a point at which every rate vanishes. "At rest" is a statement on points that were found: with no
//! equilibrium, or none that was found, nothing is said.

use crate::analysis::design::{BlindTrajectory, Still, Trajectories};

use super::list::List;
use crate::analysis::identifiability::problem::{ObservabilityProblem, SHARE_OF_REMARKS};

/// Adds to the trajectories of a regression those at equilibria.
pub(in crate::analysis::identifiability) fn add(trajectories: &mut Trajectories, problem: &ObservabilityProblem<'_>) {
    let mut list = List::new(problem, &trajectories.blind);
    let identified = problem.plant.arena.budget().share(SHARE_OF_REMARKS, || problem.at_rest(&mut list));
    let is_complete = list.is_complete;
    let (hidden, mut open): (Vec<_>, Vec<_>) = list.statements().into_iter().partition(BlindTrajectory::is_decided);
    // With constant inputs as much is hidden as at an equilibrium, or less.
    if trajectories.by_itself == Some(false) {
        open.clear();
    }
    trajectories.at_rest = identified && trajectories.by_itself == Some(true);
    trajectories.everywhere &= is_complete || !identified;
    trajectories.blind.splice(0..0, hidden);
    trajectories.blind.extend(open);
}

impl ObservabilityProblem<'_> {
    /// Adds the equilibria at which unknowns are hidden. True if there are others, at almost all of which none is.
    fn at_rest(&self, list: &mut List<'_>) -> bool {
        let (whole, held) = (self.whole(Still::Plant), self.held(&Still::Plant));
        let Ok(families) = self.equilibria() else {
            // What is hidden while the signals are constant is so at equilibria, but more may be: these are no others.
            list.is_complete = false;
            list.leave_open(&whole, None);
            return false;
        };
        if families.iter().all(|family| family.hides_as(&families[0])) {
            // One statement for all of them, of which a listed one may hold.
            if let Some(family) = families.iter().find(|family| !list.covers(family)) {
                let set = if families.len() == 1 { &family.set } else { &whole };
                list.state(self.on(&set.domain).blind(set.condition.clone(), &family.observed), set.domain.clone());
                for family in &families {
                    list.refine(family);
                }
            }
            return false;
        }
        for family in &families {
            if !family.observed.is_full() {
                list.add(family);
                continue;
            }
            let Ok(zero_set) = self.zero_set(&family.set.domain, &family.observed) else {
                list.is_complete = false;
                continue;
            };
            list.is_complete &= zero_set.all;
            for zero in zero_set.zeros {
                match list.add_zero(&family.set, zero, &held) {
                    Ok(is_complete) => list.is_complete &= is_complete,
                    Err(_) => list.leave_open(&family.set, Some(zero)),
                }
            }
        }
        families.iter().any(|family| family.observed.is_full())
    }
}
