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

use pebo_cas::linear::comparison::combine;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::MOST;
use super::constants::constants;
use super::products::terms;
use crate::analysis::Derivation;
use crate::plant::Plant;
use crate::search::problem::Problem;
use crate::search::sample::is_affine_in;

/// The degree to which rates are looked for as polynomials in the components: of higher ones, and of the products in
/// their rates, there are more than a closure may have.
const DEGREE: usize = 2;

/// The functions of x and y, by the coordinates of a candidate; none where there are too many, or the rates hold others
/// than products.
pub(in crate::search) fn closure(
    problem: &Problem<'_>,
    plant: &Plant,
    derivation: &Derivation,
) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let (Some(cascade), Some(inverse)) = (&derivation.cascade.result, &derivation.left_inverse.result) else {
        return Ok(None);
    };
    let z = &plant.z;
    let transform: BTreeMap<Symbol, Expr> = z.iter().copied().zip(plant.transform()).collect();
    let states: BTreeMap<Symbol, Expr> = inverse.x.iter().copied().collect();
    let values: Vec<Expr> = z.iter().map(|z| arena.of_symbol(*z)).collect();
    let linear = |row: usize| cascade.lambda.as_ref().map_or(arena.zero(), |lambda| arena.dot(&lambda[row], &values));
    let rates = cascade.h.iter().enumerate().map(|(row, h)| arena.add(*h, linear(row)));
    let rates: BTreeMap<Symbol, Expr> = z.iter().copied().zip(rates).collect();
    let hidden: BTreeSet<Symbol> = constants(problem).iter().chain(z).copied().collect();
    let mut found: Vec<Expr> = Vec::new();
    let mut open = Vec::new();
    for rate in problem.output_rates() {
        let by_inverse = arena.substitute(rate, &states);
        if products(problem, by_inverse, &hidden)?.is_some() {
            open.push(by_inverse);
        } else if let Some(polynomial) = polynomial(problem, rate, &transform)? {
            open.push(polynomial);
        } else {
            open.extend(cleared(problem, by_inverse)?);
        }
    }
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
    let mut kept = arena.substitute_all(&found, &transform);
    // One that the others give is no unknown: of the squares of a sine and a cosine one is left.
    for component in kept.clone().into_iter().rev() {
        let others: Vec<Expr> = kept.iter().copied().filter(|other| *other != component).collect();
        if is_affine_in(problem, &[component], &others)? {
            kept = others;
        }
    }
    Ok(Some(kept))
}

/// The numerator and the denominator of a rate, of which the equation `denominator * y' = numerator` holds the products:
/// Haldane's `S*X/(1 + S + S^2)` those of `S^2`.
fn cleared(problem: &Problem<'_>, rate: Expr) -> Result<[Expr; 2], Obstacle> {
    let field = Field::over(problem.arena, &problem.domain.facts, &[rate])?;
    let fraction = field.fraction(rate)?;
    let show = |polynomial: &Poly| Ok::<Expr, Obstacle>(field.show(&field.of_polynomial(polynomial)?));
    Ok([show(fraction.numerator())?, show(fraction.denominator())?])
}

/// A rate as a polynomial of low degree in the components, which a left inverse does not show where these are not
/// independent: `p*sin(th)` of `cos(th)`, `sin(th)` and `p`, from which the angle is recovered by its tangent.
fn polynomial(problem: &Problem<'_>, rate: Expr, transform: &BTreeMap<Symbol, Expr>) -> Result<Option<Expr>, Obstacle> {
    let arena = problem.arena;
    let mut powers = vec![arena.one()];
    for degree in 1..=DEGREE {
        let last = if degree == 1 { vec![arena.one()] } else { powers.clone() };
        for product in last {
            for z in transform.keys() {
                let next = arena.mul(product, arena.of_symbol(*z));
                if !powers.contains(&next) {
                    powers.push(next);
                }
            }
        }
        let basis = arena.substitute_all(&powers, transform);
        let field = Field::over(arena, &problem.domain.facts, &[basis.as_slice(), &[rate]].concat())?;
        if let Some(coefficients) = combine(&field, rate, &basis, &problem.hidden)? {
            let coefficients: Vec<Expr> = coefficients.iter().map(|coefficient| field.show(coefficient)).collect();
            return Ok(Some(arena.dot(&coefficients, &powers)));
        }
    }
    Ok(None)
}

/// The products of hidden symbols of which a formula is a combination with coefficients in y and u; none where they
/// occur in a sum in a denominator, or in a function.
fn products(problem: &Problem<'_>, formula: Expr, hidden: &BTreeSet<Symbol>) -> Result<Option<Vec<Expr>>, Obstacle> {
    let holds_symbols = |product: &Expr| !problem.arena.symbols_of(&[*product]).is_empty();
    let terms = terms(problem, formula, hidden)?;
    Ok(terms.map(|terms| terms.into_iter().map(|term| term.product).filter(holds_symbols).collect()))
}
