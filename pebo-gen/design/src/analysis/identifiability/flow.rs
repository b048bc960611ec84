//! The flow of the plant with the extension of its observer.
//!
//! In: rates of states and outputs, the cascade, identities. Out: the rate of any formula along the trajectory. Inputs,
//! and signals without an equation, are free functions of time up to the identities: their derivatives are new symbols.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::Cascade;
use crate::plant::Plant;
use pebo_cas::domain::zero::{is_zero, refute};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

/// The factors of the unknowns: `Phi_1`, less the rate of their factors under the derivative.
pub(super) fn effective(
    arena: &Arena,
    domain: &Domain,
    flow: &Flow,
    phi_1: &[Vec<Expr>],
    primitive_1: &[Vec<Expr>],
) -> Vec<Vec<Expr>> {
    let on_domain = |row: &Vec<Expr>| domain.analytic(arena, row);
    let mut rows: Vec<Vec<Expr>> = phi_1.iter().map(on_domain).collect();
    for (row, primitive) in rows.iter_mut().zip(primitive_1.iter().map(on_domain)) {
        for (entry, factor) in row.iter_mut().zip(primitive) {
            *entry = arena.sub(*entry, flow.rate(arena, factor));
        }
    }
    rows
}

/// The rates of the plant with its observer's extension.
pub(super) struct Flow {
    rates: BTreeMap<Symbol, Expr>,
    free: Vec<Symbol>,
    /// Where one of these is zero, an identity does not determine the rate that it was solved for.
    pub(super) divisors: Vec<Expr>,
}

impl Flow {
    pub(super) fn new(plant: &Plant, domain: &Domain, cascade: &Cascade) -> Result<Self, Obstacle> {
        Self::along(plant, domain, cascade, &BTreeSet::new())
    }

    /// The trajectories on which some signals are constant.
    pub(super) fn along(
        plant: &Plant,
        domain: &Domain,
        cascade: &Cascade,
        held: &BTreeSet<Symbol>,
    ) -> Result<Self, Obstacle> {
        let arena = &plant.arena;
        let mut rates = plant.rates();
        match &cascade.lambda {
            None => rates.extend(plant.chi.iter().copied().zip(cascade.h.iter().copied())),
            Some(lambda) => {
                let of = |row: &[Expr], vector: &[Symbol]| {
                    arena.sum(row.iter().zip(vector).map(|(a, b)| arena.mul(*a, arena.of_symbol(*b))))
                };
                for (index, row) in lambda.iter().enumerate() {
                    rates.insert(plant.xi[index], arena.add(of(row, &plant.xi), cascade.h[index]));
                    for column in 0..plant.z.len() {
                        let psi: Vec<Symbol> = plant.psi.iter().map(|r| r[column]).collect();
                        rates.insert(plant.psi[index][column], of(row, &psi));
                    }
                }
            }
        }
        let unruled = plant.y.iter().filter(|o| o.rate.is_none()).map(|o| o.symbol);
        let free = plant.commanded().chain(plant.w.iter().copied()).chain(unruled);
        let free = free.filter(|signal| !held.contains(signal)).collect();
        for rate in rates.values_mut() {
            *rate = domain.analytic(arena, &[*rate])[0];
        }
        rates.extend(held.iter().map(|signal| (*signal, arena.zero())));
        let mut flow = Self { rates, free, divisors: Vec::new() };
        let signals = flow.free.clone();
        flow.advance(plant);
        flow.bind(plant, domain)?;
        flow.keep(plant, domain, &signals);
        Ok(flow)
    }

    /// Gives signals without an equation the rates with which further equations of the domain hold at all times. Where
    /// these determine none, trajectories leave the domain.
    fn keep(&mut self, plant: &Plant, domain: &Domain, signals: &[Symbol]) {
        let arena = &plant.arena;
        for equation in domain.manifold.reduced(arena) {
            let moved = domain.analytic(arena, &[self.rate(arena, equation)])[0];
            let slopes: Vec<Expr> = self.free.iter().map(|derivative| arena.derivative(moved, *derivative)).collect();
            // A zero of one signal is a constant of it, also where the equation has several.
            let alone = only_signal(plant, equation).filter(|signal| signals.contains(signal));
            let by_itself = || slopes.iter().position(|slope| alone.is_some() && !arena.is_zero(*slope));
            let everywhere = || slopes.iter().position(|slope| domain.grants(arena, (*slope, Relation::NonZero)));
            if let Some(index) = by_itself().or_else(everywhere) {
                self.solve(arena, index, moved, slopes[index]);
            }
        }
    }

