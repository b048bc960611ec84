//! Products and quotients in an array with a cell for every monomial within given degrees.

use super::super::integer::Integer;
use super::division::{Outcome, Rest};
use super::layout::{Exponents, Layout};
use super::multiply::{Factor, Sum, Terms};

/// Boxes larger than this do not stay in the cache: a hash table or a heap is then no slower.
const MAX_CELLS: usize = 1 << 21;

/// The monomials up to some degrees, numbered: the exponents are digits, the last variable's the
/// lowest, so that numbers ascend as monomials do and add up where those are multiplied.
pub(super) struct ExponentBox<'a> {
    layout: &'a Layout,
    degrees: &'a [u32],
    cells: usize,
}

impl<'a> ExponentBox<'a> {
    /// The box of the given degrees, if it has no more cells than are worth it.
    pub(super) fn new(layout: &'a Layout, degrees: &'a [u32], worth: usize) -> Option<Self> {
        let limit = worth.min(MAX_CELLS);
        let cells = degrees.iter().try_fold(1_usize, |cells, degree| {
            cells.checked_mul(*degree as usize + 1).filter(|cells| *cells <= limit)
        })?;
        Some(Self { layout, degrees, cells })
    }

    /// The product of factors whose degrees add up to those of the box.
    pub(super) fn product<S: Sum>(&self, left: &Factor<'_, S::Factor>, right: &Factor<'_, S::Factor>) -> Terms {
        let mut sums = vec![S::default(); self.cells];
        let places = self.places(right.keys);
        for (start, a) in self.places(left.keys).into_iter().zip(left.coefficients) {
            let row = &mut sums[start..];
            for (place, b) in places.iter().zip(right.coefficients) {
                row[*place].add_product(a, b);
            }
        }
        let words = self.layout.words();
        let (mut keys, mut coefficients) = (Vec::new(), Vec::new());
        for (place, sum) in sums.into_iter().enumerate().rev() {
            if !sum.vanishes() {
                let start = keys.len();
                keys.resize(start + words, 0);
                for (index, exponent) in self.exponents(place).into_iter().enumerate() {
                    self.layout.add(&mut keys[start..], index, exponent);
                }
                coefficients.push(sum.into_integer());
            }
        }
        (keys, coefficients)
    }

    /// The quotient of a dividend within the box, with degrees up to the given ones; `spend` is
    /// called for every term of it.
    pub(super) fn quotient<S: Rest, E>(
        &self,
        dividend: &Factor<'_, Integer>,
        divisor: &Factor<'_, S::Factor>,
        degrees: &[u32],
        spend: impl Fn() -> Result<(), E>,
    ) -> Result<Outcome<S::Factor>, E> {
        let mut rest = vec![S::default(); self.cells];
        for (place, value) in self.places(dividend.keys).into_iter().zip(dividend.coefficients) {
            match S::begin(value) {
                Some(sum) => rest[place] = sum,
                None => return Ok(Outcome::Overflow),
            }
        }
        let places = self.places(divisor.keys);
        let (Some(first), Some(leading)) = (places.first(), divisor.coefficients.first()) else {
            return Ok(Outcome::Remainder);
        };
        let others: Vec<(usize, S::Factor)> = places[1..]
            .iter()
            .zip(&divisor.coefficients[1..])
            .map(|(place, value)| (*place, S::negative(value)))
            .collect();
        let lowest = self.exponents(*first);
        let (mut keys, mut coefficients) = (Vec::new(), Vec::new());
        for place in (0..self.cells).rev() {
            if rest[place].vanishes() {
                continue;
            }
            let start = keys.len();
            keys.resize(start + self.layout.words(), 0);
            let exponents = self.exponents(place).into_iter().zip(&lowest).zip(degrees);
            for (index, ((exponent, low), degree)) in exponents.enumerate() {
                match exponent.checked_sub(*low) {
                    // Else a product with it could leave the box.
                    Some(exponent) if exponent <= *degree => {
                        self.layout.add(&mut keys[start..], index, exponent);
                    }
                    _ => return Ok(Outcome::Remainder),
                }
            }
            let coefficient = match rest[place].over(leading) {
                Ok(coefficient) => coefficient,
                Err(outcome) => return Ok(outcome),
            };
            spend()?;
            let row = &mut rest[place - first..];
            for (place, value) in &others {
                row[*place].add_product(&coefficient, value);
            }
            coefficients.push(coefficient);
        }
        Ok(Outcome::Quotient(keys, coefficients))
    }

    fn places(&self, keys: &[u64]) -> Vec<usize> {
        let place = |key| {
            self.degrees
                .iter()
                .enumerate()
                .fold(0, |place, (index, degree)| place * (*degree as usize + 1) + self.layout.get(key, index) as usize)
        };
        keys.chunks_exact(self.layout.words()).map(place).collect()
    }

    fn exponents(&self, mut place: usize) -> Exponents {
        let mut exponents = Exponents::from_elem(0, self.degrees.len());
        for (exponent, degree) in exponents.iter_mut().zip(self.degrees).rev() {
            let base = *degree as usize + 1;
            #[expect(clippy::cast_possible_truncation, reason = "at most the degree")]
            let digit = (place % base) as u32;
            *exponent = digit;
            place /= base;
        }
        exponents
    }
}
