//! The observability problem on a trajectory: the directions of the unknowns that no derivative of the rows observes.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{Cascade, Regression};
use crate::analysis::identifiability::flow::{Flow, effective, without_psi};
use crate::plant::Plant;
use pebo_cas::domain::zero::decide;
use pebo_cas::linear::rank::{null_vectors, proved_rank};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Symbol};

/// The share of the remaining budget for each remark on a verdict: remarks do not use up the budget of the other claims.
pub(in crate::analysis::identifiability) const SHARE_OF_REMARKS: u64 = 8;

/// Size of the rows with their derivatives up to which exact algebra is done on them: directions, determinants.
const MOST_PARTS: usize = 600;

/// An observability problem on trajectories of a plant.
pub(in crate::analysis::identifiability) struct TrajectoryProblem<'a> {
    pub(in crate::analysis::identifiability) plant: &'a Plant,
    pub(in crate::analysis::identifiability) domain: &'a Domain,
    pub(in crate::analysis::identifiability) cascade: &'a Cascade,
    pub(in crate::analysis::identifiability) regression: &'a Regression,
    pub(in crate::analysis::identifiability) unknowns: usize,
}

/// The conditions of a trajectory at all times.
#[derive(Default)]
pub(super) struct Restriction {
    /// Signals that do not move.
    pub(super) held: BTreeSet<Symbol>,
    /// Inputs as functions of others.
    pub(super) equal: BTreeMap<Symbol, Expr>,
}

/// The observations of the rows with their derivatives on a trajectory.
pub(super) struct Observation {
    /// Rows of the same rank as all derivatives.
    pub(super) stack: Vec<Vec<Expr>>,
    /// Directions that are unobservable in them.
    pub(super) hidden: Vec<Vec<Expr>>,
}

impl TrajectoryProblem<'_> {
    /// Solves the problem on the trajectories of a restriction.
    pub(super) fn solve(&self, restriction: &Restriction) -> Result<Observation, Obstacle> {
        if restriction.equal.is_empty() {
            return self.solve_on(self.domain, restriction);
        }
        let domain = self.domain.restricted(&self.plant.arena, &restriction.equal).ok_or(Obstacle::NoPoint)?;
        self.solve_on(&domain, restriction)
    }

    /// The same where the trajectories remain in a domain.
    pub(super) fn solve_on(&self, domain: &Domain, restriction: &Restriction) -> Result<Observation, Obstacle> {
        let &Self { plant, cascade, regression, unknowns, .. } = self;
        let arena = &plant.arena;
        let mut flow = Flow::along(plant, domain, cascade, &restriction.held, &restriction.equal)?;
        let there = |rows: &[Vec<Expr>]| -> Vec<Vec<Expr>> {
            rows.iter().map(|row| arena.substitute_all(row, &restriction.equal)).collect()
        };
        let (phi_1, primitive_1) = (there(&regression.phi_1), there(&regression.primitive_1));
        let mut latest = effective(arena, domain, &flow, &phi_1, &primitive_1);
        let mut stack = without_zeros(arena, domain, without_psi(plant, &latest));
        let mut rank = proved_rank(arena, domain, &stack, unknowns);
        let mut hidden = None;
        for _ in 1..unknowns {
            if rank == unknowns {
                break;
            }
            let before = stack.clone();
            latest = flow.rates(arena, &latest)?;
            stack.extend(without_zeros(arena, domain, without_psi(plant, &latest)));
            let next = proved_rank(arena, domain, &stack, unknowns);
            if next == rank {
                self.check_size(&stack)?;
                // No derivative adds to a rank that one derivative did not raise: by exact algebra, both times.
                let vectors = null_vectors(arena, domain, &stack, unknowns)?;
                if vectors.len() == null_vectors(arena, domain, &before, unknowns)?.len() {
                    hidden = Some(vectors);
                    break;
                }
            }
            rank = next;
            flow.advance(plant);
        }
        let hidden = match hidden {
            Some(hidden) => hidden,
            None if rank == unknowns => Vec::new(),
            // As many derivatives as there are unknowns have the full rank.
            None => {
                self.check_size(&stack)?;
                null_vectors(arena, domain, &stack, unknowns)?
            }
        };
        if hidden.is_empty() && rank < unknowns {
            return Err(Obstacle::NoWitness);
        }
        Ok(Observation { stack, hidden })
    }

    /// An obstacle if the rows are too long for exact algebra.
    pub(super) fn check_size(&self, stack: &[Vec<Expr>]) -> Result<(), Obstacle> {
        if self.plant.arena.postorder(&stack.concat()).len() > MOST_PARTS { Err(Obstacle::TooLarge) } else { Ok(()) }
    }

    /// Solves the problem with all inputs constant, and an input or parameter at a value.
    pub(super) fn steady(&self, symbol: Symbol, value: Expr) -> Result<Observation, Obstacle> {
        let held = self.plant.commanded().filter(|input| *input != symbol).collect();
        self.solve(&Restriction { held, equal: BTreeMap::from([(symbol, value)]) })
    }
}

/// The rows with zero for entries that vanish on the domain: a normal form may not show that they follow from its
/// equations.
fn without_zeros(arena: &Arena, domain: &Domain, mut rows: Vec<Vec<Expr>>) -> Vec<Vec<Expr>> {
    if !domain.manifold.is_empty() {
        for entry in rows.iter_mut().flatten() {
            if decide(arena, *entry, domain).is_zero() {
                *entry = arena.zero();
            }
        }
    }
    rows
}

/// The identifiable combinations of the unknowns: those that do not change along the hidden directions. Each direction
/// has a component that is one, and zero in the others.
pub(crate) fn identifiable(arena: &Arena, symbols: &[Symbol], hidden: &[Vec<Expr>]) -> Vec<Expr> {
    let own = |index: usize| {
        (0..symbols.len()).find(|&column| {
            let entry = |(other, vector): (usize, &Vec<Expr>)| {
                vector[column] == if other == index { arena.one() } else { arena.zero() }
            };
            hidden.iter().enumerate().all(entry)
        })
    };
    let free: Vec<Option<usize>> = (0..hidden.len()).map(own).collect();
    let combination = |column: usize| {
        let moved = hidden.iter().zip(&free).filter_map(|(vector, free)| {
            Some(arena.neg(arena.mul(vector[column], arena.of_symbol(symbols[(*free)?]))))
        });
        arena.sum(moved.chain([arena.of_symbol(symbols[column])]))
    };
    (0..symbols.len()).filter(|column| !free.contains(&Some(*column))).map(combination).collect()
}
