//! Canonical construction: sums, products, powers and calls that simplify themselves.
//!
//! In: operands. Out: an expression in the form that [`Sum`] and [`Product`] describe. Every rule preserves the real
//! value wherever the operands have one; a rule may enlarge the domain (`x/x = 1`), so domain conditions are read off
//! the author's formula, never off this form.

use std::rc::Rc;

use smallvec::SmallVec;

use super::arena::Arena;
use super::expr::{Expr, Node, Product, Sum};
use super::function::{Function, Parity};
use crate::Rational;
use crate::number::rational::half;

/// Steps that entering a node takes, and those for each of its operands: an examination, a number, a position in order.
const STEPS_OF_A_NODE: u64 = 60;
const STEPS_OF_AN_OPERAND: u64 = 10;

/// A rational factor and powers to multiply it with.
type ScaledFactors = (Rational, Vec<(Expr, Rational)>);

impl Arena {
    /// `a + b`.
    pub fn add(&self, a: Expr, b: Expr) -> Expr {
        self.sum([a, b])
    }

    /// `a - b`.
    pub fn sub(&self, a: Expr, b: Expr) -> Expr {
        self.combine(&Rational::ZERO, [(a, Rational::ONE), (b, Rational::from(-1))])
    }

    /// `-a`.
    pub fn neg(&self, a: Expr) -> Expr {
        self.scale(a, &Rational::from(-1))
    }

    /// `a * b`.
    pub fn mul(&self, a: Expr, b: Expr) -> Expr {
        self.product([a, b])
    }

    /// `a / b`; without a value where `b` is the number zero.
    pub fn div(&self, a: Expr, b: Expr) -> Expr {
        self.multiply(&Rational::ONE, [(a, Rational::ONE), (b, Rational::from(-1))])
    }

    /// The sum of the operands.
    pub fn sum(&self, operands: impl IntoIterator<Item = Expr>) -> Expr {
        self.combine(&Rational::ZERO, operands.into_iter().map(|e| (e, Rational::ONE)))
    }

    /// The sum of the products of the operands in pairs.
    pub fn dot(&self, left: &[Expr], right: &[Expr]) -> Expr {
        let scaled = |number: &Rational| !number.is_zero();
        let pairs = left.iter().zip(right).map(|(a, b)| match (self.as_number(*a), self.as_number(*b)) {
            (Some(number), _) if scaled(&number) => (*b, number),
            (_, Some(number)) if scaled(&number) => (*a, number),
            _ => (self.mul(*a, *b), Rational::ONE),
        });
        self.combine(&Rational::ZERO, pairs)
    }

    /// The product of the operands.
    pub fn product(&self, operands: impl IntoIterator<Item = Expr>) -> Expr {
        self.multiply(&Rational::ONE, operands.into_iter().map(|e| (e, Rational::ONE)))
    }

    /// `factor * a`.
    pub fn scale(&self, a: Expr, factor: &Rational) -> Expr {
        self.multiply(factor, [(a, Rational::ONE)])
    }

    /// `base ^ exponent` for a rational exponent.
    pub fn power(&self, base: Expr, exponent: &Rational) -> Expr {
        self.multiply(&Rational::ONE, [(base, exponent.clone())])
    }

    /// `base ^ exponent`; a symbolic exponent is read as `exp(exponent * log(base))`.
    pub fn raise(&self, base: Expr, exponent: Expr) -> Expr {
        match self.as_number(exponent) {
            Some(value) => self.power(base, &value),
            None => self.call(Function::Exp, &[self.mul(exponent, self.call(Function::Log, &[base]))]),
        }
    }

    /// The positive square root.
    pub fn sqrt(&self, a: Expr) -> Expr {
        self.power(a, &half())
    }

    /// `constant + sum of coefficient * term`.
    pub fn combine(&self, constant: &Rational, terms: impl IntoIterator<Item = (Expr, Rational)>) -> Expr {
        self.combine_all(constant, terms.into_iter().collect())
    }

