//! Rewrites expressions in terms of named values.
//!
//! In: expressions, and values with their names. Out: equal expressions in which each value that occurs as a whole,
//! with the opposite sign, or as part of a product, is its name. Nothing new is named.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::oriented::oriented;
use pebo_cas::{Arena, Expr, Node, Product, Rational, Symbol};

/// The expressions in terms of the values.
pub(super) fn with_values(arena: &Arena, exprs: &[Expr], values: &[(Symbol, Expr)]) -> Vec<Expr> {
    let minus = Rational::from(-1);
    let mut whole: FxHashMap<Expr, Expr> = FxHashMap::default();
    let mut products: Vec<(Expr, Rc<Product>)> = Vec::new();
    for &(name, value) in values {
        let name = arena.of_symbol(name);
        let (is_opposite, value) = oriented(arena, value);
        let name = if is_opposite { arena.scale(name, &minus) } else { name };
        whole.entry(arena.scale(value, &minus)).or_insert_with(|| arena.scale(name, &minus));
        whole.insert(value, name);
        if let Node::Product(product) = arena.node(value) {
            products.push((name, product));
        }
    }
    // The largest product comes first.
    products.sort_by_key(|(_, product)| std::cmp::Reverse(product.factors.len()));
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for expr in arena.postorder(exprs) {
        let (is_opposite, plain) = oriented(arena, expr);
        let sign = if is_opposite { &minus } else { &Rational::ONE };
        let by_names = match (whole.get(&plain), arena.node(plain)) {
            (Some(name), _) => arena.scale(*name, sign),
            (None, Node::Product(product)) => arena.scale(by_parts(arena, &product, &products, &known), sign),
            (None, _) => arena.rebuild(expr, &known),
        };
        known.insert(expr, by_names);
    }
    exprs.iter().map(|expr| known[expr]).collect()
}

/// A product with the named products in it by their names.
fn by_parts(arena: &Arena, product: &Product, named: &[(Expr, Rc<Product>)], known: &FxHashMap<Expr, Expr>) -> Expr {
    let Product { mut coefficient, factors: mut rest } = product.clone();
    let mut factors: Vec<(Expr, Rational)> = Vec::new();
    for (name, part) in named {
        let Some(share) = coefficient.checked_div(&part.coefficient) else { continue };
        if part.factors.iter().all(|factor| rest.contains(factor)) {
            rest.retain(|factor| !part.factors.contains(factor));
            coefficient = share;
            factors.push((*name, Rational::ONE));
        }
    }
    let minus = Rational::from(-1);
    let value = |base: Expr| {
        // A sum may have changed its sign.
        known.get(&base).copied().unwrap_or_else(|| arena.scale(known[&arena.scale(base, &minus)], &minus))
    };
    factors.extend(rest.into_iter().map(|(base, exponent)| (value(base), exponent)));
    arena.multiply(&coefficient, factors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_found_whole_with_the_other_sign_and_in_products() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let [r, s, t] = ["r", "s", "t"].map(|name| arena.symbol(name));
        let values = [(s, arena.div(a, b)), (t, arena.sub(a, c)), (r, arena.div(arena.add(a, b), c))];
        let cases = [
            (arena.div(a, b), "s"),
            (arena.sub(c, a), "-t"),
            (arena.div(arena.neg(arena.add(a, b)), c), "-r"),
            (arena.product([c, arena.neg(arena.add(a, b)), arena.power(c, &Rational::from(-2))]), "-r"),
            (arena.product([arena.number(2), arena.div(a, b), c]), "2*c*s"),
            (arena.mul(arena.sub(a, c), arena.sqrt(arena.div(a, b))), "sqrt(s)*t"),
            // Neither `a*b` nor `a/b^2` holds `a/b` as factors of its own.
            (arena.mul(a, b), "a*b"),
            (arena.div(a, arena.mul(b, b)), "a/b^2"),
        ];
        for (expr, expected) in cases {
            assert_eq!(arena.print(with_values(&arena, &[expr], &values)[0]), expected);
        }
    }
}
