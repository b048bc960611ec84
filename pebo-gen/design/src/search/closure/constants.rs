//! Transforms of plants with unknown constants, by way of transforms for measured constants.
//!
//! In: a plant some of whose states have the rate zero. Out: the functions of x in the outputs' rates, and in the rates
//! of these, in the coordinates z = phi(x, y; c) of a plain cascade of the plant in which the constants c are outputs.
//!
//! In these coordinates the rates are free of z, so that each step takes a degree in z away and the steps end:
//! `S' = -c*S*I, I' = c*S*I - g*I` has z = S + I with z' = -g*I, and `c*z` and c close.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::{Output, Plant};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Symbol};

use super::products::terms;
use crate::search::candidate::Candidate;
use crate::search::problem::Problem;

/// More functions than this make no observer that anybody would run.
const MOST: usize = 12;

/// The plant in which its unknown constants are outputs; none where there are none beside other states.
pub(in crate::search) fn measured(problem: &Problem<'_>) -> Option<Plant> {
    let constants = constants(problem);
    if constants.is_empty() || constants.len() == problem.x.len() {
        return None;
    }
    let mut measured = problem.plant.clone();
    let known = problem.plant.x.iter().filter(|state| constants.contains(&state.symbol));
    measured.y.extend(known.map(|state| Output {
        symbol: state.symbol,
        rate: Some(state.rate),
        value: None,
        span: state.rate.span,
    }));
    measured.x.retain(|state| !constants.contains(&state.symbol));
    measured.phi.clear();
    Some(measured)
}

/// The states whose rate is zero.
pub(in crate::search) fn constants(problem: &Problem<'_>) -> BTreeSet<Symbol> {
    let is_constant = |state: &Symbol| problem.rates.get(state).is_some_and(|rate| problem.arena.is_zero(*rate));
    problem.x.iter().copied().filter(is_constant).collect()
}

/// The functions, by a plain cascade with a left inverse of the plant whose constants are measured; none where there
/// are too many, or the rates hold others.
pub(in crate::search) fn closure(problem: &Problem<'_>, candidate: &Candidate) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let derivation = &candidate.derivation;
    let (Some(cascade), Some(inverse)) = (&derivation.cascade.result, &derivation.left_inverse.result) else {
        return Ok(None);
    };
    let z = &candidate.plant.z;
    let transform: BTreeMap<Symbol, Expr> = z.iter().copied().zip(candidate.plant.transform()).collect();
    let states: BTreeMap<Symbol, Expr> = inverse.x.iter().copied().collect();
    let rates: BTreeMap<Symbol, Expr> = z.iter().copied().zip(cascade.h.iter().copied()).collect();
    let hidden: BTreeSet<Symbol> = constants(problem).iter().chain(z).copied().collect();
    let mut found: Vec<Expr> = Vec::new();
    let mut open = arena.substitute_all(&problem.output_rates(), &states);
    while let Some(formula) = open.pop() {
        let Some(functions) = monomials(problem, formula, &hidden)? else { return Ok(None) };
        for function in functions.into_iter().filter(|function| !found.contains(function)).collect::<Vec<_>>() {
            if found.len() == MOST {
                return Ok(None);
            }
            found.push(function);
            let slopes = rates.iter().map(|(z, rate)| arena.mul(arena.derivative(function, *z), *rate));
            open.push(arena.sum(slopes));
        }
    }
    // The simplest first, as an author would list them.
    found.sort_by_key(|function| (arena.print(*function).len(), *function));
    Ok(Some(arena.substitute_all(&found, &transform)))
}

/// The products of hidden symbols of which a formula is a combination with coefficients in y and u; none where they
/// occur in a sum in a denominator, or in a function.
fn monomials(problem: &Problem<'_>, formula: Expr, hidden: &BTreeSet<Symbol>) -> Result<Option<Vec<Expr>>, Obstacle> {
    let holds_symbols = |product: &Expr| !problem.arena.symbols_of(&[*product]).is_empty();
    let terms = terms(problem, formula, hidden)?;
    Ok(terms.map(|terms| terms.into_iter().map(|term| term.product).filter(holds_symbols).collect()))
}
