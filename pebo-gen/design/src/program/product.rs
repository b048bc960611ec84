//! Lowers products to operations.
//!
//! An integer power is a chain of multiplications, a half-integer one takes a square root, any other is a general
//! power. Factors whose exponents have one absolute value are raised as one base: `(q/K)^10` has a value in single
//! precision where `q^10` and `K^10` overflow. The denominators of a product are multiplied and divided by once;
//! denominators that several products share become a reciprocal.

use std::collections::BTreeMap;

use super::lower::{Lowering, Signed};
use super::sharing::denominators;
use super::straight::{Operand, Operation};
use pebo_cas::forms::scaled::is_short;
use pebo_cas::{Expr, Function, Product, Rational};

/// Longer chains of multiplications lose to a general power.
const LONGEST_CHAIN: u32 = 1 << 10;

/// The factors of a power, and their side of the fraction.
enum Power {
    Above(Vec<Operand>),
    Below(Vec<Operand>),
}

impl Lowering<'_> {
    pub(super) fn product(&mut self, product: &Product) -> Signed {
        let mut negative = product.coefficient.is_negative();
        let mut numerator: Vec<Operand> = Vec::new();
        let mut denominator: Vec<Operand> = Vec::new();
        let (combined, apart) = combined_powers(product);
        let below = denominators(&apart);
        let shared = self.sharing.is_shared(&below);
        let mut factor = apart.coefficient.abs();
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
        for power in &combined {
            let (value, is_below) = self.raised(power);
            negative ^= value.negative;
            if is_below { &mut denominator } else { &mut numerator }.push(value.operand);
        }
        for (base, exponent) in self.sharing.arranged(&apart.factors) {
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

    /// The power of a quotient; true if it is a denominator.
    fn raised(&mut self, power: &CombinedPower) -> (Signed, bool) {
        let mut negative = false;
        let mut sides = [Vec::new(), Vec::new()];
        if !power.coefficient.is_one() {
            sides[0].push(self.number(&power.coefficient));
        }
        for (base, is_below) in &power.bases {
            let value = self.known[base];
            negative ^= value.negative;
            sides[usize::from(*is_below)].push(value.operand);
        }
        let [above, below] = sides.map(|side| self.fold(&side));
        let (base, is_below) = match (above, below) {
            (Some(above), Some(below)) => (self.operation(Operation::Div(above, below)), false),
            (Some(above), None) => (above, false),
            (None, Some(below)) => (below, true),
            (None, None) => (self.number(&Rational::ONE), false),
        };
        let operand = self.chain(base, power.exponent);
        (Signed { negative: negative && power.exponent % 2 == 1, operand }, is_below)
    }

    /// A power with the given base.
    fn power(&mut self, base: Operand, exponent: &Rational) -> Power {
        let size = exponent.abs();
        let whole = u32::try_from(size.floor().to_i64().unwrap_or(i64::MAX)).ok();
        let fraction = &size - &Rational::from(size.floor());
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
                let size = self.number(&size);
                let exponent = self.plain(Signed { negative, operand: size });
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

/// The smallest exponent of a combined base: squares leave the range of single precision beyond 1e19 alone.
const SMALLEST_COMBINED: u32 = 3;

/// Bits of a coefficient, or of its reciprocal, that single precision just holds.
const MOST_BITS: u64 = 100;

/// A power of a product.
struct CombinedPower {
    coefficient: Rational,
    /// The factors of the base, and whether they divide.
    bases: Vec<(Expr, bool)>,
    exponent: u32,
}

/// The exponent's absolute value, if factors with the same may be combined.
pub(super) fn combined_exponent(exponent: &Rational) -> Option<u32> {
    let size = exponent.is_integer().then(|| u32::try_from(exponent.abs().to_i64()?).ok())??;
    (SMALLEST_COMBINED..=LONGEST_CHAIN).contains(&size).then_some(size)
}

/// The powers of products, and the product of the other factors.
fn combined_powers(product: &Product) -> (Vec<CombinedPower>, Product) {
    let mut groups: BTreeMap<u32, Vec<(Expr, bool)>> = BTreeMap::new();
    for (base, exponent) in &product.factors {
        if let Some(size) = combined_exponent(exponent) {
            groups.entry(size).or_default().push((*base, exponent.is_negative()));
        }
    }
    let mut coefficient = product.coefficient.clone();
    let is_far = |number: &Rational| number.numerator().bits().abs_diff(number.denominator().bits()) > MOST_BITS;
    let mut combined = Vec::new();
    for (exponent, bases) in groups {
        // `(q/10)^40` where 1e-40 has no value in single precision.
        let root = is_far(&coefficient).then(|| coefficient.abs().root_exact(exponent)).flatten();
        if bases.len() < 2 && root.is_none() {
            continue;
        }
        if root.is_some() {
            coefficient = Rational::from(coefficient.signum());
        }
        combined.push(CombinedPower { coefficient: root.unwrap_or(Rational::ONE), bases, exponent });
    }
    let raised = |exponent: &Rational| {
        combined_exponent(exponent).is_some_and(|size| combined.iter().any(|power| power.exponent == size))
    };
    let factors = product.factors.iter().filter(|(_, exponent)| !raised(exponent)).cloned().collect();
    (combined, Product { coefficient, factors })
}

pub(super) fn is_half(fraction: &Rational) -> bool {
    Rational::new(1, 2).as_ref() == Some(fraction)
}

fn is_odd(integer: &Rational) -> bool {
    integer.numerator().trailing_zeros() == 0
}
