//! Numbers at the positions of the fewest multiplications: `(2*a + 2*b - c*p)*p/2` becomes `(a + b - c*p/2)*p`.
//!
//! In: a sum, or a product with sums in it. Out: an equal one. A sum may be divided by a number that then multiplies
//! the whole. Beside something stored, as a parameter, a number is a part of the stored value: it costs nothing, unless
//! the same is stored without it too. Among equal costs a product has its sum with whole numbers that have no divisor
//! in common, so that `y*(10 - 2*x)` and `2*y*(5 - x)` are one.

use rustc_hash::FxHashMap;

use pebo_cas::forms::scaled::{divided, is_short};
use pebo_cas::{Arena, Expr, Node, Product, Rational, Sum};

/// The arrangement, with the stored value of an expression for the number of its occurrences.
pub(super) struct Numbers<'a, S> {
    pub(super) arena: &'a Arena,
    pub(super) is_stored: S,
    /// The number of occurrences of an expression; one, if unknown.
    pub(super) uses: FxHashMap<Expr, usize>,
}

impl<S: Fn(Expr, usize) -> bool> Numbers<'_, S> {
    /// The expression with its outermost numbers arranged.
    pub(super) fn arranged(&self, expr: Expr) -> Expr {
        let arena = self.arena;
        match arena.node(expr) {
            Node::Sum(sum) => match self.share(&sum, &Rational::ONE, false, false) {
                Some(share) => arena.multiply(&share, [(divided(arena, &sum, &share), Rational::ONE)]),
                None => expr,
            },
            Node::Product(product) => self.arranged_product(&product),
            _ => expr,
        }
    }

    fn arranged_product(&self, product: &Product) -> Expr {
        let arena = self.arena;
        let is_free = product.factors.iter().any(|(base, _)| self.takes_numbers(*base));
        let mut coefficient = product.coefficient.clone();
        let factors: Vec<(Expr, Rational)> = product
            .factors
            .iter()
            .map(|(base, exponent)| {
                if let Node::Sum(sum) = arena.node(*base)
                    && exponent.is_one()
                    && let Some(share) = self.share(&sum, &coefficient, true, is_free)
                {
                    coefficient = &coefficient * &share;
                    return (divided(arena, &sum, &share), Rational::ONE);
                }
                (*base, exponent.clone())
            })
            .collect();
        arena.multiply(&coefficient, factors)
    }

    /// The number that divides the sum, if any: beside it is this coefficient.
    fn share(&self, sum: &Sum, coefficient: &Rational, is_factor: bool, is_free: bool) -> Option<Rational> {
        // The cost, and the count of numbers, with those that are part of a stored value.
        let cost = |share: &Rational| -> Option<(usize, usize)> {
            let outer = &coefficient.abs() * share;
            let mut cost = usize::from(!is_free && !outer.is_one());
            let mut numbers = usize::from(!outer.is_one());
            for (term, number) in &sum.terms {
                let quotient = number.checked_div(share)?;
                numbers += usize::from(!quotient.abs().is_one());
                if self.has_stored(*term) {
                    continue;
                }
                // A whole number, or exact in binary: a reader has to know it again.
                let is_plain = if number.is_integer() { is_dyadic(&quotient) } else { is_short(&quotient) };
                if !is_plain {
                    return None;
                }
                cost += usize::from(!quotient.abs().is_one());
            }
            let constant = sum.constant.checked_div(share)?;
            (constant.is_integer() || !sum.constant.is_integer() && is_short(&constant)).then_some((cost, numbers))
        };
        let now = cost(&Rational::ONE)?;
        let content = sum.terms.iter().fold(sum.constant.abs(), |content, (_, number)| content.gcd(&number.abs()));
        let numbers = sum.terms.iter().map(|(_, number)| number.abs());
        let mut best: Option<((usize, usize), Rational)> = None;
        for share in std::iter::once(content.clone()).chain(numbers).chain(coefficient.abs().recip()) {
            if share.is_one() {
                continue;
            }
            let ties = is_factor && share == content;
            let Some(cost) = cost(&share).filter(|&cost| cost < now || ties && cost == now) else { continue };
            if best.as_ref().is_none_or(|best| cost < best.0) {
                best = Some((cost, share));
            }
        }
        best.map(|(_, share)| share)
    }

    /// Tests whether a number beside it is part of a stored value.
    fn has_stored(&self, term: Expr) -> bool {
        self.takes_numbers(term)
            || matches!(self.arena.node(term), Node::Product(product)
                if product.factors.iter().any(|(base, _)| self.takes_numbers(*base)))
    }

    fn takes_numbers(&self, base: Expr) -> bool {
        (self.is_stored)(base, self.uses.get(&base).copied().unwrap_or(1))
    }
}

