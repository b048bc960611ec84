//! Signs of polynomials on the assumed domain.
//!
//! In: a polynomial over the kernels, the facts. Out: a sign that holds wherever the facts hold and the
//! kernels have values, or none. The rules are sound and simple: constants, positive kernels, factors,
//! sums of like signs, and a positive multiple of a fact plus what is not negative.

use std::collections::BTreeSet;

use crate::cas::enclosure::Point;
use crate::cas::expr::{Expr, Node};
use crate::cas::facts::Relation as Compared;
use crate::cas::function::Function;
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;
use crate::cas::rational::half;

use super::fraction::{Fraction, primitive};
use super::{Field, Obstacle};

/// How many facts may be combined to show a sign.
const MOST_FACTS: usize = 3;

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
    /// Takes in the facts that can be used: polynomial ones, those about functions that occur in the
    /// question, and what was learned in earlier rounds.
    ///
    /// Most questions ask for no sign, so this waits for the first that does.
    pub(super) fn learn(&self) -> Result<(), Obstacle> {
        if self.asked.replace(true) {
            return Ok(());
        }
        let occurring: BTreeSet<Expr> = self.arena.postorder(&self.roots).into_iter().collect();
        for (expr, compared) in self.domain.facts.iter() {
            let foreign = |e: &Expr| match self.arena.node(*e) {
                Node::Call(..) => !occurring.contains(e),
                Node::Product(product) => {
                    product.factors.iter().any(|(_, exponent)| !exponent.is_integer()) && !occurring.contains(e)
                }
                _ => false,
            };
            if self.arena.postorder(&[expr]).iter().any(foreign) {
                continue;
            }
            self.learn_sign(expr, compared)?;
        }
        let learned = self.learned.borrow().clone();
        for (expr, compared) in learned {
            self.learn_sign(expr, compared)?;
        }
        Ok(())
    }

    fn learn_sign(&self, expr: Expr, compared: Compared) -> Result<(), Obstacle> {
        let fraction = self.fraction(expr)?;
        // n/d > 0 has the sign of n*d
        let poly =
            if fraction.den.is_constant() { fraction.num } else { fraction.num.mul(&fraction.den, self.limit())? };
        self.signs.borrow_mut().push((poly, compared));
        Ok(())
    }

    /// Learns the sign of what must have it for the expressions to have values. Where something was
    /// already made of an unknown sign, the field starts again.
    pub(super) fn learn_from_existence(&self, poly: &Poly, compared: Compared) -> Result<(), Obstacle> {
        let known = self.sign(poly)?;
        let enough = match compared {
            Compared::Positive => known == Some(Sign::Positive),
            _ => known.is_some_and(Sign::is_positive_or_zero),
        };
        if enough || known == Some(Sign::Negative) {
            return Ok(());
        }
        let entry = (self.show_polynomial(poly), compared);
        if !self.learned.borrow().contains(&entry) {
            self.learned.borrow_mut().push(entry);
            if !self.unsigned.borrow().is_empty() {
                *self.refined.borrow_mut() = true;
            }
        }
        self.signs.borrow_mut().push((poly.clone(), compared));
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
        if let Some(sign) = self.plain_sign(poly) {
            return Ok(Some(sign));
        }
        let (content, rest) = primitive(poly);
        debug_assert!(!content.is_negative());
        if let Some(sign) = self.sign_by_facts(&rest)? {
            return Ok(Some(sign));
        }
        if let Some(sign) = self.sign_by_factors(&rest)? {
            return Ok(Some(sign));
        }
        self.sign_by_discriminant(&rest)
    }

    /// The sign of a primitive polynomial by those of its factors.
    fn sign_by_factors(&self, rest: &Poly) -> Result<Option<Sign>, Obstacle> {
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
        let mut sign = self.plain_sign(&rest);
        if sign.is_none() {
            sign = self.sign_by_facts(&rest)?;
        }
        if sign.is_none() {
            sign = self.sign_by_discriminant(&rest)?;
        }
        Ok(sign.and_then(|sign| total.times(sign)))
    }

    /// Of a number that is not rational, as `pi/2 - 1`, by enclosing it.
    fn constant_sign(&self, poly: &Poly) -> Option<Sign> {
        const MOST_TERMS: usize = 24;
        let numbers = |v: &u32| self.arena.symbols_of(&[self.kernel(*v)]).is_empty();
        if poly.is_constant() || poly.term_count() > MOST_TERMS || !poly.variables().iter().all(numbers) {
            return None;
        }
        let value = self.arena.separated_from_zero(self.show_polynomial(poly), &Point::new())?;
        Some(if value.is_positive() { Sign::Positive } else { Sign::Negative })
    }

    /// By the signs of the terms.
    pub(super) fn plain_sign(&self, poly: &Poly) -> Option<Sign> {
        if poly.is_zero() {
            return Some(Sign::Zero);
        }
        if let Some(sign) = self.constant_sign(poly) {
            return Some(sign);
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

    /// Roots and absolute values are not negative; a root of something positive is positive. A cosine
    /// is positive where its angle is within the right half, a sine where it is within the upper one.
    fn sign_by_nature(&self, variable: u32) -> Option<Sign> {
        let (expr, radicand) = {
            let kernels = self.kernels.borrow();
            let kernel = kernels.get(variable as usize)?;
            (kernel.expr, kernel.relation.as_ref().map(|relation| relation.value.clone()))
        };
        let root = self.is_plain_root(expr);
        if !root && !matches!(self.arena.node(expr), Node::Call(..)) {
            return None;
        }
        // A fact may have the kernel itself in it: then its form is all that is known.
        let by_form =
            (root || matches!(self.arena.node(expr), Node::Call(Function::Abs, _))).then_some(Sign::NonNegative);
        if !self.asking.borrow_mut().insert(variable) {
            return by_form;
        }
        let sign = self.sign_by_arguments(expr, radicand);
        self.asking.borrow_mut().remove(&variable);
        sign.or(by_form)
    }

    fn sign_by_arguments(&self, expr: Expr, radicand: Option<Poly>) -> Option<Sign> {
        match self.arena.node(expr) {
            Node::Call(function @ (Function::Sin | Function::Cos), arguments) => {
                self.sign_on_circle(function, arguments[0])
            }
            Node::Call(function @ (Function::Asin | Function::Acos | Function::Atan | Function::Atan2), arguments) => {
                self.range_of_inverse(function, &arguments).ok()?.sign()
            }
            Node::Call(..) => None,
            _ => self.sign(&radicand?).ok()?.filter(|sign| *sign == Sign::Positive),
        }
    }

    /// The sign of a sine or cosine by the range of its angle.
    fn sign_on_circle(&self, function: Function, angle: Expr) -> Option<Sign> {
        if self.signs.borrow().is_empty() {
            return None;
        }
        let right = self.scale(&self.fraction(self.arena.pi()).ok()?, &half()).ok()?;
        let angle = self.fraction(angle).ok()?;
        // From the middle of where the function is positive.
        let angle = if function == Function::Sin { self.sub(&angle, &right).ok()? } else { angle };
        let mut strict = true;
        for distance in [self.sub(&right, &angle).ok()?, self.add(&right, &angle).ok()?] {
            match self.sign_of(&distance).ok()?? {
                Sign::Positive => {}
                Sign::NonNegative => strict = false,
                _ => return None,
            }
        }
        Some(if strict { Sign::Positive } else { Sign::NonNegative })
    }

    /// As a positive combination of facts plus what is not negative, or the negation of that; also after
    /// `cos^2 = 1 - sin^2`, which turns `c - b^2 cos^2` into `c - b^2 + b^2 sin^2`.
    fn sign_by_facts(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        let facts = self.facts_about(poly);
        let mut found = None;
        for form in [Some(poly.clone()), self.with_sines(poly)?].into_iter().flatten() {
            if let Some(sign) = self.plain_sign(&form) {
                return Ok(Some(sign));
            }
            match self.above_facts(&form, &facts, MOST_FACTS) {
                Some(Sign::Positive) => return Ok(Some(Sign::Positive)),
                // Another form may show more.
                Some(sign) => found = Some(sign),
                None => {}
            }
            if self.above_facts(&-&form, &facts, MOST_FACTS) == Some(Sign::Positive) {
                return Ok(Some(Sign::Negative));
            }
        }
        Ok(found)
    }

    /// The facts, and that no sine or cosine exceeds one.
    fn facts_about(&self, poly: &Poly) -> Vec<(Poly, Compared)> {
        let mut facts = self.signs.borrow().clone();
        for &variable in poly.variables() {
            if let Node::Call(Function::Sin | Function::Cos, _) = self.arena.node(self.kernel(variable)) {
                let value = Poly::variable(variable);
                facts.push((&Poly::one() - &value, Compared::NonNegative));
                facts.push((&Poly::one() + &value, Compared::NonNegative));
            }
        }
        facts
    }

    /// The sign of `poly = k * fact + rest` for a k > 0 that cancels a term, if the rest is not negative.
    fn above_facts(&self, poly: &Poly, facts: &[(Poly, Compared)], most: usize) -> Option<Sign> {
        let mut found = None;
        for (fact, compared) in facts {
            let effort = poly.term_count() * fact.term_count();
            if *compared == Compared::NonZero || self.limit().spend(effort as u64).is_err() {
                continue;
            }
            for (monomial, wanted) in fact.terms() {
                let Some((_, present)) = poly.terms().find(|(candidate, _)| *candidate == monomial) else { continue };
                if monomial.is_one() || wanted.is_negative() != present.is_negative() {
                    continue;
                }
                // |wanted| * poly - |present| * fact
                let rest = &poly.scale(&wanted.abs()) - &fact.scale(&present.abs());
                let mut sign = self.plain_sign(&rest);
                if sign.is_none() && most > 1 && rest.term_count() <= poly.term_count() {
                    sign = self.above_facts(&rest, facts, most - 1);
                }
                match sign {
                    Some(Sign::Positive) => return Some(Sign::Positive),
                    Some(Sign::NonNegative | Sign::Zero) if *compared == Compared::Positive => {
                        return Some(Sign::Positive);
                    }
                    Some(Sign::NonNegative | Sign::Zero) => found = Some(Sign::NonNegative),
                    _ => {}
                }
            }
        }
        found
    }

    /// Of `a v^(2k) + b v^k + c` with `a` and `4 a c - b^2` of known signs, as `(x + b)^2 + 1` written
    /// out.
    fn sign_by_discriminant(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        const MOST_TERMS: usize = 40;
        const DEEPEST: u32 = 3;
        // Each step asks for the signs of polynomials in one variable less.
        let depth = self.depth.get();
        if poly.term_count() > MOST_TERMS || depth == DEEPEST {
            return Ok(None);
        }
        self.depth.set(depth + 1);
        let sign = self.sign_as_quadratic(poly);
        self.depth.set(depth);
        sign
    }

    fn sign_as_quadratic(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        for &variable in poly.variables() {
            // Also in a power of the variable.
            let degree = poly.degree(variable);
            let (mut a, mut b, mut c) = (Poly::zero(), Poly::zero(), Poly::zero());
            let mut quadratic = degree.is_multiple_of(2);
            for (exponent, coefficient) in poly.coefficients_in(variable) {
                match exponent {
                    0 => c = coefficient,
                    _ if exponent == degree => a = coefficient,
                    _ if 2 * exponent == degree => b = coefficient,
                    _ => quadratic = false,
                }
            }
            if !quadratic {
                continue;
            }
            if b.is_zero() || c.is_zero() {
                continue;
            }
            let Some(upward) = self.sign(&a)? else { continue };
            if upward == Sign::Negative {
                (a, c) = (-&a, -&c);
            }
            let four = Integer::from(4);
            let below = &a.mul(&c, self.limit())?.scale(&four) - &b.mul(&b, self.limit())?;
            // 4 a poly = (2 a v^k + b)^2 + below; where a is zero, b is not unless below is zero.
            let least = match self.sign(&below)? {
                Some(Sign::Positive) => Sign::Positive,
                Some(Sign::NonNegative | Sign::Zero)
                    if matches!(upward, Sign::Positive | Sign::Negative)
                        || self.sign(&c)?.is_some_and(Sign::is_positive_or_zero) =>
                {
                    Sign::NonNegative
                }
                _ => continue,
            };
            return Ok(match (upward, least) {
                (Sign::Negative, Sign::Positive) => Some(Sign::Negative),
                (Sign::Negative, _) => None,
                (_, least) => Some(least),
            });
        }
        Ok(None)
    }
}

impl Field<'_> {
    /// The sign of a part: by algebra, or by enclosing it over the box that the facts state.
    pub(super) fn sign_of_part(&self, part: &Poly) -> Result<Option<Sign>, Obstacle> {
        if let Some(sign) = self.sign(part)? {
            return Ok(Some(sign));
        }
        let positive = self.sign_over_box(self.show_polynomial(part));
        Ok(positive.map(|positive| if positive { Sign::Positive } else { Sign::Negative }))
    }

    /// What enclosures over the box say, once for each expression.
    fn sign_over_box(&self, expr: Expr) -> Option<bool> {
        if let Some(known) = self.boxed.borrow().get(&expr) {
            return *known;
        }
        let sign = self.domain.sign_over_box(self.arena, expr);
        self.boxed.borrow_mut().insert(expr, sign);
        sign
    }

    /// Whether the fraction is known to be positive throughout the domain.
    pub fn is_positive(&self, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok(self.sign_of(fraction)? == Some(Sign::Positive) || self.sign_over_box(self.show(fraction)) == Some(true))
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
