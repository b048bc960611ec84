//! Solves a transform that is affine in the states and has more components than states.
//!
//! In: a plant with `phi = M(y) x + s(y)`, M with more rows than columns. Out: `x = (M'M)^-1 M' (z - s)`, which
//! divides by `det(M'M)`, a sum of squares, alone: it has a value wherever the columns of M are independent, while solving
//! some of the rows may divide by zero there.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use crate::plant::matrix::Matrix;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Domain, Expr, Symbol};

/// Products of entries are as long as these are: more components are left to elimination.
const MOST_COMPONENTS: usize = 8;

/// A formula for each state; none where the transform is another one, or its columns are never independent.
pub(super) fn by_least_squares(plant: &Plant, domain: &Domain) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let transform = plant.transform();
    let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    if transform.len() <= states.len() || transform.len() > MOST_COMPONENTS {
        return BTreeMap::new();
    }
    let slopes = Matrix::build(transform.len(), states.len(), |i, j| arena.derivative(transform[i], states[j]));
    let hidden: BTreeSet<Symbol> = plant.hidden();
    if slopes.entries().iter().any(|slope| arena.depends_on(*slope, &hidden)) {
        return BTreeMap::new();
    }
    let transposed = slopes.transpose();
    let Ok(Some(inverse)) = transposed.mul(arena, &slopes).inverse(arena, &domain.facts) else {
        return BTreeMap::new();
    };
    let nowhere: BTreeMap<Symbol, Expr> = states.iter().map(|state| (*state, arena.zero())).collect();
    let moved: Vec<Expr> = plant
        .z
        .iter()
        .zip(&transform)
        .map(|(z, formula)| arena.sub(arena.of_symbol(*z), arena.substitute(*formula, &nowhere)))
        .collect();
    // The factors of z one by one: their sum would have one denominator.
    let factors = inverse.mul(arena, &transposed).map(|factor| shortest(arena, domain, factor));
    states.into_iter().zip(factors.apply(arena, &moved)).collect()
}
