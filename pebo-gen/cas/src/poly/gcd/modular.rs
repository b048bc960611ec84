//! The divisor over the integers from divisors modulo primes.

use super::super::Poly;
use super::super::field::{PrimeField, Residue};
use super::super::layout::Layout;
use super::super::work::{TooLarge, Work};
use super::image::Image;
use super::points::Points;
use super::sparse::{Failure, Interpolation, Triple};
use crate::Integer;

/// Runs before the computation is given up. Each has its own prime and points.
const RUNS: usize = 1000;

/// A coefficient that is not yet known modulo enough primes looks random: the chance that it is as
/// short as this is 2^-12.
const SHORT: u64 = 49;

/// The coefficients of the scaled divisor, modulo the product of the primes so far.
struct Lift {
    skeleton: Image,
    coefficients: Vec<Integer>,
    modulus: Integer,
    /// True if another prime would most likely change nothing.
    settled: bool,
}

impl Lift {
    fn new(field: &PrimeField, skeleton: Image) -> Self {
        let coefficients: Vec<Integer> = skeleton.coefficients.iter().map(|c| symmetric(field, *c)).collect();
        let settled = coefficients.iter().all(|coefficient| coefficient.bits() < SHORT);
        Self { skeleton, coefficients, modulus: Integer::from(field.prime()), settled }
    }

    /// Adds the coefficients modulo another prime (Chinese remainders, Garner's form).
    fn add(&mut self, field: &PrimeField, values: &[Residue]) {
        let inverse = field.inv(field.from_integer(&self.modulus)).unwrap_or_default();
        self.settled = true;
        for (coefficient, value) in self.coefficients.iter_mut().zip(values) {
            let difference = field.sub(*value, field.from_integer(coefficient));
            if !difference.is_zero() {
                self.settled = false;
                let digit = symmetric(field, field.mul(difference, inverse));
                coefficient.add_product(&digit, &self.modulus);
            }
        }
        self.modulus *= &Integer::from(field.prime());
    }

    fn to_poly(&self, variables: &[u32]) -> Poly {
        let mut ascending = variables.to_vec();
        ascending.sort_unstable();
        let largest = self.skeleton.rows().flatten().copied().max().unwrap_or(0);
        let layout = Layout::new(ascending.into(), largest);
        let mut keys = vec![0; self.coefficients.len() * layout.words()];
        for (row, key) in self.skeleton.rows().zip(keys.chunks_exact_mut(layout.words())) {
            for (exponent, variable) in row.iter().zip(variables) {
                if let Some(index) = layout.position(*variable) {
                    layout.add(key, index, *exponent);
                }
            }
        }
        Poly::from_unsorted(layout, &keys, self.coefficients.clone())
    }
}

/// The representative of least absolute value.
fn symmetric(field: &PrimeField, residue: Residue) -> Integer {
    let (value, prime) = (i128::from(field.value(residue)), i128::from(field.prime()));
    Integer::from(if value > prime / 2 { value - prime } else { value })
}

/// The problem: the greatest common divisor of two polynomials in the same variables, primitive in the first of the
/// given ones, with bounds of its degrees.
pub(super) struct Problem<'a> {
    pub(super) a: &'a Poly,
    pub(super) b: &'a Poly,
    pub(super) variables: &'a [u32],
    pub(super) bounds: &'a [u32],
    pub(super) work: &'a Work,
}

impl Problem<'_> {
    /// The divisor, primitive. It is verified: it divides both, and its degree in the first
    /// variable is the bound, which that of no common divisor exceeds.
    pub(super) fn solve(&self, points: &mut Points) -> Result<Poly, TooLarge> {
        let main = self.variables[0];
        let leading = self.a.leading_coefficient_in(main).gcd(&self.b.leading_coefficient_in(main), self.work)?;
        // The scaling can raise the degrees by so much.
        let bounds: Vec<u32> = self.variables[1..]
            .iter()
            .zip(&self.bounds[1..])
            .map(|(variable, bound)| bound + leading.degree(*variable))
            .collect();
        let mut degree = self.bounds[0] as usize;
        let mut lift: Option<Lift> = None;
        let mut fields = PrimeField::LARGE.into_iter();
        let mut prime = 0;
        for _ in 0..RUNS {
            if degree == 0 {
                return Ok(Poly::one());
            }
            let field = fields.next().or_else(|| PrimeField::below(prime)).ok_or(TooLarge)?;
            prime = field.prime();
            let triple = Triple {
                a: Image::new(self.a, self.variables, &field),
                b: Image::new(self.b, self.variables, &field),
                leading: Image::new(&leading, self.variables, &field),
            };
            let mut run = Interpolation { field: &field, points, degree, work: self.work };
            let result = match &mut lift {
                None => run.run(&triple, &bounds).map(|image| lift = Some(Lift::new(&field, image))),
                Some(lift) => run.on_skeleton(&triple, &lift.skeleton).map(|values| lift.add(&field, &values)),
            };
            match result {
                Ok(()) => {}
                Err(Failure::TooLarge) => return Err(TooLarge),
                Err(Failure::Unlucky) => lift = None,
                Err(Failure::Degree(lower)) => {
                    degree = lower;
                    lift = None;
                }
            }
            if let Some(found) = &lift
                && found.settled
            {
                if let Some(divisor) = self.verified(found, &leading)? {
                    return Ok(divisor);
                }
                lift = None;
            }
        }
        Err(TooLarge)
    }

    /// The divisor that is lifted, if it is one.
    fn verified(&self, lift: &Lift, leading: &Poly) -> Result<Option<Poly>, TooLarge> {
        let main = self.variables[0];
        let (_, mut divisor) = lift.to_poly(self.variables).primitive();
        if !leading.is_constant() {
            let content = divisor.content_in(&[main], self.work)?;
            match divisor.div_exact(&content, self.work)? {
                Some(part) => divisor = part.primitive().1,
                None => return Ok(None),
            }
        }
        for poly in [self.a, self.b] {
            if divisor.is_zero() || poly.div_exact(&divisor, self.work)?.is_none() {
                return Ok(None);
            }
        }
        Ok(Some(divisor))
    }
}
