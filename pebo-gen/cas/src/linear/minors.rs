//! Minors, row by row: each is computed once, and nothing is divided.
//!
//! In: the minors of some rows, and one more row, over any ring. Out: the minors of all of these; too large, if they
//! take more memory than one problem of many may have, for any time they take.

use std::collections::BTreeMap;
use std::convert::Infallible;

use super::matrix::Matrix;
use crate::graph::arena::Arena;
use crate::graph::expr::Expr;
use crate::poly::{Poly, TooLarge, Work};

/// The memory limit of all minors of one size.
const MOST_BYTES: usize = 1 << 26;

/// The ring of the entries, as a value: a product may need an arena or a limit of work.
pub(crate) trait Ring {
    type Entry: Clone;
    type Error;

    fn zero(&self) -> Self::Entry;
    fn one(&self) -> Self::Entry;
    fn is_zero(&self, a: &Self::Entry) -> bool;
    fn negative(&self, a: &Self::Entry) -> Self::Entry;
    /// `sum + a b`, or `sum - a b` if odd; an error if the sums of one size then take too much memory.
    fn plus(
        &self,
        sum: &Self::Entry,
        bytes: &mut usize,
        odd: bool,
        factors: (&Self::Entry, &Self::Entry),
    ) -> Result<Self::Entry, Self::Error>;
}

impl Ring for Arena {
    type Entry = Expr;
    type Error = Infallible;

    fn zero(&self) -> Expr {
        self.zero()
    }
    fn one(&self) -> Expr {
        self.one()
    }
    fn is_zero(&self, a: &Expr) -> bool {
        self.is_zero(*a)
    }
    fn negative(&self, a: &Expr) -> Expr {
        self.neg(*a)
    }
    fn plus(&self, sum: &Expr, _: &mut usize, odd: bool, (a, b): (&Expr, &Expr)) -> Result<Expr, Infallible> {
        let product = self.mul(*a, *b);
        Ok(self.add(*sum, if odd { self.neg(product) } else { product }))
    }
}

/// Polynomials.
impl Ring for Work {
    type Entry = Poly;
    type Error = TooLarge;

    fn zero(&self) -> Poly {
        Poly::zero()
    }
    fn one(&self) -> Poly {
        Poly::one()
    }
    fn is_zero(&self, a: &Poly) -> bool {
        a.is_zero()
    }
    fn negative(&self, a: &Poly) -> Poly {
        -a
    }
    fn plus(&self, sum: &Poly, bytes: &mut usize, odd: bool, (a, b): (&Poly, &Poly)) -> Result<Poly, TooLarge> {
        let product = a.mul(b, self)?;
        let total = if odd { sum - &product } else { sum + &product };
        *bytes = *bytes + total.bytes() - sum.bytes();
        if *bytes > MOST_BYTES { Err(TooLarge) } else { Ok(total) }
    }
}

/// Minors by the sets of their columns, a bit each.
pub(crate) type Minors<T> = BTreeMap<u64, T>;

/// The minor of no rows.
pub(crate) fn smallest<R: Ring>(ring: &R) -> Minors<R::Entry> {
    BTreeMap::from([(0, ring.one())])
}

/// The minors of one more row than these.
pub(crate) fn larger<R: Ring>(
    ring: &R,
    minors: &Minors<R::Entry>,
    row: &[R::Entry],
) -> Result<Minors<R::Entry>, R::Error> {
    let (mut larger, mut bytes) = (BTreeMap::new(), 0);
    for (columns, minor) in minors {
        for (column, entry) in row.iter().enumerate() {
            let bit = 1 << column;
            if ring.is_zero(entry) || columns & bit != 0 {
                continue;
            }
            let odd = (columns >> column).count_ones() % 2 == 1;
            let sum = larger.entry(columns | bit).or_insert_with(|| ring.zero());
            *sum = ring.plus(sum, &mut bytes, odd, (entry, minor))?;
        }
    }
    Ok(larger)
}

impl<T> Matrix<T> {
    /// For each entry of a square matrix the signed minor without its row and column.
    pub(crate) fn cofactors<R: Ring<Entry = T>>(&self, ring: &R) -> Result<Self, R::Error>
    where
        T: Clone,
    {
        let size = self.height();
        let all = (1_u64 << size) - 1;
        let mut rows = Vec::with_capacity(size);
        for row in 0..size {
            let mut minors = smallest(ring);
            for (_, entries) in self.rows().iter().enumerate().filter(|(other, _)| *other != row) {
                minors = larger(ring, &minors, entries)?;
                minors.retain(|_, minor| !ring.is_zero(minor));
            }
            let signed = |column: usize| match minors.remove(&(all & !(1 << column))) {
                Some(minor) if (row + column) % 2 == 1 => ring.negative(&minor),
                minor => minor.unwrap_or_else(|| ring.zero()),
            };
            rows.push((0..size).map(signed).collect());
        }
        Ok(Self::new(rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Integer;
    use crate::poly::Monomial;

    #[test]
    fn minors_that_take_much_memory_are_given_up_in_time() {
        // A variable of its own for each of so many summands of each entry.
        let entry = |row: u32, column: u32, summands: u32| {
            let of = |k: u32| (Monomial::new([((row * 6 + column) * summands + k, 1)]), Integer::ONE);
            Poly::from_terms((0..summands).map(of)).unwrap()
        };
        let largest = |summands: u32| {
            let ring = Work::new(u64::MAX);
            let mut minors = smallest(&ring);
            for row in 0..6 {
                let entries: Vec<Poly> = (0..6).map(|column| entry(row, column, summands)).collect();
                minors = larger(&ring, &minors, &entries)?;
            }
            Ok(minors.into_values().map(|minor| minor.term_count()).max())
        };
        assert_eq!(largest(1), Ok(Some(720)), "6!");
        assert_eq!(largest(6), Err(TooLarge));
    }
}
