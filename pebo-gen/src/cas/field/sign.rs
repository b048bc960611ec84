//! Signs of polynomials on the assumed domain.
//!
//! In: a polynomial over the kernels, the facts. Out: a sign that holds wherever the facts hold and the
//! kernels have values, or none. The rules are sound and simple: constants, positive kernels, factors,
//! sums of like signs, and a positive multiple of a fact plus what is not negative.

use crate::cas::facts::{Facts, Relation as Compared};
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;

use super::fraction::{Fraction, primitive};
use super::{Field, Obstacle};

/// The sign of a value throughout a domain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sign {
    /// Greater than zero.
    Positive,
    /// Greater than or equal to zero.
    NonNegative,
    /// Zero.
    Zero,
    /// Less than zero.
    Negative,
}

impl Sign {
    pub(super) fn is_positive_or_zero(self) -> bool {
        self != Self::Negative
    }

    fn times(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Zero, _) | (_, Self::Zero) => Some(Self::Zero),
            (Self::Positive, sign) | (sign, Self::Positive) => Some(sign),
            (Self::Negative, Self::Negative) => Some(Self::Positive),
            (Self::NonNegative, Self::NonNegative) => Some(Self::NonNegative),
            _ => None,
        }
    }
}

impl Field<'_> {
    /// Takes in the facts that are polynomial in symbols: the only ones that are used.
    pub(super) fn learn(&self, facts: &Facts) -> Result<(), Obstacle> {
        let mut found = Vec::new();
        for (expr, compared) in facts.iter() {
            let calls = self.arena.postorder(&[expr]).into_iter().any(|e| {
                use crate::cas::expr::Node;
                match self.arena.node(e) {
                    Node::Call(..) => true,
                    Node::Product(product) => product.factors.iter().any(|(_, exponent)| !exponent.is_integer()),
                    _ => false,
                }
            });
            if calls {
                continue;
            }
            let fraction = self.fraction(expr)?;
            if fraction.den.is_constant() {
                found.push((fraction.num, compared));
            } else {
                // n/d > 0 has the sign of n*d
                found.push((fraction.num.mul(&fraction.den, self.limit())?, compared));
            }
        }
        *self.signs.borrow_mut() = found;
        Ok(())
    }

    /// The sign of a fraction.
    pub(super) fn sign_of(&self, fraction: &Fraction) -> Result<Option<Sign>, Obstacle> {
        let (Some(top), Some(bottom)) = (self.sign(&fraction.num)?, self.sign(&fraction.den)?) else {
            return Ok(None);
        };
        Ok(top.times(bottom))
    }

    /// The sign of a polynomial.
    pub(super) fn sign(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        if let Some(sign) = self.plain_sign(poly) {
            return Ok(Some(sign));
        }
        let (content, rest) = primitive(poly);
        debug_assert!(!content.is_negative());
        if let Some(sign) = self.sign_by_facts(&rest)? {
            return Ok(Some(sign));
        }
        // Factor by factor, where there is more than one.
        let monomial = rest.monomial_content();
        let square_free = rest.square_free(self.limit())?;
        if monomial.is_one() && square_free.factors.len() <= 1 && square_free.factors.iter().all(|f| f.1 == 1) {
            return Ok(None);
        }
        let mut total = if square_free.content.is_negative() { Sign::Negative } else { Sign::Positive };
        for (factor, multiplicity) in square_free.factors {
            let sign = match self.factor_sign(&factor)? {
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
    fn factor_sign(&self, factor: &Poly) -> Result<Option<Sign>, Obstacle> {
        let mut rest = factor.clone();
        let mut total = Sign::Positive;
        for &(variable, exponent) in factor.monomial_content().powers() {
            let variable = Poly::variable(variable);
            if let Some(quotient) = rest.div_exact(&variable.pow(exponent, self.limit())?, self.limit())? {
                rest = quotient;
                let Some(product) = self.plain_sign(&variable).and_then(|sign| total.times(sign)) else {
                    return Ok(None);
                };
                total = product;
            }
        }
        let sign = match self.plain_sign(&rest) {
            Some(sign) => Some(sign),
            None => self.sign_by_facts(&rest)?,
        };
        Ok(sign.and_then(|sign| total.times(sign)))
    }

    /// By the signs of the terms.
    fn plain_sign(&self, poly: &Poly) -> Option<Sign> {
        if poly.is_zero() {
            return Some(Sign::Zero);
        }
        let mut signs = poly.terms().map(|(monomial, coefficient)| {
            let first = if coefficient.is_negative() { Sign::Negative } else { Sign::Positive };
            monomial.powers().iter().try_fold(first, |sign, &(variable, exponent)| {
                match (self.kernel_sign(variable), exponent % 2) {
                    (Some(Sign::Positive), _) | (Some(Sign::Negative), 0) => Some(sign),
                    (Some(kernel), 1) => sign.times(kernel),
                    (_, 0) => sign.times(Sign::NonNegative),
                    _ => None,
                }
            })
        });
        let first = signs.next()??;
        signs.try_fold(first, |total, sign| match (total, sign?) {
            (Sign::Negative, Sign::Negative) => Some(Sign::Negative),
            (Sign::NonNegative, Sign::NonNegative) => Some(Sign::NonNegative),
            (Sign::Positive, Sign::Positive | Sign::NonNegative) | (Sign::NonNegative, Sign::Positive) => {
                Some(Sign::Positive)
            }
            _ => None,
        })
    }

    /// The sign of a kernel: by its nature or by a fact about it alone.
    fn kernel_sign(&self, variable: u32) -> Option<Sign> {
        if self.kernels.borrow().get(variable as usize).is_some_and(|kernel| kernel.positive) {
            return Some(Sign::Positive);
        }
        if let Some(sign) = self.sign_by_nature(variable) {
            return Some(sign);
        }
        for (fact, compared) in self.signs.borrow().iter() {
            if fact.variables() != [variable] {
                continue;
            }
            // c v + d > 0 fixes the sign of v where the constant helps.
            if fact.degree(variable) != 1 || *compared == Compared::NonZero {
                continue;
            }
            let constant = fact
                .terms()
                .find(|(monomial, _)| monomial.is_one())
                .map_or(Integer::ZERO, |(_, coefficient)| coefficient.clone());
            let rising = !fact.leading_coefficient().is_negative();
            // v > -d/c with d <= 0: positive; v < d/|c| with d <= 0: negative.
            let strict = *compared == Compared::Positive || !constant.is_zero();
            match (rising, constant.is_zero() || constant.is_negative()) {
                (true, true) if strict => return Some(Sign::Positive),
                (true, true) => return Some(Sign::NonNegative),
                (false, true) if strict => return Some(Sign::Negative),
                _ => {}
            }
        }
        None
    }

    /// Roots and absolute values are not negative; a root of something positive is positive.
    fn sign_by_nature(&self, variable: u32) -> Option<Sign> {
        use crate::cas::expr::Node;
        use crate::cas::function::Function;
        let (expr, radicand) = {
            let kernels = self.kernels.borrow();
            let kernel = kernels.get(variable as usize)?;
            (kernel.expr, kernel.relation.as_ref().map(|relation| relation.value.clone()))
        };
        if matches!(self.arena.node(expr), Node::Call(Function::Abs, _)) {
            return Some(Sign::NonNegative);
        }
        if !self.is_plain_root(expr) {
            return None;
        }
        // Relations lead to earlier kernels, so this ends.
        match self.plain_sign(&radicand?) {
            Some(Sign::Positive) => Some(Sign::Positive),
            _ => Some(Sign::NonNegative),
        }
    }

    /// As a positive multiple of a fact plus what is not negative, or the negation of that; also after
    /// `cos^2 = 1 - sin^2`, which turns `c - b^2 cos^2` into `c - b^2 + b^2 sin^2`.
    fn sign_by_facts(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        for form in self.forms(poly)? {
            if let Some(sign) = self.plain_sign(&form) {
                return Ok(Some(sign));
            }
            for (fact, compared) in self.signs.borrow().iter() {
                if *compared == Compared::NonZero {
                    continue;
                }
                for (sign, oriented) in [(Sign::Positive, form.clone()), (Sign::Negative, -&form)] {
                    if let Some(rest) = self.without(&oriented, fact) {
                        let known = match rest {
                            Sign::Positive => sign,
                            _ if *compared == Compared::Positive => sign,
                            _ if sign == Sign::Positive => Sign::NonNegative,
                            _ => continue,
                        };
                        return Ok(Some(known));
                    }
                }
            }
        }
        Ok(None)
    }

    /// The sign of `poly - k * fact` for the k > 0 that cancels a term, if it is not negative.
    fn without(&self, poly: &Poly, fact: &Poly) -> Option<Sign> {
        for (monomial, wanted) in fact.terms() {
            let Some((_, present)) = poly.terms().find(|(candidate, _)| *candidate == monomial) else { continue };
            if wanted.is_negative() != present.is_negative() {
                continue;
            }
            // |wanted| * poly - |present| * fact
            let rest = &poly.scale(&wanted.abs()) - &fact.scale(&present.abs());
            if let Some(sign) = self.plain_sign(&rest).filter(|sign| sign.is_positive_or_zero()) {
                return Some(sign);
            }
        }
        None
    }

    /// The polynomial, and the same with squared cosines replaced by squared sines.
    fn forms(&self, poly: &Poly) -> Result<Vec<Poly>, Obstacle> {
        let mut forms = vec![poly.clone()];
        let mut other = poly.clone();
        for &variable in poly.variables() {
            if let Some(sine) = self.sine_beside(variable) {
                let square = Poly::variable(sine).pow(2, self.limit())?;
                other = other.reduce_power(variable, 2, &(&Poly::one() - &square), self.limit())?;
            }
        }
        if other != *poly {
            forms.push(other);
        }
        Ok(forms)
    }

    /// The sine kernel of the same angle, for a cosine kernel.
    fn sine_beside(&self, variable: u32) -> Option<u32> {
        use crate::cas::expr::Node;
        use crate::cas::function::Function;
        let Node::Call(Function::Cos, arguments) = self.arena.node(self.kernel(variable)) else { return None };
        let sine = self.arena.call(Function::Sin, &arguments);
        self.numbers.borrow().get(&sine).copied()
    }
}

impl Field<'_> {
    /// Whether the fraction is known to be positive throughout the domain.
    pub fn is_positive(&self, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok(self.sign_of(fraction)? == Some(Sign::Positive))
    }

    /// Whether the fraction is known to be positive or zero throughout the domain.
    pub fn is_not_negative(&self, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok(self.sign_of(fraction)?.is_some_and(Sign::is_positive_or_zero))
    }

    /// Whether the polynomial is known to be zero nowhere by the nature of its kernels: exponentials,
    /// and roots of what is positive.
    pub fn never_zero(&self, poly: &Poly) -> bool {
        let never = |variable: &u32| {
            let (positive, radicand) = {
                let kernel = &self.kernels.borrow()[*variable as usize];
                let root = kernel.relation.as_ref().filter(|_| self.is_plain_root(kernel.expr));
                (kernel.positive, root.map(|relation| relation.value.clone()))
            };
            let rooted = |radicand: Poly| self.sign(&radicand).is_ok_and(|sign| sign == Some(Sign::Positive));
            positive || radicand.is_some_and(rooted)
        };
        poly.term_count() == 1 && poly.variables().iter().all(never)
    }
}
