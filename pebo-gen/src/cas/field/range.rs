//! Ranges of angles, in multiples of pi.

use crate::cas::expr::Expr;
use crate::cas::function::Function;
use crate::cas::rational::Rational;

use super::fraction::{Fraction, negated};
use super::sign::Sign;
use super::{Field, Obstacle};

/// An interval; an end is inside or not.
#[derive(Clone, Debug)]
pub(super) struct Range {
    low: (Rational, bool),
    high: (Rational, bool),
}

impl Range {
    /// From `low/2` to `high/2`, each with whether it is inside.
    fn halves(low: (i64, bool), high: (i64, bool)) -> Self {
        let half = |n: i64| Rational::new(n, 2).unwrap_or(Rational::ZERO);
        Self { low: (half(low.0), low.1), high: (half(high.0), high.1) }
    }

    /// One value.
    pub(super) fn point(value: Rational) -> Self {
        Self { low: (value.clone(), true), high: (value, true) }
    }

    /// All multiples.
    pub(super) fn times(&self, factor: i64) -> Self {
        let scaled = |end: &(Rational, bool)| (&end.0 * &Rational::from(factor), end.1);
        let (low, high) = (scaled(&self.low), scaled(&self.high));
        if factor < 0 { Self { low: high, high: low } } else { Self { low, high } }
    }

    /// All sums.
    pub(super) fn plus(&self, other: &Self) -> Self {
        let sum = |a: &(Rational, bool), b: &(Rational, bool)| (&a.0 + &b.0, a.1 && b.1);
        Self { low: sum(&self.low, &other.low), high: sum(&self.high, &other.high) }
    }

    /// What is in both.
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

    /// Whether no multiple of a full turn but zero itself is inside.
    pub(super) fn is_within_turn(&self) -> bool {
        let turn = Rational::from(2);
        let below = |end: &Rational, inside: bool| *end < turn || (*end == turn && !inside);
        below(&-&self.low.0, self.low.1) && below(&self.high.0, self.high.1)
    }

    /// The sign of the values.
    pub(super) fn sign(&self) -> Option<Sign> {
        match (&self.low, &self.high) {
            ((low, inside), _) if !low.is_negative() => {
                Some(if *inside && low.is_zero() { Sign::NonNegative } else { Sign::Positive })
            }
            (_, (high, inside)) if high.is_negative() || (high.is_zero() && !inside) => Some(Sign::Negative),
            _ => None,
        }
    }

    /// From -1/2 to 1/2.
    pub(super) fn right_half() -> Self {
        Self::halves((-1, true), (1, true))
    }

    /// Whether all values are among those of the inverse function.
    pub(super) fn is_principal(&self, function: Function) -> bool {
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

    /// Whether all values are between 0 and 1.
    pub(super) fn is_upper_half(&self) -> bool {
        !self.low.0.is_negative() && self.high.0 <= Rational::ONE
    }

    /// Whether all values are strictly between -1 and 1.
    pub(super) fn is_within_half_turn(&self) -> bool {
        let below = |end: &Rational, inside: bool| *end < Rational::ONE || (end.is_one() && !inside);
        below(&-&self.low.0, self.low.1) && below(&self.high.0, self.high.1)
    }
}

impl Field<'_> {
    /// The values that an inverse trigonometric function can have.
    pub(super) fn range_of_inverse(&self, function: Function, arguments: &[Expr]) -> Result<Range, Obstacle> {
        let first = self.sign_of(&self.fraction(arguments[0])?)?;
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
                    Some(argument) => self.sign_of(&self.fraction(*argument)?)?,
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
    pub(super) fn range_of_angle(&self, angle: &Fraction) -> Result<Option<Range>, Obstacle> {
        self.learn()?;
        if self.signs.borrow().is_empty() {
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
            match self.sign_of(&self.sub(angle, &bound)?)? {
                Some(Sign::Positive) => return Ok(Some((number, false))),
                Some(Sign::NonNegative | Sign::Zero) => return Ok(Some((number, true))),
                _ => {}
            }
        }
        Ok(None)
    }
}
