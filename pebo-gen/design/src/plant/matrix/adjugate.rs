//! Inverses that are not written out: cofactors over the determinant, as expressions that share their minors.
//!
//! In: a square matrix. Out: its adjugate and its determinant. The minors of the first rows are made once each, row by
//! row, and nothing is multiplied out: some thousand products in place of millions of terms. The normal form of such an
//! entry is as long as ever; its value at a point is cheap.

use std::collections::BTreeMap;

use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Expr, Facts};

use super::Matrix;

/// Products of entries in a determinant, written out, from which on an inverse in normal form is out of proportion.
const LONG: usize = 20_000;

/// Rows up to which all minors are made: they double with each.
const MOST_ROWS: usize = 10;

impl Matrix {
    /// Tests whether the written-out determinant is too long for its inverse to be read or proved of; not for matrices
    /// that have too many minors.
    pub fn is_long_to_invert(&self, arena: &Arena, facts: &Facts) -> Result<bool, Obstacle> {
        if self.height() > MOST_ROWS {
            return Ok(false);
        }
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let mut products = 1_usize;
        for row in &self.rows {
            let mut terms = 0;
            for entry in row {
                terms += field.fraction(*entry)?.numerator().term_count();
            }
            products = products.saturating_mul(terms);
        }
        Ok(products >= LONG)
    }

    /// The matrix A with `A * self = d`, and the determinant d.
    pub fn adjugate(&self, arena: &Arena) -> (Self, Expr) {
        let size = self.height();
        let minors: Vec<Vec<Expr>> = (0..size).map(|row| self.minors_without(arena, row)).collect();
        let signed = |odd: bool, minor: Expr| if odd { arena.neg(minor) } else { minor };
        let adjugate = Self::build(size, size, |i, j| signed((i + j) % 2 == 1, minors[j][i]));
        let determinant = arena.dot(&self.rows[0], &adjugate.column(0));
        (adjugate, determinant)
    }

    /// For each column the minor without it and the row.
    fn minors_without(&self, arena: &Arena, row: usize) -> Vec<Expr> {
        // By the set of their columns, a bit each.
        let mut minors = BTreeMap::from([(0_u64, arena.one())]);
        for (_, entries) in self.rows.iter().enumerate().filter(|(other, _)| *other != row) {
            let mut larger: BTreeMap<u64, Vec<Expr>> = BTreeMap::new();
            for (columns, minor) in &minors {
                for (column, entry) in entries.iter().enumerate() {
                    let bit = 1 << column;
                    if arena.is_zero(*entry) || columns & bit != 0 {
                        continue;
                    }
                    let product = arena.mul(*entry, *minor);
                    let odd = (columns >> column).count_ones() % 2 == 1;
                    larger.entry(columns | bit).or_default().push(if odd { arena.neg(product) } else { product });
                }
            }
            minors = larger.into_iter().map(|(columns, products)| (columns, arena.sum(products))).collect();
        }
        let all = (1_u64 << self.height()) - 1;
        let without = |column: usize| minors.get(&(all & !(1 << column))).copied();
        (0..self.width()).map(|column| without(column).unwrap_or_else(|| arena.zero())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pebo_cas::Domain;
    use pebo_cas::domain::zero::is_zero;

    #[test]
    fn the_adjugate_times_the_matrix_is_the_determinant() {
        let arena = Arena::new();
        for size in 1..=4 {
            let entry = |i: usize, j: usize| {
                if (i + 2 * j) % 5 == 4 { arena.zero() } else { arena.variable(&format!("a{i}{j}")) }
            };
            let matrix = Matrix::build(size, size, entry);
            let (adjugate, determinant) = matrix.adjugate(&arena);
            let product = adjugate.mul(&arena, &matrix);
            for i in 0..size {
                for j in 0..size {
                    let expected = if i == j { determinant } else { arena.zero() };
                    let difference = arena.sub(product.at(i, j), expected);
                    assert!(is_zero(&arena, difference, &Domain::default()), "{size}: {i}, {j}");
                }
            }
        }
    }

    #[test]
    fn a_diagonal_inverse_is_short_however_large() {
        let arena = Arena::new();
        let symbol = |i: usize, j: usize| arena.variable(&format!("a{i}{j}"));
        let diagonal = Matrix::build(9, 9, |i, j| if i == j { symbol(i, j) } else { arena.zero() });
        assert_eq!(diagonal.is_long_to_invert(&arena, &Facts::new()), Ok(false));
        assert_eq!(Matrix::build(9, 9, symbol).is_long_to_invert(&arena, &Facts::new()), Ok(true));
        assert_eq!(Matrix::build(3, 3, symbol).is_long_to_invert(&arena, &Facts::new()), Ok(false));
    }
}
