//! Greatest common divisors.
//!
//! ```text
//! integer and monomial contents -> shared variables -> degree bounds -> sparse interpolation
//!                                        one variable -> a divisor of integers
//! ```
//!
//! Each step either ends the computation or leaves a smaller problem of the same kind. The interpolation is modulo
//! primes and may err; its result is a candidate that must divide both polynomials and reach a proved degree bound, so
//! that no wrong divisor leaves this module.

mod degrees;
pub(super) mod dense;
mod heuristic;
mod image;
mod modular;
mod newton;
mod points;
mod sparse;

use super::field::PrimeField;
use super::work::{TooLarge, Work, steps};
use super::{Monomial, Poly};
use modular::Problem;
use points::Points;

/// Images in one variable have a coefficient for every power: degrees above this are refused.
const MAX_DEGREE: u32 = 1 << 20;

/// Terms from which on it pays to test first that there is a divisor at all.
const LONG: usize = 16;

impl Poly {
    /// The greatest common divisor, with a positive leading coefficient; zero of two zeros.
    pub fn gcd(&self, other: &Self, work: &Work) -> Result<Self, TooLarge> {
        let (content, a) = self.primitive();
        let (other_content, b) = other.primitive();
        let content = content.gcd(&other_content);
        if a.is_zero() || b.is_zero() {
            return Ok((&a + &b).scale(&content));
        }
        let (x, y) = (a.monomial_content(), b.monomial_content());
        let shared = x.powers().iter().map(|(v, exponent)| (*v, y.exponent(*v).min(*exponent)));
        let monomial = Monomial::new(shared);
        let (a, b) = (a.over_monomial(&x), b.over_monomial(&y));
        gcd_primitive(&a, &b, work)?.mul_term(&monomial, &content, work)
    }

    /// The least common multiple, with a positive leading coefficient; zero if either is.
    pub fn lcm(&self, other: &Self, work: &Work) -> Result<Self, TooLarge> {
        if self.is_zero() || other.is_zero() {
            return Ok(Self::zero());
        }
        let part = self.over(&self.gcd(other, work)?, work)?;
        let (content, multiple) = part.mul(other, work)?.primitive();
        Ok(multiple.scale(&content.abs()))
    }

    /// The greatest common divisor of the coefficients of this as a polynomial in the given
    /// variables: it has none of them, and a positive leading coefficient; zero of zero.
    pub fn content_in(&self, variables: &[u32], work: &Work) -> Result<Self, TooLarge> {
        let coefficients = self.collect(variables).into_iter().map(|(_, coefficient)| coefficient);
        gcd_of_all(coefficients.collect(), work)
    }
}

/// The greatest common divisor of a list; zero of an empty one.
fn gcd_of_all(mut polys: Vec<Poly>, work: &Work) -> Result<Poly, TooLarge> {
    // The smallest first: its factors are the only candidates.
    polys.sort_by_cached_key(|poly| (poly.term_count(), poly.total_degree(), poly.bits()));
    let mut common = Poly::zero();
    for poly in &polys {
        if common.is_one() {
            break;
        }
        if common.is_zero() || poly.div_exact(&common, work)?.is_none() {
            common = common.gcd(poly, work)?;
        }
    }
    Ok(common)
}

/// For polynomials that are not zero and whose integer and monomial contents are 1; so is the
/// divisor's then.
fn gcd_primitive(a: &Poly, b: &Poly, work: &Work) -> Result<Poly, TooLarge> {
    if a.is_constant() || b.is_constant() {
        return Ok(Poly::one());
    }
    if a == b {
        return Ok(a.clone());
    }
    let lacking = |a: &Poly, b: &Poly| -> Vec<u32> {
        a.variables().iter().copied().filter(|v| !b.variables().contains(v)).collect()
    };
    let (only_a, only_b) = (lacking(a, b), lacking(b, a));
    let long = a.term_count().min(b.term_count()) >= LONG;
    if long && (!only_a.is_empty() || !only_b.is_empty()) && are_coprime(a, b, work)? {
        return Ok(Poly::one());
    }
    if !only_a.is_empty() || !only_b.is_empty() {
        return without(a, &only_a, b, &only_b, work);
    }
    gcd_same_variables(a, b, work)
}

