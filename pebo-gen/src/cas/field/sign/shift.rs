//! Signs of polynomials by what is above a bound: on p > 3, `p^3 - 27 = t^3 + 9 t^2 + 27 t` with t = p - 3 > 0.
//!
//! In: a polynomial, and facts that are affine in a variable with a number as its factor. Out: the sign that all
//! terms have after such variables are written as bound plus distance (or, from above, bound minus distance). The
//! rewriting is exact, so the sign is.

use std::collections::BTreeMap;

use crate::cas::facts::Relation as Compared;
use crate::cas::poly::Poly;

use crate::cas::field::Obstacle;
use crate::cas::field::sign::{Sign, Signs, sign_of_terms};

/// How many ways of shifting are tried.
const MOST_TRIES: u32 = 12;

/// Larger polynomials are left alone: shifting writes their powers out.
const MOST_TERMS: usize = 24;
const MOST_DEGREE: u64 = 12;

/// Variables that stand for a distance from a bound, with the sign of that.
type Distances = BTreeMap<u32, Sign>;

impl Signs<'_, '_> {
    /// The sign after variables are measured from their bounds.
    pub(in crate::cas::field) fn by_shift(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if poly.term_count() > MOST_TERMS || poly.total_degree() > MOST_DEGREE {
            return Ok(None);
        }
        let facts = self.known.round.facts.borrow().clone();
        let mut tries = MOST_TRIES;
        self.shifted(poly, &facts, &Distances::new(), &mut tries)
    }

    fn shifted(
        &self,
        poly: &Poly,
        facts: &[(Poly, Compared)],
        distances: &Distances,
        tries: &mut u32,
    ) -> Result<Option<Sign>, Obstacle> {
        let mut found = None;
        for &variable in poly.variables() {
            if distances.contains_key(&variable) {
                continue;
            }
            for (fact, compared) in facts {
                // A fact in which a distance stands for its variable would say something else.
                let foreign = fact.variables().iter().any(|v| distances.contains_key(v));
                if *compared == Compared::NonZero || foreign || *tries == 0 {
                    continue;
                }
                let Some(moved) = self.measured(poly, variable, fact)? else { continue };
                *tries -= 1;
                let mut distances = distances.clone();
                let distance = if *compared == Compared::Positive { Sign::Positive } else { Sign::NonNegative };
                distances.insert(variable, distance);
                let of = |v: u32| distances.get(&v).copied().or_else(|| self.of_kernel(v));
                let mut sign = sign_of_terms(&moved, of);
                if sign.is_none() && moved.term_count() <= 4 * MOST_TERMS {
                    sign = self.shifted(&moved, facts, &distances, tries)?;
                }
                match sign {
                    // Another bound may show more.
                    Some(Sign::NonNegative) => found = sign,
                    Some(_) => return Ok(sign),
                    None => {}
                }
            }
        }
        Ok(found)
    }

    /// The polynomial, times a positive number, with the variable written in `t = fact`, which takes its place; none
    /// where the fact is not affine in it with a number as factor.
    fn measured(&self, poly: &Poly, variable: u32, fact: &Poly) -> Result<Option<Poly>, Obstacle> {
        if fact.degree(variable) != 1 {
            return Ok(None);
        }
        let Some(slope) = fact.leading_coefficient_in(variable).to_constant() else { return Ok(None) };
        // v = (t - rest)/slope
        let rest = fact - &Poly::variable(variable).scale(&slope);
        let mut value = &Poly::variable(variable) - &rest;
        if slope.is_negative() {
            value = -&value;
        }
        let degree = poly.degree(variable);
        let mut total = Poly::zero();
        for (power, coefficient) in poly.coefficients_in(variable) {
            let scale = Poly::constant(slope.abs()).pow(degree - power, self.field.limit())?;
            let term = value
                .pow(power, self.field.limit())?
                .mul(&coefficient, self.field.limit())?
                .mul(&scale, self.field.limit())?;
            total = &total + &term;
        }
        Ok(Some(total))
    }
}

#[cfg(test)]
mod tests {
    use crate::cas::facts::{Facts, Relation};
    use crate::cas::rational::Rational;
    use crate::cas::{Arena, Expr};

    use super::super::Field;
    use super::Sign;

    /// Facts and a question, of three symbols, with the sign.
    type Case = (fn(&Arena, [Expr; 3]) -> Vec<(Expr, Relation)>, fn(&Arena, [Expr; 3]) -> Expr, Option<Sign>);

    fn less(arena: &Arena, a: Expr, number: i64) -> Expr {
        arena.sub(a, arena.number(number))
    }

    fn power(arena: &Arena, a: Expr, exponent: i64) -> Expr {
        arena.power(a, &Rational::from(exponent))
    }

    const CASES: &[(&str, Case)] = &[
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
