//! Systems of linear equations in integers, solved modulo growing powers of a prime (Dixon 1982).
//!
//! ```text
//! A x = b: x modulo p from the inverse modulo p, (b - A x) / p, and again -> x modulo p^n -> quotients of integers
//! ```
//!
//! In: an invertible matrix, and right sides. Out: a solution for each, as numerators over one denominator; nothing if
//! the matrix has no inverse modulo the prime, which then divides its determinant. Holds after: a solution satisfies
//! its equations, since both sides of `A numerators = denominator b` agree modulo a number that neither reaches. The
//! work grows with the digits of the solution, while elimination takes those digits in every step.

use super::residues::ResidueRows;
use crate::Integer;
use crate::poly::{PrimeField, Residue, TooLarge, Work, steps};

/// Bits of a prime: with those of a part of an entry, sums of very many products fit double words.
const BITS_OF_PRIME: u32 = 50;

/// Bits of the parts into which the entries of the matrix are split.
const BITS_OF_PART: u32 = 60;

/// Bits of the modulus beyond those of a quotient: a wrong quotient is as short only by chance.
const SPARE_BITS: u64 = 32;

/// `numerators / denominator`.
#[derive(Debug)]
pub(crate) struct QuotientVector {
    pub(crate) numerators: Vec<Integer>,
    /// Positive.
    pub(crate) denominator: Integer,
}

/// A matrix prepared for solutions with any right side.
#[derive(Debug)]
pub(crate) struct Lifting {
    prime: PrimeField,
    /// The inverse modulo the prime.
    inverse: Vec<Vec<Residue>>,
    /// The parts of the entries that are not zero, lowest parts first; of each a list of entries for every row.
    parts: Vec<Vec<Vec<(usize, i64)>>>,
    /// Bits of the largest entry.
    bits: u64,
}

/// The prime that solutions are lifted from.
pub(crate) fn prime() -> Option<PrimeField> {
    PrimeField::below(1 << BITS_OF_PRIME)
}

impl Lifting {
    /// Inverts the matrix modulo the prime, if possible.
    pub(crate) fn of(prime: PrimeField, matrix: &[Vec<Integer>], work: &Work) -> Result<Option<Self>, TooLarge> {
        let size = steps(matrix.len());
        work.spend(size.saturating_mul(size).saturating_mul(size) / 4)?;
        let image = matrix.iter().map(|row| row.iter().map(|entry| prime.from_integer(entry)).collect()).collect();
        let Some(inverse) = inverse(&prime, image) else { return Ok(None) };
        let mut parts = Vec::new();
        let unit = Integer::ONE.shl(BITS_OF_PART);
        let mut rest: Vec<Vec<(usize, Integer)>> =
            matrix.iter().map(|row| row.iter().cloned().enumerate().collect()).collect();
        while rest.iter().flatten().any(|(_, entry)| !entry.is_zero()) {
            let split = |row: &mut Vec<(usize, Integer)>| {
                row.retain(|(_, entry)| !entry.is_zero());
                let part = |(column, entry): &mut (usize, Integer)| {
                    let (numerators, low) = entry.div_rem(&unit)?;
                    *entry = numerators;
                    Some((*column, low.to_i64()?))
                };
                row.iter_mut().map(part).collect::<Option<Vec<_>>>()
            };
            parts.push(rest.iter_mut().map(split).collect::<Option<Vec<_>>>().ok_or(TooLarge)?);
        }
        let bits = matrix.iter().flatten().map(Integer::bits).max().unwrap_or(0);
        Ok(Some(Self { prime, inverse, parts, bits }))
    }

    /// The solution for a right side.
    pub(crate) fn solve(&self, right: &[Integer], work: &Work) -> Result<QuotientVector, TooLarge> {
        let prime = Integer::from(self.prime.prime());
        let (mut residual, mut digits) = (right.to_vec(), Vec::new());
        let (mut modulus, mut wanted) = (Integer::ONE, 2);
        loop {
            while digits.len() < wanted {
                digits.push(self.digit(&mut residual, &prime, work)?);
                modulus = &modulus * &prime;
            }
            work.spend(steps(right.len() * wanted * wanted))?;
            if let Some(solution) = self.solution(&digits, &prime, &modulus, right) {
                return Ok(solution);
            }
            wanted += wanted / 2 + 1;
        }
    }

    /// The next digit of the solution; the residual becomes the remaining right side.
    fn digit(&self, residual: &mut [Integer], prime: &Integer, work: &Work) -> Result<Vec<u64>, TooLarge> {
        let field = &self.prime;
        let size = residual.len();
        work.spend(steps(size * (size + 1)) / 4 + 1)?;
        let image: Vec<Residue> = residual.iter().map(|entry| field.from_integer(entry)).collect();
        let dot = |row: &Vec<Residue>| {
            row.iter().zip(&image).fold(Residue::ZERO, |sum, (a, b)| field.add(sum, field.mul(*a, *b)))
        };
        let digit: Vec<u64> = self.inverse.iter().map(|row| field.value(dot(row))).collect();
        for (index, entry) in residual.iter_mut().enumerate() {
            for (shift, rows) in (0..).step_by(BITS_OF_PART as usize).zip(&self.parts) {
                let sum: i128 = rows[index].iter().map(|(c, part)| i128::from(*part) * i128::from(digit[*c])).sum();
                *entry -= &Integer::from(sum).shl(shift);
            }
            *entry = entry.div_exact(prime).ok_or(TooLarge)?;
        }
        Ok(digit)
    }