    /// The work of `combine`, apart so that it is compiled once and not for every iterator.
    fn combine_all(&self, constant: &Rational, mut open: Vec<(Expr, Rational)>) -> Expr {
        // Numbers as two factors, the second by its index among the scales: they are multiplied where they are added.
        let mut scales = vec![Rational::ONE];
        let mut constants: SmallVec<[(Rational, usize); 4]> = SmallVec::from_elem((constant.clone(), 0), 1);
        let mut flat: Vec<(Expr, Rational, usize)> = Vec::with_capacity(open.len());
        while let Some((term, coefficient)) = open.pop() {
            match self.node(term) {
                Node::Number(value) => {
                    constants.push((value, scales.len()));
                    scales.push(coefficient);
                }
                Node::Sum(sum) => {
                    if !sum.constant.is_zero() {
                        constants.push((sum.constant.clone(), scales.len()));
                    }
                    // Terms of a sum are neither sums nor scaled, so they need no second look.
                    flat.extend(sum.terms.iter().map(|(t, c)| (*t, c.clone(), scales.len())));
                    scales.push(coefficient);
                }
                Node::Product(product) if !product.coefficient.is_one() => {
                    let bare = self.multiply(&Rational::ONE, product.factors.iter().cloned());
                    // A bare factor can be a sum again, as in 2 * (a + b).
                    open.push((bare, &coefficient * &product.coefficient));
                }
                _ => flat.push((term, coefficient, 0)),
            }
        }
        self.count(flat.len() + constants.len());
        let constant = Rational::total_of_products(constants.iter().map(|(value, scale)| (value, &scales[*scale])));
        flat.sort_by_key(|entry| entry.0);
        let mut terms: Vec<(Expr, Rational)> = Vec::with_capacity(flat.len());
        for run in flat.chunk_by(|a, b| a.0 == b.0) {
            let products = run.iter().map(|(_, factor, scale)| (factor, &scales[*scale]));
            terms.push((run[0].0, Rational::total_of_products(products)));
        }
        terms.retain(|entry| !entry.1.is_zero());
        self.count_words(terms.iter().map(|entry| &entry.1));
        match terms.as_slice() {
            [] => self.number(constant),
            [(term, coefficient)] if constant.is_zero() => self.scale(*term, coefficient),
            _ => self.intern(Node::Sum(Rc::new(Sum { constant, terms }))),
        }
    }

    /// `coefficient * product of base ^ exponent`.
    pub fn multiply(&self, coefficient: &Rational, factors: impl IntoIterator<Item = (Expr, Rational)>) -> Expr {
        self.multiply_all(coefficient.clone(), factors.into_iter().collect())
    }

    /// The work of `multiply`, compiled once.
    fn multiply_all(&self, mut coefficient: Rational, mut open: Vec<(Expr, Rational)>) -> Expr {
        let mut flat: Vec<(Expr, Rational)> = Vec::with_capacity(open.len());
        while let Some((base, exponent)) = open.pop() {
            if exponent.is_zero() {
                continue;
            }
            match self.node(base) {
                Node::Number(value) => {
                    let (exact, rest) = number_power(&value, &exponent);
                    coefficient = &coefficient * &exact;
                    if let Some((number, exponent)) = rest {
                        flat.push((self.number(number), exponent));
                    }
                }
                Node::Product(product) => match self.distribute(&product, &exponent) {
                    Some((exact, factors)) => {
                        coefficient = &coefficient * &exact;
                        open.extend(factors);
                    }
                    None => flat.push((base, exponent)),
                },
                _ => flat.push((base, exponent)),
            }
        }
        self.count(flat.len());
        flat.sort_by_key(|entry| entry.0);
        let mut factors: Vec<(Expr, Rational)> = Vec::with_capacity(flat.len());
        let mut merged = false;
        for (base, exponent) in flat {
            match factors.last_mut() {
                Some(last) if last.0 == base => {
                    last.1 = &last.1 + &exponent;
                    merged = true;
                }
                _ => factors.push((base, exponent)),
            }
        }
        factors.retain(|entry| !entry.1.is_zero());
        if merged && factors.iter().any(|(base, exponent)| self.opens(*base, exponent)) {
            // Merging made an exponent under which a number or a product splits after all.
            return self.multiply_all(coefficient, factors);
        }
        if coefficient.is_zero() && !factors.iter().any(|(base, _)| self.is_zero(*base)) {
            return self.zero();
        }
        match factors.as_slice() {
            [] => self.number(coefficient),
            [(base, exponent)] if coefficient.is_one() && exponent.is_one() => *base,
            [(base, exponent)] if coefficient.is_negative() && coefficient.abs().is_one() && exponent.is_one() => {
                self.negated(*base, coefficient, factors)
            }
            _ => self.intern(Node::Product(Rc::new(Product { coefficient, factors }))),
        }
    }

    /// Counts a node of so many operands. It is made all the same: an exhausted budget stops the callers that make
    /// more.
    fn count(&self, operands: usize) {
        self.budget().take(STEPS_OF_A_NODE.saturating_add(STEPS_OF_AN_OPERAND.saturating_mul(operands as u64)));
    }