/// True if two polynomials in different variables provably have no factor in common: cheap, if the coefficients with
/// respect to the variables of only one of them would be many.
fn are_coprime(a: &Poly, b: &Poly, work: &Work) -> Result<bool, TooLarge> {
    let layout = a.layout.union(&b.layout);
    let over = |poly: &Poly| Poly {
        keys: poly.layout.convert(&poly.keys, &layout),
        coefficients: poly.coefficients.clone(),
        layout: layout.clone(),
    };
    let bounds = degrees::bounds(&PrimeField::MERSENNE, &mut Points::new(), &over(a), &over(b), work)?;
    Ok(bounds.iter().all(|bound| *bound == 0))
}

/// The greatest common divisor, which is known not to have the given variables: that of all
/// coefficients with respect to them.
fn without(a: &Poly, not_in_a: &[u32], b: &Poly, not_in_b: &[u32], work: &Work) -> Result<Poly, TooLarge> {
    work.spend(steps(a.term_count() + b.term_count()))?;
    let parts = a.collect(not_in_a).into_iter().chain(b.collect(not_in_b));
    gcd_of_all(parts.map(|(_, coefficient)| coefficient).collect(), work)
}

fn gcd_same_variables(a: &Poly, b: &Poly, work: &Work) -> Result<Poly, TooLarge> {
    let degrees = (a.degrees(), b.degrees());
    if degrees.0.iter().chain(&degrees.1).any(|degree| *degree > MAX_DEGREE) {
        return Err(TooLarge);
    }
    if let Some(divisor) = heuristic::divisor(a, b, work)? {
        return Ok(divisor);
    }
    let mut points = Points::new();
    let bounds = degrees::bounds(&PrimeField::MERSENNE, &mut points, a, b, work)?;
    let variables = a.variables();
    let absent: Vec<u32> =
        variables.iter().zip(&bounds).filter_map(|(variable, bound)| (*bound == 0).then_some(*variable)).collect();
    if absent.len() == variables.len() {
        return Ok(Poly::one());
    }
    if !absent.is_empty() {
        return without(a, &absent, b, &absent, work);
    }
    for (divisor, other, degrees) in [(b, a, &degrees.1), (a, b, &degrees.0)] {
        let whole = degrees.iter().eq(&bounds);
        if whole && other.div_exact(divisor, work)?.is_some() {
            return Ok(divisor.clone());
        }
    }
    interpolated(a, b, &bounds, &mut points, work)
}

/// The general case. The main variable is the one whose leading coefficients are the simplest:
/// with a constant one nothing is to be scaled and there is no content.
fn interpolated(a: &Poly, b: &Poly, bounds: &[u32], points: &mut Points, work: &Work) -> Result<Poly, TooLarge> {
    let leading_terms = |variable: u32| {
        let terms = |poly: &Poly| poly.leading_coefficient_in(variable).term_count();
        terms(a).min(terms(b))
    };
    let mut order: Vec<(u32, u32)> = a.variables().iter().copied().zip(bounds.iter().copied()).collect();
    // Few points are needed at first: the high degrees go there.
    order.sort_by_key(|(variable, bound)| (std::cmp::Reverse(*bound), *variable));
    let simplest = order.iter().enumerate().min_by_key(|(index, (v, _))| (leading_terms(*v), *index));
    if let Some((index, _)) = simplest {
        order[..=index].rotate_right(1);
    }
    let (variables, bounds): (Vec<u32>, Vec<u32>) = order.into_iter().unzip();
    let main = &variables[..1];
    let (lower_a, lower_b) = (a.content_in(main, work)?, b.content_in(main, work)?);
    let lower = lower_a.gcd(&lower_b, work)?;
    let (a, b) = (a.over(&lower_a, work)?, b.over(&lower_b, work)?);
    let upper = if lower_a.is_one() && lower_b.is_one() {
        Problem { a: &a, b: &b, variables: &variables, bounds: &bounds, work }.solve(points)?
    } else {
        // Without their contents they may lack variables.
        a.gcd(&b, work)?
    };
    upper.mul(&lower, work)
}
