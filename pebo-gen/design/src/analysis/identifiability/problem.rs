//! The observability problem: the directions of the unknowns that no derivative of the rows observes.
//!
//! In: a regression on a domain, and signals that are constant. Out: rows of the rank of all derivatives, and the
//! directions that they do not observe. A point proves a rank from below, exact algebra the directions.

use std::collections::BTreeSet;

use crate::analysis::design::{
    BlindTrajectory, Cascade, Determined, LeftInverse, Regression, Still, TrajectoryCondition,
};
use crate::plant::Plant;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::linear::rank::{full_rank, null_vectors, proved_rank};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Symbol};

use super::flow::{Flow, effective, without_psi};
use super::identified;
use super::observation::Observation;

/// The share of the remaining budget for each remark on a verdict: remarks do not use up the budget of the other claims.
pub(super) const SHARE_OF_REMARKS: u64 = 8;

/// Size of the rows with their derivatives up to which remarks do exact algebra on them: directions, determinants.
const MOST_PARTS: usize = 600;

/// The problem of observing the unknowns of a regression on a domain of a plant.
#[derive(Clone, Copy)]
pub(super) struct ObservabilityProblem<'a> {
    pub(super) plant: &'a Plant,
    pub(super) domain: &'a Domain,
    pub(super) cascade: &'a Cascade,
    pub(super) regression: &'a Regression,
    pub(super) left_inverse: Option<&'a LeftInverse>,
}

impl<'a> ObservabilityProblem<'a> {
    /// The problem on another domain.
    pub(super) fn on<'b>(&self, domain: &'b Domain) -> ObservabilityProblem<'b>
    where
        'a: 'b,
    {
        ObservabilityProblem { domain, ..*self }
    }

    /// The number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.regression.eta.len()
    }

    /// Solves the problem on all trajectories, for all values of the parameters or, where these hide more, for the given
    /// ones.
    pub(super) fn solve(&self) -> Result<Observation, Obstacle> {
        self.solve_on(self.domain, &BTreeSet::new(), usize::MAX)
    }

    /// Solves the problem on the trajectories that remain in a domain while these signals are constant, for a remark.
    pub(super) fn solve_along(&self, domain: &Domain, held: &BTreeSet<Symbol>) -> Result<Observation, Obstacle> {
        let observed = self.solve_on(domain, held, MOST_PARTS)?;
        if observed.is_special { Err(Obstacle::NoWitness) } else { Ok(observed) }
    }

    fn solve_on(&self, domain: &Domain, held: &BTreeSet<Symbol>, most_parts: usize) -> Result<Observation, Obstacle> {
        let &Self { plant, cascade, regression, .. } = self;
        let (arena, unknowns) = (&plant.arena, self.unknowns());
        let mut flow = Flow::along(plant, domain, cascade, held)?;
        let mut latest = effective(arena, domain, &flow, &regression.phi_1, &regression.primitive_1);
        let mut stack = without_zeros(arena, domain, without_psi(plant, &latest));
        let mut rank = proved_rank(arena, domain, &stack, unknowns);
        let hidden_from = |stack: &[Vec<Expr>], rank: usize| {
            check_size(plant, stack, most_parts)?;
            hidden_from(arena, domain, stack, unknowns, rank)
        };
        let mut settled = None;
        for _ in 1..unknowns {
            if rank == unknowns {
                break;
            }
            let before = stack.clone();
            latest = flow.rates(arena, &latest)?;
            stack.extend(without_zeros(arena, domain, without_psi(plant, &latest)));
            let next = proved_rank(arena, domain, &stack, unknowns);
            if next == rank {
                // No derivative adds to a rank that one derivative did not raise: by exact algebra, both times.
                let found = hidden_from(&stack, rank)?;
                if found.0.len() == hidden_from(&before, rank)?.0.len() {
                    settled = Some(found);
                    break;
                }
            }
            rank = next;
            flow.advance(plant);
        }
        let (hidden, is_special) = match settled {
            Some(found) => found,
            None if rank == unknowns => (Vec::new(), false),
            // As many derivatives as there are unknowns have the full rank.
            None => hidden_from(&stack, rank)?,
        };
        if hidden.is_empty() && rank < unknowns {
            Err(Obstacle::NoWitness)
        } else {
            Ok(Observation { stack, hidden, is_special })
        }
    }

    /// An obstacle if the rows are too long for the exact algebra of a remark.
    pub(super) fn check_size(&self, stack: &[Vec<Expr>]) -> Result<(), Obstacle> {
        check_size(self.plant, stack, MOST_PARTS)
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
    pub(super) fn inputs(&self) -> Still {
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
        let identifiable =
            identified::combinations(&self.plant.arena, self.domain, (symbols, &self.plant.hidden()), observed);
        // At an equilibrium, or where a formula of states is zero, theta has not any value, and these are those of the set.
        let hidden = self.plant.hidden();
        let is_any = condition.still != Still::Plant
            && !condition.zeros.iter().any(|zero| self.plant.arena.depends_on(*zero, &hidden));
        let is_known = is_any || self.regression.is_linear(self.plant);
        let determined = if is_known { self.determined(&observed.stack) } else { Determined::Nothing };
        BlindTrajectory { condition, identifiable, hidden: observed.hidden.clone(), determined }
    }

    /// What rows of the unknowns determine near almost every value, as the unknowns depend on one another.
    fn determined(&self, stack: &[Vec<Expr>]) -> Determined {
        if !self.regression.is_linear(self.plant) {
            return if self.determines_theta(stack) { Determined::Theta } else { Determined::Nothing };
        }
        let states: Vec<Symbol> =
            self.left_inverse.into_iter().flat_map(|inverse| &inverse.x).map(|(x, _)| *x).collect();
        let phi = self.plant.transform();
        let is_recovered = |symbol: &Symbol| states.contains(symbol) || !self.plant.hidden().contains(symbol);
        if phi.len() <= states.len() || !self.plant.arena.symbols_of(&phi).iter().all(is_recovered) {
            return Determined::Nothing;
        }
        let rows = self.rows_by(stack, &phi, &states);
        let is_full = full_rank(&self.plant.arena, self.domain, &rows, states.len());
        if is_full { Determined::States(states) } else { Determined::Nothing }
    }

    /// Rows of theta near a value of it, by those of the unknowns that are functions of it.
    pub(super) fn rows_of_theta(&self, stack: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
        self.rows_by(stack, &self.regression.eta, &self.plant.theta)
    }

    /// Rows of functions of some symbols as rows of these.
    fn rows_by(&self, stack: &[Vec<Expr>], functions: &[Expr], symbols: &[Symbol]) -> Vec<Vec<Expr>> {
        let arena = &self.plant.arena;
        let slopes = |symbol: &Symbol| functions.iter().map(|of| arena.derivative(*of, *symbol)).collect();
        let slopes: Vec<Vec<Expr>> = symbols.iter().map(slopes).collect();
        stack.iter().map(|row| slopes.iter().map(|slopes| arena.dot(row, slopes)).collect()).collect()
    }

    /// Tests whether rows of functions of theta determine it near almost every value.
    fn determines_theta(&self, stack: &[Vec<Expr>]) -> bool {
        full_rank(&self.plant.arena, self.domain, &self.rows_of_theta(stack), self.plant.theta.len())
    }
}

