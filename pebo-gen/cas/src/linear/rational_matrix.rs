//! Elimination of matrices of numbers.
//!
//! In: rows of rationals. Out: reduced rows, or the determinant. Each row is brought to integers; from then on every
//! entry is a determinant of some of them and every division is exact (Bareiss 1968), so that no common divisor is
//! computed and numbers grow no longer than the answer. Over fractions of polynomials (`fractions`) those determinants
//! would be the longest entries, so that the two share the loop, but no step. Rows and pivots of a large matrix are
//! found modulo a prime, and the rest is solved for by `lifting`; rows that this does not explain, for which that prime
//! was a bad choice, are left to elimination.

use std::cell::RefCell;

use super::echelon::Echelon;
use super::elimination::{Eliminated, Pivot, Reach, by_columns, eliminate, first};
use super::lifting::{self, Lifting};
use super::matrix::Matrix;
use super::residues::ResidueRows;
use crate::poly::{TooLarge, Work, steps};
use crate::{Integer, Rational};

/// Rows and columns from which on lifting is quicker than elimination.
const LARGE: usize = 16;

/// Reduced rows, and a multiple of each of the rows that are zero on the columns of the matrix, and may not be beyond.
pub(crate) type Reduced = (Echelon<Rational>, Matrix<Rational>);

/// Eliminates on the first `columns` columns; a row may have more, which are carried along.
pub(crate) fn reduced(matrix: &Matrix<Rational>, columns: usize, work: &Work) -> Result<Reduced, TooLarge> {
    let rows: Vec<Vec<Integer>> = matrix.rows().iter().map(|row| integers(row).0).collect();
    if rows.len().min(columns) >= LARGE
        && let Some(reduced) = lifted(&rows, columns, work)?
    {
        return Ok(reduced);
    }
    eliminated(rows, columns, work)
}

/// A solution of rows `[matrix | right side]`, with zero for free unknowns; none if there is none.
pub(crate) fn solution(
    matrix: &Matrix<Rational>,
    unknowns: usize,
    work: &Work,
) -> Result<Option<Vec<Rational>>, TooLarge> {
    let (echelon, rest) = reduced(matrix, unknowns, work)?;
    Ok(echelon.solution(&rest, unknowns, &Rational::ZERO))
}

fn eliminated(rows: Vec<Vec<Integer>>, columns: usize, work: &Work) -> Result<Reduced, TooLarge> {
    let found = by_exact_divisions(rows, columns, Reach::All, work)?;
    let over = |n: &Integer, pivot: &Integer| Rational::new(n.clone(), pivot.clone()).unwrap_or(Rational::ZERO);
    let row =
        |Pivot { column, row, .. }: &Pivot<Integer>| (*column, row.iter().map(|n| over(n, &row[*column])).collect());
    let rest = Matrix::new(found.rest).map(|n| Rational::from(n.clone()));
    Ok((Echelon { rows: found.pivots.iter().map(row).collect(), columns }, rest))
}

/// Elimination column by column, in which each division by the pivot before is exact.
fn by_exact_divisions(
    rows: Vec<Vec<Integer>>,
    columns: usize,
    reach: Reach,
    work: &Work,
) -> Result<Eliminated<Integer>, TooLarge> {
    // The pivot before, and the present one.
    let pivots = RefCell::new((Integer::ONE, Integer::ONE));
    let keep = |row: Vec<Integer>, column: usize| {
        let (before, present) = &mut *pivots.borrow_mut();
        *before = std::mem::replace(present, row[column].clone());
        Ok(row)
    };
    let clear =
        |other: &mut [Integer], row: &[Integer], column: usize| clear(other, row, column, &pivots.borrow().0, work);
    eliminate(rows, reach, by_columns(columns, first(Integer::is_zero)), keep, clear)
}

