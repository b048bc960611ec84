//! Matrices of expressions.
//!
//! Entries are kept as the shortest exact form that is at hand: the author's own, or a computed normal form. An inverse
//! need not be written out: cofactors over the determinant are expressions that share their minors, where nothing is
//! multiplied out, some thousand products in place of millions of terms. The normal form of such an entry is as long as
//! ever; its value at a point is cheap.

use super::determinant::determinant;
use super::echelon::Echelon;
use super::matrix::Matrix;
use super::rank::proved_rank;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Arena, Domain, Expr, Facts, Symbol};

/// Products of entries in a determinant, written out, from which on an inverse in normal form is out of proportion.
const LONG: usize = 20_000;

/// Rows up to which all minors are made: they double with each.
const MOST_ROWS: usize = 10;

impl Matrix<Expr> {
    /// Zero.
    pub fn zero(arena: &Arena, height: usize, width: usize) -> Self {
        Self::build(height, width, |_, _| arena.zero())
    }

    /// The identity.
    pub fn identity(arena: &Arena, size: usize) -> Self {
        Self::build(size, size, |i, j| arena.number(i64::from(i == j)))
    }

    /// The sum.
    #[must_use]
    pub fn add(&self, arena: &Arena, other: &Self) -> Self {
        Self::build(self.height(), self.width(), |i, j| arena.add(self.at(i, j), other.at(i, j)))
    }

    /// The product.
    #[must_use]
    pub fn mul(&self, arena: &Arena, other: &Self) -> Self {
        let columns: Vec<Vec<Expr>> = (0..other.width()).map(|column| other.column(column)).collect();
        Self::build(self.height(), other.width(), |i, j| arena.dot(&self.rows()[i], &columns[j]))
    }

    /// The product with a column.
    pub fn apply(&self, arena: &Arena, vector: &[Expr]) -> Vec<Expr> {
        self.rows().iter().map(|row| arena.dot(row, vector)).collect()
    }

    /// The partial derivative of each entry.
    #[must_use]
    pub fn derivative(&self, arena: &Arena, symbol: Symbol) -> Self {
        self.map(|entry| arena.derivative(*entry, symbol))
    }

    /// The matrix with each entry in normal form.
    pub fn normal(&self, arena: &Arena, facts: &Facts) -> Result<Self, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        self.try_map(|entry| Ok(field.show(&field.fraction(*entry)?)))
    }

    /// The inverse in normal form; none if the determinant is zero everywhere.
    pub fn inverse(&self, arena: &Arena, facts: &Facts) -> Result<Option<Self>, Obstacle> {
        let size = self.height();
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let mut augmented = field.matrix(self.rows())?.into_rows();
        for (i, row) in augmented.iter_mut().enumerate() {
            row.extend((0..size).map(|j| if i == j { Fraction::one() } else { Fraction::zero() }));
        }
        let (echelon, _) = Echelon::of(&field, Matrix::new(augmented), size)?;
        let rows = echelon.rows().map(|(_, row)| field.show_all(&row[size..])).collect();
        Ok((echelon.rank() == size).then(|| Self::new(rows)))
    }

    /// The rank over the field of functions that the entries generate.
    pub fn rank(&self, arena: &Arena, facts: &Facts) -> Result<usize, Obstacle> {
        // A rank at a point is a lower bound: the greatest possible one needs no elimination.
        let most = self.height().min(self.width());
        let domain = Domain { facts: facts.clone(), ..Domain::default() };
        if proved_rank(arena, &domain, self.rows(), self.width()) == most {
            return Ok(most);
        }
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        Ok(Echelon::of(&field, field.matrix(self.rows())?, self.width())?.0.rank())
    }

    /// A basis of the columns v with `self * v = 0`.
    pub fn null_space(&self, arena: &Arena, facts: &Facts) -> Result<Vec<Vec<Expr>>, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let (echelon, _) = Echelon::of(&field, field.matrix(self.rows())?, self.width())?;
        Ok(echelon.null_space().iter().map(|vector| field.show_all(vector)).collect())
    }

    /// The determinant in normal form.
    pub fn determinant(&self, arena: &Arena, facts: &Facts) -> Result<Expr, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        Ok(field.show(&determinant(&field, field.matrix(self.rows())?)?))
    }

    /// Tests whether the written-out determinant is too long for its inverse to be read or proved of; not for matrices
    /// that have too many minors.
    pub fn is_long_to_invert(&self, arena: &Arena, facts: &Facts) -> Result<bool, Obstacle> {
        if self.height() > MOST_ROWS {
            return Ok(false);
        }
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let mut products = 1_usize;
        for row in self.rows() {
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
        let Ok(cofactors) = self.cofactors(arena);
        let determinant = arena.dot(&self.rows()[0], &cofactors.rows()[0]);
        (cofactors.transpose(), determinant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::zero::is_zero;

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
