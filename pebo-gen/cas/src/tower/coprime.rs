//! A coprime base of polynomials: products of powers of polynomials without common factors.
//!
//! In: the argument of a root, a logarithm or an absolute value. Out: a sign and powers of elements of the base. A
//! field keeps one base: where a new polynomial shares a factor with an element, that one is split, and the field
//! starts again with the finer base. Holds after: any two elements that occur are coprime, so the relation of
//! `sqrt(a*b)` and `sqrt(a)` is found.
//!
//! Squares hide behind `sin^2 = 1 - cos^2`: the factor `1 - cos^2` is taken as `sin^2`, and squares of sums of sines
//! and cosines are searched for ([`Field::hidden_root`]).

use crate::Integer;
use crate::graph::expr::Expr;
use crate::poly::{Poly, TooLarge, Work};

use super::{Field, Obstacle};

/// A coprime base: square-free polynomials without common factors.
#[derive(Default, Debug)]
pub(in crate::tower) struct CoprimeBase {
    /// The polynomials of this round.
    entered: Vec<Poly>,
    /// Elements of earlier rounds that are yet to be entered in this one, as expressions: kernels may get other
    /// numbers.
    pending: Vec<Expr>,
}

/// A polynomial over a coprime base.
struct Splitting {
    /// Elements of the base, whose product it is.
    parts: Vec<Poly>,
    /// True if an element had to be split: kernels made of it before do not go with its parts.
    finer: bool,
}

impl CoprimeBase {
    /// Writes a square-free polynomial over the base, which grows by its new factors.
    fn split(&mut self, poly: Poly, work: &Work) -> Result<Splitting, TooLarge> {
        let (mut rest, mut parts, mut finer) = (poly, Vec::new(), false);
        let mut index = 0;
        while let Some(element) = self.entered.get(index).filter(|_| !rest.is_constant()).cloned() {
            let common = rest.gcd(&element, work)?;
            if !common.is_constant() {
                rest = rest.div_exact(&common, work)?.unwrap_or(rest);
                if common != element
                    && let Some(other) = element.div_exact(&common, work)?
                {
                    self.entered[index] = common.clone();
                    self.entered.push(other.primitive().1);
                    finer = true;
                }
                parts.push(common);
            }
            index += 1;
        }
        if !rest.is_constant() {
            self.entered.push(rest.clone());
            parts.push(rest);
        }
        Ok(Splitting { parts, finer })
    }

    /// Enters an element of an earlier round.
    fn enter(&mut self, poly: Poly) {
        if !poly.is_constant() && !self.entered.contains(&poly) {
            self.entered.push(poly);
        }
    }

    /// Keeps the elements of this round for the next one.
    fn keep(&mut self, shown: impl Fn(&Poly) -> Expr) {
        self.pending.extend(std::mem::take(&mut self.entered).iter().map(shown));
        self.pending.sort_unstable();
        self.pending.dedup();
        self.pending.reverse();
    }
}

/// A sign and powers of parts.
#[derive(Debug)]
pub(in crate::tower) struct ElementProduct {
    /// True if the product of the powers must be negated.
    pub negative: bool,
    /// Parts with their exponents: each primitive with a positive leading coefficient.
    pub powers: Vec<(Poly, u32)>,
    /// The divisor of the product of the powers.
    pub divisor: Integer,
}

