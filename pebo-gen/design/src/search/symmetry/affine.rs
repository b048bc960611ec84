//! Finds directions `a + B x` along which the plant is invariant.
//!
//! Shifts and scalings are of this form: those of states that occur in sums, or in products, alone. The equations for a
//! and B are linear (the determining equations of Lie, Olver 1986, Section 2.3).

use pebo_cas::domain::zero::refute;
use pebo_cas::linear::Echelon;
use pebo_cas::linear::comparison::equations;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::super::problem::Problem;
use super::found::{Symmetry, SymmetryKind};
use super::preserved::{Formulas, for_all_parameters, free_of_signals, moving, upward};

/// The shortest direction; none where there is no affine one.
pub(super) fn direction(problem: &Problem<'_>, formulas: &Formulas) -> Result<Option<Symmetry>, Obstacle> {
    let arena = problem.arena;
    let (states, rates, all) = (&formulas.states, &formulas.rates, formulas.all());
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
    let rows: Vec<Vec<Expr>> = all.iter().copied().enumerate().map(row).collect();
    let slopes = |w: &Symbol| all.iter().map(|formula| arena.derivative(*formula, *w)).collect::<Vec<Expr>>();
    let slopes: Vec<Vec<Expr>> = problem.plant.w.iter().map(slopes).collect();
    let with_signals = slopes.iter().flatten().any(|slope| !arena.is_zero(*slope));
    let rows = free_of_signals(problem, rows, &slopes)?;
    let field = Field::over(arena, &problem.domain.facts, &rows.concat())?;
    let (echelon, _) = Echelon::of(&field, equations(&field, &rows, &moving(problem))?, motions.len())?;
    let mut found: Vec<Symmetry> = Vec::new();
    for vector in echelon.null_space() {
        let (exists, moves) = for_all_parameters(problem, &field, &vector)?;
        if exists && moves {
            let states = directed(problem, &field, (states, &motions), &vector);
            // A direction that vanishes by the identities moves nothing.
            if states.iter().any(|(_, speed)| refute(arena, *speed, &problem.domain).is_some()) {
                found.push(Symmetry { kind: SymmetryKind::Direction, states, with_signals });
            }
        }
    }
    Ok(Symmetry::shortest(arena, found))
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
    upward(problem, states.iter().enumerate().map(|(index, state)| (*state, of(index))))
}