    /// The solution that these digits determine, if there are enough.
    fn solution(
        &self,
        digits: &[Vec<u64>],
        prime: &Integer,
        modulus: &Integer,
        right: &[Integer],
    ) -> Option<QuotientVector> {
        let mut numerators: Vec<Integer> = Vec::with_capacity(right.len());
        let mut denominator = Integer::ONE;
        for index in 0..right.len() {
            let add = |sum: Integer, digit: &Vec<u64>| &(&sum * prime) + &Integer::from(digit[index]);
            let value = digits.iter().rev().fold(Integer::ZERO, add);
            let value = centred(&(&denominator * &value), modulus)?;
            if value.bits() + denominator.bits() + SPARE_BITS < modulus.bits() {
                numerators.push(value);
                continue;
            }
            let (numerator, factor) = ratio(&value, modulus)?;
            for known in &mut numerators {
                *known = &*known * &factor;
            }
            denominator = &denominator * &factor;
            numerators.push(numerator);
        }
        // Neither side of the equations reaches half of the modulus.
        let most = |entries: &[Integer]| entries.iter().map(Integer::bits).max().unwrap_or(0);
        let size = Integer::from(i64::try_from(right.len()).ok()?).bits();
        let left = self.bits + most(&numerators) + size;
        (left.max(most(right) + denominator.bits()) + 1 < modulus.bits()).then(|| {
            if denominator.is_negative() {
                numerators = numerators.iter().map(|entry| -entry).collect();
                denominator = -&denominator;
            }
            QuotientVector { numerators, denominator }
        })
    }
}

/// The representative of least absolute value.
fn centred(value: &Integer, modulus: &Integer) -> Option<Integer> {
    let (_, mut rest) = value.div_rem(modulus)?;
    if rest.is_negative() {
        rest += modulus;
    }
    let other = &rest - modulus;
    Some(if other.abs() < rest { other } else { rest })
}

/// The quotient of short integers that a residue represents, by Euclid's algorithm (Wang 1981); none if there is none.
fn ratio(value: &Integer, modulus: &Integer) -> Option<(Integer, Integer)> {
    let (mut before, mut rest) = (modulus.clone(), value.clone());
    let (mut earlier, mut factor) = (Integer::ZERO, Integer::ONE);
    while 2 * rest.bits() > modulus.bits() {
        let (quotient, remainder) = before.div_rem(&rest)?;
        (before, rest) = (rest, remainder);
        let mut next = earlier;
        next.sub_product(&quotient, &factor);
        (earlier, factor) = (factor, next);
    }
    (rest.bits() + factor.bits() + SPARE_BITS < modulus.bits()).then_some((rest, factor))
}

/// The inverse of a matrix modulo a prime.
fn inverse(prime: &PrimeField, matrix: Vec<Vec<Residue>>) -> Option<Vec<Vec<Residue>>> {
    let size = matrix.len();
    let mut rows = ResidueRows::new(prime, 2 * size);
    for (index, mut row) in matrix.into_iter().enumerate() {
        row.resize(2 * size, Residue::ZERO);
        row[size + index] = prime.one();
        rows.insert(row);
    }
    // As many rows as columns: if each of these has a pivot, none is beyond.
    let is_regular = rows.pivots().eq(0..size);
    is_regular.then(|| rows.reduced().rows.into_iter().map(|(_, mut row)| row.split_off(size)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integers(entries: &[i64]) -> Vec<Integer> {
        entries.iter().copied().map(Integer::from).collect()
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        let work = Work::new(u64::MAX);
        let mut word = 7_u64;
        for (size, scale) in [(1, 0), (2, 3), (9, 0), (20, 40), (31, 130)] {
            // Entries of mixed length and sign, some of them zero.
            let mut entry = || {
                word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let value = i64::try_from(word >> 50).expect("14 bits") - (1 << 13);
                if word.is_multiple_of(5) {
                    Integer::ZERO
                } else {
                    Integer::from(value).shl(u32::try_from(word >> 20 & 1).unwrap() * scale)
                }
            };
            let mut matrix: Vec<Vec<Integer>> = (0..size).map(|_| (0..size).map(|_| entry()).collect()).collect();
            matrix.iter_mut().enumerate().for_each(|(index, row)| row[index] += &Integer::from(100_003_i64));
            let right: Vec<Integer> = (0..size).map(|_| entry()).collect();
            let lifting = Lifting::of(prime().unwrap(), &matrix, &work).unwrap().expect("an inverse");
            let QuotientVector { numerators, denominator } = lifting.solve(&right, &work).unwrap();
            assert!(!denominator.is_zero() && !denominator.is_negative());
            for (row, right) in matrix.iter().zip(&right) {
                let sum = row.iter().zip(&numerators).fold(Integer::ZERO, |sum, (a, b)| &sum + &(a * b));
                assert_eq!(sum, right * &denominator, "{size}");
            }
        }
    }

    #[test]
    fn singular_matrices_have_no_lifting() {
        let matrix = [integers(&[1, 2]), integers(&[2, 4])];
        assert!(Lifting::of(prime().unwrap(), &matrix, &Work::new(1000)).unwrap().is_none());
    }

    #[test]
    fn work_is_limited() {
        let matrix = [integers(&[3, 1]), integers(&[1, 5])];
        let lifting = Lifting::of(prime().unwrap(), &matrix, &Work::new(1000)).unwrap().unwrap();
        assert!(lifting.solve(&integers(&[1, 1]), &Work::new(2)).is_err());
    }
}
