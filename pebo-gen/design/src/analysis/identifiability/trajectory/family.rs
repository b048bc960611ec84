//! Identifiability on sets of trajectories that equations describe.
//!
//! In: a set of trajectories, and equations that hold on it at all times. Out: the points at which they hold with their
//! rates, by components, and by the cells on which the rows are analytic, each with its observations.

use std::collections::BTreeSet;

use crate::analysis::design::{Still, TrajectoryCondition};
use crate::analysis::identifiability::flow::{Flow, only_signal};
use pebo_cas::domain::cells::Cell;
use pebo_cas::domain::manifold::Manifold;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Symbol};

use crate::analysis::identifiability::observation::Observation;
use crate::analysis::identifiability::problem::ObservabilityProblem;

/// A set of trajectories: where they remain, and in words.
#[derive(Clone)]
pub(in crate::analysis::identifiability) struct Set {
    pub(in crate::analysis::identifiability) domain: Domain,
    pub(in crate::analysis::identifiability) condition: TrajectoryCondition,
}

/// A set on which the rows are analytic, with what is observed on it.
pub(super) struct Family {
    pub(super) set: Set,
    pub(super) observed: Observation,
    /// True if a state or an output moves.
    pub(super) moves: bool,
}

impl Family {
    /// Tests whether it hides the same as another one.
    pub(super) fn hides_as(&self, other: &Self) -> bool {
        !self.observed.is_full() && self.observed.hidden == other.observed.hidden
    }
}