/// Tests whether the denominator is a power of two.
fn is_dyadic(value: &Rational) -> bool {
    let denominator = value.denominator();
    denominator.bits() == u64::from(denominator.trailing_zeros()) + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arranged(build: impl Fn(&Arena, [Expr; 5]) -> Expr) -> String {
        let arena = Arena::new();
        let symbols = ["a", "b", "c", "d", "p"].map(|name| arena.variable(name));
        let numbers = Numbers { arena: &arena, is_stored: |base, _| base == symbols[4], uses: FxHashMap::default() };
        arena.print(numbers.arranged(build(&arena, symbols)))
    }

    /// `numbers[0] + numbers[1]*terms[0] + ..`
    fn sum<const N: usize>(arena: &Arena, constant: i64, terms: [(Expr, i64); N]) -> Expr {
        arena.combine(&constant.into(), terms.map(|(term, number)| (term, number.into())))
    }

    #[test]
    fn a_number_that_summands_share_leaves_the_sum() {
        assert_eq!(arranged(|arena, [a, b, ..]| sum(arena, 0, [(a, 2), (b, 2)])), "2*(a + b)");
        assert_eq!(arranged(|arena, [a, b, ..]| sum(arena, 0, [(a, 2), (b, 4)])), "2*a + 4*b");
        assert_eq!(arranged(|arena, [a, ..]| sum(arena, 10, [(a, -2)])), "10 - 2*a");
        assert_eq!(arranged(|arena, [a, b, ..]| arena.mul(b, sum(arena, 10, [(a, -2)]))), "2*b*(5 - a)");
        // Neither a third nor 2/5 is exact in binary.
        assert_eq!(arranged(|arena, [a, b, c, ..]| sum(arena, 0, [(a, 3), (b, 3), (c, 1)])), "3*a + 3*b + c");
        assert_eq!(arranged(|arena, [a, b, c, ..]| sum(arena, 0, [(a, 5), (b, 5), (c, 2)])), "5*a + 5*b + 2*c");
    }

    #[test]
    fn numbers_outside_and_inside_of_a_sum_meet() {
        let half = Rational::new(1, 2).unwrap();
        let doubled = |arena: &Arena, [a, b, c, ..]: [Expr; 5]| sum(arena, 0, [(a, 2), (b, 2), (c, -1)]);
        let beside = |arena: &Arena, e: [Expr; 5], other: Expr| arena.scale(arena.mul(other, doubled(arena, e)), &half);
        assert_eq!(arranged(|arena, e| beside(arena, e, e[3])), "d*(a + b - c/2)");
        assert_eq!(arranged(|arena, e| beside(arena, e, e[4])), "p*(a + b - c/2)");
        // Beside a parameter a third is part of a stored value.
        let third = Rational::new(1, 3).unwrap();
        let stored = arranged(|arena, [a, _, c, d, p]| {
            arena.scale(arena.mul(d, sum(arena, 0, [(a, 3), (arena.mul(c, p), -1)])), &third)
        });
        assert_eq!(stored, "d*(a - c*p/3)");
    }
}
