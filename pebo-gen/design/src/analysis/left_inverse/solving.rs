//! Solves the transform for the states.
//!
//! In: the plant. Out: for each solved state one formula in z and y: a right one where there is one, else the
//! likeliest. The caller proves that it is right.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use crate::plant::{Plant, State};
use pebo_cas::forms::opaque::OpaqueTerms;
use pebo_cas::forms::tidy::{dissolves, functions, operations, root_differences, shortest};
use pebo_cas::solve::{Equation, solve};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::cellwise::on_cells;
use super::checking::{check, open_conditions};
use super::equations::{equations, states};
use super::overdetermined::by_least_squares;

type StateFormulas = BTreeMap<Symbol, Vec<Expr>>;

/// A formula for each state that one was found for.
pub(super) fn formulas<'a>(plant: &'a Plant, domain: &Domain) -> Result<Vec<(&'a State, Expr)>, Obstacle> {
    let solving = StateSolver::of(plant, domain)?;
    let formula = |state: &'a State| Ok(solving.formula(state.symbol)?.map(|formula| (state, formula)));
    plant.x.iter().filter_map(|state| formula(state).transpose()).collect()
}

/// The transform, solved in several ways.
struct StateSolver<'a> {
    plant: &'a Plant,
    domain: &'a Domain,
    /// Solutions of the transform alone, the likelier first.
    alone: StateFormulas,
    /// Solutions with functions of y alone kept as written: they compute better.
    as_written: StateFormulas,
    /// Least-squares solutions, computed on first use.
    least_squares: OnceCell<BTreeMap<Symbol, Expr>>,
    /// Solutions of the transform with the values of outputs, computed on first use.
    with_outputs: OnceCell<Result<StateFormulas, Obstacle>>,
    /// Solutions on each cell of the domain, joined, computed on first use.
    on_cells: OnceCell<BTreeMap<Symbol, Expr>>,
}

impl<'a> StateSolver<'a> {
    fn of(plant: &'a Plant, domain: &'a Domain) -> Result<Self, Obstacle> {
        let arena = &plant.arena;
        let states = states(plant);
        // If a class proposes a formula for every state, nothing is solved for.
        let proposed = |state: &Symbol| plant.proposal.phi_left.iter().any(|(own, _)| own == state);
        let alone = if states.iter().all(proposed) {
            BTreeMap::new()
        } else {
            solve(arena, domain, &equations(plant, plant.transform()), &states)?
        };
        let hidden = plant.hidden();
        let mut frozen = OpaqueTerms::new(arena, &hidden);
        let kept = frozen.replace(&plant.transform());
        let mut as_written = if alone.is_empty() || frozen.is_empty() {
            BTreeMap::new()
        } else {
            solve(arena, domain, &equations(plant, kept), &states).unwrap_or_default()
        };
        for formula in as_written.values_mut().flatten() {
            *formula = frozen.restore(*formula);
        }
        let (least_squares, with_outputs, on_cells) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Ok(Self { plant, domain, alone, as_written, least_squares, with_outputs, on_cells })
    }

    /// The best formula for a state that is right, and else the likeliest: a wrong one may still prove that the
    /// transform is not one-to-one.
    fn formula(&self, state: Symbol) -> Result<Option<Expr>, Obstacle> {
        let arena = &self.plant.arena;
        let right = |formula: &Expr| check(self.plant, self.domain, state, *formula).1.is_zero();
        let candidates = self.candidates(state);
        let found = match self.by_worth(candidates.clone()).into_iter().find(right) {
            Some(found) => Some(found),
            // The value of an output comes with its noise: it is used where the transform alone is not solved.
            None => self.with_values(state)?.into_iter().find(right),
        };
        let found = found.or_else(|| {
            let joined = self.on_cells.get_or_init(|| on_cells(self.plant, self.domain));
            joined.get(&state).copied()
        });
        let written = self.as_written.get(&state).into_iter().flatten().copied().filter(right);
        // A formula that has a value wherever the plant has ends the search.
        let is_total = found.is_some_and(|formula| open_conditions(self.plant, self.domain, formula).is_empty());
        let squares = (!is_total).then(|| self.least_squares.get_or_init(|| self.by_least_squares()));
        let squares = squares.and_then(|squares| squares.get(&state)).copied().filter(right);
        let forms =
            found.into_iter().chain(written).chain(squares).map(|formula| shortest(arena, self.domain, formula));
        let formula = match forms.min_by_key(|formula| self.demerit(*formula)) {
            Some(formula) => Some(formula),
            None => match candidates.first() {
                Some(likeliest) => Some(*likeliest),
                None => self.with_values(state)?.first().copied(),
            },
        };
        Ok(formula.map(|formula| shortest(arena, self.domain, formula)))
    }

