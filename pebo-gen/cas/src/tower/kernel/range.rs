//! Ranges of angles, in multiples of pi.

use crate::Rational;
use crate::graph::expr::Expr;
use crate::graph::function::Function;

use crate::tower::fraction::{Fraction, negated};
use crate::tower::sign::Sign;
use crate::tower::{Field, Obstacle};

/// An interval with open or closed ends.
#[derive(Clone, Debug)]
pub(in crate::tower) struct Range {
    low: (Rational, bool),
    high: (Rational, bool),
}

impl Range {
    /// From `low/2` to `high/2`, each with true if it is inside.
    fn halves(low: (i64, bool), high: (i64, bool)) -> Self {
        let half = |n: i64| Rational::new(n, 2).unwrap_or(Rational::ZERO);
        Self { low: (half(low.0), low.1), high: (half(high.0), high.1) }
    }

    /// One value.
    pub(in crate::tower) fn point(value: Rational) -> Self {
        Self { low: (value.clone(), true), high: (value, true) }
    }

    /// All multiples.
    pub(in crate::tower) fn times(&self, factor: i64) -> Self {
        let scaled = |end: &(Rational, bool)| (&end.0 * &Rational::from(factor), end.1);
        let (low, high) = (scaled(&self.low), scaled(&self.high));
        if factor < 0 { Self { low: high, high: low } } else { Self { low, high } }
    }

    /// All sums.
    pub(in crate::tower) fn plus(&self, other: &Self) -> Self {
        let sum = |a: &(Rational, bool), b: &(Rational, bool)| (&a.0 + &b.0, a.1 && b.1);
        Self { low: sum(&self.low, &other.low), high: sum(&self.high, &other.high) }
    }

    /// The intersection.
    fn and(&self, other: &Self) -> Self {
        let later = |a: &(Rational, bool), b: &(Rational, bool)| match a.0.cmp(&b.0) {
            std::cmp::Ordering::Equal => (a.0.clone(), a.1 && b.1),
            std::cmp::Ordering::Greater => a.clone(),
            std::cmp::Ordering::Less => b.clone(),
        };
        let opposite = |end: &(Rational, bool)| (-&end.0, end.1);
        let high = later(&opposite(&self.high), &opposite(&other.high));
        Self { low: later(&self.low, &other.low), high: opposite(&high) }
    }

    /// True if no multiple of a full turn but zero itself is inside.
    pub(in crate::tower) fn is_within_turn(&self) -> bool {
        let turn = Rational::from(2);
        let below = |end: &Rational, inside: bool| *end < turn || (*end == turn && !inside);
        below(&-&self.low.0, self.low.1) && below(&self.high.0, self.high.1)
    }

    /// The sign of the values.
    pub(in crate::tower) fn sign(&self) -> Option<Sign> {
        match (&self.low, &self.high) {
            ((low, inside), _) if !low.is_negative() => {
                Some(if *inside && low.is_zero() { Sign::NonNegative } else { Sign::Positive })
            }
            (_, (high, inside)) if high.is_negative() || (high.is_zero() && !inside) => Some(Sign::Negative),
            _ => None,
        }
    }

    /// From -1/2 to 1/2.
    pub(in crate::tower) fn right_half() -> Self {
        Self::halves((-1, true), (1, true))
    }

    /// True if all values are among those of the inverse function.
    pub(in crate::tower) fn is_principal(&self, function: Function) -> bool {
        let values = match function {
            Function::Acos => Self::halves((0, true), (2, true)),
            Function::Atan => Self::halves((-1, false), (1, false)),
            _ => Self::right_half(),
        };
        let inside = |end: &(Rational, bool), bound: &(Rational, bool)| {
            end.0 < bound.0 || (end.0 == bound.0 && (bound.1 || !end.1))
        };
        let opposite = |end: &(Rational, bool)| (-&end.0, end.1);
        inside(&self.high, &values.high) && inside(&opposite(&self.low), &opposite(&values.low))
    }

    /// True if all values are between 0 and 1.
    pub(in crate::tower) fn is_upper_half(&self) -> bool {
        !self.low.0.is_negative() && self.high.0 <= Rational::ONE
    }

    /// True if all values are strictly between -1 and 1.
    pub(in crate::tower) fn is_within_half_turn(&self) -> bool {
        let below = |end: &Rational, inside: bool| *end < Rational::ONE || (end.is_one() && !inside);
        below(&-&self.low.0, self.low.1) && below(&self.high.0, self.high.1)
    }
}

