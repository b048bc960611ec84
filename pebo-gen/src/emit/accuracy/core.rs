//! Cores of formulas, which do not depend on their arrangement.
//!
//! In: formulas. Out: their subexpressions without the common factors and denominators of the summands of a sum. Two
//! sums that differ by such a factor lose the same digits: `a*c/s - b*d/(s*t)` is `(a*c*t - b*d)/(s*t)`.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use pebo_cas::{Arena, Expr, Node, Rational};

/// A product: its number, and its powers.
type Factors = (Rational, BTreeMap<Expr, Rational>);

/// The core of each subexpression: a sum without its common factors; another one with such sums in it.
pub(super) fn cores(arena: &Arena, formulas: &[Expr]) -> FxHashMap<Expr, Expr> {
    let mut whole: FxHashMap<Expr, Expr> = FxHashMap::default();
    let mut cores: FxHashMap<Expr, Expr> = FxHashMap::default();
    for expr in arena.postorder(formulas) {
        let (value, core) = match arena.node(expr) {
            Node::Sum(sum) => {
                let scaled = |(term, number): &(Expr, Rational)| {
                    let (own, powers) = factors(arena, whole[term]);
                    (&own * number, powers)
                };
                let mut terms: Vec<Factors> = sum.terms.iter().map(scaled).collect();
                if !sum.constant.is_zero() {
                    terms.push((sum.constant.clone(), BTreeMap::new()));
                }
                without_common(arena, terms)
            }
            Node::Product(product) => {
                let powers = product.factors.iter().map(|(base, exponent)| (whole[base], exponent.clone()));
                let value = arena.multiply(&product.coefficient, powers);
                (value, value)
            }
            _ => {
                let value = arena.rebuild(expr, &whole);
                (value, value)
            }
        };
        whole.insert(expr, value);
        cores.insert(expr, core);
    }
    cores
}

fn factors(arena: &Arena, expr: Expr) -> Factors {
    match arena.node(expr) {
        Node::Number(number) => (number.clone(), BTreeMap::new()),
        Node::Product(product) => (product.coefficient.clone(), product.factors.iter().cloned().collect()),
        _ => (Rational::ONE, BTreeMap::from([(expr, Rational::ONE)])),
    }
}

/// The sum of the terms as a product, and of this the sum, with leading coefficient 1.
fn without_common(arena: &Arena, terms: Vec<Factors>) -> (Expr, Expr) {
    let mut common: BTreeMap<Expr, Rational> = BTreeMap::new();
    for base in terms.iter().flat_map(|(_, powers)| powers.keys()) {
        let exponents = terms.iter().map(|(_, powers)| powers.get(base).cloned().unwrap_or(Rational::ZERO));
        if let Some(least) = exponents.min() {
            common.insert(*base, least);
        }
    }
    let rest = terms.into_iter().map(|(number, powers)| {
        let mut left = common.iter().map(|(base, least)| (*base, -least)).collect::<BTreeMap<_, _>>();
        for (base, exponent) in powers {
            let entry = left.entry(base).or_insert(Rational::ZERO);
            *entry = &*entry + &exponent;
        }
        (arena.multiply(&Rational::ONE, left), number)
    });
    let sum = arena.combine(&Rational::ZERO, rest);
    let lead = match arena.node(sum) {
        Node::Sum(sum) => sum.terms[0].1.clone(),
        Node::Product(product) => product.coefficient.clone(),
        _ => Rational::ONE,
    };
    let core = lead.recip().map_or(sum, |share| arena.scale(sum, &share));
    common.insert(core, Rational::ONE);
    (arena.multiply(&lead, common), core)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_that_differ_by_a_factor_have_one_core() {
        let arena = Arena::new();
        let [a, b, c, s] = ["a", "b", "c", "s"].map(|name| arena.variable(name));
        let core = |expr: Expr| cores(&arena, &[expr])[&expr];
        let difference = arena.sub(a, b);
        let scaled = arena.sub(arena.div(arena.mul(b, c), s), arena.div(arena.mul(a, c), s));
        assert_eq!(core(scaled), core(difference));
        let nested = |inner: Expr| arena.add(arena.mul(a, inner), arena.div(inner, s));
        assert_eq!(core(nested(scaled)), core(nested(difference)));
        let halves = arena.sub(a, arena.div(b, s));
        assert_eq!(core(halves), core(arena.sub(arena.mul(a, s), b)));
        assert_ne!(core(halves), core(difference));
        assert_ne!(core(arena.add(difference, c)), core(difference));
    }
}
