//! Exact values, and errors beside them.
//!
//! In: formulas and a point. Out: an enclosure of each value, and its variation when all its arguments are rounded;
//! errors of computed values, in units of that variation.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::super::literal::Scalar;
use super::moved::{BITS, Moves};
use super::points::Place;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Arena, Expr, Rational, Symbol};

/// More units are a loss that no author expects.
pub(super) const MOST: f64 = 100.0;

/// A part of a rounding by which a point on a border leaves the domain, and one beside it does not.
const WITHIN: f64 = 1e-12;

/// An exact value, and how much it moves when all that it depends on is rounded; none where it does not exist.
pub(super) type Value = Option<(Interval, f64)>;

/// Exact values at a point.
pub(super) struct Exact {
    pub(super) values: Vec<Value>,
}

/// Half the distance from 1 to the next number: the relative variation of an argument by rounding.
fn roundoff(scalar: Scalar) -> f64 {
    match scalar {
        Scalar::F32 => f64::from(f32::EPSILON) / 2.0,
        Scalar::F64 => f64::EPSILON / 2.0,
    }
}

/// The values of expressions; where they do not all exist, of each by itself.
pub(super) fn exact(arena: &Arena, exprs: &[Expr], place: &Place, scalar: Scalar) -> Exact {
    let values = at_once(arena, exprs, place, scalar).unwrap_or_else(|| {
        let alone = exprs.iter().map(|&expr| at_once(arena, &[expr], place, scalar)?.pop().flatten());
        alone.collect()
    });
    Exact { values }
}

/// The same in one pass, none if one of them has no value.
pub(super) fn at_once(arena: &Arena, exprs: &[Expr], place: &Place, scalar: Scalar) -> Option<Vec<Value>> {
    let still = at(arena, exprs, place, None)?;
    let parts = arena.postorder(exprs);
    let values = arena.enclose_over(&parts, &still, Precision::new(BITS))?;
    let known: FxHashMap<Expr, &Interval> = parts.iter().copied().zip(&values).collect();
    let moves = Moves::of(arena, &still, &parts, &values);
    let effects: Vec<Option<f64>> = exprs.iter().map(|expr| moves.effect(*expr)).collect();
    let unknown: Vec<Expr> =
        exprs.iter().zip(&effects).filter(|(_, effect)| effect.is_none()).map(|(e, _)| *e).collect();
    let still: Option<Vec<Interval>> = unknown.iter().map(|expr| Some((*known.get(expr)?).clone())).collect();
    let mut others = by_differences(arena, &unknown, &still?, (place, roundoff(scalar))).into_iter();
    let values = exprs
        .iter()
        .zip(effects)
        .map(|(expr, effect)| Some(((*known.get(expr)?).clone(), effect.or_else(|| others.next())?)));
    Some(values.collect())
}

/// The effects of the arguments one at a time, each varied by this part: combined, the effects of some would cancel, as
/// those of b and c in a*b - c where that is small. Without bound where a rounded argument may have no value, but one that
/// is moved by far less has: `sqrt(a - b)` a rounding beyond its border, and not on it.
fn by_differences(arena: &Arena, exprs: &[Expr], still: &[Interval], (place, part): (&Place, f64)) -> Vec<f64> {
    let mut effects = vec![0.0; exprs.len()];
    for symbol in arena.symbols_of(exprs) {
        let moving: BTreeSet<Symbol> = [symbol].into();
        let reached: Vec<usize> = (0..exprs.len()).filter(|index| arena.depends_on(exprs[*index], &moving)).collect();
        let there = |indices: &[usize], part: f64| {
            let exprs: Vec<Expr> = indices.iter().map(|index| exprs[*index]).collect();
            arena.enclose_over(&exprs, &at(arena, &exprs, place, Some((symbol, part)))?, Precision::new(BITS))
        };
        let moved: Vec<Option<Interval>> = match there(&reached, part) {
            Some(values) => values.into_iter().map(Some).collect(),
            None => reached.iter().map(|index| there(&[*index], part)?.pop()).collect(),
        };
        for (index, moved) in reached.iter().zip(moved) {
            let has_value = |part: f64| there(&[*index], part).is_some();
            let is_beyond = || [part, -part].iter().any(|part| !has_value(*part) && has_value(part * WITHIN));
            effects[*index] += match moved.and_then(|moved| moved.sub(&still[*index], Precision::new(BITS))) {
                Some(difference) => surely(&difference) / part,
                None if is_beyond() => f64::INFINITY,
                None => 0.0,
            };
        }
    }
    effects
}

