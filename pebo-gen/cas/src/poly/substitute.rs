//! Replacing a variable, or a power of it, by a polynomial.

use super::work::{TooLarge, Work};
use super::{Monomial, Poly};
use crate::Integer;

impl Poly {
    /// This with `value` in place of a variable, by Horner's rule over the powers that occur. The
    /// value may have the variable itself.
    pub fn substitute(&self, variable: u32, value: &Self, work: &Work) -> Result<Self, TooLarge> {
        horner(&self.coefficients_in(variable), value, work)
    }

    /// This modulo the relation `variable^degree = value`: no power of the variable as high as
    /// `degree` remains. The value has lower powers of the variable at most; other values are
    /// programming errors.
    pub fn reduce_power(&self, variable: u32, degree: u32, value: &Self, work: &Work) -> Result<Self, TooLarge> {
        debug_assert!(value.degree(variable) < degree, "{variable}^{degree} = {value}");
        if self.degree(variable) < degree {
            return Ok(self.clone());
        }
        if value.degree(variable) > 0 {
            return self.reduce_by(variable, degree, value, work);
        }
        let mut coefficients = self.coefficients_in(variable);
        // Stable: within a class the powers still descend.
        coefficients.sort_by_key(|(exponent, _)| exponent % degree);
        let mut reduced = Self::zero();
        for class in coefficients.chunk_by(|a, b| a.0 % degree == b.0 % degree) {
            let quotients: Vec<_> = class.iter().map(|(e, c)| (e / degree, c.clone())).collect();
            let power = Monomial::new([(variable, class[0].0 % degree)]);
            let part = horner(&quotients, value, work)?.mul_term(&power, &Integer::ONE, work)?;
            reduced = &reduced + &part;
        }
        Ok(reduced)
    }

    /// The remainder of the division by `variable^degree - value`, from the highest power down.
    fn reduce_by(&self, variable: u32, degree: u32, value: &Self, work: &Work) -> Result<Self, TooLarge> {
        let mut rest = self.clone();
        while rest.degree(variable) >= degree {
            let top = rest.degree(variable);
            let leading = rest.leading_coefficient_in(variable);
            let power = leading.mul_term(&Monomial::new([(variable, top - degree)]), &Integer::ONE, work)?;
            let above = power.mul_term(&Monomial::new([(variable, degree)]), &Integer::ONE, work)?;
            rest = &(&rest - &above) + &power.mul(value, work)?;
        }
        Ok(rest)
    }
}

/// The sum of coefficients times powers of a value, the powers descending.
fn horner(powers: &[(u32, Poly)], value: &Poly, work: &Work) -> Result<Poly, TooLarge> {
    let mut sum = Poly::zero();
    let lower = powers.iter().skip(1).map(|(exponent, _)| *exponent).chain([0]);
    for ((exponent, coefficient), next) in powers.iter().zip(lower) {
        sum = &sum + coefficient;
        sum = match exponent - next {
            0 => sum,
            1 => sum.mul(value, work)?,
            gap => sum.mul(&value.pow(gap, work)?, work)?,
        };
    }
    Ok(sum)
}
