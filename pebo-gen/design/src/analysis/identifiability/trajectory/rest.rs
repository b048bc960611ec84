//! Identifiability at equilibria.
//!
//! In: a regression whose unknowns are identifiable with all inputs constant. Out: added to its trajectories, the
//! identifiability on each component of the equilibria, cut into the cells on which the rows are analytic. An
//! equilibrium is a point at which every rate vanishes. "At rest" is a statement on points that were found: with no
//! equilibrium, or none that was found, nothing is said.

use std::collections::BTreeSet;

use crate::analysis::design::{BlindTrajectory, Cascade, Regression, Trajectories, TrajectoryCondition};
use crate::plant::Plant;
use pebo_cas::domain::cells::Side;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::family::Family;
use super::problem::{Observation, Restriction, SHARE_OF_REMARKS, TrajectoryProblem, identifiable};

/// Adds to the trajectories of a regression those at equilibria.
pub(in crate::analysis::identifiability) fn add(
    trajectories: &mut Trajectories,
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
) {
    // With constant inputs as much is hidden as at an equilibrium, or less.
    let constant = |blind: &BlindTrajectory| {
        let condition = match &blind.condition {
            TrajectoryCondition::Within(_, condition) => condition.as_ref(),
            _ => &blind.condition,
        };
        let is_of_all =
            matches!(condition, TrajectoryCondition::Constant(inputs) if inputs.len() == plant.commanded().count());
        is_of_all.then_some(blind.hidden.len())
    };
    let hidden_anyway = match trajectories.by_itself {
        Some(true) => 0,
        Some(false) => trajectories.blind.iter().filter_map(constant).min().unwrap_or(0),
        None => return,
    };
    let problem = TrajectoryProblem { plant, domain, cascade, regression, unknowns: regression.eta.len() };
    let held = problem.signals_at_rest();
    let rest = plant.arena.budget().share(SHARE_OF_REMARKS, || match problem.families(&held) {
        Ok(families) => problem.joined(&families, &trajectories.blind, &held),
        Err(_) => problem.at_constant_signals(&held),
    });
    trajectories.at_rest = rest.identified && trajectories.by_itself == Some(true);
    trajectories.everywhere &= rest.all || !rest.identified;
    let of_undecided = |blind: &BlindTrajectory| match &blind.condition {
        TrajectoryCondition::Undecided(zero) => Some(vec![*zero]),
        TrajectoryCondition::UndecidedAtRest(zeros) => Some(zeros.clone()),
        _ => None,
    };
    let known: Vec<Vec<Expr>> = trajectories.blind.iter().filter_map(of_undecided).collect();
    // What holds throughout a cell holds at its equilibria.
    let cells: Vec<_> =
        trajectories.blind.iter().filter_map(|blind| Some((cell_of(blind)?.clone(), blind.hidden.len()))).collect();
    let is_known = |sides: &[(Expr, Side)], blind: &BlindTrajectory| {
        cells.iter().any(|(cell, hidden)| cell.as_slice() == sides && *hidden == blind.hidden.len())
    };
    let is_new = |blind: &BlindTrajectory| {
        of_undecided(blind).is_none_or(|zero| !known.contains(&zero))
            && within(blind).is_none_or(|sides| !is_known(sides, blind))
            && (hidden_anyway == 0 || blind.hidden.len() > hidden_anyway)
    };
    let (undecided, hidden): (Vec<_>, Vec<_>) =
        rest.blind.into_iter().filter(is_new).partition(|blind| of_undecided(blind).is_some());
    trajectories.blind.splice(0..0, hidden);
    trajectories.blind.extend(undecided);
}

/// The cell of a statement on all of it.
fn cell_of(blind: &BlindTrajectory) -> Option<&Vec<(Expr, Side)>> {
    match &blind.condition {
        TrajectoryCondition::Cell(sides) => Some(sides),
        _ => None,
    }
}

/// The cell of a statement on its equilibria.
fn within(blind: &BlindTrajectory) -> Option<&[(Expr, Side)]> {
    match &blind.condition {
        TrajectoryCondition::Within(sides, _) => Some(sides),
        _ => None,
    }
}

/// The answer at equilibria.
#[derive(Default)]
struct Rest {
    /// True if there are equilibria, and at almost all of them the unknowns are identifiable.
    identified: bool,
    /// True if those at which they are not are listed.
    all: bool,
    blind: Vec<BlindTrajectory>,
}

impl Rest {
    /// Adds a statement, unless another holds it.
    fn add(&mut self, blind: BlindTrajectory) {
        if !self.blind.iter().any(|other| other.covers(&blind)) {
            self.blind.retain(|other| !blind.covers(other));
            self.blind.push(blind);
        }
    }
}