impl Field<'_> {
    /// The values that an inverse trigonometric function can have.
    pub(in crate::tower) fn range_of_inverse(&self, function: Function, arguments: &[Expr]) -> Result<Range, Obstacle> {
        let first = self.signs().of(&self.fraction(arguments[0])?)?;
        let by_sign = |sign: Option<Sign>, positive: Range, zero: Range, negative: Range, any: Range| match sign {
            Some(Sign::Positive) => positive,
            Some(Sign::NonNegative | Sign::Zero) => zero,
            Some(Sign::Negative) => negative,
            None => any,
        };
        let range = |low: i64, low_inside: bool, high: i64, high_inside: bool| {
            Range::halves((low, low_inside), (high, high_inside))
        };
        Ok(match function {
            Function::Asin => by_sign(
                first,
                range(0, false, 1, true),
                range(0, true, 1, true),
                range(-1, true, 0, false),
                range(-1, true, 1, true),
            ),
            Function::Acos => by_sign(
                first,
                range(0, true, 1, false),
                range(0, true, 1, true),
                range(1, false, 2, true),
                range(0, true, 2, true),
            ),
            Function::Atan => by_sign(
                first,
                range(0, false, 1, false),
                range(0, true, 1, false),
                range(-1, false, 0, false),
                range(-1, false, 1, false),
            ),
            _ => {
                let by_y = by_sign(
                    first,
                    range(0, false, 2, false),
                    range(0, true, 2, true),
                    range(-2, false, 0, false),
                    range(-2, false, 2, true),
                );
                let second = match arguments.get(1) {
                    Some(argument) => self.signs().of(&self.fraction(*argument)?)?,
                    None => None,
                };
                let by_x = match second {
                    Some(Sign::Positive) => range(-1, false, 1, false),
                    Some(Sign::NonNegative) => range(-1, true, 1, true),
                    _ => range(-2, false, 2, true),
                };
                by_y.and(&by_x)
            }
        })
    }

    /// The range of an angle by the facts, if they bound it by right angles.
    pub(in crate::tower) fn range_of_angle(&self, angle: &Fraction) -> Result<Option<Range>, Obstacle> {
        if !self.signs().has_facts()? {
            return Ok(None);
        }
        let Some(low) = self.greatest_bound(angle)? else { return Ok(None) };
        let Some((high, inside)) = self.greatest_bound(&negated(angle))? else { return Ok(None) };
        Ok(Some(Range::halves(low, (-high, inside))))
    }

    /// The greatest number of right angles, up to a half turn, that the angle is not below.
    fn greatest_bound(&self, angle: &Fraction) -> Result<Option<(i64, bool)>, Obstacle> {
        let pi = self.fraction(self.arena.pi())?;
        for number in (-2..=1).rev() {
            let bound = self.scale(&pi, &Rational::new(number, 2).unwrap_or(Rational::ZERO))?;
            match self.signs().of(&self.sub(angle, &bound)?)? {
                Some(Sign::Positive) => return Ok(Some((number, false))),
                Some(Sign::NonNegative | Sign::Zero) => return Ok(Some((number, true))),
                _ => {}
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::{Facts, Relation};

    /// In multiples of pi.
    fn shown(range: &Range) -> String {
        let ((low, from), (high, to)) = (&range.low, &range.high);
        format!("{}{low}, {high}{}", if *from { '[' } else { '(' }, if *to { ']' } else { ')' })
    }

    /// The range of a function of `x`, or of `x` and `y`, if these compare so with zero.
    fn range(function: Function, x: Option<(Relation, i64)>, y: Option<(Relation, i64)>) -> String {
        let arena = Arena::new();
        let [first, second] = ["x", "y"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        for (symbol, (relation, side)) in [(first, x), (second, y)].into_iter().filter_map(|(s, f)| Some((s, f?))) {
            facts.assume(arena.scale(symbol, &Rational::from(side)), relation);
        }
        let arguments = if function == Function::Atan2 { vec![first, second] } else { vec![first] };
        let field = Field::over(&arena, &facts, &arguments).unwrap();
        shown(&field.range_of_inverse(function, &arguments).unwrap())
    }

    const ABOVE: Option<(Relation, i64)> = Some((Relation::Positive, 1));
    const NOT_BELOW: Option<(Relation, i64)> = Some((Relation::NonNegative, 1));
    const BELOW: Option<(Relation, i64)> = Some((Relation::Positive, -1));

    #[test]
    fn an_arccosine_is_none_of_more_than_half_a_turn() {
        let upper = |high: i64| Range::halves((0, true), (high, true)).is_principal(Function::Acos);
        assert!(upper(1) && upper(2) && !upper(3));
    }

    #[test]
    fn inverse_functions_have_the_ranges_that_their_arguments_leave() {
        for (function, expected) in [
            (Function::Asin, ["(0, 1/2]", "[0, 1/2]", "[-1/2, 0)", "[-1/2, 1/2]"]),
            (Function::Acos, ["[0, 1/2)", "[0, 1/2]", "(1/2, 1]", "[0, 1]"]),
            (Function::Atan, ["(0, 1/2)", "[0, 1/2)", "(-1/2, 0)", "(-1/2, 1/2)"]),
            (Function::Atan2, ["(0, 1)", "[0, 1]", "(-1, 0)", "(-1, 1]"]),
        ] {
            let found = [ABOVE, NOT_BELOW, BELOW, None].map(|sign| range(function, sign, None));
            assert_eq!(found, expected, "{function:?}");
        }
        let beside = |y, x| range(Function::Atan2, y, x);
        assert_eq!(beside(None, ABOVE), "(-1/2, 1/2)");
        assert_eq!(beside(None, NOT_BELOW), "[-1/2, 1/2]");
        assert_eq!(beside(None, BELOW), "(-1, 1]");
        assert_eq!(beside(ABOVE, ABOVE), "(0, 1/2)");
        assert_eq!(beside(BELOW, NOT_BELOW), "[-1/2, 0)");
        assert_eq!(beside(NOT_BELOW, ABOVE), "[0, 1/2)");
    }

    #[test]
    fn facts_bound_angles_by_right_angles() {
        let arena = Arena::new();
        let (q, pi) = (arena.variable("q"), arena.pi());
        let right = arena.scale(pi, &Rational::new(1, 2).unwrap());
        let bounded = |from: Expr, to: Expr, strict: bool| {
            let mut facts = Facts::new();
            let relation = if strict { Relation::Positive } else { Relation::NonNegative };
            facts.assume(arena.sub(q, from), relation);
            facts.assume(arena.sub(to, q), relation);
            let field = Field::over(&arena, &facts, &[q, pi]).unwrap();
            field.range_of_angle(&field.fraction(q).unwrap()).unwrap().map(|range| shown(&range))
        };
        assert_eq!(bounded(arena.zero(), right, true).unwrap(), "(0, 1/2)");
        assert_eq!(bounded(arena.neg(right), pi, false).unwrap(), "[-1/2, 1]");
        assert_eq!(bounded(arena.neg(pi), arena.zero(), true).unwrap(), "(-1, 0)");
        assert_eq!(bounded(arena.one(), arena.number(2), true).unwrap(), "(0, 1)", "to the next right angle");
        assert_eq!(bounded(arena.zero(), arena.number(4), true), None, "more than a half turn");
    }

    #[test]
    fn ranges_are_added_met_and_compared() {
        let half_open = Range::halves((0, true), (1, false));
        assert_eq!(shown(&half_open.times(-2)), "(-1, 0]");
        assert_eq!(shown(&half_open.plus(&half_open)), "[0, 1)");
        assert_eq!(shown(&half_open.and(&Range::halves((-1, true), (1, true)))), "[0, 1/2)");
        assert_eq!(shown(&Range::right_half()), "[-1/2, 1/2]");
        for (low, high, within) in [
            ((-4, false), (4, false), true),
            ((-4, true), (4, false), false),
            ((-4, false), (4, true), false),
            ((-3, true), (3, true), true),
            ((0, true), (5, false), false),
        ] {
            assert_eq!(Range::halves(low, high).is_within_turn(), within, "{low:?} {high:?}");
        }
        for (low, high, within) in [((-2, false), (2, false), true), ((-2, true), (0, true), false)] {
            assert_eq!(Range::halves(low, high).is_within_half_turn(), within, "{low:?} {high:?}");
        }
        for (low, high, expected) in [
            ((0, false), (1, true), Some(Sign::Positive)),
            ((0, true), (1, true), Some(Sign::NonNegative)),
            ((1, true), (2, true), Some(Sign::Positive)),
            ((-1, true), (0, false), Some(Sign::Negative)),
            ((-2, true), (-1, true), Some(Sign::Negative)),
            ((-1, true), (0, true), None),
        ] {
            assert_eq!(Range::halves(low, high).sign(), expected, "{low:?} {high:?}");
        }
        let principal = |low, high, function| Range::halves(low, high).is_principal(function);
        assert!(principal((-1, true), (1, true), Function::Asin) && !principal((-1, true), (2, true), Function::Asin));
        assert!(
            principal((-1, false), (1, false), Function::Atan) && !principal((-1, true), (0, true), Function::Atan)
        );
        assert!(principal((0, true), (2, true), Function::Acos) && !principal((-1, false), (2, true), Function::Acos));
        assert!(Range::halves((0, true), (2, true)).is_upper_half());
        assert!(!Range::halves((-1, true), (1, true)).is_upper_half());
    }
}
