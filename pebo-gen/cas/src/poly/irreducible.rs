//! Proves polynomials irreducible over the rational numbers.
//!
//! In: a polynomial that is primitive in each of its variables. Out: true if no product of smaller ones equals it,
//! proved by the degrees of its factors modulo primes: with numbers for all variables but one, a factor has the sum of
//! some of these degrees, for each prime. False says nothing: for some polynomials no prime shows it (`x^4 + 1`).

use super::Poly;
use super::field::{PrimeField, Residue};
use super::gcd::dense;

/// Choices of numbers for the other variables: nearly each one of an irreducible polynomial is irreducible (Hilbert).
const CHOICES: u64 = 4;

/// Degrees above this are not examined: sums of degrees are bits of a word.
const MOST_DEGREE: u32 = 60;

impl Poly {
    /// True if the polynomial is proved to be irreducible.
    pub fn is_proved_irreducible(&self) -> bool {
        let Some(variable) = self.variables().iter().copied().min_by_key(|variable| self.degree(*variable)) else {
            return false;
        };
        let degree = self.degree(variable);
        if degree == 1 {
            return true;
        }
        degree <= MOST_DEGREE && (1..=CHOICES).any(|choice| self.is_irreducible_at(variable, degree, choice))
    }

    /// True if it is irreducible with numbers for all variables but one, in which it keeps its degree.
    fn is_irreducible_at(&self, variable: u32, degree: u32, choice: u64) -> bool {
        // Bit n: a factor may have degree n.
        let mut possible = u64::MAX;
        for field in PrimeField::LARGE {
            let number = |other: u32| field.from_u64(choice * 10 + 3 * u64::from(other) * (choice + 2) + 1);
            let mut image = vec![Residue::ZERO; degree as usize + 1];
            for (power, coefficient) in self.coefficients_in(variable) {
                image[power as usize] = coefficient.evaluate_mod(&field, number);
            }
            if image.last().is_some_and(|leading| leading.is_zero()) {
                return false;
            }
            let Some(degrees) = factor_degrees(&field, image) else { continue };
            possible &= degrees.iter().fold(1, |sums, degree| sums | sums << degree);
        }
        possible & ((1 << degree) - 1) == 1
    }
}

/// The degrees of the irreducible factors modulo a prime; none if one is repeated.
fn factor_degrees(field: &PrimeField, mut rest: Vec<Residue>) -> Option<Vec<u32>> {
    let derivative: Vec<Residue> =
        rest.iter().enumerate().skip(1).map(|(n, c)| field.mul(*c, field.from_u64(n as u64))).collect();
    if dense::gcd(field, rest.clone(), trimmed(derivative)).len() != 1 {
        return None;
    }
    let mut degrees = Vec::new();
    let identity = vec![Residue::ZERO, field.one()];
    let mut power = identity.clone();
    let mut degree: u32 = 1;
    // The roots of `x^(p^n) - x` are those of all irreducible polynomials whose degree divides n.
    while rest.len() > 2 * degree as usize {
        power = raised(field, &power, &rest);
        let length = power.len().max(identity.len());
        let entry = |poly: &[Residue], n: usize| poly.get(n).copied().unwrap_or_default();
        let difference = (0..length).map(|n| field.sub(entry(&power, n), entry(&identity, n))).collect();
        let common = dense::gcd(field, rest.clone(), trimmed(difference));
        let found = common.len().saturating_sub(1);
        degrees.extend(std::iter::repeat_n(degree, found / degree as usize));
        if found > 0 {
            rest = divided(field, rest, &common)?.0;
            power = divided(field, power, &rest)?.1;
        }
        degree += 1;
    }
    let left = u32::try_from(rest.len().saturating_sub(1)).ok()?;
    degrees.extend((left > 0).then_some(left));
    Some(degrees)
}

fn trimmed(mut poly: Vec<Residue>) -> Vec<Residue> {
    dense::trim(&mut poly);
    poly
}

/// The power by the prime, modulo a polynomial.
fn raised(field: &PrimeField, base: &[Residue], modulus: &[Residue]) -> Vec<Residue> {
    let mut power = vec![field.one()];
    for bit in (0..64 - field.prime().leading_zeros()).rev() {
        power = product(field, &power, &power, modulus);
        if field.prime() >> bit & 1 == 1 {
            power = product(field, &power, base, modulus);
        }
    }
    power
}

fn product(field: &PrimeField, a: &[Residue], b: &[Residue], modulus: &[Residue]) -> Vec<Residue> {
    if a.is_empty() || b.is_empty() {
        return Vec::new();
    }
    let mut product = vec![Residue::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            product[i + j] = field.add(product[i + j], field.mul(*x, *y));
        }
    }
    divided(field, product, modulus).map_or_else(Vec::new, |(_, remainder)| remainder)
}

/// The quotient and the remainder; none if the divisor is zero.
fn divided(field: &PrimeField, mut rest: Vec<Residue>, by: &[Residue]) -> Option<(Vec<Residue>, Vec<Residue>)> {
    let inverse = field.inv(*by.last()?)?;
    let mut quotient = vec![Residue::ZERO; (rest.len() + 1).saturating_sub(by.len())];
    for place in (0..quotient.len()).rev() {
        let factor = field.mul(rest[place + by.len() - 1], inverse);
        quotient[place] = factor;
        for (x, y) in rest[place..].iter_mut().zip(by) {
            *x = field.sub(*x, field.mul(factor, *y));
        }
    }
    Some((trimmed(quotient), trimmed(rest)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Integer;
    use crate::poly::Monomial;

    /// The polynomial of terms (coefficient, powers of the variables).
    fn poly(terms: &[(i64, &[u32])]) -> Poly {
        let term = |(coefficient, powers): &(i64, &[u32])| {
            let powers = powers.iter().enumerate().map(|(variable, power)| (u32::try_from(variable).unwrap(), *power));
            (Monomial::new(powers), Integer::from(*coefficient))
        };
        Poly::from_terms(terms.iter().map(term)).unwrap()
    }

    #[test]
    fn irreducible_polynomials_are_told_from_products() {
        let work = super::super::work::Work::new(1 << 20);
        let circle = poly(&[(1, &[2]), (1, &[0, 2]), (-3, &[])]);
        let cubic = poly(&[(1, &[3]), (1, &[1, 1]), (1, &[0, 3]), (1, &[])]);
        // Pascal's snail.
        let snail = poly(&[
            (1, &[4]),
            (2, &[2, 2]),
            (1, &[0, 4]),
            (-2, &[3]),
            (-2, &[1, 2]),
            (1, &[2]),
            (-4, &[2]),
            (-4, &[0, 2]),
        ]);
        for irreducible in [&circle, &cubic, &snail] {
            assert!(irreducible.is_proved_irreducible(), "{irreducible:?}");
        }
        for (one, other) in [(&circle, &cubic), (&circle, &circle), (&snail, &cubic)] {
            assert!(!one.mul(other, &work).unwrap().is_proved_irreducible());
        }
        // A product modulo each prime.
        assert!(!poly(&[(1, &[4]), (1, &[])]).is_proved_irreducible());
    }
}
