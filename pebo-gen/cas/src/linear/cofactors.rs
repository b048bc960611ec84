//! Square systems by Cramer's rule.
//!
//! In: rows `[matrix | right sides]` with polynomials for a matrix. Out: the solution for each right side. Cofactors
//! are made by minors, row by row and without a division, so that nothing swells before it cancels: elimination over
//! fractions makes the same entries with a greatest common divisor at every step.

use super::matrix::Matrix;
use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};

/// Sizes of matrices for which this pays: below, elimination is as short; above, a determinant has too many terms.
const SIZES: std::ops::RangeInclusive<usize> = 3..=7;

/// The solutions, one for each right side; none if the matrix is not of this kind or its determinant is zero.
pub(crate) fn solutions(
    field: &Field<'_>,
    rows: &[Vec<Fraction>],
    unknowns: usize,
) -> Result<Option<Vec<Vec<Fraction>>>, Obstacle> {
    if rows.len() != unknowns || !SIZES.contains(&unknowns) {
        return Ok(None);
    }
    // Kernels that relate, as sines and cosines, leave factors that only elimination cancels.
    let plain = |row: &Vec<Fraction>| {
        row[..unknowns].iter().all(|entry| entry.denominator().is_one())
            && !row.iter().any(|entry| field.has_relations(entry))
    };
    if !rows.iter().all(plain) {
        return Ok(None);
    }
    let numerators = |row: &Vec<Fraction>| row[..unknowns].iter().map(|entry| entry.numerator().clone()).collect();
    let matrix = Matrix::new(rows.iter().map(numerators).collect());
    let cofactors = matrix.cofactors(field.limit())?;
    let mut determinant = Poly::zero();
    for (entry, cofactor) in matrix.rows()[0].iter().zip(&cofactors.rows()[0]) {
        determinant = &determinant + &entry.mul(cofactor, field.limit())?;
    }
    let determinant = field.of_polynomial(&determinant)?;
    if determinant.is_zero() {
        return Ok(None);
    }
    let cofactors = cofactors.transpose().try_map(|cofactor| field.of_polynomial(cofactor))?;
    let solution = |right: usize| {
        let right = || rows.iter().map(|row| &row[right]);
        let over = |cofactors: &Vec<Fraction>| field.div(&field.dot(right(), cofactors)?, &determinant);
        cofactors.rows().iter().map(over).collect()
    };
    (unknowns..rows[0].len()).map(solution).collect::<Result<_, _>>().map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Facts;
    use crate::linear::Echelon;
    use crate::{Arena, Expr};

    #[test]
    fn solutions_are_those_of_elimination() {
        let arena = Arena::new();
        let q = arena.variable("q");
        let entries = |size: usize| -> Vec<Expr> {
            let entry = |index: usize| {
                let (i, j) = (index / (size + 2), index % (size + 2));
                match (i + 2 * j + i * j) % 5 {
                    0 => arena.add(q, arena.one()),
                    1 => arena.zero(),
                    2 => arena.mul(q, q),
                    _ => arena.variable(&format!("a{i}{j}")),
                }
            };
            (0..size * (size + 2)).map(entry).collect()
        };
        for size in 3..=4 {
            let exprs = entries(size);
            let field = Field::over(&arena, &Facts::new(), &exprs).unwrap();
            let fractions: Vec<Fraction> = exprs.iter().map(|e| field.fraction(*e).unwrap()).collect();
            let rows: Vec<Vec<Fraction>> = fractions.chunks(size + 2).map(<[Fraction]>::to_vec).collect();
            let solved = solutions(&field, &rows, size).unwrap().expect("a square system");
            let (echelon, _) = Echelon::of(&field, Matrix::new(rows), size).unwrap();
            for (column, row) in echelon.rows() {
                for right in 0..2 {
                    assert_eq!(solved[right][column], row[size + right], "{size}");
                }
            }
        }
    }

    #[test]
    fn singular_and_rectangular_systems_are_left_to_elimination() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let field = Field::over(&arena, &Facts::new(), &[a, b]).unwrap();
        let [a, b] = [a, b].map(|e| field.fraction(e).unwrap());
        let row = |x: &Fraction| vec![x.clone(), b.clone(), a.clone(), b.clone()];
        let singular = vec![row(&a), row(&a), row(&b)];
        assert_eq!(solutions(&field, &singular, 3), Ok(None));
        assert_eq!(solutions(&field, &singular[..2], 3), Ok(None));
    }
}
