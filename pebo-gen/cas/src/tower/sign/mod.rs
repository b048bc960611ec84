//! Signs of polynomials on the assumed domain, with a memory of their own.
//!
//! In: a polynomial over the kernels, the facts. Out: a sign that holds wherever the facts hold and the kernels have
//! values, or none. The rules are sound and simple: numbers, kernels ([`kernel`]), sums of like signs, facts
//! ([`facts`]), factors, differences of exponentials ([`exponential`]), discriminants ([`discriminant`]), sums with
//! roots ([`root`]), distances from bounds ([`shift`]), and last enclosures over the box that the facts state. [`Signs`] decides, with the algebra
//! of a field; [`SignMemory`] is kept between queries. The field holds it, and never reads it: roots and logarithms
//! depend on signs, so that the field queries too.

mod discriminant;
mod exponential;
mod facts;
mod kernel;
mod memo;
mod points;
mod root;
mod shift;
mod value;

use crate::graph::enclosure::Point;
use crate::graph::expr::Expr;
use crate::poly::Poly;

pub(in crate::tower) use self::memo::SignMemory;
pub(in crate::tower) use self::value::Sign;
use super::fraction::{Fraction, primitive};
use super::{Field, Obstacle};

/// Decides signs.
#[derive(Clone, Copy)]
pub struct Signs<'f, 'a> {
    field: &'f Field<'a>,
    memory: &'f SignMemory,
}

impl<'a> Field<'a> {
    /// Signs throughout the domain.
    pub fn signs(&self) -> Signs<'_, 'a> {
        Signs { field: self, memory: &self.sign_memory }
    }
}

impl Signs<'_, '_> {
    /// The sign of a fraction.
    pub(in crate::tower) fn of(&self, fraction: &Fraction) -> Result<Option<Sign>, Obstacle> {
        let (Some(top), Some(bottom)) = (self.of_polynomial(&fraction.num)?, self.of_polynomial(&fraction.den)?) else {
            return Ok(None);
        };
        Ok(top.times(bottom))
    }

    /// The sign of a polynomial.
    pub(in crate::tower) fn of_polynomial(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if let Some(number) = poly.to_constant() {
            return Ok(Some(if number.is_zero() {
                Sign::Zero
            } else if number.is_negative() {
                Sign::Negative
            } else {
                Sign::Positive
            }));
        }
        self.learn()?;
        if let Some(sign) = self.by_terms(poly) {
            return Ok(Some(sign));
        }
        let (content, rest) = primitive(poly);
        debug_assert!(!content.is_negative());
        if self.are_both(&rest)? {
            return Ok(None);
        }
        if let Some(sign) = self.by_facts(&rest)? {
            return Ok(Some(sign));
        }
        if let Some(sign) = self.by_factors(&rest)? {
            return Ok(Some(sign));
        }
        if let Some(sign) = self.by_exponents(&rest)? {
            return Ok(Some(sign));
        }
        if let Some(sign) = self.by_discriminant(&rest)? {
            return Ok(Some(sign));
        }
        if let Some(sign) = self.by_root(&rest)? {
            return Ok(Some(sign));
        }
        self.by_shift(&rest)
    }

    /// A sign by those of other polynomials, in one variable less: none where too many of these queries are open.
    fn nested(&self, decide: impl FnOnce() -> Result<Option<Sign>, Obstacle>) -> Result<Option<Sign>, Obstacle> {
        const DEEPEST: u32 = 3;
        let depth = self.memory.round.depth.get();
        if depth == DEEPEST {
            return Ok(None);
        }
        self.memory.round.depth.set(depth + 1);
        let sign = decide();
        self.memory.round.depth.set(depth);
        sign
    }

    /// The sign of a primitive polynomial by those of its factors.
    fn by_factors(&self, rest: &Poly) -> Result<Option<Sign>, Obstacle> {
        // Factor by factor, if there is more than one.
        let monomial = rest.monomial_content();
        let square_free = rest.square_free(self.field.limit())?;
        if monomial.is_one() && square_free.factors.len() <= 1 && square_free.factors.iter().all(|f| f.1 == 1) {
            return Ok(None);
        }
        let mut total = if square_free.content.is_negative() { Sign::Negative } else { Sign::Positive };
        for (factor, multiplicity) in square_free.factors {
            let sign = match self.of_factor(&factor)? {
                Some(sign) if multiplicity % 2 == 1 => Some(sign),
                Some(Sign::Positive | Sign::Negative) => Some(Sign::Positive),
                _ if multiplicity % 2 == 0 => Some(Sign::NonNegative),
                _ => None,
            };
            let Some(product) = sign.and_then(|sign| total.times(sign)) else { return Ok(None) };
            total = product;
        }
        Ok(Some(total))
    }

