//! The implicit regression: the unknown multiplies the rate of an output.
//!
//! In: rates of outputs as functions of z, y and u. Out: for each a primitive A(z, y) with
//!
//! ```text
//! a(z, y) y_k' = N(z, y, u)      dA/dy_k = a      d/dt A = N + dA/dz z' + (dA/dy y' without y_k') = R(z, y, u)
//! ```
//!
//! a is the factor of the denominator that holds z: a factor free of z may remain. Where A and R are affine in z, or
//! linear in functions of theta at z = chi + theta, filtering both sides gives a linear regression without the rate
//! (Ortega et al. 2015, Section 5.2: for the levitated ball a = z, A = z i). Nothing is divided by a, so the regression
//! holds also where a vanishes.

use std::collections::{BTreeMap, BTreeSet};

use super::equation::{Equation, velocity};
use crate::analysis::affine;
use crate::analysis::design::Cascade;
use crate::plant::Plant;
use pebo_cas::domain::zero::decide;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Rational, Symbol};

use pebo_cas::forms::tidy::{shortest, with_fewer_conditions};

/// Powers of the output in a that are looked for.
const MOST_POWERS: i64 = 8;

/// The equation for the rate of an output, known as a function of z too, whose multiplier and right side are affine in
/// phi as formulas in x: the components of phi may depend on each other.
pub(super) fn affine_equation(
    plant: &Plant,
    domain: &Domain,
    (output, in_z): (usize, Expr),
) -> Result<Option<Equation>, Obstacle> {
    let Some(rate) = plant.y[output].rate else { return Ok(None) };
    let of_states = divisor(plant, domain, rate.expr, &plant.hidden())?;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    // A reciprocal of a state may be a component of phi.
    let of_transform = factor(plant, domain, in_z)?.map(|factor| plant.arena.substitute(factor, &transform));
    for factor in of_states.into_iter().chain(of_transform) {
        if let Some(equation) = affine_multiple(plant, domain, output, factor)? {
            return Ok(Some(equation));
        }
    }
    Ok(None)
}

/// The equation for the rate of an output times a factor, where both are affine in phi.
fn affine_multiple(plant: &Plant, domain: &Domain, output: usize, factor: Expr) -> Result<Option<Equation>, Obstacle> {
    let arena = &plant.arena;
    let z: Vec<Expr> = plant.z.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let in_z = |row: &[Expr]| arena.add(row[0], arena.dot(&row[1..], &z));
    let Some(row) = affine::of(plant, domain, factor)? else { return Ok(None) };
    let moving = plant.y.iter().filter(|output| output.rate.is_some()).map(|output| output.symbol);
    let known: BTreeSet<Symbol> = moving.chain(plant.parameters.iter().map(|p| p.symbol)).collect();
    if !arena.symbols_of(&row).is_subset(&known) {
        return Ok(None);
    }
    let Some(primitive) = primitive(plant, domain, in_z(&row), plant.y[output].symbol) else { return Ok(None) };
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let moving = arena.directional(arena.substitute(primitive, &transform), &plant.rates());
    Ok(affine::of(plant, domain, moving)?.map(|row| Equation { primitive, rate: in_z(&row), outputs: vec![output] }))
}

