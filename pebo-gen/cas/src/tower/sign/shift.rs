//! Signs of polynomials by the distance from a bound: on p > 3, `p^3 - 27 = t^3 + 9 t^2 + 27 t` with t = p - 3 > 0; and
//! from two bounds: on 0 < p < 1, `(1 + t)^2 (1 - p^2) = 1 + 2 t` with t = p/(1 - p) > 0.
//!
//! In: a polynomial, and facts that are affine in a variable with a number as its factor. Out: the sign that all
//! terms have after such variables are written as bound plus distance (or, from above, bound minus distance), or as
//! `(near + far t)/(1 + t)`. The rewriting is exact, so the sign is.

use std::collections::BTreeMap;

use crate::graph::expr::Node;
use crate::graph::function::Function;
use crate::poly::Poly;
use crate::{Integer, Relation};

use super::{Sign, Signs, sign_of_terms};
use crate::tower::Obstacle;

/// The greatest number of shifts that are tried.
const MOST_TRIES: u32 = 24;

/// Limits of the polynomials that are shifted: their powers are written out.
const MOST_TERMS: usize = 24;
const MOST_DEGREE: u64 = 12;

/// Variables that represent a distance from a bound, with the sign of that.
type Distances = BTreeMap<u32, Sign>;

impl Signs<'_, '_> {
    /// The sign after variables are measured from their bounds.
    pub(in crate::tower) fn by_shift(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if poly.term_count() > MOST_TERMS || poly.total_degree() > MOST_DEGREE {
            return Ok(None);
        }
        let mut facts = self.memory.round.facts.borrow().clone();
        for &variable in poly.variables() {
            facts.extend(self.bounds_of_call(variable)?);
        }
        let mut tries = MOST_TRIES;
        self.shifted(poly, &facts, &Distances::new(), &mut tries)
    }

    /// The bounds of a sine, cosine or hyperbolic tangent, and of an exponential of what has a sign.
    fn bounds_of_call(&self, variable: u32) -> Result<Vec<(Poly, Relation)>, Obstacle> {
        let (one, call) = (Poly::one(), Poly::variable(variable));
        let Node::Call(function, arguments) = self.field.arena.node(self.field.kernel(variable)) else {
            return Ok(Vec::new());
        };
        let bounded = |relation| vec![(&one - &call, relation), (&one + &call, relation)];
        Ok(match function {
            Function::Sin | Function::Cos => bounded(Relation::NonNegative),
            Function::Tanh => bounded(Relation::Positive),
            Function::Exp => {
                let strict = |sign| if sign == Sign::Positive { Relation::Positive } else { Relation::NonNegative };
                let sign_of = |argument| self.of(&self.field.fraction(argument)?);
                let (above, below) = (sign_of(arguments[0])?, sign_of(self.field.arena.neg(arguments[0]))?);
                match (above, below) {
                    (Some(sign @ (Sign::Positive | Sign::NonNegative)), _) => vec![(&call - &one, strict(sign))],
                    (_, Some(sign @ (Sign::Positive | Sign::NonNegative))) => {
                        vec![(call.clone(), Relation::Positive), (&one - &call, strict(sign))]
                    }
                    _ => Vec::new(),
                }
            }
            _ => Vec::new(),
        })
    }

    fn shifted(
        &self,
        poly: &Poly,
        facts: &[(Poly, Relation)],
        distances: &Distances,
        tries: &mut u32,
    ) -> Result<Option<Sign>, Obstacle> {
        let mut found = None;
        for &variable in poly.variables() {
            if distances.contains_key(&variable) {
                continue;
            }
            // A fact in which a distance replaces its variable would be a different statement.
            let foreign = |fact: &Poly| fact.variables().iter().any(|v| distances.contains_key(v));
            let bounds = facts.iter().filter(|(fact, comparison)| *comparison != Relation::NonZero && !foreign(fact));
            let bounds: Vec<Bound> =
                bounds.filter_map(|(fact, comparison)| Bound::of(fact, *comparison, variable)).collect();
            let above = bounds.iter().map(|near| (near, None));
            // If the far bound may be reached, t may be infinite, which is no number.
            let far = |near: &Bound| {
                let (near_is_below, is_far) = (near.is_below, |far: &&Bound| far.distance == Sign::Positive);
                bounds.iter().filter(is_far).find(|far| far.is_below != near_is_below)
            };
            let between = bounds.iter().filter_map(|near| Some((near, Some(far(near)?))));
            for (near, far) in above.chain(between) {
                if *tries == 0 {
                    return Ok(found);
                }
                *tries -= 1;
                let moved = self.measured(poly, variable, near, far)?;
                let mut distances = distances.clone();
                distances.insert(variable, near.distance);
                let of = |v: u32| distances.get(&v).copied().or_else(|| self.of_kernel(v));
                let mut sign = sign_of_terms(&moved, of);
                if sign.is_none() && moved.term_count() <= 4 * MOST_TERMS {
                    sign = self.shifted(&moved, facts, &distances, tries)?;
                }
                match sign {
                    // Another bound may prove more.
                    Some(Sign::NonNegative) => found = sign,
                    Some(_) => return Ok(sign),
                    None => {}
                }
            }
        }
        Ok(found)
    }

