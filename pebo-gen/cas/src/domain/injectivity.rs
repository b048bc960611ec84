//! Proofs that a function of one symbol is not injective: by two rational numbers, or by the intermediate value
//! theorem.
//!
//! In: a formula, a symbol, the facts of the domain, and a point of it. Out: two values of the symbol at which the
//! formula has the same value, all other symbols being as at the point; or one value, and an interval that does not
//! hold it, at one end of which the formula is less than there and at the other end greater. The whole interval lies in
//! the domain and the formula is continuous on it, as enclosures over it prove; so the formula has the same value
//! somewhere within.

use std::collections::BTreeMap;

use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Symbol};
use crate::number::interval::{Interval, Precision};
use crate::{Domain, Rational, Relation};

const PRECISION: Precision = Precision::new(96);

/// Two values of a symbol at which a formula has the same value.
#[derive(Clone, Debug)]
pub struct Collision {
    /// One value of the symbol.
    pub at: Rational,
    /// An interval that holds the other value, or the other value twice.
    pub between: [Rational; 2],
    /// The values of the formula at `at`, and at the ends of the interval.
    pub values: [Interval; 3],
}

/// Searches for two values of the symbol with the same value of the formula, all other symbols held.
pub fn collision(
    arena: &Arena,
    domain: &Domain,
    conditions: &[(Expr, Relation)],
    formula: Expr,
    symbol: Symbol,
    point: &Point,
) -> Option<Collision> {
    let here = |expr: Expr| {
        let others = point.iter().filter(|(other, _)| **other != symbol).map(|(other, value)| (*other, *value));
        arena.substitute(expr, &others.collect())
    };
    let formula = here(formula);
    // The other facts do not depend on the symbol, so they hold at the point as well as elsewhere.
    let facts = domain.facts.iter().filter(|(fact, _)| arena.symbols_of(&[*fact]).contains(&symbol));
    let conditions: Vec<(Expr, Relation)> =
        facts.chain(conditions.iter().copied()).map(|(expr, relation)| (here(expr), relation)).collect();
    let over = |values: &Interval| {
        let values = BTreeMap::from([(symbol, values.clone())]);
        let holds = |(expr, relation): &(Expr, Relation)| {
            let Some(value) = arena.enclose_over(&[*expr], &values, PRECISION).and_then(|mut all| all.pop()) else {
                return false;
            };
            match relation {
                Relation::Positive => value.is_positive(),
                Relation::NonNegative => value.lo() >= 0.0,
                Relation::NonZero => !value.contains_zero(),
            }
        };
        conditions.iter().all(holds).then(|| arena.enclose_over(&[formula], &values, PRECISION)?.pop()).flatten()
    };
    let number = |value: &Rational| Interval::from_rational(value, PRECISION);
    let trial_values = trial_values(arena, domain, symbol, point);
    let known: Vec<(&Rational, Interval)> =
        trial_values.iter().filter_map(|place| Some((place, over(&number(place)?)?))).collect();
    let exact =
        |place: &Rational| arena.as_number(arena.substitute(formula, &[(symbol, arena.number(place.clone()))].into()));
    let mut exactly: BTreeMap<Rational, &(&Rational, Interval)> = BTreeMap::new();
    let mut simplest: Vec<_> = known.iter().collect();
    simplest.sort_by_key(|place| place.0.abs());
    for place in simplest {
        let Some(value) = exact(place.0) else { continue };
        if let Some((other, value)) = exactly.insert(value, place) {
            let values = [place.1.clone(), value.clone(), value.clone()];
            return Some(Collision { at: place.0.clone(), between: [(*other).clone(), (*other).clone()], values });
        }
    }
    let below = |a: &Interval, b: &Interval| b.sub(a, PRECISION).is_some_and(|ahead| ahead.is_positive());
    for pair in known.windows(2) {
        let [(low, first), (high, last)] = pair else { continue };
        let whole = number(low)?.hull(&number(high)?);
        if over(&whole).is_none() {
            continue;
        }
        let meets = |(place, value): &&(&Rational, Interval)| {
            (*place < *low || *place > *high)
                && ((below(first, value) && below(value, last)) || (below(last, value) && below(value, first)))
        };
        if let Some((at, value)) = known.iter().find(meets) {
            let values = [value.clone(), first.clone(), last.clone()];
            return Some(Collision { at: (*at).clone(), between: [(*low).clone(), (*high).clone()], values });
        }
    }
    None
}

/// Trial values of the symbol, ascending: simple ones, and if both its bounds are known, some between these.
fn trial_values(arena: &Arena, domain: &Domain, symbol: Symbol, point: &Point) -> Vec<Rational> {
    const SUBDIVISIONS: i64 = 24;
    // A formula that rises for a short way only does so beside a bound.
    const BESIDE: [(i64, i64); 4] = [(1, 256), (1, 64), (63, 64), (255, 256)];
    let eighths = [1, 2, 4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96];
    let simple = eighths.iter().flat_map(|n| [-n, *n]).chain([0]);
    let mut trial_values: Vec<Rational> = simple.filter_map(|n| Rational::new(n, 8)).collect();
    trial_values.extend(point.get(&symbol).and_then(|value| arena.as_number(*value)));
    if let Some((low, high)) = domain.bounds(arena, &[symbol].into()).remove(&symbol) {
        let width = &high - &low;
        let part = |(n, d)| Some(&low + &(&width * &Rational::new(n, d)?));
        trial_values.extend((1..SUBDIVISIONS).map(|n| (n, SUBDIVISIONS)).chain(BESIDE).filter_map(part));
    }
    trial_values.sort();
    trial_values.dedup();
    trial_values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::function::Function;

    #[test]
    fn functions_that_rise_and_fall_are_not_injective() {
        let arena = Arena::new();
        let [p, k] = ["p", "k"].map(|name| arena.variable(name));
        let (symbol, other) = (arena.as_symbol(p).unwrap(), arena.as_symbol(k).unwrap());
        let power = |exponent: i64| arena.power(p, &Rational::from(exponent));
        let call = |function| arena.call(function, &[p]);
        let cubic = arena.sub(power(3), arena.mul(k, p));
        let cases = [
            // Formula, bounds of p, domain conditions, expected collision.
            (cubic, None, None, true),
            (cubic, Some((2, 9)), None, false),
            (power(3), None, None, false),
            (power(2), None, Some((p, Relation::NonZero)), true),
            (power(2), None, Some((p, Relation::Positive)), false),
            (call(Function::Abs), None, Some((p, Relation::NonZero)), true),
            (call(Function::Sin), Some((0, 3)), None, true),
            (call(Function::Sin), Some((-1, 1)), None, false),
            // It is one-to-one on both branches combined.
            (power(-1), None, None, false),
            (arena.add(power(-1), p), Some((0, 9)), None, true),
            (call(Function::Sign), None, None, true),
        ];
        for (formula, bounds, ask, expected) in cases {
            let mut domain = Domain::default();
            // A fact about a symbol that the formula does not hold.
            domain.facts.assume(arena.variable("r"), Relation::Positive);
            if let Some((low, high)) = bounds {
                domain.facts.assume(arena.sub(p, arena.number(low)), Relation::Positive);
                domain.facts.assume(arena.sub(arena.number(high), p), Relation::Positive);
            }
            let conditions: Vec<_> = ask.into_iter().collect();
            let point = Point::from([(symbol, arena.number(1)), (other, arena.number(3))]);
            let found = collision(&arena, &domain, &conditions, formula, symbol, &point);
            assert_eq!(found.is_some(), expected, "{}: {found:?}", arena.print(formula));
        }
    }
}