/// The arguments of expressions at a point; one of them may be varied by a part of it.
fn at(
    arena: &Arena,
    exprs: &[Expr],
    place: &Place,
    moved: Option<(Symbol, f64)>,
) -> Option<BTreeMap<Symbol, Interval>> {
    let entry = |symbol: Symbol| {
        // In full: value (1 + part) has more digits than a number of f64.
        let value = Rational::from_f64_exact(place.get(&symbol).copied().unwrap_or(1.0))?;
        let part = Rational::from_f64_exact(moved.filter(|(own, _)| *own == symbol).map_or(0.0, |(_, part)| part))?;
        Some((symbol, Interval::from_rational(&(&value + &(&value * &part)), Precision::new(BITS))?))
    };
    arena.symbols_of(exprs).into_iter().map(entry).collect()
}

impl Exact {
    /// The errors of computed values, in units of the effect of rounding.
    pub(super) fn units(&self, computed: &[f64], scalar: Scalar) -> Vec<f64> {
        // The least number with all digits, and the largest.
        let (least, largest) = match scalar {
            Scalar::F32 => (f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)),
            Scalar::F64 => (f64::MIN_POSITIVE, f64::MAX),
        };
        let units = |(exact, &found): (&Value, &f64)| {
            let Some((value, condition)) = exact else { return 0.0 };
            if magnitude(value) > largest / 4.0 || condition.is_infinite() {
                // Nothing that the scalar could hold, or nothing that rounded arguments determine.
                return 0.0;
            }
            let Some(found) = Rational::from_f64_exact(found) else { return f64::INFINITY };
            let error = Interval::from_rational(&found, Precision::new(BITS))
                .and_then(|found| found.sub(value, Precision::new(BITS)))
                .map_or(f64::INFINITY, |error| magnitude(&error));
            let unit = roundoff(scalar) * (condition + surely(value));
            // Without a unit the value is 0 whatever the arguments: only numbers in the formula are rounded.
            if error > least && unit > 0.0 { error / unit } else { 0.0 }
        };
        self.values.iter().zip(computed).map(units).collect()
    }

    /// Sizes for units, one for each value that exists: its absolute value plus its variation.
    pub(super) fn sizes(&self) -> impl Iterator<Item = Option<f64>> {
        self.values.iter().map(|exact| exact.as_ref().map(|(value, condition)| condition + magnitude(value)))
    }
}

fn magnitude(value: &Interval) -> f64 {
    value.hi().abs().max(value.lo().abs())
}

