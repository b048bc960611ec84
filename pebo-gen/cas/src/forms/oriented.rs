//! Denominators with the sign that the assumptions determine.
//!
//! In: an expression and a domain. Out: the same value, with `1 - d` in place of `d - 1` in denominators and squares,
//! if `d < 1` is known. Turning a factor round is exact; a factor known to be positive combines with its own root, as
//! in `sqrt(r)/r`.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::{Arena, Domain, Expr, Node, Product, Rational, Relation};

/// The expression with known negative denominators turned round, in sums term by term.
pub fn oriented(arena: &Arena, domain: &Domain, expr: Expr) -> Expr {
    Orientation::new(arena, domain).of(expr)
}

/// As [`oriented`], for several expressions, which often share denominators.
pub struct Orientation<'a> {
    arena: &'a Arena,
    domain: &'a Domain,
    /// The sums examined so far; true if the domain proves them negative.
    negative: RefCell<BTreeMap<Expr, bool>>,
}

impl<'a> Orientation<'a> {
    /// Denominators of an arena's expressions, with signs that a domain implies.
    pub fn new(arena: &'a Arena, domain: &'a Domain) -> Self {
        Self { arena, domain, negative: RefCell::default() }
    }

    /// The expression turned round.
    pub fn of(&self, expr: Expr) -> Expr {
        let arena = self.arena;
        match arena.node(expr) {
            Node::Sum(sum) => {
                let terms = sum.terms.iter().map(|(term, coefficient)| {
                    let term = match arena.node(*term) {
                        Node::Product(product) => self.turned(&product),
                        _ => *term,
                    };
                    arena.scale(term, coefficient)
                });
                arena.sum(terms.chain([arena.number(sum.constant.clone())]))
            }
            Node::Product(product) => self.turned(&product),
            _ => expr,
        }
    }

    /// The domain of the signs.
    pub(crate) fn domain(&self) -> &'a Domain {
        self.domain
    }

    fn is_negative(&self, sum: Expr) -> bool {
        if let Some(known) = self.negative.borrow().get(&sum) {
            return *known;
        }
        let negative = self.domain.implies(self.arena, self.arena.neg(sum), Relation::Positive);
        self.negative.borrow_mut().insert(sum, negative);
        negative
    }

    fn turned(&self, product: &Product) -> Expr {
        let arena = self.arena;
        let two = Rational::from(2);
        let is_even = |exponent: &Rational| exponent.checked_div(&two).is_some_and(|half| half.is_integer());
        let mut coefficient = product.coefficient.clone();
        let mut factors = product.factors.clone();
        let mut changed = false;
        for (base, exponent) in &mut factors {
            let in_denominator = exponent.is_integer() && (exponent.is_negative() || is_even(exponent));
            if !in_denominator || !matches!(arena.node(*base), Node::Sum(_)) {
                continue;
            }
            if self.is_negative(*base) {
                *base = arena.neg(*base);
                changed = true;
                if !is_even(exponent) {
                    coefficient = -&coefficient;
                }
            }
        }
        if !changed {
            return arena.multiply(&coefficient, factors);
        }
        // A sum in the numerator takes a remaining sign.
        if coefficient.is_negative()
            && let Some((base, _)) =
                factors.iter_mut().find(|(base, power)| power.is_one() && matches!(arena.node(*base), Node::Sum(_)))
        {
            *base = arena.neg(*base);
            coefficient = -&coefficient;
        }
        arena.multiply(&coefficient, factors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn denominators_known_to_be_negative_are_turned_round() {
        let arena = Arena::new();
        let [a, b, d] = ["a", "b", "d"].map(|name| arena.variable(name));
        let low = arena.sub(d, arena.one());
        let mut domain = Domain::default();
        let shown = |domain: &Domain, expr: Expr| arena.print(oriented(&arena, domain, expr));
        let squared = arena.div(a, arena.mul(low, low));
        let fraction = arena.neg(arena.div(a, low));
        let before = arena.print(fraction);
        assert_eq!(shown(&domain, fraction), before, "without an assumption there is no sign");
        domain.facts.assume(arena.sub(arena.one(), d), Relation::Positive);
        assert_eq!(shown(&domain, fraction), "a/(1 - d)");
        assert_eq!(shown(&domain, squared), "a/(1 - d)^2");
        assert_eq!(shown(&domain, arena.add(b, fraction)), "b + a/(1 - d)");
        assert_eq!(shown(&domain, arena.div(arena.sub(a, b), low)), "(b - a)/(1 - d)");
        assert_eq!(shown(&domain, arena.mul(a, low)), arena.print(arena.mul(a, low)), "there is no denominator");
        let root = arena.sqrt(arena.sub(arena.one(), d));
        assert_eq!(shown(&domain, arena.div(root, low)), "-1/sqrt(1 - d)");
    }
}