/// The equation for the rate of an output, which is a function of z, y and u; none where it has no such form.
pub(super) fn equation(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    (output, rate): (usize, Expr),
    rates: &[(usize, Expr)],
) -> Result<Option<Equation>, Obstacle> {
    let arena = &plant.arena;
    let y = plant.y[output].symbol;
    let Some(factor) = factor(plant, domain, rate)? else { return Ok(None) };
    // The unknown itself multiplies the rate; a nonlinear factor is not taken for such a regression.
    let curved = |z: &Symbol| arena.depends_on(arena.derivative(factor, *z), &plant.z.iter().copied().collect());
    if plant.z.iter().any(curved) {
        return Ok(None);
    }
    let others: Vec<(Symbol, Expr)> =
        rates.iter().filter(|other| other.0 != output).map(|other| (plant.y[other.0].symbol, other.1)).collect();
    let parameters = plant.parameters.iter().map(|p| p.symbol);
    let known: BTreeSet<Symbol> =
        plant.z.iter().copied().chain([y]).chain(others.iter().map(|other| other.0)).chain(parameters).collect();
    if !arena.symbols_of(&[factor]).is_subset(&known) {
        return Ok(None);
    }
    let Some(primitive) = primitive(plant, domain, factor, y) else { return Ok(None) };
    let slopes = plant.z.iter().map(|z| arena.derivative(primitive, *z));
    let along = slopes.enumerate().map(|(index, slope)| arena.mul(slope, velocity(plant, cascade, index)));
    let beside = others.iter().map(|(other, rate)| arena.mul(arena.derivative(primitive, *other), *rate));
    let right = arena.add(arena.mul(factor, rate), arena.sum(along.chain(beside)));
    // The divisor is gone: at z = chi + theta nothing keeps it from zero.
    let field = Field::over(arena, &domain.facts, &[right])?;
    let whole = field.show(&field.fraction(right)?);
    // Another output may bring its own denominator with it.
    let unknown: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    if self::factor(plant, domain, whole)?.is_some_and(|below| arena.depends_on(below, &unknown)) {
        return Ok(None);
    }
    let right = with_fewer_conditions(arena, domain, shortest(arena, domain, right), &[whole]);
    // Proved of the plant itself: at z = phi(x, y), along its vector field.
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let moving = arena.directional(arena.substitute(primitive, &transform), &plant.rates());
    let difference = arena.sub(moving, arena.substitute(right, &transform));
    Ok(decide(arena, difference, domain).is_zero().then(|| Equation { primitive, rate: right, outputs: vec![output] }))
}

/// The multiplier of the rate: the factor of its denominator that holds z.
pub(super) fn factor(plant: &Plant, domain: &Domain, rate: Expr) -> Result<Option<Expr>, Obstacle> {
    divisor(plant, domain, rate, &plant.z.iter().copied().collect())
}

/// The factor of a formula's denominator that holds the symbols.
fn divisor(plant: &Plant, domain: &Domain, rate: Expr, symbols: &BTreeSet<Symbol>) -> Result<Option<Expr>, Obstacle> {
    let arena = &plant.arena;
    let field = Field::over(arena, &domain.facts, &[rate])?;
    let fraction = field.fraction(rate)?;
    let kernels: Vec<u32> = field.kernels_of(symbols).into_iter().collect();
    let parts = fraction.denominator().collect(&kernels);
    Ok(match parts.as_slice() {
        [(monomial, _)] => {
            let powers = monomial.powers().iter();
            let factors = powers.map(|&(kernel, times)| (field.kernel(kernel), Rational::from(i64::from(times))));
            Some(arena.multiply(&Rational::ONE, factors))
        }
        [] => None,
        [(_, first), rest @ ..] => {
            let mut common = first.clone();
            for (_, coefficient) in rest {
                common = common.gcd(coefficient, field.limit())?;
            }
            let own = fraction.denominator().div_exact(&common, field.limit())?;
            Some(field.show(&field.of_polynomial(own.as_ref().unwrap_or(fraction.denominator()))?))
        }
    })
}

/// The primitive of a polynomial in the output, zero where the output is.
fn primitive(plant: &Plant, domain: &Domain, factor: Expr, y: Symbol) -> Option<Expr> {
    let arena = &plant.arena;
    let origin = BTreeMap::from([(y, arena.zero())]);
    let mut slope = factor;
    let mut power = Rational::ONE;
    let mut terms = Vec::new();
    for degree in 0..=MOST_POWERS {
        // By Taylor: the derivative of this order at zero, over the factorial.
        let coefficient = arena.substitute(slope, &origin);
        power = power.checked_div(&Rational::from(degree + 1))?;
        let monomial = arena.power(arena.of_symbol(y), &Rational::from(degree + 1));
        terms.push(arena.scale(arena.mul(coefficient, monomial), &power));
        slope = arena.derivative(slope, y);
        if decide(arena, slope, domain).is_zero() {
            let primitive = shortest(arena, domain, arena.sum(terms));
            let difference = arena.sub(arena.derivative(primitive, y), factor);
            return decide(arena, difference, domain).is_zero().then_some(primitive);
        }
    }
    None
}
