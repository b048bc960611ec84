//! Symmetries of a plant that no output shows.
//!
//! In: a plant. Out: a direction `a + B x` with constant a and B along which the unmeasured states may move, and the
//! unmeasured signals with them, while inputs, outputs and identities are the same. Holds after: beside a trajectory that
//! it moves there is another one with the same inputs and outputs, so that no observer recovers the states that move.
//!
//! Shifts and scalings are of this form: those of states that occur in sums, or in products, alone. The equations for a
//! and B are linear (the determining equations of Lie, Olver 1986, Section 2.3).

use std::collections::BTreeSet;

use pebo_cas::domain::zero::{is_zero, refute};
use pebo_cas::linear::Echelon;
use pebo_cas::linear::comparison::equations;
use pebo_cas::linear::rank::null_vectors;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Expr, Relation, Symbol};

use super::problem::Problem;
use crate::source::listed;

/// A plant of n states has n + n^2 coefficients.
const MOST_STATES: usize = 12;

/// A direction along which no output shows the states.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// The states that move, each with its speed.
    pub states: Vec<(Symbol, Expr)>,
    /// True if unmeasured signals may have to move with them.
    pub with_signals: bool,
}

/// The shortest symmetry of the plant; none where there is no affine one, or formulas are non-smooth.
pub(super) fn symmetry(problem: &Problem<'_>) -> Result<Option<Symmetry>, Obstacle> {
    let (plant, arena) = (problem.plant, problem.arena);
    let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    let rates: Vec<Expr> = plant.x.iter().map(|state| state.rate.expr).collect();
    // The value of an output is an identity, and its rate follows from it.
    let by_rate = plant.y.iter().filter(|output| output.value.is_none());
    let shown = by_rate.filter_map(|output| output.rate).chain(plant.identities.iter().copied());
    let formulas: Vec<Expr> = rates.iter().copied().chain(shown.map(|formula| formula.expr)).collect();
    // An output without an equation may depend on any state.
    let is_open = plant.y.iter().any(|output| output.value.is_none() && output.rate.is_none());
    if states.len() > MOST_STATES || is_open || !arena.dividers(&formulas).is_empty() {
        return Ok(None);
    }
    // The motion of a state by a constant, or by a multiple of a state.
    let factors: Vec<Option<usize>> = std::iter::once(None).chain((0..states.len()).map(Some)).collect();
    let motions: Vec<(usize, Option<usize>)> =
        factors.iter().flat_map(|by| (0..states.len()).map(move |moved| (moved, *by))).collect();
    let speed = |by: Option<usize>| by.map_or(arena.one(), |by| arena.of_symbol(states[by]));
    let entry = |(index, formula): (usize, Expr), (moved, by): (usize, Option<usize>)| {
        let slope = arena.mul(arena.derivative(formula, states[moved]), speed(by));
        // The rate of a state that moves changes by the rate of the motion.
        let own = by.filter(|_| index == moved).map_or(arena.zero(), |by| rates[by]);
        arena.sub(slope, own)
    };
    let row = |formula| motions.iter().map(|motion| entry(formula, *motion)).collect::<Vec<Expr>>();
    let mut rows: Vec<Vec<Expr>> = formulas.iter().copied().enumerate().map(row).collect();
    let slopes = |w: &Symbol| formulas.iter().map(|formula| arena.derivative(*formula, *w)).collect::<Vec<Expr>>();
    let moved: Vec<Vec<Expr>> = plant.w.iter().map(slopes).collect();
    let with_signals = moved.iter().flatten().any(|slope| !arena.is_zero(*slope));
    if with_signals {
        // Combinations of the formulas that no unmeasured signal moves.
        let free = null_vectors(arena, &problem.domain.without_equations(), &moved, formulas.len())?;
        let combined = |factors: &Vec<Expr>| {
            let column = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<Expr>>();
            (0..motions.len()).map(|at| arena.dot(factors, &column(at))).collect::<Vec<Expr>>()
        };
        rows = free.iter().map(combined).collect();
    }
    let field = Field::over(arena, &problem.domain.facts, &rows.concat())?;
    let moving: BTreeSet<Symbol> = problem.signals.iter().copied().chain(plant.time).collect();
    let (echelon, _) = Echelon::of(&field, equations(&field, &rows, &moving)?, motions.len())?;
    let is_nonzero = |polynomial: &Poly| -> Result<bool, Obstacle> {
        let shown = field.show(&field.of_polynomial(polynomial)?);
        Ok(problem.domain.grants(arena, (shown, Relation::NonZero)))
    };
    let mut found: Vec<Symmetry> = Vec::new();
    for vector in echelon.null_space() {
        // For all values of the parameters: the coefficients exist, and one of them does not vanish.
        let mut moves = false;
        let mut exists = true;
        for coefficient in vector.iter().filter(|coefficient| !coefficient.is_zero()) {
            exists &= is_nonzero(coefficient.denominator())?;
            moves |= is_nonzero(coefficient.numerator())?;
        }
        if exists && moves {
            let states = directed(problem, &field, (&states, &motions), &vector);
            // A direction that vanishes by the identities moves nothing.
            if states.iter().any(|(_, speed)| refute(arena, *speed, &problem.domain).is_some()) {
                found.push(Symmetry { states, with_signals });
            }
        }
    }
    Ok(found.into_iter().min_by_key(|symmetry| symmetry.entries(problem).join(", ").len()))
}

/// The states that move, with their speeds.
fn directed(
    problem: &Problem<'_>,
    field: &Field<'_>,
    (states, motions): (&[Symbol], &[(usize, Option<usize>)]),
    vector: &[Fraction],
) -> Vec<(Symbol, Expr)> {
    let arena = problem.arena;
    let of = |index: usize| {
        let own = motions.iter().zip(vector).filter(|((moved, _), _)| *moved == index);
        arena.sum(own.map(|((_, by), coefficient)| {
            let factor = by.map_or(arena.one(), |by| arena.of_symbol(states[by]));
            arena.mul(field.show(coefficient), factor)
        }))
    };
    let all = states.iter().enumerate().map(|(index, state)| (*state, of(index)));
    let moving: Vec<(Symbol, Expr)> = all.filter(|(_, speed)| !is_zero(arena, *speed, &problem.domain)).collect();
    // The first state moves up.
    let is_downward = moving.first().is_some_and(|(_, speed)| arena.print(*speed).starts_with('-'));
    let turned = |(state, speed)| (state, if is_downward { arena.neg(speed) } else { speed });
    moving.into_iter().map(turned).collect()
}

impl Symmetry {
    fn entries(&self, problem: &Problem<'_>) -> Vec<String> {
        self.states.iter().map(|(_, speed)| problem.arena.print(*speed)).collect()
    }

    /// The symmetry in a line.
    pub fn sentence(&self, arena: &Arena) -> String {
        let names: Vec<String> = self.states.iter().map(|(state, _)| arena.name(*state)).collect();
        let speeds: Vec<String> = self.states.iter().map(|(_, speed)| arena.print(*speed)).collect();
        let (verb, them) = if names.len() == 1 { ("moves", "it") } else { ("move", "them") };
        let signals = if self.with_signals { ", and unmeasured signals with them" } else { "" };
        format!(
            "the outputs are the same where {} {verb} along ({}){signals}: no observer recovers {them}: proved",
            listed(names.iter().map(String::as_str)),
            speeds.join(", ")
        )
    }
}
