//! Points that agree in all but some symbols, and prove that an expression is no combination of others.
//!
//! In: a target, a basis, and the symbols x that the coefficients must not hold. Out: rational points of the domain
//! with the same values of all other symbols, at which the vectors `[basis, target]` are linearly independent, one
//! more than the basis has. No coefficients free of x can then give the target from the basis. With the basis {1} these
//! are two points at which the target differs. No point outside the domain is used, and no normal form.

use std::collections::BTreeSet;

use super::pivots::pivots;
use crate::Domain;
use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Symbol};
use crate::number::interval::{Interval, Precision};

/// The greatest number of values of the other symbols that are tried.
const MOST_PLACES: usize = 24;

/// Points drawn beside each value, beyond the number of vectors needed.
const SPARE: usize = 6;

/// Working precisions that are tried in turn, in bits: the second if the first leaves a pivot open.
const PRECISIONS: [u32; 2] = [64, 256];

/// Points that agree in all but x, with the target's value at each.
#[derive(Clone, Debug)]
pub struct Contrast {
    /// The points.
    pub points: Vec<Point>,
    /// Enclosures of the target.
    pub values: Vec<Interval>,
}

/// Searches for points of the domain which prove that the target is no combination of the basis with coefficients free
/// of x.
pub fn contrast(
    arena: &Arena,
    target: Expr,
    basis: &[Expr],
    x: &BTreeSet<Symbol>,
    domain: &Domain,
) -> Option<Contrast> {
    let mut exprs = basis.to_vec();
    exprs.push(target);
    let hidden: BTreeSet<Symbol> = arena.symbols_of(&exprs).intersection(x).copied().collect();
    if hidden.is_empty() {
        return None;
    }
    domain.points(arena, &exprs).take(MOST_PLACES).find_map(|first| {
        // Simple values of x before any drawn ones: the reader sees these.
        let simple = [0, 1, 2].into_iter().filter_map(|value| {
            let mut point = first.clone();
            point.extend(hidden.iter().map(|symbol| (*symbol, arena.number(value))));
            domain.contains(arena, &point).then_some(point)
        });
        let beside = domain.beside(&first, x);
        let drawn = beside.points(arena, &exprs).take(exprs.len() + SPARE);
        let points: Vec<Point> = std::iter::once(first.clone()).chain(simple).chain(drawn).collect();
        PRECISIONS.iter().find_map(|&bits| independent(arena, &exprs, &points, Precision::new(bits)))
    })
}

/// The first of the points at which the values of the expressions make as many independent vectors as there are
/// expressions.
fn independent(arena: &Arena, exprs: &[Expr], points: &[Point], precision: Precision) -> Option<Contrast> {
    let mut rows: Vec<Vec<Interval>> = Vec::new();
    let mut places = Vec::new();
    for point in points {
        let Some(row) = arena.enclose_all(exprs, point, precision) else { continue };
        rows.push(row);
        places.push(point);
        if rows.len() < exprs.len() {
            continue;
        }
        let mut chosen = pivots(rows.clone(), exprs.len(), precision, arena.budget())?;
        if chosen.len() == exprs.len() {
            chosen.sort_unstable();
            return Some(Contrast {
                points: chosen.iter().map(|&index| places[index].clone()).collect(),
                values: chosen.iter().filter_map(|&index| rows[index].last().cloned()).collect(),
            });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rational;
    use crate::Relation;
    use crate::{Arena, Function};

    /// `p > 3`, with p the symbol that coefficients must not hold.
    fn above_three(arena: &Arena) -> (Domain, Expr, BTreeSet<Symbol>) {
        let p = arena.variable("p");
        let mut domain = Domain::default();
        domain.facts.assume(arena.sub(p, arena.number(3)), Relation::Positive);
        (domain, p, BTreeSet::from([arena.symbol("p")]))
    }

    #[test]
    fn points_outside_the_domain_prove_nothing() {
        let arena = Arena::new();
        let (domain, p, x) = above_three(&arena);
        let cube = arena.power(p, &Rational::from(3));
        let inside = arena.sub(cube, arena.number(27));
        // 27 - p^3 + |p^3 - 27| is 0 on p > 3 and positive below.
        let kink = arena.sub(arena.call(Function::Abs, &[inside]), inside);
        assert!(contrast(&arena, kink, &[arena.one()], &x, &domain).is_none());
        assert!(contrast(&arena, kink, &[arena.one()], &x, &Domain::default()).is_some());
        assert!(contrast(&arena, arena.add(kink, p), &[arena.one(), p], &x, &domain).is_none());
        let found = contrast(&arena, cube, &[arena.one(), p], &x, &domain).unwrap();
        assert_eq!(found.points.len(), 3);
        assert!(found.points.iter().all(|point| domain.contains(&arena, point)));
    }

    #[test]
    fn the_points_agree_in_all_other_symbols() {
        let arena = Arena::new();
        let (domain, p, x) = above_three(&arena);
        let u = arena.symbol("u");
        let found = contrast(&arena, arena.mul(p, arena.of_symbol(u)), &[arena.one()], &x, &domain).unwrap();
        assert_eq!(found.points[0][&u], found.points[1][&u]);
        assert!(!found.values[0].sub(&found.values[1], Precision::new(64)).unwrap().contains_zero());
        // A target free of x needs no points.
        assert!(contrast(&arena, arena.of_symbol(u), &[arena.one()], &x, &domain).is_none());
    }
}
