//! Values at points: rational, and modulo a prime.

use super::Poly;
use super::field::{PrimeField, Residue};
use super::work::{TooLarge, Work, steps};
use crate::Rational;

/// Powers up to here are tabulated.
const TABLE: u32 = 1 << 10;

/// The powers of one coordinate, as far as a table is worth it.
struct PowerTable<T> {
    table: Vec<T>,
    base: T,
}

impl<T: Clone> PowerTable<T> {
    fn new(one: T, base: T, degree: u32, mul: impl Fn(&T, &T) -> T) -> Self {
        let next = |power: &T| Some(mul(power, &base));
        let powers = std::iter::successors(Some(one), next);
        let table = if degree > TABLE { Vec::new() } else { powers.take(degree as usize + 1).collect() };
        Self { table, base }
    }

    fn get(&self, exponent: u32) -> Result<&T, &T> {
        self.table.get(exponent as usize).ok_or(&self.base)
    }
}

/// The coordinate of a variable at one of several points that are the same in every run.
pub(super) fn coordinate(field: &PrimeField, variable: u32, sample: u64) -> Residue {
    let seed = u64::from(variable) + 1;
    field.pow(field.from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)), 2 * sample + 1)
}

impl Poly {
    /// The value modulo a prime, at the point with the given coordinates.
    pub fn evaluate_mod(&self, field: &PrimeField, point: impl Fn(u32) -> Residue) -> Residue {
        let powers: Vec<_> = self
            .variables()
            .iter()
            .zip(self.degrees())
            .map(|(v, degree)| PowerTable::new(field.one(), point(*v), degree, |a, b| field.mul(*a, *b)))
            .collect();
        let mut sum = Residue::ZERO;
        for (key, coefficient) in self.keys().zip(&self.coefficients) {
            let mut value = field.from_integer(coefficient);
            for (index, powers) in powers.iter().enumerate() {
                let exponent = self.layout.get(key, index);
                if exponent > 0 {
                    let power = match powers.get(exponent) {
                        Ok(power) => *power,
                        Err(base) => field.pow(*base, exponent.into()),
                    };
                    value = field.mul(value, power);
                }
            }
            sum = field.add(sum, value);
        }
        sum
    }

    /// The value at the rational point with the given coordinates.
    pub fn evaluate(&self, point: impl Fn(u32) -> Rational, work: &Work) -> Result<Rational, TooLarge> {
        let mut powers = Vec::new();
        for (variable, degree) in self.variables().iter().zip(self.degrees()) {
            let coordinate = point(*variable);
            let bits = coordinate.bits().saturating_mul(u64::from(degree.min(TABLE)));
            work.spend(bits / 64 * u64::from(degree.min(TABLE)) / 2)?;
            powers.push(PowerTable::new(Rational::ONE, coordinate, degree, |a, b| a * b));
        }
        let mut sum = Rational::ZERO;
        for (key, coefficient) in self.keys().zip(&self.coefficients) {
            let mut value = Rational::from(coefficient.clone());
            for (index, powers) in powers.iter().enumerate() {
                match powers.get(self.layout.get(key, index)) {
                    Ok(power) => value *= power,
                    Err(base) => {
                        let exponent = i32::try_from(self.layout.get(key, index));
                        let power = exponent.ok().and_then(|e| base.pow(e)).ok_or(TooLarge)?;
                        value *= &power;
                    }
                }
            }
            sum += &value;
            work.spend(steps(powers.len() + 1).saturating_mul(1 + sum.bits() / 64))?;
        }
        Ok(sum)
    }
}
