//! The start of a simulation, near which the plant has values that satisfy its identities.
//!
//! In: the section `simulation`. Out: a rational value of each state and output that it names, and of the outputs whose
//! values follow; one that is not rational is rounded. Nothing is concluded from it: it is where points are looked for.

use crate::model::Model;
use pebo_cas::graph::enclosure::Point;
use pebo_cas::number::interval::Precision;
use pebo_cas::{Arena, Expr, Rational, Symbol};

use super::formula::lower;
use super::scope::Scope;

/// The values at the start, with those of the parameters and the formulas of the outputs' values.
pub(super) fn start(
    arena: &Arena,
    model: &Model,
    parameters: &[(Symbol, Rational)],
    outputs: &[(Symbol, Expr)],
) -> Point {
    let mut start = Point::new();
    let Some(simulation) = &model.simulation else { return start };
    // An arena of its own: results are not to be printed with the decimals of a simulation.
    let (own, mut scope) = (Arena::new(), Scope::new());
    for (symbol, value) in parameters {
        scope.define(arena.name(*symbol), own.number(value.clone()));
    }
    for entry in &simulation.initial {
        let value = lower(&own, &scope, &entry.value).ok().and_then(|formula| rational(&own, formula));
        start.extend(value.map(|value| (arena.symbol(&entry.name.value), arena.number(value))));
    }
    let parameters: Point = parameters.iter().map(|(symbol, value)| (*symbol, arena.number(value.clone()))).collect();
    for (output, value) in outputs {
        let value = rational(arena, arena.substitute(arena.substitute(*value, &start), &parameters));
        start.extend(value.map(|value| (*output, arena.number(value))));
    }
    start
}

/// The number that a formula without symbols is, or one close to it.
fn rational(arena: &Arena, value: Expr) -> Option<Rational> {
    let is_constant = arena.symbols_of(&[value]).is_empty();
    let enclosed = || is_constant.then(|| arena.enclose(value, &Point::new(), Precision::new(64)))?;
    arena.as_number(value).or_else(|| Rational::from_f64_exact(enclosed()?.lo()))
}
