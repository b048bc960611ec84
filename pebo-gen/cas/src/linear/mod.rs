//! Exact linear algebra over the field of fractions.
//!
//! Elimination picks the lightest pivot, so that entries remain short; free unknowns are zero. A matrix of numbers is
//! left to `rational_matrix`, which has no use for weights and divides exactly; `determinant` takes the same steps
//! without clearing the entries above a pivot.

mod cofactors;
pub mod combination;
pub mod comparison;
pub mod contrast;
pub mod determinant;
mod lifting;
mod minors;
pub mod pivots;
pub mod rank;
pub(crate) mod rational_matrix;
pub mod residues;

use super::poly::Work;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Budget, Rational};
use rational_matrix::ReducedMatrix;

/// The result of elimination: pivot columns and reduced rows.
#[derive(Debug)]
pub struct Echelon {
    /// Rows in reduced form, each with its pivot column, where it is one.
    rows: Vec<(usize, Vec<Fraction>)>,
    columns: usize,
}

impl Echelon {
    /// Eliminates on the first `columns` columns; a row may have more, which are carried along.
    ///
    /// The result's rows span the same space as the given ones, apart from rows that are zero on the
    /// first columns, which come back separately.
    pub fn of(
        field: &Field<'_>,
        rows: Vec<Vec<Fraction>>,
        columns: usize,
    ) -> Result<(Self, Vec<Vec<Fraction>>), Obstacle> {
        if let Some(numbers) = numbers_of(&rows) {
            let ReducedMatrix { rows, rest } = rational_matrix::reduced(&numbers, columns, field.limit())?;
            let fractions = |row: Vec<Rational>| row.iter().map(Fraction::constant).collect::<Vec<_>>();
            let rows = rows.into_iter().map(|(column, row)| (column, fractions(row))).collect();
            return Ok((Self { rows, columns }, rest.into_iter().map(fractions).collect()));
        }
        let mut rest = rows;
        let mut done: Vec<(usize, Vec<Fraction>)> = Vec::new();
        loop {
            // The lightest entry of all: constants before monomials before sums.
            let pivot = rest
                .iter()
                .enumerate()
                .flat_map(|(index, row)| {
                    row.iter()
                        .take(columns)
                        .enumerate()
                        .filter(|(_, entry)| !entry.is_zero())
                        .map(move |(column, entry)| (entry.weight() + entry.variables().count(), column, index))
                })
                .min();
            let Some((_, column, index)) = pivot else { break };
            let row = rest.swap_remove(index);
            let row = row.iter().map(|entry| field.div(entry, &row[column])).collect::<Result<Vec<_>, _>>()?;
            for other in rest.iter_mut().chain(done.iter_mut().map(|(_, row)| row)) {
                let factor = other[column].clone();
                subtract(field, other, &factor, &row)?;
            }
            done.push((column, row));
        }
        done.sort_by_key(|(column, _)| *column);
        Ok((Self { rows: done, columns }, rest))
    }

    /// Eliminates on the first columns, then the remaining rows on the others.
    pub fn in_order(
        field: &Field<'_>,
        rows: Vec<Vec<Fraction>>,
        (first, columns): (usize, usize),
    ) -> Result<Self, Obstacle> {
        let (before, rest) = Self::of(field, rows, first)?;
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

    /// The number of pivots.
    pub fn rank(&self) -> usize {
        self.rows.len()
    }

    /// The rows with their pivot columns, ascending.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[Fraction])> {
        self.rows.iter().map(|(column, row)| (*column, row.as_slice()))
    }

    /// A basis of the vectors that every row annihilates.
    pub fn null_space(&self) -> Vec<Vec<Fraction>> {
        let is_pivot = |column: usize| self.rows.iter().any(|(pivot, _)| *pivot == column);
        (0..self.columns)
            .filter(|column| !is_pivot(*column))
            .map(|free| {
                let mut vector = vec![Fraction::zero(); self.columns];
                vector[free] = Fraction::one();
                for (pivot, row) in &self.rows {
                    vector[*pivot] = row[free].opposite();
                }
                vector
            })
            .collect()
    }
}

/// A basis of the vectors that rows of numbers annihilate; none if that exceeds the budget.
pub fn null_space_of_numbers(rows: &[Vec<Rational>], columns: usize, budget: &Budget) -> Option<Vec<Vec<Rational>>> {
    let ReducedMatrix { rows, .. } = rational_matrix::reduced(rows, columns, &Work::within(u64::MAX, budget)).ok()?;
    let is_pivot = |column: &usize| rows.iter().any(|(pivot, _)| pivot == column);
    let vector = |free: usize| {
        let mut vector = vec![Rational::ZERO; columns];
        vector[free] = Rational::ONE;
        for (pivot, row) in &rows {
            vector[*pivot] = -&row[free];
        }
        vector
    };
    Some((0..columns).filter(|column| !is_pivot(column)).map(vector).collect())
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

/// The entries, if all are rational numbers.
pub(super) fn numbers_of(rows: &[Vec<Fraction>]) -> Option<Vec<Vec<Rational>>> {
    rows.iter().map(|row| row.iter().map(Fraction::to_constant).collect()).collect()
}

/// Solves `matrix * unknowns = right` for rows `[matrix | right]` with the right side in the last column; none if there
/// is no solution, zero for free unknowns.
pub fn solve(field: &Field<'_>, rows: Vec<Vec<Fraction>>, unknowns: usize) -> Result<Option<Vec<Fraction>>, Obstacle> {
    Ok(solve_each(field, rows, unknowns)?.into_iter().next().flatten())
}

/// As [`solve`] for several right sides, which are the columns behind those of the matrix: one elimination serves
/// them all.
pub fn solve_each(
    field: &Field<'_>,
    rows: Vec<Vec<Fraction>>,
    unknowns: usize,
) -> Result<Vec<Option<Vec<Fraction>>>, Obstacle> {
    let width = rows.first().map_or(unknowns, Vec::len);
    if numbers_of(&rows).is_none()
        && let Some(solutions) = cofactors::solutions(field, &rows, unknowns)?
    {
        return Ok(solutions.into_iter().map(Some).collect());
    }
    let (echelon, rest) = Echelon::of(field, rows, unknowns)?;
    let solution = |right: usize| {
        if rest.iter().any(|row| !row[right].is_zero()) {
            return None;
        }
        let mut solution = vec![Fraction::zero(); unknowns];
        for (column, row) in echelon.rows() {
            solution[column] = row[right].clone();
        }
        Some(solution)
    };
    Ok((unknowns..width).map(solution).collect())
}