/// The same by lifting; none if pivots modulo the prime are not the pivots.
fn lifted(rows: &[Vec<Integer>], columns: usize, work: &Work) -> Result<Option<Reduced>, TooLarge> {
    let Some(prime) = lifting::prime() else { return Ok(None) };
    let mut echelon = ResidueRows::new(&prime, columns);
    let (mut chosen, mut others) = (Vec::new(), Vec::new());
    for row in rows {
        work.spend(steps(columns * (echelon.rank() + 1)) / 4)?;
        let image = row[..columns].iter().map(|entry| prime.from_integer(entry)).collect();
        if echelon.insert(image) { chosen.push(row) } else { others.push(row) }
    }
    let pivots: Vec<usize> = echelon.pivots().collect();
    let entries = |row: &&Vec<Integer>| pivots.iter().map(|pivot| row[*pivot].clone()).collect::<Vec<_>>();
    let square: Vec<Vec<Integer>> = chosen.iter().map(entries).collect();
    let width = rows.first().map_or(0, Vec::len);
    let free: Vec<usize> = (0..width).filter(|column| !pivots.contains(column)).collect();
    let mut reduced: Vec<(usize, Vec<Rational>)> =
        pivots.iter().map(|pivot| (*pivot, vec![Rational::ZERO; width])).collect();
    for (pivot, row) in &mut reduced {
        row[*pivot] = Rational::ONE;
    }
    let mut rest = vec![vec![Rational::ZERO; width]; others.len()];
    let Some(lifting) = Lifting::of(prime, &square, work)? else { return Ok(None) };
    for column in free {
        let right: Vec<Integer> = chosen.iter().map(|row| row[column].clone()).collect();
        let solution = lifting.solve(&right, work)?;
        let over = |numerator: &Integer| Rational::new(numerator.clone(), solution.denominator.clone()).ok_or(TooLarge);
        for ((_, row), above) in reduced.iter_mut().zip(&solution.numerators) {
            row[column] = over(above)?;
        }
        // The part of another row that the chosen rows do not explain.
        let words = solution.denominator.bits().div_ceil(64) + 1;
        for (other, left) in others.iter().zip(&mut rest) {
            work.spend(words.saturating_mul(steps(pivots.len())))?;
            let mut value = &solution.denominator * &other[column];
            for (pivot, above) in pivots.iter().zip(&solution.numerators) {
                if !other[*pivot].is_zero() {
                    value.sub_product(&other[*pivot], above);
                }
            }
            if column < columns && !value.is_zero() {
                return Ok(None);
            }
            left[column] = over(&value)?;
        }
    }
    Ok(Some((Echelon { rows: reduced, columns }, Matrix::new(rest))))
}

/// The determinant of a square matrix.
pub(crate) fn determinant(matrix: &Matrix<Rational>, work: &Work) -> Result<Rational, TooLarge> {
    let (rows, scales): (Vec<Vec<Integer>>, Vec<Integer>) = matrix.rows().iter().map(|row| integers(row)).unzip();
    let found = by_exact_divisions(rows, matrix.height(), Reach::Below, work)?;
    if !found.rest.is_empty() {
        return Ok(Rational::ZERO);
    }
    let total = found.pivots.last().map_or(Integer::ONE, |Pivot { column, row, .. }| row[*column].clone());
    let denominator = scales.iter().fold(Integer::ONE, |product, scale| &product * scale);
    Rational::new(if found.odd { -&total } else { total }, denominator).ok_or(TooLarge)
}

/// `(pivot * other - factor * row) / last`, which is zero in the column of the pivot.
fn clear(other: &mut [Integer], row: &[Integer], column: usize, last: &Integer, work: &Work) -> Result<(), TooLarge> {
    let (pivot, factor) = (&row[column], other[column].clone());
    // A step is about one product of words.
    let words = pivot.bits().div_ceil(64) + 1;
    work.spend(words.saturating_mul(other.len() as u64))?;
    for (entry, own) in other.iter_mut().zip(row) {
        if entry.is_zero() && (factor.is_zero() || own.is_zero()) {
            continue;
        }
        let mut value = pivot * &*entry;
        value.sub_product(&factor, own);
        *entry = value.div_exact(last).ok_or(TooLarge)?;
    }
    Ok(())
}

