//! Checks a candidate left inverse.
//!
//! In: the plant, and a formula in z and y. Out: the decision whether it gives the state back at z = phi(x, y), for
//! angles up to periods, and the domain conditions there that the domain does not imply.

use std::collections::BTreeMap;

use crate::plant::Plant;
use crate::source::Span;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Domain, Expr, Function, Relation, Symbol};

/// The domain conditions of a formula for a state at z = phi(x, y) that the domain does not imply: the condition in z,
/// and at z = phi(x, y).
///
/// Arguments of roots and logarithms and denominators are read off the formula as written, since substituting would
/// simplify its domain away.
pub(super) fn open_conditions(
    plant: &Plant,
    domain: &Domain,
    formula: Expr,
) -> Vec<((Expr, Relation), (Expr, Relation))> {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let conditions = arena.domain_conditions(&[formula], Regularity::Defined).into_iter();
    let there = conditions.map(|(part, relation)| ((part, relation), (arena.substitute(part, &transform), relation)));
    there.filter(|(_, condition)| !domain.grants(arena, *condition)).collect()
}

/// The expression that vanishes if the formula is right, for an angle up to periods: `phi_left(phi(x, y), y) - x`.
fn residual(plant: &Plant, state: Symbol, formula: Expr) -> Expr {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    arena.sub(arena.substitute(formula, &transform), arena.of_symbol(state))
}

/// Decides whether a formula gives the state back; returns the tested expression as well.
pub(super) fn check(plant: &Plant, domain: &Domain, state: Symbol, formula: Expr) -> (Expr, Answer) {
    let arena = &plant.arena;
    let difference = residual(plant, state, formula);
    let plain = decide(arena, difference, domain);
    let Some(period) = plant.period(state) else { return (difference, plain) };
    if plain.is_zero() {
        return (difference, plain);
    }
    let unlike = unlike_after(plant, domain, state, period);
    if let Some(answer) = unlike {
        return answer;
    }
    let turn = arena.div(arena.turn(), period);
    turns(arena, domain, arena.mul(difference, turn))
}

/// A rate that is not the same a period further on: then the state is no angle of that period, and
/// knowing it up to the period is not knowing it.
pub(super) fn unlike_after(plant: &Plant, domain: &Domain, state: Symbol, period: Expr) -> Option<(Expr, Answer)> {
    let arena = &plant.arena;
    let turned = BTreeMap::from([(state, arena.add(arena.of_symbol(state), period))]);
    plant.rates().into_values().find_map(|rate| {
        let change = arena.sub(arena.substitute(rate, &turned), rate);
        let answer = decide(arena, change, domain);
        (!answer.is_zero()).then_some((change, answer))
    })
}

/// Decides whether an angle is a whole number of turns: its cosine is 1.
fn turns(arena: &Arena, domain: &Domain, angle: Expr) -> (Expr, Answer) {
    let difference = arena.sub(arena.call(Function::Cos, &[angle]), arena.one());
    (difference, decide(arena, difference, domain))
}

/// Tests whether an angle is provably a whole number of turns.
pub(in crate::analysis) fn is_whole_turns(arena: &Arena, domain: &Domain, angle: Expr) -> bool {
    turns(arena, domain, angle).1.is_zero()
}

/// The span of the transform.
pub(in crate::analysis) fn at_phi(plant: &Plant) -> Span {
    match (plant.phi.first(), plant.phi.last()) {
        (Some(first), Some(last)) => first.span.to(last.span),
        _ => Span::point(0),
    }
}
