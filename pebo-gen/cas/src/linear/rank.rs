//! Ranks and null vectors of matrices over a domain.
//!
//! In: rows of formulas. Out: a rank proved at exact points of the domain by a rigorous elimination, hence a lower
//! bound almost everywhere if the formulas are analytic there; and by exact algebra the vectors that every row provably
//! annihilates.

use super::Echelon;
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
    let entries: Vec<Expr> = rows.iter().flatten().copied().collect();
    let field = Field::over(arena, &domain.facts, &entries)?;
    let fractions = |row: &Vec<Expr>| row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>();
    let mut rest: Vec<Vec<Fraction>> = rows.iter().map(fractions).collect::<Result<_, _>>()?;
    let vanishes_nowhere =
        |entry: &Fraction| entry.to_constant().is_some() || domain.implies(arena, field.show(entry), Relation::NonZero);
    for _ in 0..columns {
        let mut entries: Vec<(usize, usize)> =
            (0..rest.len()).flat_map(|row| (0..columns).map(move |column| (row, column))).collect();
        entries.retain(|(row, column)| !rest[*row][*column].is_zero());
        entries.sort_by_key(|(row, column)| rest[*row][*column].weight());
        let pivot = entries.into_iter().find(|(row, column)| vanishes_nowhere(&rest[*row][*column]));
        let Some((row, column)) = pivot else { return Ok(false) };
        let row = rest.swap_remove(row);
        for other in rest.iter_mut().filter(|other| !other[column].is_zero()) {
            let factor = field.div(&other[column], &row[column])?;
            for (entry, above) in other.iter_mut().zip(&row) {
                *entry = field.sub(entry, &field.mul(&factor, above)?)?;
            }
        }
    }
    Ok(true)
}

/// True if a matrix, whose entries are given row by row, provably has full column rank at a point.
pub fn full_rank_at(arena: &Arena, entries: &[Expr], columns: usize, point: &Point) -> bool {
    rank_at(arena, entries, columns, point) == columns
}

const PRECISION: Precision = Precision::new(256);

fn rank_at(arena: &Arena, entries: &[Expr], columns: usize, point: &Point) -> usize {
    values_at(arena, entries, columns, point).map_or(0, |rows| rank_of(arena, rows, columns))
}

fn values_at(arena: &Arena, entries: &[Expr], columns: usize, point: &Point) -> Option<Vec<Vec<Interval>>> {
    let values = arena.enclose_all(entries, point, PRECISION)?;
    Some(values.chunks(columns).map(<[Interval]>::to_vec).collect())
}

fn rank_of(arena: &Arena, rows: Vec<Vec<Interval>>, columns: usize) -> usize {
    pivots(rows, columns, PRECISION, arena.budget()).map_or(0, |chosen| chosen.len())
}

/// Vectors that every row provably annihilates.
pub fn null_vectors(
    arena: &Arena,
    domain: &Domain,
    rows: &[Vec<Expr>],
    columns: usize,
) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let entries: Vec<Expr> = rows.iter().flatten().copied().collect();
    let field = Field::on(arena, domain, &entries)?;
    let matrix = rows
        .iter()
        .map(|row| row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<Fraction>, _>>())
        .collect::<Result<Vec<_>, _>>()?;
    let (echelon, _) = Echelon::of(&field, matrix, columns)?;
    let vectors: Vec<Vec<Expr>> =
        echelon.null_space().iter().map(|vector| vector.iter().map(|e| field.show(e)).collect()).collect();
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