    /// The polynomial, times a positive factor, with the variable written in its distance from the near bound, or in
    /// the quotient of its distances from the near and the far one, which replaces the variable.
    fn measured(&self, poly: &Poly, variable: u32, near: &Bound, far: Option<&Bound>) -> Result<Poly, Obstacle> {
        let t = Poly::variable(variable);
        // The variable is value/scale.
        let (value, scale) = match far {
            None if near.is_below => (&near.rest + &t, Poly::constant(near.slope.clone())),
            None => (&near.rest - &t, Poly::constant(near.slope.clone())),
            Some(far) => {
                let (slope, rest) = (&far.rest.scale(&near.slope), near.rest.scale(&far.slope));
                let both = Poly::constant(&near.slope * &far.slope);
                (&rest + &slope.mul(&t, self.field.limit())?, &both + &both.mul(&t, self.field.limit())?)
            }
        };
        let degree = poly.degree(variable);
        let mut total = Poly::zero();
        for (power, coefficient) in poly.coefficients_in(variable) {
            let term = value
                .pow(power, self.field.limit())?
                .mul(&coefficient, self.field.limit())?
                .mul(&scale.pow(degree - power, self.field.limit())?, self.field.limit())?;
            total = &total + &term;
        }
        Ok(total)
    }
}

/// A bound `rest/slope` of a variable, with a number for the slope.
struct Bound {
    is_below: bool,
    slope: Integer,
    rest: Poly,
    /// The sign of the variable's distance from the bound.
    distance: Sign,
}

impl Bound {
    /// The bound that a fact sets; none if it is not affine in the variable with a number as factor.
    fn of(fact: &Poly, comparison: Relation, variable: u32) -> Option<Self> {
        if fact.degree(variable) != 1 {
            return None;
        }
        let slope = fact.leading_coefficient_in(variable).to_constant()?;
        let is_below = !slope.is_negative();
        let rest = fact - &Poly::variable(variable).scale(&slope);
        let distance = if comparison == Relation::Positive { Sign::Positive } else { Sign::NonNegative };
        Some(Self { is_below, slope: slope.abs(), rest: if is_below { -&rest } else { rest }, distance })
    }
}

#[cfg(test)]
mod tests {
    use crate::Rational;
    use crate::{Arena, Expr};
    use crate::{Facts, Function, Relation};

    use super::Sign;
    use crate::tower::sign::Field;

    /// Facts and a polynomial, of three symbols, with the sign.
    type Case = (fn(&Arena, [Expr; 3]) -> Vec<(Expr, Relation)>, fn(&Arena, [Expr; 3]) -> Expr, Option<Sign>);

    fn less(arena: &Arena, a: Expr, number: i64) -> Expr {
        arena.sub(a, arena.number(number))
    }

    fn power(arena: &Arena, a: Expr, exponent: i64) -> Expr {
        arena.power(a, &Rational::from(exponent))
    }

