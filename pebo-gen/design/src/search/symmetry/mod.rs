//! Symmetries of a plant that no output shows.
//!
//! In: a plant. Out: a change of the unmeasured states, and of the unmeasured signals with them, under which inputs,
//! outputs and identities are the same: along a direction `a + B x` with constant a and B, by a constant vector, or of
//! signs. Holds after: beside a trajectory there is another one with the same inputs and outputs, so that no observer
//! recovers the states that change, on a domain that contains both.

mod affine;
mod shifts;
mod signs;

use std::collections::BTreeSet;

use pebo_cas::linear::rank::null_vectors;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Expr, Symbol};

use super::problem::Problem;
use crate::source::listed;

/// A plant of n states has n + n^2 coefficients of a direction, and 2^n - 1 changes of signs.
const MOST_STATES: usize = 12;

/// A change of the states that no output shows.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// The change.
    pub kind: SymmetryKind,
    /// The states that change: each with its speed, or with its other value.
    pub states: Vec<(Symbol, Expr)>,
    /// True if unmeasured signals may have to change with them.
    pub with_signals: bool,
}

/// A kind of changes of the states.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SymmetryKind {
    /// The states move along a direction.
    Direction,
    /// The states change their signs.
    Signs,
}

impl SymmetryKind {
    /// The kind, in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::Signs => "signs",
        }
    }
}

/// The formulas of a plant that a symmetry preserves.
struct Formulas {
    states: Vec<Symbol>,
    /// The rates of the states.
    rates: Vec<Expr>,
    /// What the outputs show: rates and identities.
    shown: Vec<Expr>,
}

impl Formulas {
    /// The formulas; none where an output has no equation, so that it may depend on any state.
    fn of(problem: &Problem<'_>) -> Option<Self> {
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

    /// The rates, then what the outputs show.
    fn all(&self) -> Vec<Expr> {
        self.rates.iter().chain(&self.shown).copied().collect()
    }
}

/// The first symmetry of the plant: along an affine direction, by a constant vector, of signs; none where there is
/// none of them.
pub(super) fn symmetry(problem: &Problem<'_>) -> Result<Option<Symmetry>, Obstacle> {
    let Some(formulas) = Formulas::of(problem) else { return Ok(None) };
    if problem.arena.dividers(&formulas.all()).is_empty() {
        for along in [affine::direction, shifts::direction] {
            let found = along(problem, &formulas)?;
            if found.is_some() {
                return Ok(found);
            }
        }
    }
    Ok(signs::change(problem, &formulas))
}

/// Combinations of rows that no unmeasured signal moves: `slopes` has one row a signal, with an entry for each of `rows`.
fn free_of_signals(
    problem: &Problem<'_>,
    rows: Vec<Vec<Expr>>,
    slopes: &[Vec<Expr>],
) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    if slopes.iter().flatten().all(|slope| arena.is_zero(*slope)) {
        return Ok(rows);
    }
    let columns = rows.first().map_or(0, Vec::len);
    let free = null_vectors(arena, &problem.domain.without_equations(), slopes, rows.len())?;
    let combined = |factors: &Vec<Expr>| {
        let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<Expr>>();
        (0..columns).map(|at| arena.dot(factors, &column(at))).collect::<Vec<Expr>>()
    };
    Ok(free.iter().map(combined).collect())
}

/// What no coefficient may depend on: the states, signals, outputs, inputs, and time.
fn moving(problem: &Problem<'_>) -> BTreeSet<Symbol> {
    problem.signals.iter().copied().chain(problem.plant.time).collect()
}

impl Symmetry {
    /// The shortest of several.
    fn shortest(arena: &Arena, found: Vec<Self>) -> Option<Self> {
        found.into_iter().min_by_key(|symmetry| symmetry.entries(arena).join(", ").len())
    }

    /// The speeds or values of the states that change.
    #[must_use]
    pub fn entries(&self, arena: &Arena) -> Vec<String> {
        self.states.iter().map(|(_, entry)| arena.print(*entry)).collect()
    }

    /// The symmetry in a line.
    #[must_use]
    pub fn sentence(&self, arena: &Arena) -> String {
        let names: Vec<String> = self.states.iter().map(|(state, _)| arena.name(*state)).collect();
        let names_listed = listed(names.iter().map(String::as_str));
        let them = if names.len() == 1 { "it" } else { "them" };
        let signals = if self.with_signals { ", and unmeasured signals with them" } else { "" };
        let change = match (self.kind, names.len()) {
            (SymmetryKind::Direction, 1) => format!("{names_listed} moves along ({})", self.entries(arena).join(", ")),
            (SymmetryKind::Direction, _) => format!("{names_listed} move along ({})", self.entries(arena).join(", ")),
            (SymmetryKind::Signs, 1) => format!("{names_listed} changes its sign"),
            (SymmetryKind::Signs, _) => format!("{names_listed} change their signs"),
        };
        let unless = match (self.kind, names.len()) {
            (SymmetryKind::Direction, _) => "",
            (SymmetryKind::Signs, 1) => " unless its sign is known",
            (SymmetryKind::Signs, _) => " unless one of the signs is known",
        };
        format!("the outputs are the same where {change}{signals}: no observer recovers {them}{unless}: proved")
    }
}
