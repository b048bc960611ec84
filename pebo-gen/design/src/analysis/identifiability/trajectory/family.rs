//! Identifiability on sets of trajectories that equations describe.
//!
//! In: equations that hold at all times, as the rates at equilibria, or an expression that is zero. Out: the points at
//! which they hold, by components, and by the cells on which the rows are analytic, each with its observations.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{BlindTrajectory, TrajectoryCondition};
use crate::analysis::identifiability::flow::Flow;
use pebo_cas::domain::cells::Cell;
use pebo_cas::domain::manifold::Manifold;
use pebo_cas::domain::zero::decide;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Relation, Symbol};

use super::problem::{Observation, Restriction, SHARE_OF_REMARKS, TrajectoryProblem};

/// Trajectories on which the rows are analytic.
pub(super) struct Family {
    pub(super) domain: Domain,
    pub(super) condition: TrajectoryCondition,
    pub(super) observed: Observation,
}

impl TrajectoryProblem<'_> {
    /// The points of a domain at which the equations hold too, by components and cells.
    pub(super) fn families_of(
        &self,
        domain: &Domain,
        equations: &[Expr],
        held: &BTreeSet<Symbol>,
        named: impl Fn(&[Expr], Vec<Expr>) -> TrajectoryCondition,
    ) -> Result<Vec<Family>, Obstacle> {
        let arena = &self.plant.arena;
        let (whole, order) = (domain, self.plant.elimination_order());
        let rows = [&self.regression.phi_1, &self.regression.primitive_1].into_iter().flatten().flatten();
        let formulas = rows.chain(self.cascade.lambda.iter().flatten().flatten()).chain(equations);
        let formulas: Vec<Expr> = formulas.copied().collect();
        let components = domain.components(arena, equations, &formulas, &order)?;
        // What distinguishes a component is not what holds on all of them.
        let reduced: Vec<Vec<Expr>> = components.iter().map(|there| there.domain.manifold.reduced(arena)).collect();
        let hidden = self.plant.hidden();
        let mut families = Vec::new();
        for (cell, own) in components.into_iter().zip(&reduced) {
            let domain = cell.domain.clone();
            let is_own = |equation: &&Expr| !reduced.iter().all(|other| other.contains(*equation));
            let special: Vec<Expr> = own.iter().filter(is_own).copied().collect();
            let sides = cell.distinct_sides(arena, whole);
            // Or the equations by the branches of the cell are all that hold there.
            let within = Domain { manifold: whole.manifold.clone(), ..domain.clone() };
            let branches = within.without_equations().analytic(arena, equations);
            let branches = Manifold::new(arena, &within.facts, branches, order.clone()).reduced(arena);
            let others: Vec<Expr> = special.iter().filter(|equation| !branches.contains(equation)).copied().collect();
            let all_sides = Cell { domain: within.clone(), sides: cell.sides }.distinct_sides(arena, whole);
            let is_shorter = others.len() + all_sides.len() < special.len() + sides.len();
            let (sides, special) = if is_shorter { (all_sides, others) } else { (sides, special) };
            let of_signals: Vec<Expr> =
                special.iter().copied().filter(|equation| !arena.depends_on(*equation, &hidden)).collect();
            // Where these leave one component, the unmeasured states follow from them.
            let determined = [equations, &of_signals].concat();
            let is_enough = !of_signals.is_empty()
                && within.components(arena, &determined, &[], &order).is_ok_and(|components| components.len() == 1);
            let condition = named(own, if is_enough { of_signals } else { special });
            let determined_by: Vec<Expr> =
                own.iter().copied().chain(sides.iter().map(|(divider, _)| *divider)).collect();
            let condition =
                if sides.is_empty() { condition } else { TrajectoryCondition::Within(sides, Box::new(condition)) };
            let has_point = |domain: &Domain| domain.points(arena, &determined_by).next().is_some();
            let mut domain = domain;
            if !has_point(&domain) {
                // It may be one of other values of the parameters.
                domain.fixed.clear();
                if !has_point(&domain) {
                    return Err(Obstacle::NoPoint);
                }
            }
            let restriction = Restriction { held: held.clone(), ..Restriction::default() };
            let observed = self.solve_on(&domain, &restriction)?;
            families.push(Family { domain, condition, observed });
        }
        Ok(families)
    }

    /// The trajectories on which an expression is zero at all times and not all unknowns are identifiable, with these
    /// signals constant; and true if there are no others. Those that are listed, and those at which the plant rests, are
    /// left out.
    pub(in crate::analysis::identifiability) fn at_zero(
        &self,
        zero: Expr,
        held: &BTreeSet<Symbol>,
        listed: &[BlindTrajectory],
    ) -> Result<(Vec<BlindTrajectory>, bool), Obstacle> {
        let families = self.plant.arena.budget().share(SHARE_OF_REMARKS, || self.invariant(zero, held))?;
        // Zeros within one that identifies all unknowns were not worked out.
        let all = families.iter().all(|family| !family.observed.hidden.is_empty());
        let is_listed = |family: &Family| {
            let says_as_much = |blind: &&BlindTrajectory| blind.hidden.len() == family.observed.hidden.len();
            listed.iter().filter(says_as_much).any(|blind| self.holds_in(blind, family))
        };
        let hidden = families.into_iter().filter(|family| !family.observed.hidden.is_empty() && !is_listed(family));
        let mut found: Vec<BlindTrajectory> = Vec::new();
        for blind in hidden.map(|family| self.blind(family.condition, &family.observed)) {
            if !found.iter().any(|other| other.covers(&blind)) {
                found.retain(|other| !blind.covers(other));
                found.push(blind);
            }
        }
        Ok((found, all))
    }

    /// Tests whether the condition of a listed trajectory holds throughout a family.
    pub(super) fn holds_in(&self, listed: &BlindTrajectory, family: &Family) -> bool {
        let arena = &self.plant.arena;
        let vanishes = |zero: Expr| decide(arena, zero, &family.domain).is_zero();
        match &listed.condition {
            TrajectoryCondition::Value(symbol, value) | TrajectoryCondition::Steady(symbol, value) => {
                vanishes(arena.sub(arena.of_symbol(*symbol), *value))
            }
            TrajectoryCondition::Undecided(zero) => vanishes(*zero),
            TrajectoryCondition::Zero(zeros) => zeros.iter().all(|zero| vanishes(*zero)),
            TrajectoryCondition::Cell(sides) => sides.iter().all(|(divider, side)| {
                family.domain.implies(arena, side.positive(arena, *divider), Relation::Positive)
            }),
            _ => false,
        }
    }

    /// The same trajectories by families: the largest invariant set on which the expression is zero. It vanishes with
    /// its rates there.
    fn invariant(&self, zero: Expr, held: &BTreeSet<Symbol>) -> Result<Vec<Family>, Obstacle> {
        let &Self { plant, cascade, domain, .. } = self;
        let arena = &plant.arena;
        let known = domain.manifold.reduced(arena);
        let declared = |symbol: Symbol| plant.is_of_extension(symbol) || plant.declares(symbol);
        // The rate of an input that is zero at all times is zero too.
        let is_implied = |equation: Expr, own: &[Expr]| {
            own.len() > 1 && arena.as_symbol(equation).is_some_and(|symbol| !declared(symbol))
        };
        let named = |own: &[Expr], _| {
            let own = own.iter().copied().filter(|equation| !known.contains(equation));
            let own: Vec<Expr> = own.collect();
            TrajectoryCondition::Zero(own.iter().copied().filter(|equation| !is_implied(*equation, &own)).collect())
        };
        let mut open = vec![(domain.clone(), vec![zero])];
        let mut found = Vec::new();
        for _ in 0..=plant.x.len() + plant.y.len() {
            for (domain, equations) in std::mem::take(&mut open) {
                for family in self.families_of(&domain, &equations, held, named)? {
                    let there = &family.domain;
                    let flow = Flow::along(plant, there, cascade, held, &BTreeMap::new())?;
                    let moves = |expr: Expr| {
                        let rate = there.analytic(arena, &[flow.rate(arena, expr)])[0];
                        (!decide(arena, rate, there).is_zero()).then_some(rate)
                    };
                    let rates: Vec<Expr> = there.manifold.reduced(arena).into_iter().filter_map(moves).collect();
                    if !rates.is_empty() {
                        open.push((family.domain, rates));
                    } else if plant.rates().into_keys().any(|signal| moves(arena.of_symbol(signal)).is_some()) {
                        found.push(family);
                    }
                }
            }
        }
        // The rates of as many equations as there are signals determine all others.
        if open.is_empty() { Ok(found) } else { Err(Obstacle::TooLarge) }
    }
}

impl BlindTrajectory {
    /// Tests whether it is a statement on more trajectories of the same kind that says as much as another.
    pub(super) fn covers(&self, other: &Self) -> bool {
        self.hidden.len() == other.hidden.len() && self.condition.holds_where(&other.condition)
    }
}

impl TrajectoryCondition {
    /// Tests whether it has no sign and no zero that the other has not.
    fn holds_where(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Equilibrium(own), Self::Equilibrium(zeros)) | (Self::Zero(own), Self::Zero(zeros)) => {
                own.iter().all(|zero| zeros.contains(zero))
            }
            (Self::Within(own, condition), Self::Within(sides, other)) => {
                own.iter().all(|side| sides.contains(side)) && condition.holds_where(other)
            }
            (condition, Self::Within(_, other)) => condition.holds_where(other),
            _ => false,
        }
    }
}