    /// Gives a signal without an equation the rate that an identity determines, everywhere if there is such a signal: it
    /// is not free then. Undecided bindings are an error, since a rank could be found that no trajectory has.
    fn bind(&mut self, plant: &Plant, domain: &Domain) -> Result<(), Obstacle> {
        let arena = &plant.arena;
        for identity in &plant.identities {
            let moved = self.rate(arena, identity.expr);
            let slopes: Vec<Expr> = self.free.iter().map(|derivative| arena.derivative(moved, *derivative)).collect();
            let everywhere = slopes.iter().position(|slope| domain.grants(arena, (*slope, Relation::NonZero)));
            let somewhere = || slopes.iter().position(|slope| refute(arena, *slope, domain).is_some());
            let bound = everywhere.or_else(somewhere);
            let Some(index) = bound else {
                if slopes.iter().all(|slope| is_zero(arena, *slope, domain)) {
                    continue;
                }
                return Err(Obstacle::Unsolved(arena.print(identity.expr)));
            };
            let slope = slopes[index];
            self.divisors.extend(everywhere.is_none().then_some(slope));
            self.solve(arena, index, moved, slope);
        }
        Ok(())
    }

    /// Solves the rate of an equation for a derivative, in which it is affine.
    fn solve(&mut self, arena: &Arena, index: usize, moved: Expr, slope: Expr) {
        let derivative = self.free.remove(index);
        let rest = arena.substitute(moved, &BTreeMap::from([(derivative, arena.zero())]));
        let value = BTreeMap::from([(derivative, arena.neg(arena.div(rest, slope)))]);
        for rate in self.rates.values_mut() {
            *rate = arena.substitute(*rate, &value);
        }
    }

    /// Gives the latest derivatives of the free signals rates of their own.
    pub(super) fn advance(&mut self, plant: &Plant) {
        let arena = &plant.arena;
        self.free = self
            .free
            .iter()
            .map(|signal| {
                let rate = arena.generated(&format!("{}'", arena.name(*signal)));
                self.rates.insert(*signal, arena.of_symbol(rate));
                rate
            })
            .collect();
    }

    pub(super) fn rate(&self, arena: &Arena, expr: Expr) -> Expr {
        arena.directional(expr, &self.rates)
    }

    /// The rates of the entries of a matrix; none where the budget ends with them, as each may be many times as long as
    /// its entry.
    pub(super) fn rates(&self, arena: &Arena, rows: &[Vec<Expr>]) -> Result<Vec<Vec<Expr>>, Obstacle> {
        let rate = |entry: &Expr| {
            if arena.budget().is_exhausted() { Err(Obstacle::OutOfBudget) } else { Ok(self.rate(arena, *entry)) }
        };
        rows.iter().map(|row| row.iter().map(rate).collect()).collect()
    }
}

/// The regressor with the fundamental matrix at its initial value: being invertible at all times, it takes
/// nothing from the rank.
pub(super) fn without_psi(plant: &Plant, phi_1: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    let arena = &plant.arena;
    let identity: BTreeMap<Symbol, Expr> = plant
        .psi
        .iter()
        .enumerate()
        .flat_map(|(i, row)| row.iter().enumerate().map(move |(j, symbol)| (*symbol, arena.number(i64::from(i == j)))))
        .collect();
    phi_1.iter().map(|row| arena.substitute_all(row, &identity)).collect()
}

/// Tests whether an expression depends on more than the parameters.
pub(super) fn varies(plant: &Plant, expr: Expr) -> bool {
    let is_constant = |symbol| plant.parameters.iter().any(|known| known.symbol == symbol);
    plant.arena.symbols_of(&[expr]).into_iter().any(|symbol| !is_constant(symbol))
}

/// The only signal of an expression, if it has one alone.
pub(super) fn only_signal(plant: &Plant, expr: Expr) -> Option<Symbol> {
    let arena = &plant.arena;
    let mut signals = arena.symbols_of(&[expr]).into_iter().filter(|symbol| varies(plant, arena.of_symbol(*symbol)));
    signals.next().filter(|_| signals.next().is_none())
}
