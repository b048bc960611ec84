//! Ranges of angles: of inverse functions by the signs of their arguments, of other angles by the facts.

use crate::Rational;
use crate::graph::expr::Expr;
use crate::graph::function::Function;

use super::range::Range;
use crate::tower::fraction::Fraction;
use crate::tower::sign::Sign;
use crate::tower::{Field, Obstacle};

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
        let Some((high, inside)) = self.greatest_bound(&angle.opposite())? else { return Ok(None) };
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
        field.range_of_inverse(function, &arguments).unwrap().to_string()
    }

    const ABOVE: Option<(Relation, i64)> = Some((Relation::Positive, 1));
    const NOT_BELOW: Option<(Relation, i64)> = Some((Relation::NonNegative, 1));
    const BELOW: Option<(Relation, i64)> = Some((Relation::Positive, -1));

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
            field.range_of_angle(&field.fraction(q).unwrap()).unwrap().map(|range| range.to_string())
        };
        assert_eq!(bounded(arena.zero(), right, true).unwrap(), "(0, 1/2)");
        assert_eq!(bounded(arena.neg(right), pi, false).unwrap(), "[-1/2, 1]");
        assert_eq!(bounded(arena.neg(pi), arena.zero(), true).unwrap(), "(-1, 0)");
        assert_eq!(bounded(arena.one(), arena.number(2), true).unwrap(), "(0, 1)", "to the next right angle");
        assert_eq!(bounded(arena.zero(), arena.number(4), true), None, "more than a half turn");
    }
}
