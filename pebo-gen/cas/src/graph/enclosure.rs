//! Rigorous values of expressions at exact points.
//!
//! In: an expression and a constant for each of its symbols, as a rule a rational one. Out: an interval that contains
//! the exact real value, or nothing if the value does not exist or could not be separated from a point where it does
//! not.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::arena::Arena;
use super::expr::{Expr, Node, Symbol};
use crate::Rational;
use crate::number::interval::{Interval, Precision};

/// Values of symbols: constants, most of them rational; on a manifold some are roots.
pub type Point = BTreeMap<Symbol, Expr>;

/// Working precisions that are tried in turn, in bits.
const PRECISIONS: [u32; 4] = [64, 128, 256, 512];

/// A rational value with more bits than this is enclosed instead.
const MOST_BITS: u64 = 1 << 14;

/// The result of rational arithmetic.
enum RationalValue {
    /// The value is this number.
    Value(Rational),
    /// The value does not exist: a divisor is zero.
    Undefined,
    /// Rational arithmetic does not suffice.
    Irrational,
}

impl Arena {
    /// Encloses several expressions at a point; none if one of them has no value there.
    pub fn enclose_all(&self, exprs: &[Expr], point: &Point, precision: Precision) -> Option<Vec<Interval>> {
        let mut values = BTreeMap::new();
        for symbol in self.symbols_of(exprs) {
            let constant = *point.get(&symbol)?;
            let value = match self.as_number(constant) {
                Some(number) => Interval::from_rational(&number, precision)?,
                None => self.enclose_over(&[constant], &BTreeMap::new(), precision)?.pop()?,
            };
            values.insert(symbol, value);
        }
        self.enclose_over(exprs, &values, precision)
    }

    /// Encloses several expressions over all values that the symbols may have.
    pub fn enclose_over(
        &self,
        exprs: &[Expr],
        values: &BTreeMap<Symbol, Interval>,
        precision: Precision,
    ) -> Option<Vec<Interval>> {
        let mut known: FxHashMap<Expr, Interval> = FxHashMap::default();
        for e in self.postorder(exprs) {
            if !self.budget().take(precision.steps().saturating_mul(1 + self.operand_count(e))) {
                return None;
            }
            let value = self.enclosure_of(e, values, precision, &known)?;
            known.insert(e, value);
        }
        exprs.iter().map(|e| known.get(e).cloned()).collect()
    }

    /// Encloses an expression at a point.
    pub fn enclose(&self, expr: Expr, point: &Point, precision: Precision) -> Option<Interval> {
        self.enclose_all(&[expr], point, precision)?.pop()
    }

    /// The value at a point, if rational arithmetic suffices: much cheaper than an enclosure.
    fn rational_at(&self, expr: Expr, point: &Point) -> RationalValue {
        let mut known: FxHashMap<Expr, Rational> = FxHashMap::default();
        for e in self.postorder(&[expr]) {
            let value = match self.node(e) {
                Node::Number(value) => Some(value),
                Node::Symbol(symbol) => point.get(&symbol).and_then(|constant| self.as_number(*constant)),
                Node::Sum(sum) => {
                    Some(sum.terms.iter().fold(sum.constant.clone(), |total, (t, c)| &total + &(&known[t] * c)))
                }
                Node::Product(product) => {
                    let mut total = product.coefficient.clone();
                    for (base, exponent) in &product.factors {
                        let Some(exponent) = exponent.to_i64().and_then(|e| i32::try_from(e).ok()) else {
                            return RationalValue::Irrational;
                        };
                        if exponent < 0 && known[base].is_zero() {
                            return RationalValue::Undefined;
                        }
                        let bits = known[base].bits().saturating_mul(exponent.unsigned_abs().into());
                        if bits > MOST_BITS {
                            return RationalValue::Irrational;
                        }
                        let Some(power) = known[base].pow(exponent) else { return RationalValue::Irrational };
                        total = &total * &power;
                    }
                    Some(total)
                }
                Node::Pi | Node::Call(..) => None,
            };
            let Some(value) = value.filter(|value| value.bits() <= MOST_BITS) else { return RationalValue::Irrational };
            // Its operands are of that length too, and it has no common factor left.
            let words = value.bits().div_ceil(64);
            self.budget().take(words * words * (1 + self.operand_count(e)));
            known.insert(e, value);
        }
        known.remove(&expr).map_or(RationalValue::Irrational, RationalValue::Value)
    }

    /// The enclosure that excludes zero, at the least sufficient precision.
    pub fn separated_from_zero(&self, expr: Expr, point: &Point) -> Option<Interval> {
        match self.rational_at(expr, point) {
            RationalValue::Value(value) if value.is_zero() => return None,
            RationalValue::Value(value) => return Interval::from_rational(&value, Precision::new(PRECISIONS[0])),
            RationalValue::Undefined => return None,
            RationalValue::Irrational => {}
        }
        PRECISIONS
            .iter()
            .find_map(|&bits| self.enclose(expr, point, Precision::new(bits)).filter(|value| !value.contains_zero()))
    }

    /// True if the expression provably has a value at the point.
    pub fn exists_at(&self, expr: Expr, point: &Point) -> bool {
        match self.rational_at(expr, point) {
            RationalValue::Value(_) => return true,
            RationalValue::Undefined => return false,
            RationalValue::Irrational => {}
        }
        PRECISIONS.iter().any(|&bits| self.enclose(expr, point, Precision::new(bits)).is_some())
    }

    fn enclosure_of(
        &self,
        e: Expr,
        values: &BTreeMap<Symbol, Interval>,
        p: Precision,
        known: &FxHashMap<Expr, Interval>,
    ) -> Option<Interval> {
        match self.node(e) {
            Node::Number(value) => Interval::from_rational(&value, p),
            Node::Pi => Interval::pi(p),
            Node::Symbol(symbol) => values.get(&symbol).cloned().or_else(|| self.location(symbol)),
            Node::Sum(sum) => {
                let mut total = Interval::from_rational(&sum.constant, p)?;
                for (term, coefficient) in &sum.terms {
                    let scaled = known.get(term)?.mul(&Interval::from_rational(coefficient, p)?, p)?;
                    total = total.add(&scaled, p)?;
                }
                Some(total)
            }
            Node::Product(product) => {
                let mut total = Interval::from_rational(&product.coefficient, p)?;
                for (base, exponent) in &product.factors {
                    let base = known.get(base)?;
                    let power = match exponent.to_i64() {
                        Some(integer) => base.powi(integer, p)?,
                        None => base.pow(exponent, p)?,
                    };
                    total = total.mul(&power, p)?;
                }
                Some(total)
            }
            Node::Call(function, arguments) => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments.iter() {
                    values.push(known.get(argument)?.clone());
                }
                (function.row().enclosure)(&values, p)
            }
        }
    }
}
