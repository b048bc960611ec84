//! Ranks and null vectors of matrices over a domain.
//!
//! In: rows of formulas. Out: a rank proved at exact points of the domain by a rigorous elimination, hence a lower
//! bound almost everywhere if the formulas are analytic there; and by exact algebra the vectors that every row provably
//! annihilates.

use super::echelon::Echelon;
use super::elimination::{PlacedRow, Reach, eliminate};
use super::fractions::subtract;
use super::pivots::pivots;
use crate::domain::zero::is_zero;
use crate::graph::enclosure::Point;
use crate::number::interval::{Interval, Precision};
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Arena, Domain, Expr, Relation};

/// Points that are tried before a rank counts as deficient.
const MOST_POINTS: usize = 6;

/// True if the matrix provably has full column rank at a point of the domain, hence almost everywhere in the point's
/// cell, on which the entries are analytic.
pub fn full_rank(arena: &Arena, domain: &Domain, rows: &[Vec<Expr>], columns: usize) -> bool {
    rows.len() >= columns && proved_rank(arena, domain, rows, columns) == columns
}

/// The largest rank that the matrix provably has at a point of the domain; almost everywhere it is no smaller.
pub fn proved_rank(arena: &Arena, domain: &Domain, rows: &[Vec<Expr>], columns: usize) -> usize {
    let entries: Vec<Expr> = rows.iter().flatten().copied().collect();
    let mut most = 0;
    for point in domain.points(arena, &entries).take(MOST_POINTS) {
        most = most.max(rank_at(arena, &entries, columns, &point));
        if most == columns {
            break;
        }
    }
    most
}

/// True if the matrix provably has full column rank at every point of the domain: an elimination finds pivots that
/// vanish nowhere.
pub fn full_rank_throughout(
    arena: &Arena,
    domain: &Domain,
    rows: &[Vec<Expr>],
    columns: usize,
) -> Result<bool, Obstacle> {
    let field = Field::over(arena, &domain.facts, &rows.concat())?;
    let vanishes_nowhere =
        |entry: &Fraction| entry.to_constant().is_some() || domain.implies(arena, field.show(entry), Relation::NonZero);
    // The lightest first: to find that a pivot has no zeros takes long.
    let choose = |rest: &[PlacedRow<Fraction>]| {
        let entries = (0..rest.len()).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let entry = |(row, column): &(usize, usize)| &rest[*row].1[*column];
        let mut entries: Vec<(usize, usize)> = entries.filter(|place| !entry(place).is_zero()).collect();
        entries.sort_by_key(|place| entry(place).weight());
        entries.into_iter().find(|place| vanishes_nowhere(entry(place)))
    };
    let clear = |other: &mut [Fraction], row: &[Fraction], column: usize| {
        let factor =
            if other[column].is_zero() { Fraction::zero() } else { field.div(&other[column], &row[column])? };
        subtract(&field, other, &factor, row)
    };
    let found = eliminate(field.matrix(rows)?.into_rows(), Reach::Below, choose, |row, _| Ok(row), clear)?;
    Ok(found.pivots.len() == columns)
}

/// True if a matrix, whose entries are given row by row, provably has full column rank at a point.
pub fn full_rank_at(arena: &Arena, entries: &[Expr], columns: usize, point: &Point) -> bool {
    rank_at(arena, entries, columns, point) == columns
}

const PRECISION: Precision = Precision::new(256);

fn rank_at(arena: &Arena, entries: &[Expr], columns: usize, point: &Point) -> usize {
    let rank = || {
        let values = arena.enclose_all(entries, point, PRECISION)?;
        let rows = values.chunks(columns).map(<[Interval]>::to_vec).collect();
        Some(pivots(rows, columns, PRECISION, arena.budget())?.len())
    };
    rank().unwrap_or(0)
}

/// Vectors that every row provably annihilates.
pub fn null_vectors(
    arena: &Arena,
    domain: &Domain,
    rows: &[Vec<Expr>],
    columns: usize,
) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let field = Field::on(arena, domain, &rows.concat())?;
    let (echelon, _) = Echelon::of(&field, field.matrix(rows)?, columns)?;
    let vectors: Vec<Vec<Expr>> = echelon.null_space().iter().map(|vector| field.show_all(vector)).collect();
    for vector in &vectors {
        for row in rows {
            let product = arena.sum(row.iter().zip(vector).map(|(a, b)| arena.mul(*a, *b)));
            if !is_zero(arena, product, domain) {
                return Err(Obstacle::NoWitness);
            }
        }
    }
    Ok(vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_that_are_full_throughout_have_pivots_without_zeros() {
        let arena = Arena::new();
        let [p, q] = ["p", "q"].map(|name| arena.variable(name));
        let (zero, one) = (arena.zero(), arena.one());
        let above = arena.add(arena.mul(q, q), one);
        let full = |rows: &[Vec<Expr>]| full_rank_throughout(&arena, &Domain::default(), rows, 2).unwrap();
        assert!(full(&[vec![p, one], vec![above, zero]]));
        assert!(full(&[vec![zero, one], vec![q, p], vec![one, p]]));
        assert!(!full(&[vec![p, one], vec![q, zero]]));
        // The zeros of p and q are not the same, but neither pivot excludes them.
        assert!(!full(&[vec![p, zero], vec![zero, one], vec![q, zero]]));
        assert!(!full(&[vec![one, p], vec![one, p]]));
    }
}