/// The least absolute value in an enclosure: the width of an enclosure of zero is no size.
fn surely(value: &Interval) -> f64 {
    if value.lo() <= 0.0 && value.hi() >= 0.0 { 0.0 } else { value.hi().abs().min(value.lo().abs()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::accuracy::moved::MOVE;
    use pebo_cas::Function;

    const PLACE: [f64; 3] = [0.3, 1.7, -0.6];

    fn both(arena: &Arena, expr: Expr, place: [f64; 3]) -> (Option<f64>, f64) {
        let place: Place = ["a", "b", "c"].map(|name| arena.symbol(name)).into_iter().zip(place).collect();
        let still = at(arena, &[expr], &place, None).unwrap();
        let parts = arena.postorder(&[expr]);
        let values = arena.enclose_over(&parts, &still, Precision::new(BITS)).unwrap();
        let effect = Moves::of(arena, &still, &parts, &values).effect(expr);
        (effect, by_differences(arena, &[expr], &values[parts.len() - 1..], (&place, MOVE))[0])
    }

    #[test]
    fn effects_to_first_order_are_those_of_small_moves() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let root = arena.sqrt(arena.add(arena.mul(a, a), arena.mul(b, b)));
        for expr in [
            arena.div(arena.mul(call(Function::Sin, &[a]), b), c),
            arena.sub(root, c),
            arena.mul(call(Function::Atan2, &[a, b]), call(Function::Exp, &[c])),
            arena.sub(call(Function::Abs, &[arena.sub(a, b)]), call(Function::Max, &[a, c])),
            arena.power(arena.mul(a, b), &Rational::new(-5, 2).unwrap()),
            // Differences of two large products.
            arena.sub(arena.mul(a, arena.add(b, c)), arena.mul(a, b)),
        ] {
            let (effect, difference) = both(&arena, expr, PLACE);
            // The curvature of the value over a variation of 1e-9.
            let close = effect.is_some_and(|effect| (effect - difference).abs() <= 1e-6 * difference);
            assert!(close, "{}: {effect:?}, {difference}", arena.print(expr));
        }
    }

    #[test]
    fn a_zero_that_is_enclosed_has_no_unit() {
        // At b = 0 no argument moves it, and the enclosure of `sin(a) - sin(a)*(1 + b)` is as wide as its digits are.
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let sine = arena.call(Function::Sin, &[a]);
        let third = arena.scale(sine, &Rational::new(1, 3).unwrap());
        let vanishing = arena
            .sub(arena.call(Function::Sin, &[arena.add(a, arena.mul(b, b))]), arena.scale(third, &Rational::from(3)));
        let parts = arena.add(arena.div(vanishing, a), arena.mul(b, b));
        let place: Place = [(arena.symbol("a"), 0.3), (arena.symbol("b"), 0.0)].into();
        let units = exact(&arena, &[parts], &place, Scalar::F64).units(&[1e-17], Scalar::F64);
        assert_eq!(units, [0.0]);
        // Beside it there is one.
        let place: Place = [(arena.symbol("a"), 0.3), (arena.symbol("b"), 0.1)].into();
        assert!(exact(&arena, &[parts], &place, Scalar::F64).units(&[1.0], Scalar::F64)[0] > MOST);
    }

    #[test]
    fn near_the_zero_of_a_root_a_rounding_is_no_move_of_more() {
        // (a - b)^(1/3) is as steep there as it is for a rounding of a; over a larger variation it is curved.
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let root = arena.power(arena.sub(a, b), &Rational::new(1, 3).unwrap());
        let place: Place = [(arena.symbol("a"), 27.0 + 16.0 * f64::EPSILON), (arena.symbol("b"), 27.0)].into();
        let value = (16.0 * f64::EPSILON).cbrt();
        let units = exact(&arena, &[root], &place, Scalar::F64).units(&[value * 1.1], Scalar::F64)[0];
        assert!(units < MOST, "{units}");
        assert!(exact(&arena, &[root], &place, Scalar::F64).units(&[1.0], Scalar::F64)[0] > MOST);
    }

    #[test]
    fn a_rounding_beyond_a_border_determines_nothing() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let steep = arena.power(arena.sub(a, b), &Rational::new(-1, 2).unwrap());
        let near: Place = [(arena.symbol("a"), 4.0), (arena.symbol("b"), 4.0 - f64::EPSILON)].into();
        assert_eq!(exact(&arena, &[steep], &near, Scalar::F64).units(&[f64::INFINITY], Scalar::F64), [0.0]);
        // Away from the border no rounding makes it infinite; on it the value is that of the point.
        let away: Place = [(arena.symbol("a"), 4.0), (arena.symbol("b"), 3.0)].into();
        assert!(exact(&arena, &[steep], &away, Scalar::F64).units(&[f64::INFINITY], Scalar::F64)[0].is_infinite());
        let root = arena.sqrt(arena.sub(a, b));
        let on: Place = [(arena.symbol("a"), 4.0), (arena.symbol("b"), 4.0)].into();
        assert!(
            exact(&arena, &[arena.add(a, root)], &on, Scalar::F64).units(&[f64::NAN], Scalar::F64)[0].is_infinite()
        );
    }

    #[test]
    fn no_effect_is_told_where_it_is_not_of_first_order() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let square = |e| arena.mul(e, e);
        let difference = arena.sub(a, b);
        // Zero everywhere; a kink; a root that begins.
        let mixed = arena.scale(arena.mul(a, b), &Rational::from(2));
        let zero = arena.sub(square(arena.add(a, b)), arena.sum([square(a), square(b), mixed]));
        let kink = arena.call(Function::Abs, &[difference]);
        for (expr, place) in [(zero, PLACE), (kink, [0.3, 0.3, 1.0]), (arena.sqrt(difference), [0.3, 0.3, 1.0])] {
            assert_eq!(both(&arena, expr, place).0, None, "{}", arena.print(expr));
        }
    }
}
