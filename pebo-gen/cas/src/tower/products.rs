//! Polynomials as products over the coprime base of a field.
//!
//! In: the argument of a root, a logarithm or an absolute value. Out: a sign and powers of elements of the base. A
//! field keeps one base: where a new polynomial shares a factor with an element, that one is split, and the field
//! starts again with the finer base. Holds after: any two elements that occur are coprime, so the relation of
//! `sqrt(a*b)` and `sqrt(a)` is found.
//!
//! Squares hide behind `sin^2 = 1 - cos^2`: the factor `1 - cos^2` is taken as `sin^2`, and squares of sums of sines
//! and cosines are searched for ([`Field::hidden_root`]).

use crate::Integer;
use crate::poly::Poly;

use super::coprime::Splitting;
use super::{Field, Obstacle};

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
            let Some(expr) = self.base.borrow_mut().next_pending() else { return Ok(()) };
            let poly = self.fraction(expr)?.num.primitive().1;
            self.base.borrow_mut().enter(poly);
        }
    }

    /// Keeps the base for the next round.
    pub(in crate::tower) fn keep_base(&self) {
        self.base.borrow_mut().keep(|poly| self.show_polynomial(poly));
    }
}
