//! The motion that unknowns need to be identifiable where one instant does not suffice, and the trajectories on which
//! they are hidden.
//!
//! In: a regression whose rows are of full rank over time on almost every trajectory. Out: the same with all inputs
//! constant; and the trajectories on which they are not: while inputs are constant, or while the determinant of the rows
//! or one of their entries is zero at all times.
//!
//! The problem is the same as for all trajectories: the rank of the rows with their derivatives. A point proves full
//! rank; otherwise exact algebra gives the directions that no derivative observes. A zero at which trajectories may
//! remain is listed as undecided where nothing was proved; that there are no others is reported only if all were worked
//! out.

mod coinciding;
mod family;
mod list;
mod losses;
pub(super) mod rest;
#[cfg(test)]
mod tests;
pub(in crate::analysis) mod words;

use std::collections::BTreeSet;

use crate::analysis::design::{InputCourses, Still, Trajectories};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Relation, Symbol};

use super::observation::Observation;
use super::problem::{ObservabilityProblem, SHARE_OF_REMARKS};
use family::Family;

pub(super) use list::List;

/// The necessary motion, and combinations of the parameters whose zeros lower the rank.
pub(super) fn of(problem: &ObservabilityProblem<'_>) -> (Trajectories, Vec<Expr>) {
    let &ObservabilityProblem { plant, domain, .. } = problem;
    let inputs = problem.inputs();
    let constant = problem.solve_along(domain, &problem.held(&inputs));
    let by_itself = constant.as_ref().ok().map(Observation::is_full).or((inputs == Still::Nothing).then_some(true));
    // The shortest rows of full rank are those of the fewest moving signals.
    let still = (by_itself == Some(true)).then(|| problem.solve_along(domain, &problem.held(&Still::Plant)));
    let free;
    let shortest = still.iter().chain([&constant]).flatten().find(|observed| observed.is_full());
    let observed = if shortest.is_some() {
        shortest
    } else {
        free = problem.solve_along(domain, &BTreeSet::new());
        free.as_ref().ok()
    };
    let special = observed.and_then(|observed| {
        let is_short = problem.check_size(&observed.stack).is_ok();
        let worked_out = || problem.constants(observed).ok();
        if is_short { worked_out() } else { plant.arena.budget().share(SHARE_OF_REMARKS, worked_out) }
    });
    let coincide = || observed.is_some_and(|observed| problem.may_coincide(&observed.stack));
    let (constants, all) = special.unwrap_or_default();
    let parameters = all && !coincide();
    let domain = &assuming(domain, &constants, &[]);
    let problem = problem.on(domain);
    let mut list = List::new(&problem, &[]);
    match (&constant, by_itself) {
        (Ok(observed), Some(true)) => problem.under_constant_inputs(observed, &constants, &mut list),
        (_, Some(true)) => list.is_complete = false,
        _ => problem.under_excitation(constant.as_ref().ok(), observed, &mut list),
    }
    let is_all = match &constant {
        _ if inputs == Still::Nothing => true,
        Ok(_) if by_itself == Some(true) => {
            plant.arena.budget().share(SHARE_OF_REMARKS, || problem.holds_under_any_inputs(&mut list)).unwrap_or(false)
        }
        _ => false,
    };
    let everywhere = list.is_complete;
    let blind = list.statements();
    let courses = if is_all { InputCourses::All } else { InputCourses::Constant };
    (Trajectories { by_itself, courses, at_rest: false, blind, everywhere, parameters }, constants)
}

/// A domain on which these are not zero, and these are positive.
pub(super) fn assuming(domain: &Domain, nonzero: &[Expr], positive: &[Expr]) -> Domain {
    let mut domain = domain.clone();
    let nonzero = nonzero.iter().map(|expr| (*expr, Relation::NonZero));
    for (expr, relation) in nonzero.chain(positive.iter().map(|expr| (*expr, Relation::Positive))) {
        domain.facts.assume(expr, relation);
    }
    domain
}

