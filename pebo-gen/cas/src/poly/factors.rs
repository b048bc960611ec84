//! Factors for a reader: multiplicities, contents, and factors that are linear in a variable.
//!
//! In: a polynomial. Out: a product of powers. Each factor of degree one in some variable is irreducible; in the
//! others, only factors that are linear in a variable are searched for, so one may still be a product.

use super::Poly;
use super::evaluate::coordinate;
use super::field::{PrimeField, Residue};
use super::square_free::SquareFree;
use super::work::{TooLarge, Work};
use crate::Integer;

/// Divisors of a coefficient that are tried as parts of a linear factor.
const MOST_DIVISORS: usize = 24;

/// Terms of a polynomial up to which linear factors are searched for: nobody reads a longer one as a product either.
const MOST_TERMS: usize = 400;

impl Poly {
    /// The polynomial as a product, with factors as small as contents, multiplicities and linear factors yield:
    /// coprime, not constant, primitive with positive leading coefficients, ascending.
    pub fn factored(&self, work: &Work) -> Result<SquareFree, TooLarge> {
        let SquareFree { content, factors } = self.square_free(work)?;
        let mut found = Vec::new();
        for (factor, exponent) in factors {
            let mut parts = Vec::new();
            split(factor, work, &mut parts)?;
            found.extend(parts.into_iter().map(|part| (part.primitive().1, exponent)));
        }
        found.sort_by(|a, b| a.0.term_count().cmp(&b.0.term_count()).then_with(|| b.0.cmp(&a.0)));
        Ok(SquareFree { content, factors: found })
    }
}

/// The factors of a square-free polynomial.
fn split(poly: Poly, work: &Work, found: &mut Vec<Poly>) -> Result<(), TooLarge> {
    let mut rest = poly;
    for variable in rest.variables().to_vec() {
        let lower = rest.content_in(&[variable], work)?;
        if !lower.is_constant() {
            rest = rest.over(&lower, work)?;
            split(lower, work, found)?;
        }
    }
    // The rest is primitive in each of its variables: of degree one in any, it has no factors.
    while let Some(linear) = linear_factor(&rest, work)? {
        rest = rest.over(&linear, work)?;
        found.push(linear);
    }
    if !rest.is_constant() {
        found.push(rest);
    }
    Ok(())
}

/// A proper factor of degree one in some variable, of a polynomial that is primitive in all of its variables.
fn linear_factor(poly: &Poly, work: &Work) -> Result<Option<Poly>, TooLarge> {
    let degrees: Vec<(u32, u32)> = poly.variables().iter().map(|v| (*v, poly.degree(*v))).collect();
    if poly.term_count() > MOST_TERMS || degrees.iter().any(|(_, degree)| *degree == 1) {
        return Ok(None);
    }
    for (variable, degree) in degrees {
        let found = if degree == 2 { root_of_two(poly, variable, work)? } else { root(poly, variable, work)? };
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}

/// A linear factor of a polynomial that is quadratic in a variable: there is one if the discriminant is a square.
fn root_of_two(poly: &Poly, variable: u32, work: &Work) -> Result<Option<Poly>, TooLarge> {
    let [square, slope, rest] = quadratic(poly, variable);
    let product = square.mul(&rest, work)?.scale(&Integer::from(4));
    let Some(apart) = (&slope.mul(&slope, work)? - &product).sqrt_exact(work)? else { return Ok(None) };
    let double = square.scale(&Integer::from(2)).mul(&Poly::variable(variable), work)?;
    poly.gcd(&(&(&double + &slope) - &apart), work).map(Some)
}

/// The coefficients of the second, first and zeroth power.
fn quadratic(poly: &Poly, variable: u32) -> [Poly; 3] {
    let mut found = [Poly::zero(), Poly::zero(), Poly::zero()];
    for (power, coefficient) in poly.coefficients_in(variable) {
        if let Some(place) = 2_usize.checked_sub(power as usize) {
            found[place] = coefficient;
        }
    }
    found
}

/// A factor `a v - b`: a divides the leading coefficient, b the last one.
fn root(poly: &Poly, variable: u32, work: &Work) -> Result<Option<Poly>, TooLarge> {
    let coefficients = poly.coefficients_in(variable);
    let (Some((_, first)), Some((0, last))) = (coefficients.first(), coefficients.last()) else { return Ok(None) };
    let image = FactorImage::of(&coefficients);
    let lasts: Vec<(Residue, Poly)> = divisors(last, work)?.into_iter().map(|e| (image.value(&e), e)).collect();
    for leading in divisors(first, work)? {
        let value = image.value(&leading);
        let leading = leading.mul(&Poly::variable(variable), work)?;
        for (other, constant) in &lasts {
            for (opposite, sign) in [(*other, -1), (image.field.neg(*other), 1)] {
                if !image.may_have_root(value, opposite) {
                    continue;
                }
                let candidate = if sign < 0 { &leading - constant } else { &leading + constant };
                if poly.div_exact(&candidate, work)?.is_some() {
                    return Ok(Some(candidate));
                }
            }
        }
    }
    Ok(None)
}

/// The image of a polynomial in one variable, the others having values modulo a prime: it excludes most candidates for
/// a factor.
struct FactorImage {
    field: PrimeField,
    /// The powers of the variable, highest first, with their coefficients.
    coefficients: Vec<(u32, Residue)>,
}

impl FactorImage {
    fn of(coefficients: &[(u32, Poly)]) -> Self {
        let field = PrimeField::MERSENNE;
        let mut image = Self { field, coefficients: Vec::new() };
        image.coefficients = coefficients.iter().map(|(power, e)| (*power, image.value(e))).collect();
        image
    }

    fn value(&self, poly: &Poly) -> Residue {
        poly.evaluate_mod(&self.field, |variable| coordinate(&self.field, variable, 1))
    }

    /// True if `constant / leading` is a root, as it must be if `leading v - constant` divides the polynomial.
    fn may_have_root(&self, leading: Residue, constant: Residue) -> bool {
        let (field, degree) = (&self.field, self.coefficients.first().map_or(0, |(power, _)| *power));
        let sum = self.coefficients.iter().fold(Residue::ZERO, |sum, (power, coefficient)| {
            let powers =
                field.mul(field.pow(constant, u64::from(*power)), field.pow(leading, u64::from(degree - power)));
            field.add(sum, field.mul(*coefficient, powers))
        });
        sum.is_zero()
    }
}

/// Divisors up to the sign, the first of them if there are many.
fn divisors(poly: &Poly, work: &Work) -> Result<Vec<Poly>, TooLarge> {
    let parts = poly.factored(work)?;
    let content = parts.content.abs();
    let small = (1..=9_i64).map(Integer::from).filter(|n| content.div_exact(n).is_some());
    let mut found: Vec<Poly> = small.map(Poly::constant).collect();
    if found.iter().all(|n| n.to_constant().as_ref() != Some(&content)) {
        found.push(Poly::constant(content));
    }
    for (factor, exponent) in parts.factors {
        for index in 0..found.len() {
            let mut power = found[index].clone();
            for _ in 0..exponent {
                power = power.mul(&factor, work)?;
                found.push(power.clone());
            }
        }
        found.truncate(MOST_DIVISORS);
    }
    Ok(found)
}