/// A row times the least common denominator of its entries, and that.
fn integers(row: &[Rational]) -> (Vec<Integer>, Integer) {
    let common = row.iter().fold(Integer::ONE, |common, entry| common.lcm(&entry.denominator()));
    let scale = Rational::from(common.clone());
    (row.iter().map(|entry| (entry * &scale).numerator()).collect(), common)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i64]], denominator: i64) -> Matrix<Rational> {
        let entry = |n: &i64| Rational::new(*n, denominator).unwrap();
        Matrix::new(rows.iter().map(|row| row.iter().map(entry).collect()).collect())
    }

    #[test]
    fn rows_are_reduced_and_the_rest_has_the_contradictions() {
        let rows = matrix(&[&[0, 2, 4, 1], &[1, 1, 1, 0], &[1, 3, 5, 2], &[2, 4, 6, 1]], 10);
        let (echelon, rest) = reduced(&rows, 3, &Work::new(1_000_000)).unwrap();
        let (rows, rest) = (echelon.rows, rest.into_rows());
        let pivots: Vec<usize> = rows.iter().map(|(column, _)| *column).collect();
        assert_eq!(pivots, [0, 1]);
        let ratio = |n: i64, d: i64| Rational::new(n, d).unwrap();
        assert_eq!(rows[0].1, [ratio(1, 1), ratio(0, 1), ratio(-1, 1), ratio(-1, 2)]);
        assert_eq!(rows[1].1, [ratio(0, 1), ratio(1, 1), ratio(2, 1), ratio(1, 2)]);
        // The third row is the second and the first, but for its right side; the fourth is consistent.
        let wrong: Vec<bool> = rest.iter().map(|row| !row[3].is_zero()).collect();
        assert_eq!(wrong.iter().filter(|wrong| **wrong).count(), 1, "{rest:?}");
        assert!(rest.iter().all(|row| row[..3].iter().all(Rational::is_zero)));
    }

    #[test]
    fn lifting_leaves_what_elimination_leaves() {
        let work = Work::new(u64::MAX);
        let (height, rank, columns, carried) = (24, 17, 20, 2);
        let mut word = 5_u64;
        let mut entry = |_| {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            Integer::from(i64::try_from(word >> 58).expect("six bits") - 31)
        };
        let factors: Vec<Vec<Integer>> = (0..height).map(|_| (0..rank).map(&mut entry).collect()).collect();
        let basis: Vec<Vec<Integer>> = (0..rank).map(|_| (0..columns).map(&mut entry).collect()).collect();
        let product = |row: &Vec<Integer>, column: usize| {
            row.iter().zip(&basis).fold(Integer::ZERO, |sum, (factor, other)| &sum + &(factor * &other[column]))
        };
        let rows: Vec<Vec<Integer>> = factors
            .iter()
            .map(|row| (0..columns).map(|c| product(row, c)).chain((0..carried).map(&mut entry)).collect())
            .collect();
        let by_lifting = lifted(&rows, columns, &work).unwrap().expect("a good prime");
        let by_elimination = eliminated(rows, columns, &work).unwrap();
        assert_eq!(by_lifting.0.rank(), rank);
        let before = |rows: &[(usize, Vec<Rational>)]| {
            rows.iter().map(|(pivot, row)| (*pivot, row[..columns].to_vec())).collect::<Vec<_>>()
        };
        assert_eq!(before(&by_lifting.0.rows), before(&by_elimination.0.rows));
        // The carried columns are determined up to the remaining rows, which span the same.
        let rest = [&by_lifting, &by_elimination].map(|found| {
            assert!(found.1.rows().iter().all(|row| row[..columns].iter().all(Rational::is_zero)));
            found.1.rows().iter().map(|row| row[columns..].to_vec()).collect::<Vec<_>>()
        });
        assert_eq!(rest.each_ref().map(Vec::len), [height - rank; 2]);
        let spans = rest.map(|rest| reduced(&Matrix::new(rest), carried, &work).unwrap().0);
        assert_eq!(spans[0], spans[1]);
    }

    #[test]
    fn determinants_have_their_sign_and_scale() {
        let work = Work::new(1_000_000);
        let value = |rows: &[&[i64]], denominator| determinant(&matrix(rows, denominator), &work).unwrap();
        assert_eq!(value(&[&[0, 1], &[1, 0]], 1), Rational::from(-1));
        assert_eq!(value(&[&[0, 0, 1], &[1, 0, 0], &[0, 1, 0]], 1), Rational::ONE);
        assert_eq!(value(&[&[0, 0, 1], &[0, 1, 0], &[1, 0, 0]], 1), Rational::from(-1));
        assert_eq!(value(&[&[2, 7, 1], &[3, 5, 4], &[6, 9, 8]], 10), Rational::new(5, 1000).unwrap());
        assert_eq!(value(&[&[1, 2], &[2, 4]], 3), Rational::ZERO);
    }
}
