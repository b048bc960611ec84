//! The observability problem on a set of trajectories: the directions of the unknowns that no derivative of the rows
//! observes.

use std::collections::BTreeSet;

use crate::analysis::design::{BlindTrajectory, Cascade, Regression, Still, TrajectoryCondition};
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

/// The observations of the rows with their derivatives on a trajectory.
#[derive(Clone)]
pub(super) struct Observation {
    /// Rows of the same rank as all derivatives.
    pub(super) stack: Vec<Vec<Expr>>,
    /// Directions that are unobservable in them.
    pub(super) hidden: Vec<Vec<Expr>>,
}

impl Observation {
    /// Tests whether all unknowns are identifiable.
    pub(super) fn is_full(&self) -> bool {
        self.hidden.is_empty()
    }
}

impl TrajectoryProblem<'_> {
    /// Solves the problem on the trajectories that remain in a domain while these signals are constant.
    pub(super) fn solve(&self, domain: &Domain, held: &BTreeSet<Symbol>) -> Result<Observation, Obstacle> {
        let &Self { plant, cascade, regression, unknowns, .. } = self;
        let arena = &plant.arena;
        let mut flow = Flow::along(plant, domain, cascade, held)?;
        let mut latest = effective(arena, domain, &flow, &regression.phi_1, &regression.primitive_1);
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

    /// The signals that are constant.
    pub(super) fn held(&self, still: &Still) -> BTreeSet<Symbol> {
        match still {
            Still::Nothing => BTreeSet::new(),
            Still::Inputs(inputs) => inputs.iter().copied().collect(),
            Still::Plant => self.signals_at_rest(),
        }
    }

    /// All inputs, if there are any.
    pub(in crate::analysis::identifiability) fn inputs(&self) -> Still {
        let inputs: Vec<Symbol> = self.plant.commanded().collect();
        if inputs.is_empty() { Still::Nothing } else { Still::Inputs(inputs) }
    }

    /// The signals that are constant at rest. With them the states are, and so is the input of a plain extension.
    fn signals_at_rest(&self) -> BTreeSet<Symbol> {
        let &Self { plant, cascade, .. } = self;
        let rates: Vec<Expr> = plant.rates().into_values().collect();
        let outputs = plant.y.iter().map(|output| output.symbol);
        let extension = plant.chi.iter().copied().filter(|_| cascade.lambda.is_none());
        let disturbances = plant.arena.symbols_of(&rates).into_iter().filter(|symbol| plant.w.contains(symbol));
        let constant = plant.commanded().chain(outputs).chain(extension).chain(disturbances);
        constant.filter(|symbol| plant.time != Some(*symbol)).collect()
    }

    /// The statement on trajectories that hide unknowns.
    pub(super) fn blind(&self, condition: TrajectoryCondition, observed: &Observation) -> BlindTrajectory {
        let symbols = if self.regression.is_linear(self.plant) { &self.plant.z } else { &self.regression.eta_symbols };
        let identifiable = identifiable(&self.plant.arena, symbols, &observed.hidden);
        BlindTrajectory { condition, identifiable, hidden: observed.hidden.clone() }
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