fn check_size(plant: &Plant, stack: &[Vec<Expr>], most_parts: usize) -> Result<(), Obstacle> {
    if plant.arena.postorder(&stack.concat()).len() > most_parts { Err(Obstacle::TooLarge) } else { Ok(()) }
}

/// Vectors that every row provably annihilates, as formulas in the parameters; where these do not explain the rank that
/// was found, those at the given values of the parameters, and true if they are more.
fn hidden_from(
    arena: &Arena,
    domain: &Domain,
    rows: &[Vec<Expr>],
    columns: usize,
    rank: usize,
) -> Result<(Vec<Vec<Expr>>, bool), Obstacle> {
    let general = null_vectors(arena, domain, rows, columns)?;
    if general.len() + rank == columns || domain.fixed.is_empty() {
        return Ok((general, false));
    }
    let valued: Vec<Vec<Expr>> = rows.iter().map(|row| arena.substitute_all(row, &domain.fixed)).collect();
    let special = null_vectors(arena, &domain.at_given_values(arena), &valued, columns)?;
    let is_special = special.len() > general.len();
    Ok((if is_special { special } else { general }, is_special))
}

/// The rows with zero for entries that vanish on the domain: a normal form may not show that they follow from its
/// equations.
fn without_zeros(arena: &Arena, domain: &Domain, mut rows: Vec<Vec<Expr>>) -> Vec<Vec<Expr>> {
    if !domain.manifold.is_empty() {
        for entry in rows.iter_mut().flatten() {
            if is_zero(arena, *entry, domain) {
                *entry = arena.zero();
            }
        }
    }
    rows
}
