//! Closures in the coordinates z = phi(x, y) of a cascade that has a left inverse.
//!
//! In: a transform whose cascade and left inverse are proved, of the plant or of the plant in which its unknown
//! constants c are outputs. Out: the products of z and c in the outputs' rates, and in the rates of these, as functions
//! of x and y.
//!
//! In these coordinates the rates are affine in z, so that no product has a rate of a higher degree in z and the steps
//! end. `S' = -c*S*I, I' = c*S*I - g*I` has z = S + I with z' = -g*I, and `c*z` and c close; of `T' = k*(s^4 - T^4) - T,
//! s' = k*(T^4 - s^4)` the sum z = T + s has z' = s - z, and the powers of z close to the fourth, in which s' is affine.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Symbol};

use super::MOST;
use super::constants::constants;
use super::products::terms;
use crate::search::candidate::Candidate;
use crate::search::problem::Problem;

/// The functions of x and y, by the coordinates of a candidate; none where there are too many, or the rates hold others
/// than products.
pub(in crate::search) fn closure(problem: &Problem<'_>, candidate: &Candidate) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let derivation = &candidate.derivation;
    let (Some(cascade), Some(inverse)) = (&derivation.cascade.result, &derivation.left_inverse.result) else {
        return Ok(None);
    };
    let z = &candidate.plant.z;
    let transform: BTreeMap<Symbol, Expr> = z.iter().copied().zip(candidate.plant.transform()).collect();
    let states: BTreeMap<Symbol, Expr> = inverse.x.iter().copied().collect();
    let values: Vec<Expr> = z.iter().map(|z| arena.of_symbol(*z)).collect();
    let linear = |row: usize| cascade.lambda.as_ref().map_or(arena.zero(), |lambda| arena.dot(&lambda[row], &values));
    let rates = cascade.h.iter().enumerate().map(|(row, h)| arena.add(*h, linear(row)));
    let rates: BTreeMap<Symbol, Expr> = z.iter().copied().zip(rates).collect();
    let hidden: BTreeSet<Symbol> = constants(problem).iter().chain(z).copied().collect();
    let mut found: Vec<Expr> = Vec::new();
    let mut open = arena.substitute_all(&problem.output_rates(), &states);
    while let Some(formula) = open.pop() {
        let Some(functions) = products(problem, formula, &hidden)? else { return Ok(None) };
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
    found.sort_by_cached_key(|function| {
        let text = arena.print(*function);
        (text.len(), text)
    });
    Ok(Some(arena.substitute_all(&found, &transform)))
}

/// The products of hidden symbols of which a formula is a combination with coefficients in y and u; none where they
/// occur in a sum in a denominator, or in a function.
fn products(problem: &Problem<'_>, formula: Expr, hidden: &BTreeSet<Symbol>) -> Result<Option<Vec<Expr>>, Obstacle> {
    let holds_symbols = |product: &Expr| !problem.arena.symbols_of(&[*product]).is_empty();
    let terms = terms(problem, formula, hidden)?;
    Ok(terms.map(|terms| terms.into_iter().map(|term| term.product).filter(holds_symbols).collect()))
}
