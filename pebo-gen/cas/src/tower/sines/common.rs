//! Sines that numerator and denominator have in common.
//!
//! In: a fraction whose denominator has `sin(q)^2`, which the normal form writes as `1 - cos(q)^2`. Out: the same
//! without the sines that its numerator has too, for printing: `(sin(p)*sin(q)^2 - cos(p)*sin(q)*cos(q))/sin(q)^2` is
//! `-cos(p + q)/sin(q)`. With `s^2 = 1 - c^2` a polynomial is `A(c) + B(c) s`, and `s` divides it if `1 - c^2` divides
//! `A`; the normal form has no common factor of `A + B s` and `1 - c^2`.

use crate::Rational;
use crate::graph::expr::Expr;
use crate::poly::{Monomial, Poly};

use super::SinePower;
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

impl Field<'_> {
    /// The forms of the fraction without common sines, the last with each term over the sines that it does not hold;
    /// empty if there are none.
    pub fn show_without_sines(&self, fraction: &Fraction) -> Vec<Expr> {
        let Ok(Some((rest, sines))) = self.without_common_sines(fraction) else { return Vec::new() };
        let divisors =
            sines.powers().iter().map(|&(sine, times)| (self.kernel(sine), Rational::from(-i64::from(times))));
        let divisors: Vec<(Expr, Rational)> = divisors.collect();
        let over = |shown: Expr| {
            self.arena.multiply(&Rational::ONE, [vec![(shown, Rational::ONE)], divisors.clone()].concat())
        };
        let whole = [Some(self.show(&rest)), self.show_by_angles(&rest)].into_iter().flatten().map(over);
        whole.chain([self.show_apart_over(&rest, &sines)]).collect()
    }

    /// The fraction over powers of sines in place of those of `1 - cos(q)^2`, if the denominator has such, with the
    /// numerator's multiples of them written so: then terms cancel on their own. It is not in normal form. Other terms
    /// are unchanged, as `cos(q)^2` is: `1 - sin(q)^2` in its place has lost its digits where it is small.
    pub(in crate::tower) fn over_sines(&self, fraction: &Fraction) -> Result<Fraction, Obstacle> {
        let mut num = fraction.num.clone();
        let (mut den, powers) = self.without_sines(&fraction.den)?;
        for SinePower { sine, cosine, times } in powers {
            let square = self.square_beside(cosine)?;
            let power = |times: u32| Poly::variable(sine).pow(times, self.limit());
            den = den.mul(&power(times)?, self.limit())?;
            let others: Vec<u32> = num.variables().iter().copied().filter(|v| ![cosine, sine].contains(v)).collect();
            let mut total = Poly::zero();
            for (monomial, mut rest) in num.collect(&others) {
                let mut taken = 0;
                while taken < times
                    && let Some(quotient) = self.over_sine(&rest, sine, &square)?
                {
                    rest = quotient;
                    taken += 1;
                }
                let monomial = Poly::from_terms([(monomial, 1.into())])?;
                let rest = rest.mul(&power(taken)?, self.limit())?;
                total = &total + &rest.mul(&monomial, self.limit())?;
            }
            num = total;
        }
        Ok(Fraction { num, den })
    }

    /// The polynomial over a sine with the given square, if that divides it.
    fn over_sine(&self, poly: &Poly, sine: u32, square: &Poly) -> Result<Option<Poly>, Obstacle> {
        let turned = self.reduce(&poly.mul(&Poly::variable(sine), self.limit())?)?;
        Ok(turned.div_exact(square, self.limit())?)
    }

    /// The reduced fraction, and the powers of sines that remain in the denominator, if any cancelled.
    fn without_common_sines(&self, fraction: &Fraction) -> Result<Option<(Fraction, Monomial)>, Obstacle> {
        let mut num = fraction.num.clone();
        let (mut den, mut powers) = self.without_sines(&fraction.den)?;
        let mut cancelled = false;
        for SinePower { sine, cosine, times } in &mut powers {
            let square = self.square_beside(*cosine)?;
            while *times > 0
                && let Some(rest) = self.over_sine(&num, *sine, &square)?
            {
                num = rest;
                *times -= 1;
                cancelled = true;
            }
        }
        if den.leading_coefficient().is_negative() {
            (num, den) = (-&num, -&den);
        }
        let left = Monomial::new(powers.into_iter().map(|power| (power.sine, power.times)));
        Ok(cancelled.then_some((Fraction { num, den }, left)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Domain;
    use crate::Facts;
    use crate::domain::zero::is_zero;
    use crate::graph::function::Function;

    #[test]
    fn common_sines_cancel() {
        let arena = Arena::new();
        let [p, q, a] = ["p", "q", "a"].map(|name| arena.variable(name));
        let sin = |angle| arena.call(Function::Sin, &[angle]);
        let cos = |angle| arena.call(Function::Cos, &[angle]);
        let square = |expr| arena.power(expr, &Rational::from(2));
        let denominator = arena.sub(arena.one(), square(cos(q)));
        let sum = arena.sub(sin(p), arena.mul(cos(q), sin(arena.add(p, q))));
        let cases = [
            (arena.div(sum, denominator), Some("-cos(p + q)/sin(q)")),
            (arena.div(arena.mul(a, sum), square(denominator)), Some("-a*cos(p + q)/sin(q)^3")),
            (arena.div(arena.sub(a, cos(q)), arena.mul(denominator, a)), None),
            (arena.div(sum, a), None),
            // A numerator with a sine is not divided by it.
            (
                arena.div(arena.mul(sin(q), arena.add(cos(arena.add(p, q)), arena.mul(a, cos(p)))), denominator),
                Some("cos(p)*(a + cos(q))/sin(q) - sin(p)"),
            ),
        ];
        for (written, expected) in cases {
            let field = Field::over(&arena, &Facts::default(), &[written]).unwrap();
            let shown = field.show_without_sines(&field.fraction(written).unwrap());
            let printed: Vec<String> = shown.iter().map(|form| arena.print(*form)).collect();
            assert_eq!(printed.is_empty(), expected.is_none(), "{printed:?}");
            assert!(expected.is_none_or(|expected| printed.iter().any(|form| form == expected)), "{printed:?}");
            for form in shown {
                assert!(is_zero(&arena, arena.sub(form, written), &Domain::default()));
            }
        }
    }

    #[test]
    fn terms_cancel_over_sines() {
        let arena = Arena::new();
        let [q, a, b] = ["q", "a", "b"].map(|name| arena.variable(name));
        let [s, c] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[q]));
        let square = arena.sub(arena.one(), arena.mul(c, c));
        let cases = [
            (arena.div(arena.add(arena.mul(a, square), arena.product([b, s, c])), square), "a + b*cos(q)/sin(q)"),
            (arena.div(arena.mul(a, s), arena.mul(b, square)), "a/(b*sin(q))"),
            (arena.div(arena.sub(a, arena.mul(b, square)), arena.mul(square, square)), "a/sin(q)^4 - b/sin(q)^2"),
            // For a small cosine, `1/sin(q)^2 - 1` has no digits.
            (arena.div(arena.mul(a, arena.mul(c, c)), square), "a*cos(q)^2/sin(q)^2"),
            (arena.div(arena.mul(c, c), arena.mul(square, square)), "cos(q)^2/sin(q)^4"),
            (arena.div(arena.add(a, s), arena.add(b, c)), "(a + sin(q))/(b + cos(q))"),
        ];
        for (written, expected) in cases {
            let field = Field::over(&arena, &Facts::default(), &[written]).unwrap();
            let shown = field.show_apart(&field.fraction(written).unwrap());
            assert_eq!(arena.print(shown), expected);
            assert!(is_zero(&arena, arena.sub(shown, written), &Domain::default()));
        }
    }
}