impl TrajectoryProblem<'_> {
    /// The signals that are constant at rest. With them the states are, and so is the input of a plain extension.
    pub(super) fn signals_at_rest(&self) -> BTreeSet<Symbol> {
        let &Self { plant, cascade, .. } = self;
        let rates: Vec<Expr> = plant.rates().into_values().collect();
        let outputs = plant.y.iter().map(|output| output.symbol);
        let extension = plant.chi.iter().copied().filter(|_| cascade.lambda.is_none());
        let disturbances = plant.arena.symbols_of(&rates).into_iter().filter(|symbol| plant.w.contains(symbol));
        let constant = plant.commanded().chain(outputs).chain(extension).chain(disturbances);
        constant.filter(|symbol| plant.time != Some(*symbol)).collect()
    }

    /// The equilibria, by components and cells.
    fn families(&self, held: &BTreeSet<Symbol>) -> Result<Vec<Family>, Obstacle> {
        let arena = &self.plant.arena;
        let mut rates = self.plant.rates();
        rates.retain(|symbol, _| self.plant.time != Some(*symbol));
        let rates: Vec<Expr> = rates.into_values().collect();
        if self.plant.time.is_some_and(|time| arena.symbols_of(&rates).contains(&time)) {
            return Ok(Vec::new());
        }
        self.families_of(self.domain, &rates, held, |_, special| TrajectoryCondition::Equilibrium(special))
    }

    /// The answer of all families. Where they differ, those in a listed trajectory are exceptions that are known.
    fn joined(&self, families: &[Family], listed: &[BlindTrajectory], held: &BTreeSet<Symbol>) -> Rest {
        let is_hidden = |family: &Family| !family.observed.hidden.is_empty();
        let is_same = |family: &Family| family.observed.hidden == families[0].observed.hidden;
        if families.iter().all(|family| is_hidden(family) && is_same(family)) {
            let blind = families.first().map(|family| {
                let condition = match &family.condition {
                    TrajectoryCondition::Within(..) if families.len() == 1 => family.condition.clone(),
                    _ => TrajectoryCondition::Equilibrium(Vec::new()),
                };
                self.blind(condition, &family.observed)
            });
            return Rest { identified: false, all: true, blind: blind.into_iter().collect() };
        }
        // Exceptions need something that they are exceptions of.
        let identified = families.iter().any(|family| !is_hidden(family));
        let mut rest = Rest { identified, all: true, blind: Vec::new() };
        for family in families {
            let cover = self.cover(listed, family);
            if cover.is_some_and(|blind| !blind.hidden.is_empty()) {
                continue;
            }
            if is_hidden(family) {
                rest.identified &= cover.is_some();
                rest.add(self.blind(family.condition.clone(), &family.observed));
                continue;
            }
            let (zeros, all) = self.doubtful_at_rest(&family.domain, &family.observed.stack);
            rest.all &= all;
            for zero in zeros {
                self.add_zero(&mut rest, (zero, family), listed, held);
            }
        }
        rest
    }

    /// Adds the equilibria of a family, on which the unknowns are identifiable, at a zero of its determinant.
    fn add_zero(
        &self,
        rest: &mut Rest,
        (zero, family): (Expr, &Family),
        listed: &[BlindTrajectory],
        held: &BTreeSet<Symbol>,
    ) {
        let Ok(families) =
            self.families_of(&family.domain, &[zero], held, |_, special| TrajectoryCondition::Equilibrium(special))
        else {
            rest.blind.push(BlindTrajectory::undecided(TrajectoryCondition::UndecidedAtRest(vec![zero])));
            return;
        };
        let at_zero = TrajectoryCondition::Equilibrium(vec![zero]);
        for there in families.into_iter().filter(|there| self.cover(listed, there).is_none()) {
            if there.observed.hidden.is_empty() {
                // Zeros within this one were not worked out.
                rest.all = false;
                continue;
            }
            let condition = family.condition.clone().and(&there.condition).and(&at_zero);
            rest.add(self.blind(condition, &there.observed));
        }
    }

    pub(super) fn blind(&self, condition: TrajectoryCondition, observed: &Observation) -> BlindTrajectory {
        let symbols = if self.regression.is_linear(self.plant) { &self.plant.z } else { &self.regression.eta_symbols };
        let identifiable = identifiable(&self.plant.arena, symbols, &observed.hidden);
        BlindTrajectory { condition, identifiable, hidden: observed.hidden.clone() }
    }

    /// A listed trajectory that holds all of a family and hides as many directions, or is undecided.
    fn cover<'a>(&self, listed: &'a [BlindTrajectory], family: &Family) -> Option<&'a BlindTrajectory> {
        listed.iter().find(|blind| {
            let says_as_much = blind.hidden.is_empty() || blind.hidden.len() == family.observed.hidden.len();
            says_as_much && !family.observed.hidden.is_empty() && self.holds_in(blind, family)
        })
    }

    /// The directions that are unobservable with constant signals: at equilibria too, which could not be worked out. If
    /// there are none, equilibria are undecided.
    fn at_constant_signals(&self, held: &BTreeSet<Symbol>) -> Rest {
        let observed = self.solve(&Restriction { held: held.clone(), ..Restriction::default() });
        let blind = match observed {
            Ok(observed) if !observed.hidden.is_empty() => {
                self.blind(TrajectoryCondition::Equilibrium(Vec::new()), &observed)
            }
            _ => BlindTrajectory::undecided(TrajectoryCondition::UndecidedAtRest(Vec::new())),
        };
        Rest { identified: false, all: false, blind: vec![blind] }
    }
}

impl TrajectoryCondition {
    /// The equilibria at which both hold.
    fn and(self, other: &Self) -> Self {
        match (self, other) {
            (Self::Equilibrium(mut zeros), Self::Equilibrium(others)) => {
                let new: Vec<Expr> = others.iter().copied().filter(|zero| !zeros.contains(zero)).collect();
                zeros.extend(new);
                Self::Equilibrium(zeros)
            }
            (Self::Within(mut sides, condition), Self::Within(others, other)) => {
                let new: Vec<_> = others.iter().filter(|side| !sides.contains(side)).copied().collect();
                sides.extend(new);
                Self::Within(sides, Box::new(condition.and(other)))
            }
            (Self::Within(sides, condition), other) => Self::Within(sides, Box::new(condition.and(other))),
            (condition, Self::Within(sides, other)) => Self::Within(sides.clone(), Box::new(condition.and(other))),
            (condition, _) => condition,
        }
    }
}
