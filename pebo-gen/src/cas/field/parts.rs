//! Polynomials as products of parts that have no factor in common.
//!
//! In: what a root, a logarithm or an absolute value is taken of. Out: a sign and powers of parts. A
//! field keeps one set of parts: where a new polynomial shares a factor with one of them, that one is
//! split, and the field starts again with the finer set. Holds after: any two parts that occur are
//! coprime, so `sqrt(a*b)` and `sqrt(a)` are seen to be related.
//!
//! Squares hide behind `sin^2 = 1 - cos^2`: the factor `1 - cos^2` is taken as `sin^2`, and squares of
//! sums of sines and cosines are looked for (see [`super::square`]).

use crate::cas::expr::Expr;
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;

use super::{Field, Obstacle};

/// The parts of a field.
#[derive(Default, Debug)]
pub(super) struct Parts {
    /// What was found in earlier rounds and is yet to be entered in this one.
    pending: Vec<Expr>,
    /// The parts of this round.
    entered: Vec<Poly>,
}

/// A sign and powers of parts.
#[derive(Debug)]
pub(super) struct Product {
    /// Whether the product of the powers must be negated.
    pub negative: bool,
    /// Parts with their exponents: each primitive with a positive leading coefficient.
    pub powers: Vec<(Poly, u32)>,
    /// What the product of the powers must be divided by.
    pub divisor: Integer,
}

impl Field<'_> {
    /// A primitive polynomial as a product of powers of parts.
    pub(super) fn product_of(&self, poly: &Poly) -> Result<Product, Obstacle> {
        let mut powers: Vec<(Poly, u32)> = Vec::new();
        let mut rest = poly.clone();
        for (sine, square) in self.sines_of(poly)? {
            let mut times = 0;
            while let Some(quotient) = rest.div_exact(&square, self.limit())? {
                rest = quotient;
                times += 2;
            }
            if times > 0 {
                powers.push((Poly::variable(sine), times));
            }
        }
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
            for part in self.split_over_parts(rest)? {
                powers.push((part, times));
            }
        }
        Ok(Product { negative: found.content.is_negative(), powers, divisor })
    }

    /// A square-free polynomial without monomial factors as a product of parts.
    fn split_over_parts(&self, poly: Poly) -> Result<Vec<Poly>, Obstacle> {
        self.enter_pending_parts()?;
        let mut rest = poly;
        let mut found = Vec::new();
        let mut index = 0;
        while !rest.is_constant() {
            let Some(part) = self.parts.borrow().entered.get(index).cloned() else { break };
            let common = rest.gcd(&part, self.limit())?;
            if !common.is_constant() {
                rest = rest.div_exact(&common, self.limit())?.unwrap_or(rest);
                if common != part
                    && let Some(other) = part.div_exact(&common, self.limit())?
                {
                    let mut parts = self.parts.borrow_mut();
                    parts.entered[index] = common.clone();
                    parts.entered.push(other.primitive().1);
                    *self.refined.borrow_mut() = true;
                }
                found.push(common);
            }
            index += 1;
        }
        if !rest.is_constant() {
            self.parts.borrow_mut().entered.push(rest.clone());
            found.push(rest);
        }
        Ok(found)
    }

    /// Enters the parts of earlier rounds; they may have parts themselves.
    fn enter_pending_parts(&self) -> Result<(), Obstacle> {
        loop {
            let Some(expr) = self.parts.borrow_mut().pending.pop() else { return Ok(()) };
            let poly = self.fraction(expr)?.num.primitive().1;
            let mut parts = self.parts.borrow_mut();
            if !poly.is_constant() && !parts.entered.contains(&poly) {
                parts.entered.push(poly);
            }
        }
    }

    /// Keeps the parts for the next round, as expressions: kernels may get other numbers.
    pub(super) fn keep_parts(&self) {
        let entered = std::mem::take(&mut self.parts.borrow_mut().entered);
        let shown: Vec<Expr> = entered.iter().map(|poly| self.show_polynomial(poly)).collect();
        let mut parts = self.parts.borrow_mut();
        parts.pending.extend(shown);
        parts.pending.sort_unstable();
        parts.pending.dedup();
        parts.pending.reverse();
    }

    /// The sine kernels of the angles whose cosines occur, each with its square.
    fn sines_of(&self, poly: &Poly) -> Result<Vec<(u32, Poly)>, Obstacle> {
        let mut sines = Vec::new();
        for &variable in poly.variables() {
            if let Some(sine) = self.sine_beside(variable) {
                sines.push((sine, &Poly::one() - &Poly::variable(variable).pow(2, self.limit())?));
            }
        }
        Ok(sines)
    }

    /// The polynomial with squared cosines replaced by squared sines, if there are any.
    pub(super) fn with_sines(&self, poly: &Poly) -> Result<Option<Poly>, Obstacle> {
        let mut other = poly.clone();
        for &variable in poly.variables() {
            if let Some(sine) = self.sine_beside(variable) {
                let square = &Poly::one() - &Poly::variable(sine).pow(2, self.limit())?;
                other = other.reduce_power(variable, 2, &square, self.limit())?;
            }
        }
        Ok((other != *poly).then_some(other))
    }

    /// The sine kernel of the same angle, for a cosine kernel.
    pub(super) fn sine_beside(&self, variable: u32) -> Option<u32> {
        use crate::cas::expr::Node;
        use crate::cas::function::Function;
        let Node::Call(Function::Cos, arguments) = self.arena.node(self.kernel(variable)) else { return None };
        let sine = self.arena.call(Function::Sin, &arguments);
        self.numbers.borrow().get(&sine).copied()
    }
}
