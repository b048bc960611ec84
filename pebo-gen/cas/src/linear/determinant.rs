//! Determinants over the field of fractions.
//!
//! In: a square matrix, or one with more columns than rows. Out: its determinant, or its largest minors. Rows over a common denominator have polynomials for entries; their minors
//! of the first rows are computed once each, row by row, without a division: fractions of fractions, which elimination
//! makes, would swell long before they cancel. Elimination takes over if there are too many minors.

use std::collections::BTreeMap;

use super::minors::larger_minors;
use super::{numbers_of, rational_matrix, subtract};
use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};

/// The greatest number of minors of one size before elimination takes over: those of ten dense rows are no more.
const MOST_MINORS: usize = 256;

/// The determinant of a square matrix.
pub fn determinant(field: &Field<'_>, rows: Vec<Vec<Fraction>>) -> Result<Fraction, Obstacle> {
    if let Some(numbers) = numbers_of(&rows) {
        return Ok(Fraction::constant(&rational_matrix::determinant(&numbers, field.limit())?));
    }
    match by_minors(field, &rows)? {
        Some(total) => Ok(total),
        None => by_elimination(field, rows),
    }
}

/// The numerators of the minors of all rows that are not zero, over one denominator; an obstacle if there are too many.
pub fn largest_minors(field: &Field<'_>, rows: &[Vec<Fraction>]) -> Result<Vec<Poly>, Obstacle> {
    let minors = all_minors(field, rows)?.ok_or(Obstacle::TooLarge)?;
    Ok(minors.numerators.into_values().collect())
}

/// By minors; none if there are too many.
fn by_minors(field: &Field<'_>, rows: &[Vec<Fraction>]) -> Result<Option<Fraction>, Obstacle> {
    let Some(Minors { numerators, denominator }) = all_minors(field, rows)? else { return Ok(None) };
    let total = numerators.into_values().next().unwrap_or_default();
    Ok(Some(field.div(&field.of_polynomial(&total)?, &denominator)?))
}

/// The minors of all rows that are not zero.
struct Minors {
    /// By the set of their columns, a bit each.
    numerators: BTreeMap<u64, Poly>,
    /// The denominator of all.
    denominator: Fraction,
}

/// The minors of all rows; none if there are too many.
fn all_minors(field: &Field<'_>, rows: &[Vec<Fraction>]) -> Result<Option<Minors>, Obstacle> {
    if rows.iter().map(Vec::len).chain([rows.len()]).any(|size| size >= u64::BITS as usize) {
        return Ok(None);
    }
    let work = field.limit();
    let mut denominator = Fraction::one();
    let mut minors = BTreeMap::from([(0_u64, Poly::one())]);
    for row in rows {
        let mut common = Poly::one();
        for entry in row {
            common = common.lcm(entry.denominator(), work)?;
        }
        denominator = field.mul(&denominator, &field.of_polynomial(&common)?)?;
        let entries = row.iter().map(|entry| field.over_denominator(entry, &common)).collect::<Result<Vec<_>, _>>()?;
        let larger = larger_minors(&minors, &entries.iter().collect::<Vec<_>>(), work)?;
        if larger.len() > MOST_MINORS {
            return Ok(None);
        }
        minors = BTreeMap::new();
        for (columns, minor) in larger {
            let minor = field.of_polynomial(&minor)?;
            if !minor.is_zero() {
                minors.insert(columns, minor.numerator().clone());
            }
        }
    }
    Ok(Some(Minors { numerators: minors, denominator }))
}

/// By elimination: for matrices whose entries are mostly zero or one and the others long, as that of Hurwitz.
pub fn by_elimination(field: &Field<'_>, mut rows: Vec<Vec<Fraction>>) -> Result<Fraction, Obstacle> {
    let mut total = Fraction::one();
    for column in 0..rows.len() {
        let Some(pivot) = (column..rows.len()).find(|row| !rows[*row][column].is_zero()) else {
            return Ok(Fraction::zero());
        };
        if pivot != column {
            rows.swap(pivot, column);
            total = total.opposite();
        }
        total = field.mul(&total, &rows[column][column])?;
        let (above, below) = rows.split_at_mut(column + 1);
        let pivot_row = &above[column];
        for row in below {
            let factor = field.div(&row[column], &pivot_row[column])?;
            subtract(field, &mut row[column..], &factor, &pivot_row[column..])?;
        }
    }
    Ok(total)
}
