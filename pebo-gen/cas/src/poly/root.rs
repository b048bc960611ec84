//! Exact square roots.

use super::evaluate::coordinate;
use super::field::PrimeField;
use super::work::{TooLarge, Work, steps};
use super::{Monomial, Poly};
use crate::Integer;

impl Poly {
    /// The polynomial with this square and a positive leading coefficient, if there is one; zero of
    /// zero.
    pub fn sqrt_exact(&self, work: &Work) -> Result<Option<Self>, TooLarge> {
        let Some((monomial, coefficient)) = self.leading_term() else {
            return Ok(Some(Self::zero()));
        };
        let first = half(&monomial).zip(coefficient.root_exact(2));
        let Some((monomial, coefficient)) = first else {
            return Ok(None);
        };
        if self.degrees().iter().any(|degree| degree % 2 == 1) || !self.may_be_square() {
            return Ok(None);
        }
        // As by hand: the next term of the root is half the rest's leading term over the root's.
        let first = Self::from_terms([(monomial, coefficient)])?;
        let leading = first.scale(&Integer::from(2));
        let mut doubled = leading.clone();
        let mut rest = self - &first.mul(&first, work)?;
        while let Some((monomial, coefficient)) = rest.leading_term() {
            work.spend(steps(rest.term_count()))?;
            let leading_rest = Self::from_terms([(monomial, coefficient.clone())])?;
            let Some(term) = leading_rest.div_exact(&leading, work)? else {
                return Ok(None);
            };
            if !term.degrees_within(self) {
                return Ok(None);
            }
            // (s + t)^2 = s^2 + t (2 s + t).
            rest = &rest - &term.mul(&(&doubled + &term), work)?;
            doubled = doubled.add_scaled(&term, 2);
        }
        Ok(doubled.div_integer(&Integer::from(2)))
    }

    /// True if twice the degrees of this are degrees of `square`.
    fn degrees_within(&self, square: &Self) -> bool {
        let doubles = self.variables().iter().zip(self.degrees());
        doubles.into_iter().all(|(v, degree)| u64::from(square.degree(*v)) >= 2 * u64::from(degree))
    }

    /// True if values at some points are squares: all those of a square are, half of others'.
    fn may_be_square(&self) -> bool {
        let field = PrimeField::MERSENNE;
        (1..=6_u64)
            .all(|sample| field.is_square(self.evaluate_mod(&field, |variable| coordinate(&field, variable, sample))))
    }
}

fn half(monomial: &Monomial) -> Option<Monomial> {
    let even = monomial.powers().iter().all(|(_, exponent)| exponent % 2 == 0);
    even.then(|| Monomial::new(monomial.powers().iter().map(|(v, exponent)| (*v, exponent / 2))))
}
