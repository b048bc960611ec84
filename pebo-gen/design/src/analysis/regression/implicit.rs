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

/// The equation for the rate of an output times its denominator: with a right side that is affine in phi as a formula
/// in x, since the components of phi may depend on each other, or else with one that is a function of z.
pub(super) fn equation(
    premises: &Premises<'_>,
    (output, rate): (usize, Expr),
    in_z: Expr,
) -> Result<Option<Equation>, Obstacle> {
    let of_states = divisor(premises, rate, &premises.plant.hidden())?;
    // A reciprocal of a state may be a component of phi.
    let of_z = factor(premises, in_z)?.map(|factor| premises.at_phi(factor));
    let mut curved = None;
    for factor in of_states.into_iter().chain(of_z) {
        let Some(primitive) = primitive_of(premises, output, factor)? else { continue };
        let rate = premises.arena().directional(premises.at_phi(primitive), &premises.plant.rates());
        if let Some(row) = affine::of(premises.plant, premises.domain, rate)? {
            return Ok(Some(Equation::new(premises, primitive, premises.of_row(&row), vec![output])));
        }
        curved = curved.or(in_z_alone(premises, rate)?.map(|right| (primitive, right)));
    }
    Ok(curved.map(|(primitive, right)| Equation::new(premises, primitive, right, vec![output])))
}

/// The primitive of a factor of the rate, in z and the outputs: the unknown itself multiplies the rate; a nonlinear
/// factor is not taken for such a regression.
fn primitive_of(premises: &Premises<'_>, output: usize, factor: Expr) -> Result<Option<Expr>, Obstacle> {
    let plant = premises.plant;
    let Some(row) = affine::of(plant, premises.domain, factor)? else { return Ok(None) };
    let moving = plant.y.iter().filter(|output| output.rate.is_some()).map(|output| output.symbol);
    let is_known = plant.arena.symbols_of(&row).is_subset(&moving.chain(premises.constants()).collect());
    Ok(if is_known { primitive(premises, premises.of_row(&row), plant.y[output].symbol) } else { None })
}

/// A rate of z and the outputs as a function of z without a denominator that holds z, proved; none if it is not one.
fn in_z_alone(premises: &Premises<'_>, rate: Expr) -> Result<Option<Expr>, Obstacle> {
    let (arena, domain) = (premises.arena(), premises.domain);
    let Some(right) = premises.in_z(rate).filter(|right| !premises.is_hidden(*right)) else { return Ok(None) };
    // The divisor is gone: at z = chi + theta nothing keeps it from zero.
    let field = Field::over(arena, &domain.facts, &[right])?;
    let whole = field.show(&field.fraction(right)?);
    // Another output may bring its own denominator with it.
    if factor(premises, whole)?.is_some_and(|below| arena.depends_on(below, &premises.unknown())) {
        return Ok(None);
    }
    let right = with_fewer_conditions(arena, domain, premises.shortest(right), &[whole]);
    Ok(premises.are_equal(rate, premises.at_phi(right)).then_some(right))
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