impl ObservabilityProblem<'_> {
    /// Tests whether unknowns that are identifiable while all inputs are constant provably are so for every course of the
    /// inputs, but on listed trajectories: a course may cancel what the rows of constant ones show. Where the rows of free
    /// inputs lose rank, no derivative of an input decides, which would be an equation for its course.
    fn holds_under_any_inputs(&self, list: &mut List<'_>) -> Result<bool, Obstacle> {
        let (free, nothing) = (self.whole(Still::Nothing), BTreeSet::new());
        let zero_set = self.zero_set(self.domain, &self.solve_along(self.domain, &nothing)?)?;
        let is_declared = |zero: &Expr| self.plant.arena.symbols_of(&[*zero]).iter().all(|s| self.plant.declares(*s));
        if !zero_set.all || !zero_set.zeros.iter().all(is_declared) {
            return Ok(false);
        }
        for zero in zero_set.zeros {
            if !list.add_zero(&free, zero, &nothing)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Adds the trajectories that hide unknowns which are identifiable while all inputs are constant: with inputs that
    /// move, or with constant ones.
    fn under_constant_inputs(&self, observed: &Observation, conditions: &[Expr], list: &mut List<'_>) {
        let Ok(zero_set) = self.zero_set(self.domain, observed) else {
            list.is_complete = false;
            return;
        };
        let (free, steady) = (self.whole(Still::Nothing), self.whole(self.inputs()));
        let held = self.held(&steady.condition.still);
        list.is_complete &= zero_set.all;
        for zero in zero_set.zeros {
            if free.condition != steady.condition {
                // What is undecided there is so with constant inputs too.
                let _ = list.add_zero(&free, zero, &BTreeSet::new());
            }
            match list.add_zero(&steady, zero, &held) {
                Ok(is_complete) => list.is_complete &= is_complete,
                Err(_) if self.may_remain(zero, &held) => list.leave_open(&free, Some(zero)),
                Err(_) => list.is_complete = false,
            }
        }
        for zero in zero_set.constants.into_iter().filter(|zero| !conditions.contains(zero)) {
            let families = self.at_zero(&steady, zero, &held).unwrap_or_default();
            for family in &families {
                list.add(family);
            }
        }
    }

    /// Adds the trajectories that hide unknowns which are identifiable under excitation, as far as rows with constant
    /// inputs and rows of full rank show them.
    fn under_excitation(&self, constant: Option<&Observation>, full: Option<&Observation>, list: &mut List<'_>) {
        let arena = &self.plant.arena;
        list.is_complete = false;
        let mut restrict = |still: Still, observed: Option<Observation>| {
            let Some(observed) = observed else { return };
            list.add(&Family { set: self.whole(still), observed, moves: true });
        };
        let inputs: Vec<Symbol> = self.plant.commanded().collect();
        let solved = |still: &Still| self.solve_along(self.domain, &self.held(still)).ok();
        for still in std::iter::once(self.inputs()).chain(inputs.iter().map(|input| Still::Inputs(vec![*input]))) {
            let observed = solved(&still);
            restrict(still, observed);
        }
        let mut zeros: Vec<Expr> = Vec::new();
        for (index, one) in inputs.iter().enumerate() {
            let others = inputs[index + 1..].iter();
            zeros.extend(others.map(|other| arena.sub(arena.of_symbol(*one), arena.of_symbol(*other))));
        }
        let rows = [self.rows(), constant.map(|observed| observed.stack.clone()).unwrap_or_default()].concat();
        zeros.extend(self.zeros_of_entries(&rows).unwrap_or_default());
        let mut of_determinant = full.and_then(|full| self.zero_set(self.domain, full).ok()).unwrap_or_default().zeros;
        of_determinant.retain(|zero| arena.symbols_of(&[*zero]).iter().all(|symbol| self.plant.declares(*symbol)));
        zeros.retain(|zero| !of_determinant.contains(zero));
        let (free, nothing) = (self.whole(Still::Nothing), BTreeSet::new());
        for zero in zeros.iter().chain(&of_determinant) {
            if list.add_zero(&free, *zero, &nothing).is_ok() {
                continue;
            }
            let remains = of_determinant.contains(zero) && self.may_remain(*zero, &nothing);
            if remains || self.hides_an_unknown(*zero) {
                list.leave_open(&free, Some(*zero));
            }
        }
    }
}
