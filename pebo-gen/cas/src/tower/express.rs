//! Fractions back to expressions, short: common factors taken out, terms grouped by their commonest
//! kernel (`E - v2 + d*v2` becomes `E + (d - 1)*v2`).

use std::collections::BTreeMap;

use crate::forms::number_powers::joined;
use crate::graph::expr::Expr;
use crate::poly::{Monomial, Poly, TooLarge, steps};
use crate::{Integer, Rational};

use super::Field;
use super::fraction::{Fraction, primitive};
use super::sines::SinePower;

/// The numbers of terms for which a polynomial is tested as a power.
const TERMS_OF_POWERS: std::ops::RangeInclusive<usize> = 3..=200;

/// Terms of a polynomial, to be grouped.
type Terms = Vec<(Monomial, Integer)>;

impl Field<'_> {
    /// The fraction as an expression.
    pub fn show(&self, fraction: &Fraction) -> Expr {
        self.count(fraction);
        let (numerator, num) = primitive(&fraction.num);
        let (denominator, den) = primitive(&fraction.den);
        let (num, mut sines) = self.sines(num, 1);
        let (den, below_sines) = self.sines(den, -1);
        sines.extend(below_sines);
        let coefficient = Rational::new(numerator, denominator).unwrap_or(Rational::ZERO);
        let powers =
            |poly: &Poly, exponent| self.powers(poly, exponent).unwrap_or_else(|| self.factors(poly, exponent));
        let mut factors = powers(&num, 1);
        factors.extend(powers(&den, -1));
        factors.extend(sines);
        self.joined(self.arena.multiply(&coefficient, factors))
    }

    /// The expression with powers and logarithms of one number in place of several.
    fn joined(&self, expr: Expr) -> Expr {
        // Two of them have something to join.
        if self.arena.number_logarithms() < 2 { expr } else { joined(self.arena, expr) }
    }

    /// The fraction as a product of the factors found: `(1 - a)*(1 - b)` rather than its terms.
    pub fn show_factored(&self, fraction: &Fraction) -> Expr {
        let product = || -> Result<Expr, TooLarge> {
            let mut coefficient = Rational::ONE;
            let mut powers = Vec::new();
            for (poly, exponent) in [(&fraction.num, 1), (&fraction.den, -1)] {
                let (poly, sines) = self.sines(poly.clone(), exponent);
                powers.extend(sines);
                let parts = poly.factored(self.limit())?;
                let content = Rational::from(parts.content);
                coefficient = if exponent > 0 { content } else { coefficient.checked_div(&content).ok_or(TooLarge)? };
                for (factor, times) in &parts.factors {
                    let times = Rational::from(exponent * i64::from(*times));
                    let shown = self.factors(factor, 1);
                    powers.extend(shown.into_iter().map(|(base, power)| (base, &power * &times)));
                }
            }
            Ok(self.joined(self.arena.multiply(&coefficient, powers)))
        };
        product().unwrap_or_else(|_| self.show(fraction))
    }

    /// The fraction as a sum, with the denominator rationalised from a difference in its numerator that holds a root:
    /// `1/(sqrt(1 + x) + 1)` rather than `(sqrt(1 + x) - 1)/x`, which loses digits where `x` is small. None if there is
    /// no such difference.
    pub fn show_rationalised(&self, fraction: &Fraction) -> Option<Expr> {
        let conjugate = self.conjugate(&fraction.num).ok()??;
        if conjugate.term_count() < 2 {
            return None;
        }
        let conjugate = if conjugate.leading_coefficient().is_negative() { -&conjugate } else { conjugate };
        let above = self.reduce(&fraction.num.mul(&conjugate, self.limit()).ok()?).ok()?;
        let rest = self.quotient(&above, &fraction.den).ok()?;
        Some(self.arena.div(self.show(&rest), self.show_polynomial(&conjugate)))
    }

    /// Counts the work: each term is examined once for each of its kernels that is taken out.
    fn count(&self, fraction: &Fraction) {
        const STEPS_OF_A_TERM: u64 = 16;
        self.arena.budget().take(STEPS_OF_A_TERM * steps(fraction.weight() * (1 + fraction.variables().count())));
    }

    /// A polynomial as an expression.
    pub(in crate::tower) fn show_polynomial(&self, poly: &Poly) -> Expr {
        let (content, rest) = primitive(poly);
        self.arena.multiply(&Rational::from(content), self.factors(&rest, 1))
    }

    /// The fraction as a sum over the denominators that remain when each term of the numerator cancels on its own:
    /// `(a + b)/L - G*c/C` rather than everything over `L*C`.
    pub fn show_apart(&self, fraction: &Fraction) -> Expr {
        self.show_apart_over(fraction, &Monomial::one())
    }

    /// The same of the fraction over these powers of kernels.
    pub(super) fn show_apart_over(&self, fraction: &Fraction, also: &Monomial) -> Expr {
        self.count(fraction);
        let Fraction { num, den } = &self.over_sines(fraction).unwrap_or_else(|_| fraction.clone());
        let (denominator, den) = primitive(den);
        let own = den.monomial_content();
        let mut powers: BTreeMap<u32, u32> = own.powers().iter().copied().collect();
        for (variable, times) in also.powers() {
            *powers.entry(*variable).or_default() += times;
        }
        let content = Monomial::new(powers);
        let mut groups: BTreeMap<Vec<(u32, u32)>, Terms> = BTreeMap::new();
        for (monomial, coefficient) in num.terms() {
            let cancelled = common(&monomial, &content);
            let left = divided(&content, &cancelled);
            let group = groups.entry(left.powers().to_vec()).or_default();
            group.push((divided(&monomial, &cancelled), coefficient.clone()));
        }
        let rest: Terms = den.terms().map(|(m, c)| (divided(&m, &own), c.clone())).collect();
        let rest = self.grouped(rest, &|variable| self.kernel(variable));
        let scale = Rational::new(Integer::ONE, denominator).unwrap_or(Rational::ONE);
        self.joined(self.arena.sum(groups.into_iter().map(|(left, terms)| {
            let (above, terms) = without_content(terms);
            let mut factors: Vec<(Expr, Rational)> =
                left.iter().map(|&(v, e)| (self.kernel(v), Rational::from(-i64::from(e)))).collect();
            factors.push((self.grouped(terms, &|variable| self.kernel(variable)), Rational::ONE));
            factors.push((rest, Rational::from(-1)));
            self.arena.multiply(&(&scale * &Rational::from(above)), factors)
        })))
    }

    /// A polynomial without its factors `cos(q)^2 - 1`, and these, to a common power, as `-sin(q)^2`: no digits are
    /// lost where they are small, and a superfluous sine of a divisor cancels.
    fn sines(&self, poly: Poly, sign: i64) -> (Poly, Vec<(Expr, Rational)>) {
        let Ok((mut rest, powers)) = self.without_sines(&poly) else { return (poly, Vec::new()) };
        let mut found = Vec::new();
        for SinePower { sine, times, .. } in powers {
            if times % 4 == 2 {
                rest = -&rest;
                found.push((self.arena.number(-1), Rational::ONE));
            }
            found.push((self.kernel(sine), Rational::from(i64::from(times) * sign)));
        }
        (rest, found)
    }

    /// The square-free factors with their multiplicities, to a common power; none if that is no shorter, or takes too
    /// long.
    fn powers(&self, poly: &Poly, exponent: i64) -> Option<Vec<(Expr, Rational)>> {
        if !TERMS_OF_POWERS.contains(&poly.term_count()) {
            return None;
        }
        let parts = poly.square_free(self.limit()).ok()?;
        let repeated = parts.factors.iter().any(|(factor, times)| *times > 1 && factor.term_count() > 1);
        let shown = |(factor, times): &(Poly, u32)| {
            let times = exponent * i64::from(*times);
            self.factors(factor, 1).into_iter().map(move |(base, power)| (base, &power * &Rational::from(times)))
        };
        repeated.then(|| {
            let content = (self.arena.number(Rational::from(parts.content.clone())), Rational::from(exponent));
            parts.factors.iter().flat_map(shown).chain([content]).collect()
        })
    }

    /// The monomial content and the rest, to a common power.
    fn factors(&self, poly: &Poly, exponent: i64) -> Vec<(Expr, Rational)> {
        let content = poly.monomial_content();
        let mut factors: Vec<(Expr, Rational)> = content
            .powers()
            .iter()
            .map(|&(variable, times)| (self.kernel(variable), Rational::from(exponent * i64::from(times))))
            .collect();
        let rest: Terms =
            poly.terms().map(|(monomial, coefficient)| (divided(&monomial, &content), coefficient.clone())).collect();
        factors.push((self.grouped(rest, &|variable| self.kernel(variable)), Rational::from(exponent)));
        factors
    }

    /// A sum with its commonest kernel taken out of the terms that have it, repeatedly; kernels by these names.
    pub(super) fn grouped(&self, terms: Terms, named: &dyn Fn(u32) -> Expr) -> Expr {
        // The number of terms with the kernel, and of those with another factor besides.
        let mut counts: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
        for (monomial, _) in &terms {
            for &(variable, _) in monomial.powers() {
                let count = counts.entry(variable).or_default();
                count.0 += 1;
                count.1 += usize::from(monomial.degree() > 1);
            }
        }
        // Of the commonest kernels the one that saves most products, then the first: deterministic.
        let commonest = counts.iter().max_by_key(|(variable, count)| (**count, std::cmp::Reverse(**variable)));
        let Some((&variable, _)) = commonest.filter(|(_, count)| count.0 > 1) else {
            return self.arena.sum(terms.iter().map(|(monomial, coefficient)| self.term(monomial, coefficient, named)));
        };
        let (with, without): (Terms, Terms) = terms.into_iter().partition(|(m, _)| m.exponent(variable) > 0);
        let mut content = with[0].0.clone();
        for (monomial, _) in &with[1..] {
            content = common(&content, monomial);
        }
        let inner =
            with.into_iter().map(|(monomial, coefficient)| (divided(&monomial, &content), coefficient)).collect();
        let (number, inner) = without_content(inner);
        let group = self.arena.mul(self.term(&content, &number, named), self.grouped(inner, named));
        if without.is_empty() { group } else { self.arena.add(self.grouped(without, named), group) }
    }

    fn term(&self, monomial: &Monomial, coefficient: &Integer, named: &dyn Fn(u32) -> Expr) -> Expr {
        let factors = monomial.powers().iter().map(|&(v, e)| (named(v), Rational::from(i64::from(e))));
        self.arena.multiply(&Rational::from(coefficient.clone()), factors)
    }
}

