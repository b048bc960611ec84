//! Products in, operations out.
//!
//! An integer power is a chain of multiplications, a half-integer one takes a square root, any other
//! is a general power. The denominators of a product are multiplied and divided by once; denominators
//! that several products share become a reciprocal.

use super::lower::{Lowering, Signed};
use super::sharing::denominators;
use super::straight::{Operand, Operation};
use crate::cas::rational::Rational;
use crate::cas::{Function, Product};

/// Longer chains of multiplications lose to a general power.
const LONGEST_CHAIN: u32 = 1 << 10;

/// The factors that make up a power, and the side of the fraction on which they stand.
enum Power {
    Above(Vec<Operand>),
    Below(Vec<Operand>),
}

impl Lowering<'_> {
    pub(super) fn product(&mut self, product: &Product) -> Signed {
        let mut negative = product.coefficient.is_negative();
        let mut numerator: Vec<Operand> = Vec::new();
        let mut denominator: Vec<Operand> = Vec::new();
        let below = denominators(product);
        let shared = self.sharing.is_shared(&below);
        let mut factor = product.coefficient.abs();
        if !below.is_empty() && !shared && !is_short(&factor) {
            // x/(3*y) rather than a rounded third.
            let divisor = self.number(&factor.denominator().into());
            denominator.push(divisor);
            factor = factor.numerator().into();
        }
        if !factor.is_one() {
            let coefficient = self.number(&factor);
            numerator.push(coefficient);
        }
        for (base, exponent) in self.sharing.arranged(&product.factors) {
            let value = self.known[&base];
            negative ^= value.negative && exponent.is_integer() && is_odd(&exponent);
            let base = if exponent.is_integer() { value.operand } else { self.plain(value) };
            match self.power(base, &exponent) {
                Power::Above(factors) => numerator.extend(factors),
                Power::Below(factors) => denominator.extend(factors),
            }
        }
        let one = self.number(&Rational::ONE);
        if shared {
            let divisor = self.fold(&denominator).unwrap_or(one);
            numerator.push(self.operation(Operation::Div(one, divisor)));
            denominator.clear();
        }
        let above = self.fold(&numerator).unwrap_or(one);
        let operand = match self.fold(&denominator) {
            None => above,
            Some(divisor) => self.operation(Operation::Div(above, divisor)),
        };
        Signed { negative, operand }
    }

    /// A power with the given base.
    fn power(&mut self, base: Operand, exponent: &Rational) -> Power {
        let magnitude = exponent.abs();
        let whole = u32::try_from(magnitude.floor().to_i64().unwrap_or(i64::MAX)).ok();
        let fraction = &magnitude - &Rational::from(magnitude.floor());
        let factors = match whole {
            Some(whole) if whole <= LONGEST_CHAIN && fraction.is_zero() => {
                vec![self.chain(base, whole)]
            }
            Some(whole) if whole <= LONGEST_CHAIN && is_half(&fraction) => {
                let root = self.operation(Operation::Unary(Function::Sqrt, base));
                if whole == 0 { vec![root] } else { vec![self.chain(base, whole), root] }
            }
            _ => {
                let negative = exponent.is_negative();
                let magnitude = self.number(&magnitude);
                let exponent = self.plain(Signed { negative, operand: magnitude });
                return Power::Above(vec![self.operation(Operation::Power(base, exponent))]);
            }
        };
        if exponent.is_negative() { Power::Below(factors) } else { Power::Above(factors) }
    }

    /// A power by repeated squaring, for a positive exponent.
    fn chain(&mut self, base: Operand, exponent: u32) -> Operand {
        let mut result = None;
        let mut square = base;
        let mut rest = exponent;
        loop {
            if rest % 2 == 1 {
                result = Some(match result {
                    None => square,
                    Some(product) => self.operation(Operation::Mul(square, product)),
                });
            }
            rest /= 2;
            if rest == 0 {
                return result.unwrap_or(base);
            }
            square = self.operation(Operation::Mul(square, square));
        }
    }

    /// The product of the factors, from the left; none of no factors.
    fn fold(&mut self, factors: &[Operand]) -> Option<Operand> {
        let (&first, rest) = factors.split_first()?;
        Some(rest.iter().fold(first, |product, &factor| self.operation(Operation::Mul(product, factor))))
    }
}

pub(super) fn is_half(fraction: &Rational) -> bool {
    Rational::new(1, 2).as_ref() == Some(fraction)
}

fn is_odd(integer: &Rational) -> bool {
    integer.numerator().trailing_zeros() == 0
}

/// Whether the number has an exact decimal: its denominator has no prime factor but 2 and 5.
fn is_short(value: &Rational) -> bool {
    let mut denominator = value.denominator();
    for prime in [2, 5] {
        while let Some(quotient) = denominator.div_exact(&prime.into()) {
            denominator = quotient;
        }
    }
    denominator.is_one()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_a_finite_decimal_is_short() {
        let short = |n: i64, d: i64| is_short(&Rational::new(n, d).unwrap());
        assert!(short(3, 1) && short(1, 8) && short(7, 25) && short(1, 40));
        assert!(!short(1, 3) && !short(1, 30));
    }
}
