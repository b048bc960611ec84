//! Theta from the functions of it that a regression identifies, where they determine it at least up to whole turns.

use std::collections::{BTreeMap, BTreeSet};

use super::premises::Premises;
use super::separation::{Separation, join_dependent};
use crate::analysis::left_inverse::checking::is_whole_turns;
use pebo_cas::solve::{Equation, solve};
use pebo_cas::{Arena, Expr, Function, Node, Symbol};

/// theta as functions of eta, each proved.
#[derive(Clone, Debug)]
pub(super) struct ThetaRecovery {
    /// An entry for each theta, in the eta symbols.
    pub theta: Vec<Expr>,
    /// Indices of the components of theta that are determined up to multiples of a step, as from sine and cosine of
    /// theta, which have the step 2 pi; with the step.
    pub turning: Vec<(usize, Expr)>,
}

/// theta from its functions, if they determine it at least up to whole turns.
pub(super) fn recover(premises: &Premises<'_>, eta: &[Expr]) -> Option<ThetaRecovery> {
    let (arena, plant, domain) = (premises.arena(), premises.plant, premises.domain);
    let symbols = plant.eta(eta.len());
    let equations: Vec<Equation> =
        eta.iter().zip(&symbols).map(|(f, s)| Equation { formula: *f, value: arena.of_symbol(*s) }).collect();
    let direct: BTreeMap<Symbol, Expr> = equations
        .iter()
        .filter_map(|e| Some((arena.as_symbol(e.formula)?, e.value)))
        .filter(|(s, _)| plant.theta.contains(s))
        .collect();
    let rest: Vec<Symbol> = plant.theta.iter().copied().filter(|t| !direct.contains_key(t)).collect();
    // The others are solved for with these in their place.
    let equations: Vec<Equation> = equations
        .iter()
        .map(|e| Equation { formula: arena.substitute(e.formula, &direct), value: e.value })
        .filter(|e| e.formula != e.value)
        .collect();
    let mut solved = if rest.is_empty() { BTreeMap::new() } else { solve(arena, domain, &equations, &rest).ok()? };
    solved.extend(direct.into_iter().map(|(symbol, value)| (symbol, vec![value])));
    for theta in &rest {
        solved.entry(*theta).or_default().extend(as_ratio(arena, *theta, eta, &symbols));
    }
    let values: BTreeMap<Symbol, Expr> = symbols.iter().copied().zip(eta.iter().copied()).collect();
    let unknown: BTreeSet<Symbol> = plant.theta.iter().copied().collect();
    let mut recovered = ThetaRecovery { theta: Vec::new(), turning: Vec::new() };
    for (index, theta) in plant.theta.iter().enumerate() {
        let candidates = solved.get(theta)?.iter().filter(|f| !arena.depends_on(**f, &unknown));
        let difference = |formula: Expr| arena.sub(arena.substitute(formula, &values), arena.of_symbol(*theta));
        let exact = candidates.clone().find(|f| premises.vanishes(difference(**f)));
        if let Some(formula) = exact {
            recovered.theta.push(*formula);
            continue;
        }
        let (formula, step) = candidates.clone().find_map(|formula| {
            let per_turn = per_turn(arena, *formula);
            let turns = arena.div(difference(*formula), per_turn);
            let step = arena.mul(arena.turn(), per_turn);
            is_whole_turns(arena, domain, turns).then_some((*formula, step))
        })?;
        recovered.theta.push(formula);
        recovered.turning.push((index, step));
    }
    Some(recovered)
}

/// theta from functions that are others times theta, as from `cos(theta)`, `sin(theta)`, `theta*cos(theta)` and
/// `theta*sin(theta)`: the quotient with the least squares, which has a value where one of the others is not zero.
fn as_ratio(arena: &Arena, theta: Symbol, eta: &[Expr], symbols: &[Symbol]) -> Option<Expr> {
    let theta = arena.of_symbol(theta);
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (factor, symbol) in eta.iter().zip(symbols) {
        if let Some(index) = eta.iter().position(|other| *other == arena.mul(theta, *factor)) {
            let symbol = arena.of_symbol(*symbol);
            above.push(arena.mul(symbol, arena.of_symbol(symbols[index])));
            below.push(arena.mul(symbol, symbol));
        }
    }
    (!below.is_empty()).then(|| arena.div(arena.sum(above), arena.sum(below)))
}

/// The growth of a formula in the angle that it is a multiple of; one where it is none.
fn per_turn(arena: &Arena, formula: Expr) -> Expr {
    let Node::Product(product) = arena.node(formula) else { return arena.one() };
    let is_angle = |base: &Expr| matches!(arena.node(*base), Node::Call(Function::Atan2, _));
    match product.factors.iter().find(|(base, exponent)| is_angle(base) && exponent.is_one()) {
        Some((angle, _)) => arena.div(formula, *angle),
        None => arena.one(),
    }
}

/// The separation with theta recovered from its functions: the fewer of them, if they are enough. None if theta is not
/// recovered.
pub(super) fn recoverable(premises: &Premises<'_>, separated: Separation) -> Option<(Separation, ThetaRecovery)> {
    let joined = join_dependent(premises, &separated).ok().and_then(|joined| {
        let recovered = recover(premises, &joined.eta)?;
        Some((joined, recovered))
    });
    joined.or_else(|| {
        let recovered = recover(premises, &separated.eta)?;
        Some((separated, recovered))
    })
}