    const CASES: &[(&str, Case)] = &[
        (
            "between two bounds",
            (
                |a, [p, ..]| vec![(p, Relation::Positive), (a.sub(a.one(), p), Relation::NonNegative)],
                |a, [p, ..]| a.sub(a.sub(a.number(2), p), power(a, p, 2)),
                Some(Sign::NonNegative),
            ),
        ),
        (
            "between bounds that are not reached",
            (
                |a, [p, ..]| vec![(p, Relation::Positive), (a.sub(a.one(), p), Relation::Positive)],
                |a, [p, ..]| less(a, power(a, p, 2), 1),
                Some(Sign::Negative),
            ),
        ),
        (
            "between symbols, of two variables",
            (
                |a, [p, q, r]| {
                    let positive = [p, q, r, a.sub(r, p), a.sub(r, q)];
                    positive.map(|fact| (fact, Relation::Positive)).to_vec()
                },
                |a, [p, q, r]| a.sub(power(a, r, 2), a.mul(p, q)),
                Some(Sign::Positive),
            ),
        ),
        (
            "both bounds reached show nothing here",
            (
                |a, [p, ..]| vec![(p, Relation::NonNegative), (a.sub(a.one(), p), Relation::NonNegative)],
                |a, [p, ..]| a.sub(a.add(a.one(), p), a.scale(power(a, p, 2), &Rational::from(3))),
                None,
            ),
        ),
        (
            "a cube above its bound",
            (
                |a, [p, ..]| vec![(less(a, p, 3), Relation::Positive)],
                |a, [p, ..]| less(a, power(a, p, 3), 27),
                Some(Sign::Positive),
            ),
        ),
        (
            "at the bound it may vanish",
            (
                |a, [p, ..]| vec![(less(a, p, 3), Relation::NonNegative)],
                |a, [p, ..]| less(a, power(a, p, 3), 27),
                Some(Sign::NonNegative),
            ),
        ),
        (
            "below the bound it may not",
            (|a, [p, ..]| vec![(less(a, p, 3), Relation::Positive)], |a, [p, ..]| less(a, power(a, p, 3), 28), None),
        ),
        (
            "from above",
            (
                |a, [p, ..]| vec![(a.sub(a.number(-2), p), Relation::Positive)],
                |a, [p, ..]| a.add(power(a, p, 3), a.number(8)),
                Some(Sign::Negative),
            ),
        ),
        (
            "a bound that is no integer",
            (
                |a, [p, ..]| vec![(less(a, a.scale(p, &Rational::from(2)), 1), Relation::Positive)],
                |a, [p, ..]| less(a, a.scale(power(a, p, 4), &Rational::from(16)), 1),
                Some(Sign::Positive),
            ),
        ),
        (
            "two variables",
            (
                |a, [p, q, _]| vec![(less(a, p, 1), Relation::Positive), (less(a, q, 2), Relation::Positive)],
                |a, [p, q, _]| less(a, a.mul(p, power(a, q, 2)), 4),
                Some(Sign::Positive),
            ),
        ),
        (
            "one from above and one from below",
            (
                |a, [p, q, _]| vec![(less(a, p, 1), Relation::Positive), (a.sub(a.number(-1), q), Relation::Positive)],
                |a, [p, q, _]| a.add(a.mul(p, power(a, q, 3)), a.one()),
                Some(Sign::Negative),
            ),
        ),
        (
            "a bound that is a symbol",
            (
                |a, [p, q, _]| vec![(a.sub(p, q), Relation::Positive), (q, Relation::Positive)],
                |a, [p, q, _]| a.sub(power(a, p, 3), power(a, q, 3)),
                Some(Sign::Positive),
            ),
        ),
        (
            "a chain of bounds",
            (
                |a, [p, q, r]| {
                    vec![
                        (a.sub(p, q), Relation::Positive),
                        (a.sub(q, r), Relation::NonNegative),
                        (r, Relation::Positive),
                    ]
                },
                |a, [p, _, r]| a.sub(power(a, p, 2), a.mul(p, r)),
                Some(Sign::Positive),
            ),
        ),
        (
            "of the other sign where nothing bounds it",
            (
                |a, [p, q, _]| vec![(a.sub(p, q), Relation::Positive)],
                |a, [p, q, _]| a.sub(power(a, p, 2), power(a, q, 2)),
                None,
            ),
        ),
        (
            "an exponential of what is not positive",
            (
                |_, [p, q, _]| vec![(p, Relation::Positive), (q, Relation::Positive)],
                |a, [p, q, r]| {
                    let decaying = a.call(Function::Exp, &[a.neg(power(a, r, 2))]);
                    a.add(p, a.mul(a.sub(q, p), decaying))
                },
                Some(Sign::Positive),
            ),
        ),
        (
            "a hyperbolic tangent does not reach its bounds",
            (
                |_, [p, ..]| vec![(p, Relation::Positive)],
                |a, [p, q, _]| a.add(a.mul(p, a.one()), a.mul(p, a.call(Function::Tanh, &[q]))),
                Some(Sign::Positive),
            ),
        ),
        (
            "a sine reaches its bounds",
            (
                |_, [p, ..]| vec![(p, Relation::Positive)],
                |a, [p, q, _]| a.sub(a.mul(p, a.call(Function::Sin, &[q])), p),
                None,
            ),
        ),
        (
            "what only does not vanish is no bound",
            (|a, [p, ..]| vec![(less(a, p, 3), Relation::NonZero)], |a, [p, ..]| less(a, power(a, p, 3), 27), None),
        ),
    ];

    #[test]
    fn bounds_show_signs() {
        for (what, (facts, question, expected)) in CASES {
            let arena = Arena::new();
            let symbols = ["p", "q", "r"].map(|name| arena.variable(name));
            let mut assumed = Facts::new();
            for (expr, relation) in facts(&arena, symbols) {
                assumed.assume(expr, relation);
            }
            let question = question(&arena, symbols);
            let field = Field::over(&arena, &assumed, &[question]).expect("polynomials");
            let fraction = field.fraction(question).expect("a polynomial");
            assert_eq!(field.signs().of(&fraction).expect("little work"), *expected, "{what}");
        }
    }
}
