//! Signs over a box of values, by interval arithmetic with subdivision.
//!
//! In: an expression, and a domain that bounds each of its symbols from both sides. Out: its sign, if one holds
//! throughout the box; the box contains the domain. The enclosures and the answer are rigorous; there is no answer
//! where the expression comes close to zero.

use std::collections::BTreeMap;

use crate::domain::Ranges;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Symbol};
use crate::number::interval::{Interval, Precision};
use crate::number::rational::half;
use crate::{Domain, Rational};

/// The greatest number of boxes for one sign.
const MOST_BOXES: usize = 4096;

/// Bits of the enclosures: the width of a box matters more.
const PRECISION: Precision = Precision::new(64);

impl Domain {
    /// The sign of the expression throughout the domain: positive (true) or negative (false).
    pub fn sign_over_box(&self, arena: &Arena, expr: Expr) -> Option<bool> {
        let symbols = arena.symbols_of(&[expr]);
        if symbols.is_empty() {
            return None;
        }
        let ranges = self.bounds(arena, &symbols);
        let whole: Ranges = symbols.iter().map(|s| Some((*s, ranges.get(s)?.clone()))).collect::<Option<_>>()?;
        sign_on_box(arena, expr, whole)
    }
}

/// The sign of the expression on the whole box: positive (true) or negative (false), by division into smaller ones.
pub fn sign_on_box(arena: &Arena, expr: Expr, whole: Ranges) -> Option<bool> {
    // Most expressions without a sign show it at a corner, where they are zero or have another sign.
    let corner = |upper: bool| {
        let at = |(symbol, (low, high)): (&Symbol, &(Rational, Rational))| {
            let end = if upper { high } else { low };
            (*symbol, (end.clone(), end.clone()))
        };
        sign(arena, expr, &whole.iter().map(at).collect())
    };
    if corner(false)? != corner(true)? {
        return None;
    }
    let mut open = vec![whole];
    let mut found: Option<bool> = None;
    for _ in 0..=MOST_BOXES {
        let Some(part) = open.pop() else { return found };
        match sign(arena, expr, &part) {
            Some(sign) if found.is_none_or(|known| known == sign) => found = Some(sign),
            Some(_) => return None,
            None => open.extend(halves(part)?),
        }
    }
    None
}

/// The sign that one enclosure proves.
fn sign(arena: &Arena, expr: Expr, part: &Ranges) -> Option<bool> {
    let mut values = BTreeMap::new();
    for (symbol, (low, high)) in part {
        let ends = [low, high].map(|end| Interval::from_rational(end, PRECISION));
        let [Some(low), Some(high)] = ends else { return None };
        values.insert(*symbol, low.hull(&high));
    }
    let value = arena.enclose_over(&[expr], &values, PRECISION)?.pop()?;
    (!value.contains_zero()).then(|| value.is_positive())
}

/// The box cut in two across its widest side; none if it is a point.
fn halves(part: Ranges) -> Option<[Ranges; 2]> {
    let widest = part.iter().max_by_key(|(_, (low, high))| high - low)?;
    let (symbol, (low, high)) = (*widest.0, widest.1.clone());
    if low == high {
        return None;
    }
    let middle = &(&low + &high) * &half();
    let mut parts = [part.clone(), part];
    parts[0].insert(symbol, (low, middle.clone()));
    parts[1].insert(symbol, (middle, high));
    Some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relation;
    use crate::graph::function::Function;

    /// The domain `low < x < high`, with an irrational end if needed.
    fn between(arena: &Arena, low: Expr, high: Expr) -> Domain {
        let x = arena.variable("x");
        let mut domain = Domain::default();
        domain.facts.assume(arena.sub(x, low), Relation::Positive);
        domain.facts.assume(arena.sub(high, x), Relation::Positive);
        domain
    }

    #[test]
    fn signs_hold_throughout_or_not_at_all() {
        let arena = Arena::new();
        let number = |n: i64| arena.number(n);
        let x = arena.variable("x");
        let third = arena.scale(arena.pi(), &Rational::new(1, 3).expect("a third"));
        let cosine = arena.call(Function::Cos, &[x]);
        // Before the third of a half turn the cosine is above one half, and only there.
        let above = arena.sub(cosine, arena.number(Rational::new(49, 100).expect("a rational")));
        let below = arena.sub(cosine, arena.number(Rational::new(51, 100).expect("a rational")));
        let domain = between(&arena, number(0), third);
        assert_eq!(domain.sign_over_box(&arena, above), Some(true));
        assert_eq!(domain.sign_over_box(&arena, arena.neg(above)), Some(false));
        assert_eq!(domain.sign_over_box(&arena, below), None);
        // Unbounded on one side, and zero within the box.
        let y = arena.variable("y");
        assert_eq!(domain.sign_over_box(&arena, arena.add(above, y)), None);
        assert_eq!(between(&arena, number(-1), number(1)).sign_over_box(&arena, x), None);
    }
}
