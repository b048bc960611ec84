//! Products and quotients in an array with a cell for every monomial within given degrees.

use std::ops::Range;

use super::layout::{Exponents, Layout};
use super::sums::{CoefficientSum, Outcome, PackedFactor, PackedTerms, RemainderSum};
use crate::Integer;

/// Larger boxes exceed the cache: a hash table or a heap is then no slower.
const MAX_CELLS: usize = 1 << 21;

/// The size of a block of sums, which are added to in turn.
const MOST_BYTES_OF_BLOCK: usize = 1 << 15;

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
    pub(super) fn product<S: CoefficientSum>(
        &self,
        left: &PackedFactor<'_, S::Factor>,
        right: &PackedFactor<'_, S::Factor>,
    ) -> PackedTerms {
        let mut sums = vec![S::default(); self.cells];
        let block = self.block(size_of::<S>());
        let (left_places, right_places) = (self.places(left.keys), self.places(right.keys));
        for rows in blocks(&left_places, block) {
            for columns in blocks(&right_places, block) {
                let terms = right_places[columns.clone()].iter().zip(&right.coefficients[columns]);
                for (start, a) in left_places[rows.clone()].iter().zip(&left.coefficients[rows.clone()]) {
                    let row = &mut sums[*start..];
                    for (place, b) in terms.clone() {
                        row[*place].add_product(a, b);
                    }
                }
            }
        }
        self.terms(sums, block)
    }

    /// The terms with these coefficients, one for every cell. A block's keys are those of the first block with the
    /// exponents of the block's first monomial added.
    fn terms<S: CoefficientSum>(&self, sums: Vec<S>, block: usize) -> PackedTerms {
        let words = self.layout.words();
        let count = sums.iter().filter(|sum| !sum.vanishes()).count();
        let (mut keys, mut coefficients) = (Vec::with_capacity(count * words), Vec::with_capacity(count));
        let last: Vec<u64> = (0..block).flat_map(|place| self.key(place)).collect();
        let mut first = self.key(self.cells - block);
        for (place, sum) in sums.into_iter().enumerate().rev() {
            let within = place % block;
            if !sum.vanishes() {
                keys.extend((0..words).map(|word| first[word] + last[within * words + word]));
                coefficients.push(sum.into_integer());
            }
            if within == 0 && place > 0 {
                first = self.key(place - block);
            }
        }
        (keys, coefficients)
    }

    /// The quotient of a dividend within the box, with degrees up to the given ones; `spend` is
    /// called for every term of it.
    pub(super) fn quotient<S: RemainderSum, E>(
        &self,
        dividend: &PackedFactor<'_, Integer>,
        divisor: &PackedFactor<'_, S::Factor>,
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

    /// The number of cells, the monomials in the last variables, that remain in the nearest cache while terms are added
    /// to them.
    fn block(&self, bytes: usize) -> usize {
        let mut block = 1;
        for degree in self.degrees.iter().rev() {
            let larger = block * (*degree as usize + 1);
            if larger * bytes > MOST_BYTES_OF_BLOCK {
                break;
            }
            block = larger;
        }
        block
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

    fn key(&self, place: usize) -> Vec<u64> {
        let mut key = vec![0; self.layout.words()];
        for (index, exponent) in self.exponents(place).into_iter().enumerate() {
            self.layout.add(&mut key, index, exponent);
        }
        key
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

/// The ranges of descending places that lie in one block each.
fn blocks(places: &[usize], block: usize) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut start = 0;
    places.chunk_by(move |a, b| a / block == b / block).map(move |chunk| {
        let range = start..start + chunk.len();
        start = range.end;
        range
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poly::{Monomial, Poly, TooLarge, Work};

    #[test]
    fn a_box_of_many_blocks_holds_the_sum_of_all_products() {
        let poly = |largest: u32, step: u32, sign: i64| {
            let entry = |k: u32| {
                let exponents = [k % largest, k * step % largest, k / largest % largest].into_iter();
                (Monomial::new((0..).zip(exponents)), Integer::from(sign * i64::from(k % 17) + 3))
            };
            Poly::from_terms((0..500).map(entry)).unwrap()
        };
        let work = Work::new(u64::MAX);
        for largest in [13, 31, 37] {
            let (a, b) = (poly(largest, 7, 1), poly(largest, 11, -1));
            let cells: u32 = a.degrees().iter().zip(&b.degrees()).map(|(a, b)| a + b + 1).product();
            assert!(cells as usize > MOST_BYTES_OF_BLOCK / size_of::<i64>(), "more than a block");
            let term_by_term = b.terms().try_fold(Poly::zero(), |sum, (monomial, coefficient)| {
                Ok::<_, TooLarge>(&sum + &a.mul_term(&monomial, coefficient, &work)?)
            });
            assert_eq!(a.mul(&b, &work), term_by_term, "{largest}");
        }
    }
}