    /// Counts the work on numbers longer than a word: products, and their common divisors.
    fn count_words<'a>(&self, numbers: impl Iterator<Item = &'a Rational>) {
        let words = numbers.map(|number| number.bits() / 64).filter(|words| *words > 2);
        self.budget().take(words.map(|words| words.saturating_mul(words)).sum());
    }

    /// `-base`: the sign goes into a sum, so that `-(a - b)` is `b - a`.
    fn negated(&self, base: Expr, coefficient: Rational, factors: Vec<(Expr, Rational)>) -> Expr {
        match self.node(base) {
            Node::Sum(sum) => {
                let terms = sum.terms.iter().map(|(term, c)| (*term, -c)).collect();
                self.intern(Node::Sum(Rc::new(Sum { constant: -&sum.constant, terms })))
            }
            _ => self.intern(Node::Product(Rc::new(Product { coefficient, factors }))),
        }
    }

    /// True if `base ^ exponent` is not yet in canonical form.
    fn opens(&self, base: Expr, exponent: &Rational) -> bool {
        match self.node(base) {
            Node::Number(value) => {
                let (exact, rest) = number_power(&value, exponent);
                !exact.is_one() || rest.is_none()
            }
            Node::Product(product) => self.distribute(&product, exponent).is_some(),
            _ => false,
        }
    }

    /// `product ^ exponent` taken into the product, where the real value allows it.
    fn distribute(&self, product: &Product, exponent: &Rational) -> Option<ScaledFactors> {
        let raised = |factors: &[(Expr, Rational)]| -> Vec<(Expr, Rational)> {
            factors.iter().map(|(base, inner)| (*base, inner * exponent)).collect()
        };
        if exponent.is_integer() {
            let (exact, rest) = number_power(&product.coefficient, exponent);
            return rest.is_none().then(|| (exact, raised(&product.factors)));
        }
        if product.coefficient.is_one() {
            // A power of one base merges if the base must be non-negative anyway.
            let [(_, inner)] = product.factors.as_slice() else { return None };
            let forces_sign = !inner.is_integer() || inner.numerator().trailing_zeros() == 0;
            return forces_sign.then(|| (Rational::ONE, raised(&product.factors)));
        }
        if product.coefficient.is_negative() {
            return None;
        }
        // A positive rational factor comes out of a root if its own root is rational.
        let (exact, rest) = number_power(&product.coefficient, exponent);
        let bare = self.multiply(&Rational::ONE, product.factors.iter().cloned());
        rest.is_none().then(|| (exact, vec![(bare, exponent.clone())]))
    }

    /// The function applied to its arguments; `sqrt` becomes a power.
    pub fn call(&self, function: Function, arguments: &[Expr]) -> Expr {
        debug_assert!([0, arguments.len()].contains(&function.row().arity), "{}", function.row().name);
        let first = arguments[0];
        if function == Function::Sqrt {
            return self.sqrt(first);
        }
        let row = function.row();
        let numbers: Option<Vec<Rational>> = arguments.iter().map(|argument| self.as_number(*argument)).collect();
        match (numbers.as_deref(), row.rational, row.at_zero) {
            (Some(numbers), Some(rational), _) => {
                if let Some(value) = rational(numbers) {
                    return self.number(value);
                }
            }
            (Some([zero]), _, Some(at_zero)) if zero.is_zero() => return self.number(at_zero),
            (Some([one]), ..) if function == Function::Log && one.is_one() => return self.zero(),
            _ => {}
        }
        if let Node::Product(product) = self.node(first)
            && product.coefficient.is_negative()
            && let Some(parity) = row.parity
        {
            let sign = Rational::from(if parity == Parity::Odd { -1 } else { 1 });
            let positive = self.call(function, &[self.neg(first)]);
            return self.scale(positive, &sign);
        }
        if let (Function::Log, Node::Call(Function::Exp, inner)) | (Function::Exp, Node::Call(Function::Log, inner)) =
            (function, self.node(first))
        {
            return inner[0];
        }
        self.intern(Node::Call(function, arguments.into()))
    }
}

/// `value ^ exponent` as an exact rational times an irrational power.
fn number_power(value: &Rational, exponent: &Rational) -> (Rational, Option<(Rational, Rational)>) {
    let unevaluated = || (Rational::ONE, Some((value.clone(), exponent.clone())));
    if value.is_one() {
        return (Rational::ONE, None);
    }
    if value.is_zero() {
        return if exponent.is_negative() { unevaluated() } else { (Rational::ZERO, None) };
    }
    let whole = Rational::from(exponent.floor());
    let fraction = exponent - &whole;
    if value.is_negative() && !fraction.is_zero() {
        return unevaluated();
    }
    let Some(power) = small_power(value, &whole) else {
        return unevaluated();
    };
    if fraction.is_zero() {
        return (power, None);
    }
    let root = fraction
        .denominator()
        .to_i64()
        .and_then(|degree| u32::try_from(degree).ok())
        .and_then(|degree| value.root_exact(degree))
        .and_then(|root| small_power(&root, &Rational::from(fraction.numerator())));
    match root {
        Some(root) => (&power * &root, None),
        None => (power, Some((value.clone(), fraction))),
    }
}

/// The power, unless it is excessively large.
fn small_power(value: &Rational, exponent: &Rational) -> Option<Rational> {
    const MOST_BITS: u64 = 1 << 16;
    let exponent = i32::try_from(exponent.to_i64()?).ok()?;
    let bits = value.bits().checked_mul(u64::from(exponent.unsigned_abs()))?;
    if bits > MOST_BITS {
        return None;
    }
    value.pow(exponent)
}
