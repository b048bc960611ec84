//! Finds constant vectors by which the states may be shifted, where the shift itself changes with time.
//!
//! The largest subspace W of constant vectors that no output shows and that the rates carry into itself: N v = 0 and
//! J v in W for every v of W, at all points, with the slopes N of what is shown and J of the rates. Then the states
//! modulo W are a plant of their own, which makes the same outputs (the unobservable subspace of a linear plant, Wonham
//! 1985, Section 3.2, with J for its matrix).

use pebo_cas::linear::comparison::equations;
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::super::problem::Problem;
use super::found::{Symmetry, SymmetryKind};
use super::preserved::{Formulas, for_all_parameters, free_of_signals, moving, upward};

/// The shortest vector of a basis of W; none where W is zero, or does not exist for all values of the parameters.
pub(super) fn direction(problem: &Problem<'_>, formulas: &Formulas) -> Result<Option<Symmetry>, Obstacle> {
    let (arena, states) = (problem.arena, &formulas.states);
    let gradient =
        |formula: Expr, by: &[Symbol]| by.iter().map(|s| arena.derivative(formula, *s)).collect::<Vec<Expr>>();
    // Each row: the slopes of a formula by the states, then by the unmeasured signals.
    let row = |formula: &Expr| [gradient(*formula, states), gradient(*formula, &problem.plant.w)].concat();
    let shown: Vec<Vec<Expr>> = formulas.shown.iter().map(row).collect();
    let jacobian: Vec<Vec<Expr>> = formulas.rates.iter().map(row).collect();
    let columns = states.len() + problem.plant.w.len();
    let transposed = Matrix::build(columns, jacobian.len(), |at, row| jacobian[row][at]);
    let with_signals = shown.iter().chain(&jacobian).any(|row| row[states.len()..].iter().any(|s| !arena.is_zero(*s)));
    let moving = moving(problem);
    let mut rows = shown.clone();
    let mut dimension = states.len() + 1;
    loop {
        let of_signal = |at: usize| rows.iter().map(|row| row[at]).collect::<Vec<Expr>>();
        let slopes: Vec<Vec<Expr>> = (states.len()..columns).map(of_signal).collect();
        let of_states = rows.iter().map(|row| row[..states.len()].to_vec()).collect();
        let free = free_of_signals(problem, of_states, &slopes)?;
        let field = Field::over(arena, &problem.domain.facts, &free.concat())?;
        let (echelon, _) = Echelon::of(&field, equations(&field, &free, &moving)?, states.len())?;
        let subspace = echelon.null_space();
        if subspace.is_empty() {
            return Ok(None);
        }
        if subspace.len() == dimension {
            let mut found = Vec::new();
            for vector in &subspace {
                let (exists, moves) = for_all_parameters(problem, &field, vector)?;
                if !exists {
                    return Ok(None);
                }
                let speeds = states.iter().zip(vector).map(|(state, speed)| (*state, field.show(speed)));
                let states = upward(problem, speeds);
                found.extend(moves.then_some(Symmetry { kind: SymmetryKind::Direction, states, with_signals }));
            }
            return Ok(Symmetry::shortest(arena, found));
        }
        dimension = subspace.len();
        // What vanishes on W: its rows, times the slopes of the rates, have to vanish on W too.
        let carried = echelon.rows().map(|(_, normal)| transposed.apply(arena, &field.show_all(normal)));
        rows = shown.iter().cloned().chain(carried).collect();
    }
}