    /// The sign of a square-free factor: its monomial content apart.
    fn of_factor(&self, factor: &Poly) -> Result<Option<Sign>, Obstacle> {
        let mut rest = factor.clone();
        let mut total = Sign::Positive;
        for &(variable, exponent) in factor.monomial_content().powers() {
            let variable = Poly::variable(variable);
            if let Some(quotient) = rest.div_exact(&variable.pow(exponent, self.field.limit())?, self.field.limit())? {
                rest = quotient;
                let sign = match self.by_terms(&variable) {
                    Some(sign) => Some(sign),
                    None => self.by_shift(&variable)?,
                };
                let Some(product) = sign.and_then(|sign| total.times(sign)) else { return Ok(None) };
                total = product;
            }
        }
        let mut sign = self.by_terms(&rest);
        if sign.is_none() {
            sign = self.by_facts(&rest)?;
        }
        if sign.is_none() {
            sign = self.by_exponents(&rest)?;
        }
        if sign.is_none() {
            sign = self.by_discriminant(&rest)?;
        }
        if sign.is_none() {
            sign = self.by_root(&rest)?;
        }
        if sign.is_none() {
            sign = self.by_shift(&rest)?;
        }
        Ok(sign.and_then(|sign| total.times(sign)))
    }

    /// The sign of a number that is not rational, as `pi/2 - 1`, by enclosing it.
    fn of_constant(&self, poly: &Poly) -> Option<Sign> {
        const MOST_TERMS: usize = 24;
        let numbers = |v: &u32| self.field.arena.symbols_of(&[self.field.kernel(*v)]).is_empty();
        if poly.is_constant() || poly.term_count() > MOST_TERMS || !poly.variables().iter().all(numbers) {
            return None;
        }
        let value = self.field.arena.separated_from_zero(self.field.show_polynomial(poly), &Point::new())?;
        Some(if value.is_positive() { Sign::Positive } else { Sign::Negative })
    }

    /// By the signs of the terms.
    pub(in crate::tower) fn by_terms(&self, poly: &Poly) -> Option<Sign> {
        if poly.is_zero() {
            return Some(Sign::Zero);
        }
        if let Some(sign) = self.of_constant(poly) {
            return Some(sign);
        }
        sign_of_terms(poly, |variable| self.of_kernel(variable))
    }

    /// The sign of a part: by algebra, or by enclosing it over the box that the facts state.
    pub(in crate::tower) fn of_part(&self, part: &Poly) -> Result<Option<Sign>, Obstacle> {
        if let Some(sign) = self.of_polynomial(part)? {
            return Ok(Some(sign));
        }
        let positive = self.over_box(self.field.show_polynomial(part));
        Ok(positive.map(|positive| if positive { Sign::Positive } else { Sign::Negative }))
    }

    /// The sign that enclosures over the box prove, once for each expression.
    fn over_box(&self, expr: Expr) -> Option<bool> {
        if let Some(known) = self.memory.boxed.borrow().get(&expr) {
            return *known;
        }
        let sign = self.field.domain.sign_over_box(self.field.arena, expr);
        self.memory.boxed.borrow_mut().insert(expr, sign);
        sign
    }

    /// True if the fraction is known to be positive throughout the domain.
    pub fn is_positive(&self, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok(self.of(fraction)? == Some(Sign::Positive) || self.over_box(self.field.show(fraction)) == Some(true))
    }

    /// True if the fraction is known to be positive or zero throughout the domain.
    pub fn is_not_negative(&self, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok(self.of(fraction)?.is_some_and(Sign::is_positive_or_zero))
    }
}

#[cfg(test)]
impl Signs<'_, '_> {
    /// The number of learned conditions for the expressions to have values.
    pub(in crate::tower) fn count_learned(&self) -> usize {
        self.memory.learned.borrow().len()
    }
}

/// The sign that all terms of a polynomial have, by the signs of its variables.
pub(in crate::tower) fn sign_of_terms(poly: &Poly, sign_of: impl Fn(u32) -> Option<Sign>) -> Option<Sign> {
    let mut signs = poly.terms().map(|(monomial, coefficient)| {
        let first = if coefficient.is_negative() { Sign::Negative } else { Sign::Positive };
        monomial.powers().iter().try_fold(first, |sign, &(variable, exponent)| {
            match (sign_of(variable), exponent % 2) {
                (Some(Sign::Positive), _) | (Some(Sign::Negative), 0) => Some(sign),
                (Some(kernel), 1) => sign.times(kernel),
                (_, 0) => sign.times(Sign::NonNegative),
                _ => None,
            }
        })
    });
    let Some(first) = signs.next() else { return Some(Sign::Zero) };
    signs.try_fold(first?, |total, sign| match (total, sign?) {
        (Sign::Negative, Sign::Negative) => Some(Sign::Negative),
        (Sign::NonNegative, Sign::NonNegative) => Some(Sign::NonNegative),
        (Sign::Positive, Sign::Positive | Sign::NonNegative) | (Sign::NonNegative, Sign::Positive) => {
            Some(Sign::Positive)
        }
        _ => None,
    })
}
