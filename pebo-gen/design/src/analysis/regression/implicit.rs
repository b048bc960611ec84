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

use super::equation::Equation;
use super::premises::Premises;
use crate::analysis::affine;
use pebo_cas::forms::tidy::with_fewer_conditions;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Rational, Symbol};

/// Powers of the output in a that are looked for.
const MOST_POWERS: i64 = 8;

/// The equation for the rate of an output, known as a function of z too, whose multiplier and right side are affine in
/// phi as formulas in x: the components of phi may depend on each other.
pub(super) fn affine_equation(
    premises: &Premises<'_>,
    (output, in_z): (usize, Expr),
) -> Result<Option<Equation>, Obstacle> {
    let Some(rate) = premises.plant.y[output].rate else { return Ok(None) };
    let of_states = divisor(premises, rate.expr, &premises.plant.hidden())?;
    // A reciprocal of a state may be a component of phi.
    let of_transform = factor(premises, in_z)?.map(|factor| premises.at_phi(factor));
    for factor in of_states.into_iter().chain(of_transform) {
        if let Some(equation) = affine_multiple(premises, output, factor)? {
            return Ok(Some(equation));
        }
    }
    Ok(None)
}

/// The equation for the rate of an output times a factor, where both are affine in phi.
fn affine_multiple(premises: &Premises<'_>, output: usize, factor: Expr) -> Result<Option<Equation>, Obstacle> {
    let (arena, plant, domain) = (premises.arena(), premises.plant, premises.domain);
    let Some(row) = affine::of(plant, domain, factor)? else { return Ok(None) };
    let moving = plant.y.iter().filter(|output| output.rate.is_some()).map(|output| output.symbol);
    let known: BTreeSet<Symbol> = moving.chain(premises.constants()).collect();
    if !arena.symbols_of(&row).is_subset(&known) {
        return Ok(None);
    }
    let Some(primitive) = primitive(premises, premises.of_row(&row), plant.y[output].symbol) else { return Ok(None) };
    let row = affine::of(plant, domain, rate_along(premises, primitive))?;
    Ok(row.map(|row| Equation::new(premises, primitive, premises.of_row(&row), vec![output])))
}

/// The rate of a function of z and y along the plant.
fn rate_along(premises: &Premises<'_>, of_z: Expr) -> Expr {
    premises.arena().directional(premises.at_phi(of_z), &premises.plant.rates())
}

/// The equation for the rate of an output, one of these functions of z, y and u; none where it has no such form.
pub(super) fn equation(
    premises: &Premises<'_>,
    (output, rate): (usize, Expr),
    rates: &[(usize, Expr)],
) -> Result<Option<Equation>, Obstacle> {
    let (arena, plant, domain) = (premises.arena(), premises.plant, premises.domain);
    let (y, unknown) = (plant.y[output].symbol, premises.unknown());
    let Some(factor) = factor(premises, rate)? else { return Ok(None) };
    // The unknown itself multiplies the rate; a nonlinear factor is not taken for such a regression.
    if plant.z.iter().any(|z| arena.depends_on(arena.derivative(factor, *z), &unknown)) {
        return Ok(None);
    }
    let others: Vec<(Symbol, Expr)> =
        rates.iter().filter(|other| other.0 != output).map(|other| (plant.y[other.0].symbol, other.1)).collect();
    let signals = unknown.iter().copied().chain([y]).chain(others.iter().map(|other| other.0));
    if !arena.symbols_of(&[factor]).is_subset(&signals.chain(premises.constants()).collect()) {
        return Ok(None);
    }
    let Some(primitive) = primitive(premises, factor, y) else { return Ok(None) };
    let slopes = plant.z.iter().map(|z| arena.derivative(primitive, *z));
    let along = slopes.enumerate().map(|(index, slope)| arena.mul(slope, premises.velocity(index)));
    let beside = others.iter().map(|(other, rate)| arena.mul(arena.derivative(primitive, *other), *rate));
    let right = arena.add(arena.mul(factor, rate), arena.sum(along.chain(beside)));
    // The divisor is gone: at z = chi + theta nothing keeps it from zero.
    let field = Field::over(arena, &domain.facts, &[right])?;
    let whole = field.show(&field.fraction(right)?);
    // Another output may bring its own denominator with it.
    if self::factor(premises, whole)?.is_some_and(|below| arena.depends_on(below, &unknown)) {
        return Ok(None);
    }
    let right = with_fewer_conditions(arena, domain, premises.shortest(right), &[whole]);
    // Proved of the plant itself: at z = phi(x, y), along its vector field.
    let is_proved = premises.are_equal(rate_along(premises, primitive), premises.at_phi(right));
    Ok(is_proved.then(|| Equation::new(premises, primitive, right, vec![output])))
}

/// The multiplier of the rate: the factor of its denominator that holds z.
pub(super) fn factor(premises: &Premises<'_>, rate: Expr) -> Result<Option<Expr>, Obstacle> {
    divisor(premises, rate, &premises.unknown())
}

/// The factor of a formula's denominator that holds the symbols.
fn divisor(premises: &Premises<'_>, rate: Expr, symbols: &BTreeSet<Symbol>) -> Result<Option<Expr>, Obstacle> {
    let arena = premises.arena();
    let field = Field::over(arena, &premises.domain.facts, &[rate])?;
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
fn primitive(premises: &Premises<'_>, factor: Expr, y: Symbol) -> Option<Expr> {
    let arena = premises.arena();
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
        if premises.vanishes(slope) {
            let primitive = premises.shortest(arena.sum(terms));
            return premises.are_equal(arena.derivative(primitive, y), factor).then_some(primitive);
        }
    }
    None
}
