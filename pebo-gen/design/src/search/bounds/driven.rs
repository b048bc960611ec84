//! Finds the states by which the slope of a transform with a plain cascade is a function of y alone.
//!
//! In: a plant. Out: for each state, true if inputs move it by itself. The rate of phi is free of x for every value of
//! an input, so that its derivative by the input is: phi along the field g by which the input moves the plant. If g has
//! no component in y and none that depends on x, that is a combination of slopes of phi by x with coefficients free of
//! x. Where such combinations give a single slope, it is free of x, and phi is affine in that state with a coefficient
//! of y.

use pebo_cas::linear::Echelon;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Symbol};

use crate::search::problem::Problem;

/// For each state, true if the slope by it is provably free of x.
pub(in crate::search) fn driven(problem: &Problem<'_>) -> Vec<bool> {
    free_slopes(problem).unwrap_or_else(|_| vec![false; problem.x.len()])
}

fn free_slopes(problem: &Problem<'_>) -> Result<Vec<bool>, Obstacle> {
    let arena = problem.arena;
    let along = |symbols: &[Symbol], input| -> Vec<Expr> {
        let rates = symbols.iter().filter_map(|symbol| problem.rates.get(symbol));
        rates.map(|rate| arena.derivative(*rate, input)).collect()
    };
    let is_free = |e: &Expr| !arena.depends_on(*e, &problem.hidden);
    let fields = problem.plant.u.iter().filter(|input| along(&problem.y, **input).iter().all(|e| arena.is_zero(*e)));
    let fields: Vec<Vec<Expr>> =
        fields.map(|input| along(&problem.x, *input)).filter(|field| field.iter().all(is_free)).collect();
    let field = Field::over(arena, &problem.domain.facts, &fields.concat())?;
    let (echelon, _) = Echelon::of(&field, field.matrix(&fields)?, problem.x.len())?;
    let mut driven = vec![false; problem.x.len()];
    for (pivot, _) in echelon.determined() {
        driven[pivot] = true;
    }
    Ok(driven)
}
