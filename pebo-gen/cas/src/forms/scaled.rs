//! The shortest numbers beside sums: `(3*p - 2*b)/(2*J)` is `(1.5*p - b)/J`.
//!
//! In: an expression, as a normal form over whole numbers writes it. Out: an equal one. A sum beside a number may be
//! divided by a number that joins it. A decimal stays one: no number appears that has no exact decimal, unless the one
//! beside the sum goes: `(3*v - q)/3` is `v - q/3`.

use rustc_hash::FxHashMap;

use crate::{Arena, Expr, Node, Rational, Sum};

/// The expression with fewer numbers beside its sums.
pub fn scaled(arena: &Arena, expr: Expr) -> Expr {
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for e in arena.postorder(&[expr]) {
        let rebuilt = arena.rebuild(e, &known);
        let better = match arena.node(rebuilt) {
            Node::Product(product) => {
                let mut coefficient = product.coefficient.clone();
                let mut factors = product.factors.clone();
                for (base, exponent) in &mut factors {
                    if let Node::Sum(sum) = arena.node(*base)
                        && exponent.is_one()
                        && let Some(share) = share(&sum, &coefficient)
                    {
                        coefficient = &coefficient * &share;
                        *base = divided(arena, &sum, &share);
                    }
                }
                arena.multiply(&coefficient, factors)
            }
            _ => rebuilt,
        };
        known.insert(e, better);
    }
    known[&expr]
}

/// The number by which a sum with this coefficient is to be divided, if any.
fn share(sum: &Sum, coefficient: &Rational) -> Option<Rational> {
    // The count of numbers that remain, if none of them loses its decimal or the coefficient goes.
    let count = |share: &Rational| -> Option<usize> {
        let outer = &coefficient.abs() * share;
        let may_lose = outer.is_one();
        let mut count = usize::from(!outer.is_one());
        for (_, number) in &sum.terms {
            let quotient = number.checked_div(share)?;
            if !may_lose && !is_short(&quotient) && is_short(number) {
                return None;
            }
            count += usize::from(!quotient.abs().is_one());
        }
        let constant = sum.constant.checked_div(share)?;
        count += usize::from(!constant.is_integer());
        (may_lose || is_short(&constant) || !is_short(&sum.constant)).then_some(count)
    };
    let mut best = (count(&Rational::ONE)?, None);
    let numbers = sum.terms.iter().map(|(_, number)| number.abs());
    for share in numbers.chain(coefficient.abs().recip()) {
        if let Some(count) = count(&share).filter(|&count| count < best.0) {
            best = (count, Some(share));
        }
    }
    best.1
}

/// The sum divided by a number that is not zero.
pub fn divided(arena: &Arena, sum: &Sum, share: &Rational) -> Expr {
    let part = |number: &Rational| number.checked_div(share).unwrap_or_else(|| number.clone());
    arena.combine(&part(&sum.constant), sum.terms.iter().map(|(term, number)| (*term, part(number))))
}

/// True if the number has an exact decimal: its denominator has no prime factor but 2 and 5.
pub fn is_short(value: &Rational) -> bool {
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
    fn common_denominators_of_numbers_leave() {
        let arena = Arena::new();
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| arena.variable(name));
        let fraction = |n: i64, d: i64| Rational::new(n, d).unwrap();
        let sum = |numbers: [i64; 3], constant: i64| {
            arena.combine(&constant.into(), [a, b, c].into_iter().zip(numbers.map(Rational::from)))
        };
        let over = |number: Rational, sum: Expr| arena.scale(arena.div(sum, d), &number);
        let million = 1_000_000;
        let cases = [
            (over(fraction(1, 2), sum([3, -2, 0], 0)), "(3*a/2 - b)/d"),
            (over(fraction(1, 5), sum([2, 0, 0], -5)), "(2*a/5 - 1)/d"),
            (over(fraction(1, million), sum([million, -million, 1], 0)), "(a - b + 1e-6*c)/d"),
            // If no number vanishes for it, a third remains outside.
            (over(fraction(1, 3), sum([3, -1, 0], 0)), "(a - b/3)/d"),
            (over(fraction(1, 3), sum([1, 2, 0], 0)), "(a + 2*b)/(3*d)"),
            (over(fraction(1, 2), sum([1, -1, 0], 0)), "(a - b)/(2*d)"),
        ];
        for (expr, expected) in cases {
            assert_eq!(arena.print(scaled(&arena, expr)), expected);
        }
    }

    #[test]
    fn numbers_with_finite_decimals_are_short() {
        let short = |n: i64, d: i64| is_short(&Rational::new(n, d).unwrap());
        assert!(short(3, 1) && short(1, 8) && short(7, 25) && short(1, 40));
        assert!(!short(1, 3) && !short(1, 30));
    }
}
