//! The list of the trajectories that hide unknowns, none of which follows from another.

use std::collections::BTreeSet;

use crate::analysis::design::{BlindTrajectory, Still, TrajectoryCondition};
use crate::plant::Plant;
use pebo_cas::domain::cells::Side;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy::operations_of;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Relation, Symbol};

use super::family::{Family, Set};
use crate::analysis::identifiability::flow::varies;
use crate::analysis::identifiability::problem::ObservabilityProblem;

/// Operations of a condition up to which it is named where nothing was decided: in a longer one a reader finds nothing.
const MOST_READ: usize = 60;

/// Statements on trajectories.
pub(in crate::analysis::identifiability) struct List<'a> {
    problem: &'a ObservabilityProblem<'a>,
    /// Statements on other domains, which hold here too.
    known: &'a [BlindTrajectory],
    found: Vec<(BlindTrajectory, Domain)>,
    /// True if there are no others.
    pub(super) is_complete: bool,
}

impl<'a> List<'a> {
    pub(in crate::analysis::identifiability) fn new(
        problem: &'a ObservabilityProblem<'a>,
        known: &'a [BlindTrajectory],
    ) -> Self {
        Self { problem, known, found: Vec::new(), is_complete: true }
    }

    /// Adds a family that hides unknowns, unless a statement holds it; and the trajectories in it that hide more.
    pub(super) fn add(&mut self, family: &Family) {
        if !family.observed.is_full() && !self.covers(family) {
            let Set { domain, condition } = &family.set;
            self.state(self.problem.on(domain).blind(condition.clone(), &family.observed), domain.clone());
            self.refine(family);
        }
    }

    /// Adds the trajectories of a family that hide more than it does, for a list that is complete so far.
    pub(super) fn refine(&mut self, family: &Family) {
        if !self.is_complete {
            return;
        }
        let zero_set = self.problem.zero_set(&family.set.domain, &family.observed).unwrap_or_default();
        self.is_complete &= zero_set.all;
        let held = self.problem.held(&family.set.condition.still);
        for zero in zero_set.zeros.into_iter().chain(zero_set.constants) {
            match self.add_zero(&family.set, zero, &held) {
                Ok(is_complete) => self.is_complete &= is_complete,
                Err(_) if self.problem.may_remain(zero, &held) && self.problem.may_hide_more(family, zero) => {
                    self.leave_open(&family.set, Some(zero));
                }
                Err(_) => self.is_complete = false,
            }
        }
    }

    /// Adds the trajectories of a set that hide unknowns while an expression is zero; those at which nothing moves only
    /// if inputs alone decide that, since equilibria are worked out as such. True if these are all.
    pub(in crate::analysis::identifiability) fn add_zero(
        &mut self,
        set: &Set,
        zero: Expr,
        held: &BTreeSet<Symbol>,
    ) -> Result<bool, Obstacle> {
        let mut families = self.problem.at_zero(set, zero, held)?;
        // Components that hide the same are one set.
        let is_one = families.len() > 1 && families.iter().all(|family| family.hides_as(&families[0]));
        let is_stated = match set.condition.still {
            Still::Nothing => self.problem.is_of_inputs(zero),
            Still::Inputs(_) => false,
            Still::Plant => true,
        };
        families.retain(|family| family.moves || is_stated);
        match families.first() {
            Some(first) if is_one => {
                let mut whole = set.clone();
                whole.domain = self.problem.also(&set.domain, &[zero]);
                whole.condition.zeros.push(zero);
                let observed = first.observed.clone();
                self.add(&Family { set: whole, observed, moves: first.moves });
            }
            _ => {
                for family in &families {
                    self.add(family);
                }
            }
        }
        // Zeros within one that identifies all unknowns were not worked out.
        Ok(families.iter().all(|family| !family.observed.is_full()))
    }

    /// Adds a statement in place of those that follow from it.
    pub(super) fn state(&mut self, blind: BlindTrajectory, domain: Domain) {
        let plant = self.problem.plant;
        self.found.retain(|(other, there)| {
            other.hidden.len() != blind.hidden.len() || !blind.condition.holds_on(plant, &other.condition.still, there)
        });
        self.found.push((blind, domain));
    }

