//! Linear relations among columns of residues.
//!
//! In: any number of rows over a prime field. Out: the number of independent rows, and the vectors that all of them
//! annihilate. Rows come one by one, until there are enough: the loop of `elimination` has all of them at once.

use super::echelon::Echelon;
use crate::poly::{PrimeField, Residue};

/// Rows in echelon form.
#[derive(Clone, Debug)]
pub struct ResidueRows<'a> {
    prime: &'a PrimeField,
    columns: usize,
    /// Each with its pivot, the first column in which it is not zero; there it is one.
    echelon: Vec<(usize, Vec<Residue>)>,
}

impl<'a> ResidueRows<'a> {
    /// No rows yet, of so many columns.
    pub fn new(prime: &'a PrimeField, columns: usize) -> Self {
        Self { prime, columns, echelon: Vec::new() }
    }

    /// The number of independent rows.
    pub fn rank(&self) -> usize {
        self.echelon.len()
    }

    /// The first columns in which the rows are not zero, after elimination.
    pub fn pivots(&self) -> impl Iterator<Item = usize> + '_ {
        self.echelon.iter().map(|(pivot, _)| *pivot)
    }

    /// Adds a row; true if it is independent of those before.
    pub fn insert(&mut self, mut row: Vec<Residue>) -> bool {
        let prime = self.prime;
        for (pivot, known) in &self.echelon {
            let factor = row[*pivot];
            if !factor.is_zero() {
                clear(prime, &mut row[*pivot..], factor, &known[*pivot..]);
            }
        }
        let Some(pivot) = row.iter().position(|entry| !entry.is_zero()) else { return false };
        let Some(scale) = prime.inv(row[pivot]) else { return false };
        for entry in &mut row[pivot..] {
            *entry = prime.mul(*entry, scale);
        }
        let place = self.echelon.partition_point(|(known, _)| *known < pivot);
        self.echelon.insert(place, (pivot, row));
        true
    }

    /// The rows in reduced form.
    pub(crate) fn reduced(self) -> Echelon<Residue> {
        let Self { prime, columns, echelon: mut rows } = self;
        for index in (0..rows.len()).rev() {
            let (above, rest) = rows.split_at_mut(index);
            let (pivot, row) = &rest[0];
            for (_, other) in above {
                let factor = other[*pivot];
                if !factor.is_zero() {
                    clear(prime, &mut other[*pivot..], factor, &row[*pivot..]);
                }
            }
        }
        Echelon { rows, columns }
    }

    /// A basis of the vectors that all rows annihilate, each with its last column: the others are left of it, and no
    /// two have the same. A column has a vector if and only if it is a combination of those left of it.
    pub fn null_space(&self) -> Vec<(usize, Vec<Residue>)> {
        let reduced = self.clone().reduced();
        let vectors = reduced.annihilated(&Residue::ZERO, &self.prime.one(), |entry| self.prime.neg(*entry));
        reduced.free().zip(vectors).collect()
    }
}

/// `row - factor * other`
fn clear(prime: &PrimeField, row: &mut [Residue], factor: Residue, other: &[Residue]) {
    for (entry, other) in row.iter_mut().zip(other) {
        *entry = prime.sub(*entry, prime.mul(factor, *other));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_end_in_the_first_column_that_depends_on_those_before() {
        let prime = PrimeField::new(65_537).expect("prime");
        let of = |n: i64| prime.from_u64(u64::try_from(n.rem_euclid(65_537)).expect("not negative"));
        let mut rows = ResidueRows::new(&prime, 4);
        let inserted: Vec<bool> = [[0, 1, 2, 3], [1, 1, 1, 1], [2, 3, 4, 5], [0, 0, 0, 0]]
            .map(|row: [i64; 4]| rows.insert(row.map(of).to_vec()))
            .to_vec();
        assert_eq!((inserted, rows.rank()), (vec![true, true, false, false], 2));
        let expected = [(2, [1, -2, 1, 0]), (3, [2, -3, 0, 1])].map(|(free, v)| (free, v.map(of).to_vec()));
        assert_eq!(rows.null_space(), expected);
    }
}