impl ObservabilityProblem<'_> {
    /// All trajectories of the domain on which these do not move.
    pub(in crate::analysis::identifiability) fn whole(&self, still: Still) -> Set {
        let condition = TrajectoryCondition { still, ..TrajectoryCondition::default() };
        Set { domain: self.domain.clone(), condition }
    }

    /// The equilibria.
    pub(super) fn equilibria(&self) -> Result<Vec<Family>, Obstacle> {
        let mut rates = self.plant.rates();
        rates.retain(|symbol, _| self.plant.time != Some(*symbol));
        let rates: Vec<Expr> = rates.into_values().collect();
        if self.plant.time.is_some_and(|time| self.plant.arena.symbols_of(&rates).contains(&time)) {
            return Ok(Vec::new());
        }
        let held = self.held(&Still::Plant);
        let sets = self.subsets(&self.whole(Still::Plant), &rates, |_, special| special)?;
        sets.into_iter().map(|set| self.observe(set, &held, false)).collect()
    }

    /// The largest sets within a set on which an expression is zero at all times: its rates are zero there too.
    pub(super) fn at_zero(&self, set: &Set, zero: Expr, held: &BTreeSet<Symbol>) -> Result<Vec<Family>, Obstacle> {
        // At most half of what is left, so that others follow.
        self.plant.arena.budget().share(2, || match set.condition.still {
            Still::Plant => {
                let known = [set.condition.zeros.as_slice(), &[zero]].concat();
                let named = |_: &[Expr], special: Vec<Expr>| {
                    let new = special.into_iter().filter(|equation| !known.contains(equation));
                    let mut zeros = set.condition.zeros.clone();
                    zeros.extend(new);
                    zeros.retain(|known| *known != zero);
                    zeros.push(zero);
                    zeros
                };
                let sets = self.subsets(set, &[zero], named)?;
                sets.into_iter().map(|there| self.observe(there, held, false)).collect()
            }
            _ => self.invariant(set, zero, held),
        })
    }

    /// The same for sets of trajectories that move.
    fn invariant(&self, set: &Set, zero: Expr, held: &BTreeSet<Symbol>) -> Result<Vec<Family>, Obstacle> {
        let &Self { plant, cascade, .. } = self;
        let arena = &plant.arena;
        let named = |own: &[Expr], _| self.distinct(own);
        let signals: Vec<Symbol> = plant.rates().into_keys().collect();
        let mut open = vec![(set.clone(), vec![zero])];
        let mut found = Vec::new();
        // The rates of as many equations as there are signals determine all others.
        for _ in 0..=signals.len() + plant.u.len() {
            for (set, equations) in std::mem::take(&mut open) {
                for there in self.subsets(&set, &equations, named)? {
                    let domain = &there.domain;
                    let flow = Flow::along(plant, domain, cascade, held)?;
                    let moves = |expr: Expr| {
                        let rate = domain.analytic(arena, &[flow.rate(arena, expr)])[0];
                        (!is_zero(arena, rate, domain)).then_some(rate)
                    };
                    // Where a function of one signal is zero at all times the signal is constant.
                    let reduced = domain.manifold.reduced(arena).into_iter();
                    let signal = |equation| only_signal(plant, equation).map(|signal| arena.of_symbol(signal));
                    let reduced = reduced.flat_map(|equation| [Some(equation), signal(equation)]).flatten();
                    let rates: Vec<Expr> = reduced.filter_map(moves).collect();
                    let is_own = |symbol: &Symbol| plant.declares(*symbol) || plant.is_of_extension(*symbol);
                    if !arena.symbols_of(&rates).iter().all(is_own) {
                        // An equation for the rate of an input, whose own rate is another free function.
                        return Err(Obstacle::Unsolved(arena.print(zero)));
                    }
                    if rates.is_empty() {
                        let moves = signals.iter().any(|signal| moves(arena.of_symbol(*signal)).is_some());
                        found.push(self.observe(there, held, moves)?);
                    } else {
                        open.push((there, rates));
                    }
                }
            }
        }
        if open.is_empty() { Ok(found) } else { Err(Obstacle::TooLarge) }
    }

    /// The points of a domain at which equations hold too.
    pub(super) fn also(&self, domain: &Domain, equations: &[Expr]) -> Domain {
        let all = domain.manifold.equations().iter().chain(equations).copied().collect();
        let manifold = Manifold::new(&self.plant.arena, &domain.facts, all, self.plant.elimination_order());
        Domain { manifold, ..domain.clone() }
    }

    /// Equations none of which follows from the others and the identities: those in unmeasured states follow first.
    fn distinct(&self, equations: &[Expr]) -> Vec<Expr> {
        let (arena, domain) = (&self.plant.arena, self.domain);
        let hidden = self.plant.hidden();
        let mut left: Vec<Expr> = Vec::new();
        for equation in equations.iter().map(|equation| self.without_denominator(*equation)) {
            if !left.contains(&equation) {
                left.push(equation);
            }
        }
        let mut order = left.clone();
        order.sort_by_key(|equation| !arena.depends_on(*equation, &hidden));
        for equation in order {
            let others: Vec<Expr> = left.iter().copied().filter(|other| *other != equation).collect();
            let there = self.also(domain, &others);
            let vanishes =
                || Field::on(arena, &there, &[equation])?.fraction(equation).map(|fraction| fraction.is_zero());
            if there.manifold.reduced(arena).contains(&equation) || vanishes().unwrap_or(false) {
                left = others;
            }
        }
        left
    }

    /// An expression that is zero where a fraction is.
    fn without_denominator(&self, zero: Expr) -> Expr {
        let arena = &self.plant.arena;
        let numerator = || -> Result<Expr, Obstacle> {
            let field = Field::over(arena, &self.domain.facts, &[zero])?;
            let fraction = field.fraction(zero)?;
            let numerator = field.show(&field.of_polynomial(fraction.numerator())?);
            Ok(if fraction.denominator().is_constant() { zero } else { shortest(arena, self.domain, numerator) })
        };
        numerator().unwrap_or(zero)
    }

    /// The observations on a set.
    fn observe(&self, set: Set, held: &BTreeSet<Symbol>, moves: bool) -> Result<Family, Obstacle> {
        let observed = self.solve_along(&set.domain, held)?;
        Ok(Family { set, observed, moves })
    }

    /// The points of a set at which equations hold too, by components and cells: named by all of their equations, or by
    /// those that distinguish a component.
    fn subsets(
        &self,
        set: &Set,
        equations: &[Expr],
        named: impl Fn(&[Expr], Vec<Expr>) -> Vec<Expr>,
    ) -> Result<Vec<Set>, Obstacle> {
        let arena = &self.plant.arena;
        let (whole, order) = (&set.domain, self.plant.elimination_order());
        let rows = [&self.regression.phi_1, &self.regression.primitive_1].into_iter().flatten().flatten();
        let formulas = rows.chain(self.cascade.lambda.iter().flatten().flatten()).chain(equations);
        let formulas: Vec<Expr> = formulas.copied().collect();
        let components = whole.components(arena, equations, &formulas, &order)?;
        // What distinguishes a component is not what holds on all of them.
        let reduced: Vec<Vec<Expr>> = components.iter().map(|there| there.domain.manifold.reduced(arena)).collect();
        let hidden = self.plant.hidden();
        let mut found = Vec::new();
        for (cell, own) in components.into_iter().zip(&reduced) {
            let is_own = |equation: &&Expr| !reduced.iter().all(|other| other.contains(*equation));
            let special: Vec<Expr> = own.iter().filter(is_own).copied().collect();
            let sides = cell.distinct_sides(arena, whole);
            // Or the equations by the branches of the cell are all that hold there.
            let within = Domain { manifold: whole.manifold.clone(), ..cell.domain.clone() };
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
            let zeros = named(own, if is_enough { of_signals } else { special });
            let determined_by: Vec<Expr> =
                own.iter().copied().chain(sides.iter().map(|(divider, _)| *divider)).collect();
            let has_point = |domain: &Domain| domain.points(arena, &determined_by).next().is_some();
            let mut domain = cell.domain;
            if !has_point(&domain) {
                // It may be one of other values of the parameters.
                domain.fixed.clear();
                if !has_point(&domain) {
                    return Err(Obstacle::NoPoint);
                }
            }
            // The equations may hold by the branches of the sides so far.
            let mut all = set.condition.sides.clone();
            all.extend(sides.into_iter().filter(|side| !set.condition.sides.contains(side)));
            let condition = TrajectoryCondition { sides: all, still: set.condition.still.clone(), zeros };
            found.push(Set { domain, condition });
        }
        Ok(found)
    }
}