    /// Adds that it is undecided what is identified on a set.
    pub(in crate::analysis::identifiability) fn leave_open(&mut self, set: &Set, zero: Option<Expr>) {
        let mut condition = set.condition.clone();
        condition.zeros.extend(zero);
        if operations_of(&self.problem.plant.arena, &condition.zeros) > MOST_READ {
            self.is_complete = false;
            return;
        }
        let is_known = |blind: &BlindTrajectory| !blind.is_decided() && blind.condition.zeros == condition.zeros;
        if self.known.iter().any(is_known) {
            return;
        }
        if self.found.iter().any(|(blind, _)| blind.is_decided() && blind.condition == condition) {
            // What is decided of all trajectories there is open for some of them.
            self.is_complete = false;
            return;
        }
        self.state(BlindTrajectory::undecided(condition), set.domain.clone());
    }

    /// Tests whether what is hidden on a family is stated: of all of it, or of the cells into which others divide it.
    pub(super) fn covers(&self, family: &Family) -> bool {
        let Set { domain, condition } = &family.set;
        let is_same = |blind: &&BlindTrajectory| blind.hidden.len() == family.observed.hidden.len();
        let all: Vec<&TrajectoryCondition> = self.all().filter(is_same).map(|blind| &blind.condition).collect();
        let mut dividers: Vec<Expr> = all.iter().flat_map(|other| &other.sides).map(|(divider, _)| *divider).collect();
        dividers.sort_unstable();
        dividers.dedup();
        !family.observed.is_full() && self.are_covering(&all, &dividers, &condition.still, domain)
    }

    /// Tests whether one of the conditions holds on each of the cells of a domain.
    fn are_covering(&self, all: &[&TrajectoryCondition], dividers: &[Expr], still: &Still, domain: &Domain) -> bool {
        let arena = &self.problem.plant.arena;
        if all.iter().any(|condition| condition.holds_on(self.problem.plant, still, domain)) {
            return true;
        }
        let Some((divider, others)) = dividers.split_first() else { return false };
        let mut parts: Vec<Domain> = Vec::new();
        for side in [Side::Positive, Side::Negative] {
            let positive = side.positive(arena, *divider);
            if !domain.implies(arena, arena.neg(positive), Relation::NonNegative) {
                let mut part = domain.clone();
                part.facts.assume(positive, Relation::Positive);
                parts.push(part);
            }
        }
        if !domain.implies(arena, *divider, Relation::NonZero) {
            parts.push(self.problem.also(domain, &[*divider]));
        }
        parts.iter().all(|part| self.are_covering(all, others, still, part))
    }

    fn all(&self) -> impl Iterator<Item = &BlindTrajectory> {
        self.known.iter().chain(self.found.iter().map(|(blind, _)| blind))
    }

    /// The statements: those that are decided first.
    pub(in crate::analysis::identifiability) fn statements(self) -> Vec<BlindTrajectory> {
        let (decided, open): (Vec<_>, Vec<_>) =
            self.found.into_iter().map(|(blind, _)| blind).partition(BlindTrajectory::is_decided);
        [decided, open].concat()
    }
}

impl TrajectoryCondition {
    /// Tests whether it holds throughout a domain while these do not move.
    fn holds_on(&self, plant: &Plant, still: &Still, domain: &Domain) -> bool {
        let arena = &plant.arena;
        let is_still = match (&self.still, still) {
            (Still::Nothing, _) | (_, Still::Plant) => true,
            (Still::Inputs(own), _) => {
                let inputs = if let Still::Inputs(inputs) = still { inputs.as_slice() } else { &[] };
                let values = domain.manifold.determined();
                let has_value = |input: &Symbol| values.get(input).is_some_and(|value| !varies(plant, *value));
                own.iter().all(|input| inputs.contains(input) || has_value(input))
            }
            (Still::Plant, _) => false,
        };
        is_still
            && self.zeros.iter().all(|zero| is_zero(arena, *zero, domain))
            && self
                .sides
                .iter()
                .all(|(divider, side)| domain.implies(arena, side.positive(arena, *divider), Relation::Positive))
    }
}

impl BlindTrajectory {
    /// Tests whether it is decided what is identified.
    pub(super) fn is_decided(&self) -> bool {
        !self.hidden.is_empty()
    }
}
