//! The motion that unknowns need to be identifiable where one instant does not suffice, and the trajectories on which
//! they are hidden.
//!
//! In: a regression whose rows are of full rank over time on almost every trajectory. Out: the same with all inputs
//! constant; and simple trajectories on which they are not: inputs that are constant, that are equal, or
//! at a value at which an entry vanishes.
//!
//! The problem is the same as for all trajectories: the rank of the rows with their derivatives. A point proves full
//! rank; otherwise exact algebra gives the directions that no derivative observes. Undecided trajectories are not
//! reported; that there are no others is reported only if each of them provably ends at once.

mod problem;

mod coinciding;
mod family;
mod losses;
pub(super) mod rest;
#[cfg(test)]
mod tests;
pub(in crate::analysis) mod words;

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{BlindTrajectory, Cascade, Regression, Trajectories, TrajectoryCondition};
use crate::plant::Plant;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use losses::is_listed;
use problem::{Observation, Restriction};

pub(super) use problem::{SHARE_OF_REMARKS, TrajectoryProblem, identifiable};

/// The necessary motion, and combinations of the parameters whose zeros lower the rank.
pub(super) fn of(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
) -> (Trajectories, Vec<Expr>) {
    let arena = &plant.arena;
    let problem = TrajectoryProblem { plant, domain, cascade, regression, unknowns: regression.eta.len() };
    let inputs: BTreeSet<Symbol> = plant.commanded().collect();
    let held = problem.solve(&Restriction { held: inputs.clone(), ..Restriction::default() });
    let by_itself = held.as_ref().ok().map(|observed| observed.hidden.is_empty()).or(inputs.is_empty().then_some(true));
    let mut blind = Vec::new();
    let mut note = |condition: TrajectoryCondition, observed: &Result<Observation, Obstacle>| {
        let hidden = observed.as_ref().ok().filter(|observed| !observed.hidden.is_empty());
        blind.extend(hidden.map(|observed| problem.blind(condition, observed)));
    };
    if by_itself != Some(true) {
        note(TrajectoryCondition::Constant(plant.commanded().collect()), &held);
    }
    // The shortest rows of full rank are those of the fewest moving signals.
    let at_rest = || Restriction { held: problem.signals_at_rest(), ..Restriction::default() };
    let still = (by_itself == Some(true)).then(|| problem.solve(&at_rest()));
    let free;
    let observed =
        if let Some(observed) = still.iter().chain([&held]).flatten().find(|observed| observed.hidden.is_empty()) {
            Some(observed)
        } else {
            free = problem.solve(&Restriction::default());
            free.as_ref().ok()
        };
    let special = observed.and_then(|observed| {
        let is_short = problem.check_size(&observed.stack).is_ok();
        let worked_out = || problem.constants(&observed.stack).ok();
        if is_short { worked_out() } else { arena.budget().share(SHARE_OF_REMARKS, worked_out) }
    });
    let coincide = || observed.is_some_and(|observed| problem.may_coincide(&observed.stack));
    let (constants, all) = special.unwrap_or_default();
    let parameters = all && !coincide();
    let kept = observed.filter(|_| by_itself != Some(true)).map(|observed| problem.kept(&observed.stack));
    let undecided = |zero| BlindTrajectory::undecided(TrajectoryCondition::Undecided(zero));
    let decided = |zero: Expr| {
        let found = problem.at_zero(zero, &BTreeSet::new(), &[]);
        found.map_or_else(|_| vec![undecided(zero)], |(decided, _)| decided)
    };
    let kept: Vec<BlindTrajectory> = kept.into_iter().flatten().flat_map(decided).collect();
    let mut everywhere = false;
    let short = held.as_ref().ok().filter(|observed| problem.check_size(&observed.stack).is_ok());
    if let Some(Observation { stack, .. }) = short {
        let mut tried: Vec<(Symbol, Expr)> = Vec::new();
        for (condition, restriction) in problem.candidates(by_itself == Some(true), stack) {
            if let TrajectoryCondition::Value(input, value) = &condition {
                tried.push((*input, *value));
            }
            let observed = problem.solve(&restriction);
            let is_identified = observed.as_ref().is_ok_and(|observed| observed.hidden.is_empty());
            // Inputs that identify unknowns by their variation do not do so as constants.
            if let (true, Some(true), TrajectoryCondition::Value(input, value)) = (is_identified, by_itself, &condition)
            {
                note(TrajectoryCondition::Steady(*input, *value), &problem.steady(*input, *value));
            }
            note(condition, &observed);
        }
        if by_itself == Some(true) {
            for input in inputs.iter().filter(|input| !tried.contains(&(**input, arena.zero()))) {
                let alone = inputs.len() == 1;
                let condition = if alone { TrajectoryCondition::Value } else { TrajectoryCondition::Steady };
                note(condition(*input, arena.zero()), &problem.steady(*input, arena.zero()));
            }
            for (parameter, value) in problem.coincidences(stack, &constants) {
                note(TrajectoryCondition::Steady(parameter, value), &problem.steady(parameter, value));
            }
            let (doubtful, all) = problem.doubtful(&blind, stack);
            blind.extend(doubtful);
            everywhere = all;
        }
    }
    if by_itself != Some(true) {
        let zeros = problem.columns().unwrap_or_default().into_iter();
        let others: Vec<BlindTrajectory> =
            zeros.filter(|zero| !is_listed(arena, &blind, *zero)).map(undecided).collect();
        blind.extend(others);
    }
    blind.extend(kept);
    (Trajectories { by_itself, at_rest: false, blind, everywhere, parameters }, constants)
}

impl TrajectoryProblem<'_> {
    /// Candidate trajectories.
    fn candidates(&self, by_itself: bool, stack: &[Vec<Expr>]) -> Vec<(TrajectoryCondition, Restriction)> {
        let inputs: Vec<Symbol> = self.plant.commanded().collect();
        let arena = &self.plant.arena;
        let mut found = Vec::new();
        if !by_itself && inputs.len() > 1 {
            for (index, &one) in inputs.iter().enumerate() {
                let held = BTreeSet::from([one]);
                found.push((TrajectoryCondition::Constant(vec![one]), Restriction { held, ..Restriction::default() }));
                for &other in &inputs[index + 1..] {
                    let equal = BTreeMap::from([(other, arena.of_symbol(one))]);
                    found.push((
                        TrajectoryCondition::Value(one, arena.of_symbol(other)),
                        Restriction { equal, ..Restriction::default() },
                    ));
                }
            }
        }
        for (input, value) in self.values(stack).unwrap_or_default() {
            let equal = BTreeMap::from([(input, value)]);
            found.push((TrajectoryCondition::Value(input, value), Restriction { equal, ..Restriction::default() }));
        }
        found
    }
}
