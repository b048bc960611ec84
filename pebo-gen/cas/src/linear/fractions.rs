//! Linear equations over the field of fractions.
//!
//! In: rows of fractions, or of formulas. Out: echelon forms, solutions, products. Elimination picks the lightest
//! pivot, so that entries remain short; free unknowns are zero. A matrix of numbers is left to `rational_matrix`, which
//! has no use for weights and divides exactly; a small square one of polynomials to `cofactors`.

use super::echelon::Echelon;
use super::elimination::{PlacedRow, Reach, eliminate};
use super::matrix::Matrix;
use super::{cofactors, rational_matrix};
use crate::graph::expr::Expr;
use crate::poly::Work;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Budget, Rational};

impl Field<'_> {
    /// The normal forms of rows of formulas.
    pub fn matrix(&self, rows: &[Vec<Expr>]) -> Result<Matrix<Fraction>, Obstacle> {
        let row = |row: &Vec<Expr>| row.iter().map(|entry| self.fraction(*entry)).collect();
        Ok(Matrix::new(rows.iter().map(row).collect::<Result<_, Obstacle>>()?))
    }

    /// The formulas of fractions.
    pub fn show_all(&self, fractions: &[Fraction]) -> Vec<Expr> {
        fractions.iter().map(|fraction| self.show(fraction)).collect()
    }

    /// The sum of the products of fractions.
    pub fn dot<'a, 'b>(
        &self,
        left: impl IntoIterator<Item = &'a Fraction>,
        right: impl IntoIterator<Item = &'b Fraction>,
    ) -> Result<Fraction, Obstacle> {
        let mut pairs = left.into_iter().zip(right).filter(|(a, b)| !a.is_zero() && !b.is_zero());
        pairs.try_fold(Fraction::zero(), |sum, (a, b)| self.add(&sum, &self.mul(a, b)?))
    }
}

impl Matrix<Fraction> {
    /// The entries, if all are rational numbers.
    pub(super) fn numbers(&self) -> Option<Matrix<Rational>> {
        self.try_map(|entry| entry.to_constant().ok_or(())).ok()
    }

    /// The product.
    pub fn product(&self, field: &Field<'_>, other: &Self) -> Result<Self, Obstacle> {
        let columns = other.transpose();
        let row = |row: &Vec<Fraction>| columns.rows().iter().map(|column| field.dot(row, column)).collect();
        Ok(Self::new(self.rows().iter().map(row).collect::<Result<_, Obstacle>>()?))
    }

    /// The product of the transposed matrix and this, where it has so many columns.
    pub fn gram(&self, field: &Field<'_>, columns: usize) -> Result<Self, Obstacle> {
        let column = |column: usize| self.rows().iter().map(move |row| &row[column]);
        let mut gram: Vec<Vec<Fraction>> = Vec::new();
        for i in 0..columns {
            let mut row: Vec<Fraction> = gram.iter().map(|above| above[i].clone()).collect();
            for j in i..columns {
                row.push(field.dot(column(i), column(j))?);
            }
            gram.push(row);
        }
        Ok(Self::new(gram))
    }
}

impl Echelon {
    /// Eliminates on the first `columns` columns; a row may have more, which are carried along.
    ///
    /// The result's rows span the same space as the given ones, apart from rows that are zero on the
    /// first columns, which come back separately.
    pub fn of(
        field: &Field<'_>,
        matrix: Matrix<Fraction>,
        columns: usize,
    ) -> Result<(Self, Matrix<Fraction>), Obstacle> {
        if let Some(numbers) = matrix.numbers() {
            let (echelon, rest) = rational_matrix::reduced(&numbers, columns, field.limit())?;
            return Ok((echelon.map(Fraction::constant), rest.map(Fraction::constant)));
        }
        // The lightest entry of all: constants before monomials before sums.
        let lightest = |rest: &[PlacedRow<Fraction>]| {
            let entries = rest.iter().enumerate().flat_map(|(index, (_, row))| {
                let entries = row.iter().take(columns).enumerate().filter(|(_, entry)| !entry.is_zero());
                entries.map(move |(column, entry)| (entry.weight() + entry.variables().count(), column, index))
            });
            entries.min().map(|(_, column, index)| (index, column))
        };
        let over = |row: Vec<Fraction>, column: usize| row.iter().map(|entry| field.div(entry, &row[column])).collect();
        let found = eliminate(matrix.into_rows(), Reach::All, lightest, over, |other, row, column| {
            let factor = other[column].clone();
            subtract(field, other, &factor, row)
        })?;
        let mut rows: Vec<_> = found.pivots.into_iter().map(|pivot| (pivot.column, pivot.row)).collect();
        rows.sort_by_key(|(column, _)| *column);
        Ok((Self { rows, columns }, Matrix::new(found.rest)))
    }

