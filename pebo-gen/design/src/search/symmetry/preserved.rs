//! The formulas that a symmetry preserves, and linear conditions on it.

use std::collections::BTreeSet;

use pebo_cas::domain::zero::is_zero;
use pebo_cas::linear::Matrix;
use pebo_cas::linear::rank::null_vectors;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Relation, Symbol};

use super::super::problem::Problem;

/// A plant of n states has n + n^2 coefficients of a direction, and 2^n - 1 changes of signs; of its exchanges most end
/// at the first formula.
pub(super) const MOST_STATES: usize = 12;

/// The formulas of a plant that a symmetry preserves.
pub(super) struct Formulas {
    pub(super) states: Vec<Symbol>,
    /// The rates of the states.
    pub(super) rates: Vec<Expr>,
    /// What the outputs show: rates and identities.
    pub(super) shown: Vec<Expr>,
}

impl Formulas {
    /// The formulas; none where an output has no equation, so that it may depend on any state.
    pub(super) fn of(problem: &Problem<'_>) -> Option<Self> {
        let plant = problem.plant;
        // The value of an output is an identity, and its rate follows from it.
        let by_rate = plant.y.iter().filter(|output| output.value.is_none());
        let is_open = plant.y.iter().any(|output| output.value.is_none() && output.rate.is_none());
        let shown = by_rate.filter_map(|output| output.rate).chain(plant.identities.iter().copied());
        let formulas = Self {
            states: plant.x.iter().map(|state| state.symbol).collect(),
            rates: plant.x.iter().map(|state| state.rate.expr).collect(),
            shown: shown.map(|formula| formula.expr).collect(),
        };
        (!is_open && formulas.states.len() <= MOST_STATES).then_some(formulas)
    }

    /// The rate of a state.
    pub(super) fn rate(&self, state: Symbol) -> Option<Expr> {
        let at = self.states.iter().position(|own| *own == state)?;
        Some(self.rates[at])
    }

    /// The rates, then what the outputs show.
    pub(super) fn all(&self) -> Vec<Expr> {
        self.rates.iter().chain(&self.shown).copied().collect()
    }
}

/// Combinations of rows that no unmeasured signal moves: `slopes` has one row a signal, with an entry for each of `rows`.
pub(super) fn free_of_signals(
    problem: &Problem<'_>,
    rows: Vec<Vec<Expr>>,
    slopes: &[Vec<Expr>],
) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    if slopes.iter().flatten().all(|slope| arena.is_zero(*slope)) {
        return Ok(rows);
    }
    let free = null_vectors(arena, &problem.domain.without_equations(), slopes, rows.len())?;
    let transposed = Matrix::new(rows).transpose();
    Ok(free.iter().map(|factors| transposed.apply(arena, factors)).collect())
}

/// What no coefficient may depend on: the states, signals, outputs, inputs, and time.
pub(super) fn moving(problem: &Problem<'_>) -> BTreeSet<Symbol> {
    problem.signals.iter().copied().chain(problem.plant.time).collect()
}

/// For all values of the parameters: the coefficients exist; one of them does not vanish.
pub(super) fn for_all_parameters(
    problem: &Problem<'_>,
    field: &Field<'_>,
    vector: &[Fraction],
) -> Result<(bool, bool), Obstacle> {
    let is_nonzero = |polynomial: &Poly| -> Result<bool, Obstacle> {
        let shown = field.show(&field.of_polynomial(polynomial)?);
        Ok(problem.domain.grants(problem.arena, (shown, Relation::NonZero)))
    };
    let (mut exists, mut moves) = (true, false);
    for coefficient in vector.iter().filter(|coefficient| !coefficient.is_zero()) {
        exists &= is_nonzero(coefficient.denominator())?;
        moves |= is_nonzero(coefficient.numerator())?;
    }
    Ok((exists, moves))
}

/// The states that move, turned so that the first moves up.
pub(super) fn upward(problem: &Problem<'_>, all: impl Iterator<Item = (Symbol, Expr)>) -> Vec<(Symbol, Expr)> {
    let arena = problem.arena;
    let moving: Vec<(Symbol, Expr)> = all.filter(|(_, speed)| !is_zero(arena, *speed, &problem.domain)).collect();
    let is_downward = moving.first().is_some_and(|(_, speed)| arena.print(*speed).starts_with('-'));
    let turned = |(state, speed)| (state, if is_downward { arena.neg(speed) } else { speed });
    moving.into_iter().map(turned).collect()
}