impl Field<'_> {
    /// A primitive polynomial as a product of powers of parts.
    pub(in crate::tower) fn product_of(&self, poly: &Poly) -> Result<ElementProduct, Obstacle> {
        let (rest, sines) = self.without_sines(poly)?;
        let mut powers: Vec<(Poly, u32)> =
            sines.into_iter().map(|power| (Poly::variable(power.sine), power.times)).collect();
        let mut found = rest.square_free(self.limit())?;
        let mut divisor = Integer::ONE;
        if let [(factor, 1)] = found.factors.as_slice() {
            for negative in [false, true] {
                if let Some((root, multiple)) = self.hidden_root(&if negative { -factor } else { factor.clone() })? {
                    divisor = multiple;
                    if negative {
                        found.content = -found.content;
                    }
                    found.factors = vec![(root, 2)];
                    break;
                }
            }
        }
        for (factor, times) in found.factors {
            let monomial = factor.monomial_content();
            let mut rest = factor;
            for &(variable, exponent) in monomial.powers() {
                let variable = Poly::variable(variable);
                powers.push((variable.clone(), exponent * times));
                rest = rest.div_exact(&variable.pow(exponent, self.limit())?, self.limit())?.unwrap_or(rest);
            }
            for part in self.over_base(rest)? {
                powers.push((part, times));
            }
        }
        Ok(ElementProduct { negative: found.content.is_negative(), powers, divisor })
    }

    /// A square-free polynomial without monomial factors over the coprime base.
    fn over_base(&self, poly: Poly) -> Result<Vec<Poly>, Obstacle> {
        self.enter_pending()?;
        let Splitting { parts, finer } = self.base.borrow_mut().split(poly, self.limit())?;
        if finer {
            self.round.finer.set(true);
        }
        Ok(parts)
    }

    /// Enters the elements of earlier rounds. Reading them may itself use the base.
    fn enter_pending(&self) -> Result<(), Obstacle> {
        loop {
            let Some(expr) = self.base.borrow_mut().pending.pop() else { return Ok(()) };
            let poly = self.fraction(expr)?.num.primitive().1;
            self.base.borrow_mut().enter(poly);
        }
    }

    /// Keeps the base for the next round.
    pub(in crate::tower) fn keep_base(&self) {
        self.base.borrow_mut().keep(|poly| self.show_polynomial(poly));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A product of `x + n`, one for each number.
    fn product(numbers: &[i64]) -> Poly {
        let work = Work::new(1_000_000);
        numbers.iter().fold(Poly::one(), |product, number| {
            product.mul(&(&Poly::variable(0) + &Poly::constant(*number)), &work).unwrap()
        })
    }

    #[test]
    fn elements_of_a_base_have_no_factor_in_common() {
        let work = Work::new(1_000_000);
        let mut base = CoprimeBase::default();
        let mut split = |numbers: &[i64]| {
            let split = base.split(product(numbers), &work).unwrap();
            let whole = split.parts.iter().fold(Poly::one(), |product, part| product.mul(part, &work).unwrap());
            assert_eq!(whole, product(numbers));
            for (index, one) in base.entered.iter().enumerate() {
                assert!(base.entered[..index].iter().all(|other| one.gcd(other, &work).unwrap().is_constant()));
            }
            (split.parts.len(), split.finer)
        };
        assert_eq!(split(&[1, 2]), (1, false), "new as a whole");
        assert_eq!(split(&[1, 2]), (1, false), "known as a whole");
        assert_eq!(split(&[2, 3]), (2, true), "shares a factor with what is known");
        assert_eq!(split(&[1, 3]), (2, false), "of elements that are there");
        assert_eq!(split(&[1, 2, 3, 4, 5]), (4, false), "with something new");
        assert_eq!(split(&[5]), (1, true));
    }

    #[test]
    fn the_next_round_begins_with_what_this_one_found() {
        let arena = crate::Arena::new();
        let work = Work::new(1_000_000);
        let mut base = CoprimeBase::default();
        base.split(product(&[1]), &work).unwrap();
        base.split(product(&[2]), &work).unwrap();
        let names = [arena.variable("a"), arena.variable("b")];
        base.keep(|poly| names[usize::from(*poly == product(&[2]))]);
        assert!(base.entered.is_empty());
        assert_eq!(base.pending.len(), 2);
        base.enter(product(&[1]));
        base.enter(product(&[1]));
        base.enter(Poly::one());
        assert_eq!(base.entered, [product(&[1])], "once each, and no numbers");
    }
}