/// The greatest common divisor of the coefficients, of their sign if they have one, and the terms without it.
fn without_content(terms: Terms) -> (Integer, Terms) {
    let content = terms.iter().fold(Integer::ZERO, |content, (_, coefficient)| content.gcd(coefficient));
    let negative = terms.iter().all(|(_, coefficient)| coefficient.signum() < 0);
    let content = if negative { -&content } else { content };
    let divided = terms.iter().map(|(m, c)| Some((m.clone(), c.div_exact(&content)?))).collect::<Option<Terms>>();
    match divided {
        Some(divided) => (content, divided),
        None => (Integer::ONE, terms),
    }
}

fn divided(monomial: &Monomial, content: &Monomial) -> Monomial {
    Monomial::new(monomial.powers().iter().map(|&(v, e)| (v, e - content.exponent(v))))
}

fn common(a: &Monomial, b: &Monomial) -> Monomial {
    Monomial::new(a.powers().iter().map(|&(v, e)| (v, e.min(b.exponent(v)))))
}

#[cfg(test)]
mod tests {
    use crate::Arena;
    use crate::Facts;

    use super::Field;

    #[test]
    fn powers_of_sums_are_shown_as_such() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let [sum, difference] = [arena.add(a, b), arena.sub(a, b)];
        let square = arena.mul(sum, sum);
        let cases = [
            (square, "(a + b)^2"),
            (arena.product([square, sum, difference]), "(a + b)^3*(a - b)"),
            (arena.product([square, a, arena.number(6)]), "6*a*(a + b)^2"),
            (arena.div(arena.product([square, square]), arena.add(c, c)), "(a + b)^4/(2*c)"),
            (arena.add(c, arena.product([a, sum, arena.number(-2)])), "c - 2*a*(a + b)"),
            // Two terms each have a and b; b saves two products and a one.
            (arena.sum([a, arena.mul(a, b), arena.mul(b, c)]), "a + b*(a + c)"),
            // Factors of one multiplicity are not separated.
            (arena.div(c, arena.sub(arena.number(1), square)), "-c/(a*(a + 2*b) + b^2 - 1)"),
        ];
        for (expr, expected) in cases {
            let expanded = arena.sub(arena.add(expr, c), c);
            let facts = Facts::default();
            let field = Field::over(&arena, &facts, &[expanded]).expect("rational");
            let fraction = field.fraction(expanded).expect("rational");
            assert_eq!(arena.print(field.show(&fraction)), expected);
        }
    }

    #[test]
    fn differences_with_roots_go_into_the_denominator() {
        let arena = Arena::new();
        let [a, x] = ["a", "x"].map(|name| arena.variable(name));
        let root = |number: i64| arena.sqrt(arena.add(x, arena.number(number)));
        let cases = [
            (arena.div(arena.sub(root(1), arena.one()), x), Some("1/(sqrt(x + 1) + 1)")),
            (arena.sub(root(1), root(0)), Some("1/(sqrt(x + 1) + sqrt(x))")),
            (arena.mul(a, root(1)), None),
            (arena.add(a, x), None),
        ];
        for (written, expected) in cases {
            let field = Field::over(&arena, &Facts::default(), &[written]).expect("roots");
            let shown = field.show_rationalised(&field.fraction(written).expect("roots"));
            assert_eq!(shown.map(|shown| arena.print(shown)).as_deref(), expected);
        }
    }

    #[test]
    fn factors_are_shown_with_their_powers() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let below = |e| arena.sub(arena.one(), e);
        let above = arena.product([below(a), below(a), below(b), arena.number(6)]);
        let fraction = arena.div(above, arena.product([c, c, arena.add(a, b)]));
        let expanded = arena.sub(arena.add(fraction, c), c);
        let field = Field::over(&arena, &Facts::default(), &[expanded]).expect("rational");
        let shown = field.show_factored(&field.fraction(expanded).expect("rational"));
        let difference = field.fraction(arena.sub(shown, fraction)).expect("rational");
        assert!(difference.is_zero(), "{}", arena.print(shown));
        assert!(arena.print(shown).contains("^2"), "{}", arena.print(shown));
    }
}