    /// Eliminates on the first columns, then the remaining rows on the others.
    pub fn in_order(
        field: &Field<'_>,
        matrix: Matrix<Fraction>,
        (first, columns): (usize, usize),
    ) -> Result<Self, Obstacle> {
        let (before, rest) = Self::of(field, matrix, first)?;
        let (behind, _) = Self::of(field, rest, columns)?;
        let mut rows = before.rows;
        for (column, pivot) in &behind.rows {
            for (_, row) in &mut rows {
                let factor = row[*column].clone();
                subtract(field, row, &factor, pivot)?;
            }
        }
        rows.extend(behind.rows);
        rows.sort_by_key(|(column, _)| *column);
        Ok(Self { rows, columns })
    }

    /// The rows that hold nothing but their pivot in the columns of the elimination.
    pub fn determined(&self) -> impl Iterator<Item = (usize, &[Fraction])> {
        self.rows().filter(|(pivot, row)| {
            let mut entries = row[..self.columns].iter().enumerate();
            entries.all(|(column, entry)| column == *pivot || entry.is_zero())
        })
    }

    /// A basis of the vectors that every row annihilates.
    pub fn null_space(&self) -> Vec<Vec<Fraction>> {
        self.annihilated(&Fraction::zero(), &Fraction::one(), Fraction::opposite)
    }
}

/// A basis of the vectors that rows of numbers annihilate; none if that exceeds the budget.
pub fn null_space_of_numbers(rows: Vec<Vec<Rational>>, columns: usize, budget: &Budget) -> Option<Vec<Vec<Rational>>> {
    let work = Work::within(u64::MAX, budget);
    let (echelon, _) = rational_matrix::reduced(&Matrix::new(rows), columns, &work).ok()?;
    Some(echelon.annihilated(&Rational::ZERO, &Rational::ONE, |entry| -entry))
}

/// `row - factor * other`, the step of every elimination over fractions.
pub(super) fn subtract(
    field: &Field<'_>,
    row: &mut [Fraction],
    factor: &Fraction,
    other: &[Fraction],
) -> Result<(), Obstacle> {
    if factor.is_zero() {
        return Ok(());
    }
    for (entry, other) in row.iter_mut().zip(other) {
        *entry = field.sub(entry, &field.mul(factor, other)?)?;
    }
    Ok(())
}

/// Solves `matrix * unknowns = right` for rows `[matrix | right]` with the right side in the last column; none if there
/// is no solution, zero for free unknowns.
pub fn solve(field: &Field<'_>, rows: Matrix<Fraction>, unknowns: usize) -> Result<Option<Vec<Fraction>>, Obstacle> {
    Ok(solve_each(field, rows, unknowns)?.into_iter().next().flatten())
}

/// As [`solve`] for several right sides, which are the columns behind those of the matrix: one elimination serves
/// them all.
pub fn solve_each(
    field: &Field<'_>,
    rows: Matrix<Fraction>,
    unknowns: usize,
) -> Result<Vec<Option<Vec<Fraction>>>, Obstacle> {
    let width = if rows.height() == 0 { unknowns } else { rows.width() };
    if rows.numbers().is_none()
        && let Some(solutions) = cofactors::solutions(field, rows.rows(), unknowns)?
    {
        return Ok(solutions.into_iter().map(Some).collect());
    }
    let (echelon, rest) = Echelon::of(field, rows, unknowns)?;
    Ok((unknowns..width).map(|right| echelon.solution(&rest, right, &Fraction::zero())).collect())
}
