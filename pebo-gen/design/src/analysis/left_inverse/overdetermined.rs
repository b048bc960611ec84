//! Solves components of a transform that are affine in the states and more than these.
//!
//! In: a plant with `phi = M(y) x + s(y)`, M with more rows than columns; or so in some states, where the others are
//! known as functions of z, as a position beside the heading by whose sine and cosine it is turned. Out: `x = (M'M)^-1 M' (z - s)`, which divides
//! by `det(M'M)`, a sum of squares, alone: it has a value wherever the columns of M are independent, while solving some
//! of the rows may divide by what vanishes there.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Matrix;
use crate::plant::Plant;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Domain, Expr, Symbol};

/// Products of entries are as long as these are: more components are left to elimination.
const MOST_COMPONENTS: usize = 8;

/// A formula for each state but the known ones, for which there are formulas; none where too few components are affine in
/// these states, or their columns are never independent.
pub(super) fn by_least_squares(
    plant: &Plant,
    domain: &Domain,
    known: &BTreeMap<Symbol, Expr>,
) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let states: Vec<Symbol> =
        plant.x.iter().map(|state| state.symbol).filter(|state| !known.contains_key(state)).collect();
    let unknown: BTreeSet<Symbol> = plant.hidden().into_iter().filter(|symbol| !known.contains_key(symbol)).collect();
    let slopes = |formula: Expr| states.iter().map(|state| arena.derivative(formula, *state)).collect::<Vec<Expr>>();
    let rows = plant.z.iter().zip(plant.transform()).map(|(z, formula)| (*z, formula, slopes(formula)));
    // With all states unknown each component has to be affine.
    let is_affine = |slopes: &[Expr]| !slopes.iter().any(|slope| arena.depends_on(*slope, &unknown));
    let says_something = |slopes: &[Expr]| known.is_empty() || slopes.iter().any(|slope| !arena.is_zero(*slope));
    let (rows, others): (Vec<_>, Vec<_>) = rows.partition(|row| is_affine(&row.2));
    let rows: Vec<_> = rows.into_iter().filter(|row| says_something(&row.2)).collect();
    if states.is_empty()
        || rows.len() <= states.len()
        || rows.len() > MOST_COMPONENTS
        || known.is_empty() && !others.is_empty()
    {
        return BTreeMap::new();
    }
    let at_known = |formula: Expr| arena.substitute(formula, known);
    let slopes = Matrix::build(rows.len(), states.len(), |i, j| shortest(arena, domain, at_known(rows[i].2[j])));
    let transposed = slopes.transpose();
    let Ok(Some(inverse)) = transposed.mul(arena, &slopes).inverse(arena, &domain.facts) else {
        return BTreeMap::new();
    };
    let nowhere: BTreeMap<Symbol, Expr> = states.iter().map(|state| (*state, arena.zero())).collect();
    let rest = |formula: Expr| at_known(arena.substitute(formula, &nowhere));
    let moved: Vec<Expr> = rows.iter().map(|(z, formula, _)| arena.sub(arena.of_symbol(*z), rest(*formula))).collect();
    // The factors of z one by one: their sum would have one denominator.
    let factors = inverse.mul(arena, &transposed).map(|factor| shortest(arena, domain, *factor));
    states.into_iter().zip(factors.apply(arena, &moved)).collect()
}
