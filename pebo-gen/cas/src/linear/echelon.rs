//! Matrices in echelon form: null vectors and solutions are read off them.

use super::matrix::Matrix;
use crate::tower::Fraction;

/// The result of elimination: pivot columns and reduced rows.
#[derive(Debug, PartialEq, Eq)]
pub struct Echelon<T = Fraction> {
    /// Rows in reduced form by ascending pivot columns, where each is one and all others are zero.
    pub(super) rows: Vec<(usize, Vec<T>)>,
    pub(super) columns: usize,
}

impl<T> Echelon<T> {
    /// The number of pivots.
    pub fn rank(&self) -> usize {
        self.rows.len()
    }

    /// The rows with their pivot columns, ascending.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[T])> {
        self.rows.iter().map(|(column, row)| (*column, row.as_slice()))
    }

    /// The columns without a pivot, ascending.
    pub fn free(&self) -> impl Iterator<Item = usize> {
        let is_pivot = |column: &usize| self.rows.binary_search_by_key(column, |(pivot, _)| *pivot).is_ok();
        (0..self.columns).filter(move |column| !is_pivot(column))
    }
}

impl<T: Clone> Echelon<T> {
    /// The rows with other entries.
    pub(super) fn map<U>(self, change: impl Fn(&T) -> U) -> Echelon<U> {
        let row = |(column, row): (usize, Vec<T>)| (column, row.iter().map(&change).collect());
        Echelon { rows: self.rows.into_iter().map(row).collect(), columns: self.columns }
    }

    /// For each free column the vector that every row annihilates with one there, and zero in the other free columns.
    pub(super) fn annihilated(&self, zero: &T, one: &T, negative: impl Fn(&T) -> T) -> Vec<Vec<T>> {
        let vector = |free: usize| {
            let mut vector = vec![zero.clone(); self.columns];
            vector[free] = one.clone();
            for (pivot, row) in &self.rows {
                vector[*pivot] = negative(&row[free]);
            }
            vector
        };
        self.free().map(vector).collect()
    }

    /// The solution with the right side in a column, zero for free unknowns, unless a row that is left contradicts it.
    pub(super) fn solution(&self, rest: &Matrix<T>, right: usize, zero: &T) -> Option<Vec<T>>
    where
        T: PartialEq,
    {
        if rest.rows().iter().any(|row| row[right] != *zero) {
            return None;
        }
        let mut solution = vec![zero.clone(); self.columns];
        for (column, row) in &self.rows {
            solution[*column] = row[right].clone();
        }
        Some(solution)
    }
}
