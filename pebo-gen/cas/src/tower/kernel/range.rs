//! Angles as values: sine, cosine, and the range, in multiples of pi.

use crate::Rational;
use crate::graph::function::Function;

use crate::tower::fraction::Fraction;
use crate::tower::sign::Sign;

/// Sine and cosine of one angle.
pub(in crate::tower) type Pair = (Fraction, Fraction);

/// An angle with its sine and cosine.
#[derive(Clone, Debug)]
pub(in crate::tower) struct InverseAngle {
    pub value: Fraction,
    pub pair: Pair,
    pub range: Range,
}

/// An interval with open or closed ends.
#[derive(Clone, Debug)]
pub(in crate::tower) struct Range {
    low: (Rational, bool),
    high: (Rational, bool),
}

impl Range {
    /// From `low/2` to `high/2`, each with true if it is inside.
    pub(in crate::tower) fn halves(low: (i64, bool), high: (i64, bool)) -> Self {
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
    pub(in crate::tower) fn and(&self, other: &Self) -> Self {
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

/// In multiples of pi.
#[cfg(test)]
impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ((low, from), (high, to)) = (&self.low, &self.high);
        write!(f, "{}{low}, {high}{}", if *from { '[' } else { '(' }, if *to { ']' } else { ')' })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arccosine_is_none_of_more_than_half_a_turn() {
        let upper = |high: i64| Range::halves((0, true), (high, true)).is_principal(Function::Acos);
        assert!(upper(1) && upper(2) && !upper(3));
    }

    #[test]
    fn ranges_are_added_met_and_compared() {
        let half_open = Range::halves((0, true), (1, false));
        assert_eq!(half_open.times(-2).to_string(), "(-1, 0]");
        assert_eq!(half_open.plus(&half_open).to_string(), "[0, 1)");
        assert_eq!(half_open.and(&Range::halves((-1, true), (1, true))).to_string(), "[0, 1/2)");
        assert_eq!(Range::right_half().to_string(), "[-1/2, 1/2]");
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
