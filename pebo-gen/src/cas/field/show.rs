//! Fractions back to expressions, short: common factors taken out, terms grouped by their commonest
//! kernel (`E - v2 + d*v2` becomes `E + (d - 1)*v2`).

use std::collections::BTreeMap;

use crate::cas::expr::Expr;
use crate::cas::integer::Integer;
use crate::cas::poly::{Monomial, Poly};
use crate::cas::rational::Rational;

use super::Field;
use super::fraction::{Fraction, primitive};

/// Terms of a polynomial, to be grouped.
type Terms = Vec<(Monomial, Integer)>;

impl Field<'_> {
    /// The fraction as an expression.
    pub fn show(&self, fraction: &Fraction) -> Expr {
        let (above, num) = primitive(&fraction.num);
        let (below, den) = primitive(&fraction.den);
        let coefficient = Rational::new(above, below).unwrap_or(Rational::ZERO);
        let mut factors = self.factors(&num, 1);
        factors.extend(self.factors(&den, -1));
        self.arena.multiply(&coefficient, factors)
    }

    /// A polynomial as an expression.
    pub(super) fn show_polynomial(&self, poly: &Poly) -> Expr {
        let (content, rest) = primitive(poly);
        self.arena.multiply(&Rational::from(content), self.factors(&rest, 1))
    }

    /// The fraction as a sum over the denominators that are left when each term of the numerator cancels
    /// on its own: `(a + b)/L - G*c/C` rather than everything over `L*C`.
    pub fn show_apart(&self, fraction: &Fraction) -> Expr {
        let (below, den) = primitive(&fraction.den);
        let content = den.monomial_content();
        let mut groups: BTreeMap<Vec<(u32, u32)>, Terms> = BTreeMap::new();
        for (monomial, coefficient) in fraction.num.terms() {
            let cancelled = common(&monomial, &content);
            let left = divided(&content, &cancelled);
            let group = groups.entry(left.powers().to_vec()).or_default();
            group.push((divided(&monomial, &cancelled), coefficient.clone()));
        }
        let rest: Terms = den.terms().map(|(m, c)| (divided(&m, &content), c.clone())).collect();
        let rest = self.grouped(rest);
        let scale = Rational::new(Integer::ONE, below).unwrap_or(Rational::ONE);
        self.arena.sum(groups.into_iter().map(|(left, terms)| {
            let (above, terms) = without_content(terms);
            let mut factors: Vec<(Expr, Rational)> =
                left.iter().map(|&(v, e)| (self.kernel(v), Rational::from(-i64::from(e)))).collect();
            factors.push((self.grouped(terms), Rational::ONE));
            factors.push((rest, Rational::from(-1)));
            self.arena.multiply(&(&scale * &Rational::from(above)), factors)
        }))
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
        factors.push((self.grouped(rest), Rational::from(exponent)));
        factors
    }

    /// A sum with its commonest kernel taken out of the terms that have it, repeatedly.
    fn grouped(&self, terms: Terms) -> Expr {
        // How many terms have the kernel, and how many of them have something else besides.
        let mut counts: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
        for (monomial, _) in &terms {
            for &(variable, _) in monomial.powers() {
                let count = counts.entry(variable).or_default();
                count.0 += 1;
                count.1 += usize::from(monomial.degree() > 1);
            }
        }
        // Of the commonest the one that saves most products, then the first: the same every time.
        let commonest = counts.iter().max_by_key(|(variable, count)| (**count, std::cmp::Reverse(**variable)));
        let Some((&variable, _)) = commonest.filter(|(_, count)| count.0 > 1) else {
            return self.arena.sum(terms.iter().map(|(monomial, coefficient)| self.term(monomial, coefficient)));
        };
        let (with, without): (Terms, Terms) = terms.into_iter().partition(|(m, _)| m.exponent(variable) > 0);
        let mut content = with[0].0.clone();
        for (monomial, _) in &with[1..] {
            content = common(&content, monomial);
        }
        let inner =
            with.into_iter().map(|(monomial, coefficient)| (divided(&monomial, &content), coefficient)).collect();
        let group = self.arena.mul(self.term(&content, &Integer::ONE), self.grouped(inner));
        if without.is_empty() { group } else { self.arena.add(self.grouped(without), group) }
    }

    fn term(&self, monomial: &Monomial, coefficient: &Integer) -> Expr {
        let factors = monomial.powers().iter().map(|&(v, e)| (self.kernel(v), Rational::from(i64::from(e))));
        self.arena.multiply(&Rational::from(coefficient.clone()), factors)
    }
}

/// The greatest common divisor of the coefficients, and the terms without it.
fn without_content(terms: Terms) -> (Integer, Terms) {
    let content = terms.iter().fold(Integer::ZERO, |content, (_, coefficient)| content.gcd(coefficient));
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
