//! Determinants over the field of fractions.
//!
//! In: a square matrix, or one with more columns than rows. Out: its determinant, or its largest minors. Rows over a
//! common denominator have polynomials for entries; their minors of the first rows are computed once each, row by row,
//! without a division: fractions of fractions, which elimination makes, would swell long before they cancel. Elimination
//! takes over if there are too many minors.

use super::elimination::{PlacedRow, Reach, eliminate, first};
use super::fractions::subtract;
use super::matrix::Matrix;
use super::minors::{Minors, larger, smallest};
use super::rational_matrix;
use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};

/// The greatest number of minors of one size before elimination takes over: those of ten dense rows are no more.
const MOST_MINORS: usize = 256;

/// The determinant of a square matrix.
pub fn determinant(field: &Field<'_>, matrix: Matrix<Fraction>) -> Result<Fraction, Obstacle> {
    if let Some(numbers) = matrix.numbers() {
        return Ok(Fraction::constant(&rational_matrix::determinant(&numbers, field.limit())?));
    }
    match all_minors(field, &matrix)? {
        Some((minors, denominator)) => {
            let total = minors.into_values().next().unwrap_or_default();
            field.div(&field.of_polynomial(&total)?, &denominator)
        }
        None => by_elimination(field, matrix),
    }
}

/// The numerators of the minors of all rows that are not zero, over one denominator; an obstacle if there are too many.
pub fn largest_minors(field: &Field<'_>, matrix: &Matrix<Fraction>) -> Result<Vec<Poly>, Obstacle> {
    let (minors, _) = all_minors(field, matrix)?.ok_or(Obstacle::TooLarge)?;
    Ok(minors.into_values().collect())
}

/// The numerators of the minors of all rows that are not zero, and the denominator of all; none if there are too many.
fn all_minors(field: &Field<'_>, matrix: &Matrix<Fraction>) -> Result<Option<(Minors<Poly>, Fraction)>, Obstacle> {
    if matrix.height().max(matrix.width()) >= u64::BITS as usize {
        return Ok(None);
    }
    let mut denominator = Fraction::one();
    let mut minors = smallest(field.limit());
    for row in matrix.rows() {
        let (entries, common) = field.over_common_denominator(row)?;
        denominator = field.mul(&denominator, &field.of_polynomial(&common)?)?;
        let larger = larger(field.limit(), &minors, &entries)?;
        if larger.len() > MOST_MINORS {
            return Ok(None);
        }
        minors = Minors::new();
        for (columns, minor) in larger {
            let minor = field.of_polynomial(&minor)?;
            if !minor.is_zero() {
                minors.insert(columns, minor.numerator().clone());
            }
        }
    }
    Ok(Some((minors, denominator)))
}

/// By elimination: for matrices whose entries are mostly zero or one and the others long, as that of Hurwitz.
pub fn by_elimination(field: &Field<'_>, matrix: Matrix<Fraction>) -> Result<Fraction, Obstacle> {
    let size = matrix.height();
    // A column without a pivot ends it.
    let next = |rest: &[PlacedRow<Fraction>]| {
        let column = size - rest.len();
        first(Fraction::is_zero)(rest, column).map(|index| (index, column))
    };
    let clear = |other: &mut [Fraction], row: &[Fraction], column: usize| {
        let factor = field.div(&other[column], &row[column])?;
        subtract(field, &mut other[column..], &factor, &row[column..])
    };
    let found = eliminate(matrix.into_rows(), Reach::Below, next, |row, _| Ok(row), clear)?;
    if !found.rest.is_empty() {
        return Ok(Fraction::zero());
    }
    let pivots = found.pivots.iter().map(|pivot| &pivot.row[pivot.column]);
    let total = pivots.into_iter().try_fold(Fraction::one(), |total, pivot| field.mul(&total, pivot))?;
    Ok(if found.odd { total.opposite() } else { total })
}