    /// Least-squares solutions: for all states, or else for those beside others that have a formula with a value wherever
    /// the plant has.
    fn by_least_squares(&self) -> BTreeMap<Symbol, Expr> {
        let whole = by_least_squares(self.plant, self.domain, &BTreeMap::new());
        if !whole.is_empty() {
            return whole;
        }
        let is_right = |state: Symbol, formula: Expr| {
            open_conditions(self.plant, self.domain, formula).is_empty()
                && check(self.plant, self.domain, state, formula).1.is_zero()
        };
        let formula = |state: Symbol| {
            let found = self.by_worth(self.candidates(state)).into_iter().find(|formula| is_right(state, *formula));
            found.map(|formula| (state, formula))
        };
        let known = self.plant.x.iter().filter_map(|state| formula(state.symbol)).collect();
        by_least_squares(self.plant, self.domain, &known)
    }

    /// The proposals of the class, the shortest first, and the solutions of the transform alone.
    fn candidates(&self, state: Symbol) -> Vec<Expr> {
        let arena = &self.plant.arena;
        let proposed = self.plant.proposal.phi_left.iter().filter(|(own, _)| *own == state);
        let mut candidates: Vec<Expr> = proposed.map(|(_, formula)| shortest(arena, self.domain, *formula)).collect();
        candidates.sort_by_cached_key(|formula| operations(arena, *formula));
        candidates.extend(self.alone.get(&state).into_iter().flatten());
        candidates
    }

    /// The solutions of the transform with the values of outputs, the best first.
    fn with_values(&self, state: Symbol) -> Result<Vec<Expr>, Obstacle> {
        let solved =
            self.with_outputs.get_or_init(|| with_outputs(self.plant, self.domain)).as_ref().map_err(Clone::clone)?;
        Ok(self.by_worth(solved.get(&state).cloned().unwrap_or_default()))
    }

    /// Sorts formulas: first those with a value wherever the plant has, then those without a root that cancels, then
    /// short ones.
    fn by_worth(&self, mut candidates: Vec<Expr>) -> Vec<Expr> {
        // Domain conditions are computed only for a comparison.
        if candidates.len() > 1 {
            candidates.sort_by_cached_key(|formula| self.cost(*formula));
        }
        candidates
    }

    /// As [`Self::by_worth`], and before the roots the author's functions: `z/tanh(y)`, and nothing in exponentials.
    fn demerit(&self, formula: Expr) -> (usize, usize, usize, usize) {
        let arena = &self.plant.arena;
        let own = functions(arena, &self.plant.transform());
        let z = self.plant.z.iter().copied().collect();
        let is_foreign = |call: &Expr| !own.contains(call) && arena.symbols_of(&[*call]).is_disjoint(&z);
        let foreign = functions(arena, &[formula]).into_iter().filter(is_foreign).count()
            + usize::from(dissolves(arena, &self.plant.transform(), formula));
        let (open_conditions, cancelling, operations) = self.cost(formula);
        (open_conditions, foreign, cancelling, operations)
    }

    /// The number of open domain conditions, of roots that cancel, and of operations.
    fn cost(&self, formula: Expr) -> (usize, usize, usize) {
        let arena = &self.plant.arena;
        let open_conditions = open_conditions(self.plant, self.domain, formula).len();
        (open_conditions, root_differences(arena, formula).len(), operations(arena, formula))
    }
}

/// Solves the transform with the identities; returns the functions of z and y among the solutions.
fn with_outputs(plant: &Plant, domain: &Domain) -> Result<StateFormulas, Obstacle> {
    if plant.identities.is_empty() {
        return Ok(BTreeMap::new());
    }
    let arena = &plant.arena;
    let zero = arena.zero();
    let mut equations = equations(plant, plant.transform());
    equations.extend(plant.identities.iter().map(|identity| Equation { formula: identity.expr, value: zero }));
    let mut foreign = plant.hidden();
    foreign.extend(&plant.u);
    let mut solved = solve(arena, domain, &equations, &states(plant))?;
    for candidates in solved.values_mut() {
        candidates.retain(|formula| !arena.depends_on(*formula, &foreign));
    }
    Ok(solved)
}
