//! Quotients of an absolute value and its argument, as signs: `abs(q)*sqrt(abs(q))/q` is `sign(q)*sqrt(abs(q))`.
//!
//! In: an expression as the normal form writes it, with signs as quotients. Out: an expression with the same values and
//! no division for the sake of a sign. Code computes the sign of 0 as 0, and 0/0 not at all.

use rustc_hash::FxHashMap;

use crate::graph::function::Function;
use crate::{Arena, Expr, Node, Product, Rational};

/// The expression with signs in place of such quotients.
pub(crate) fn as_sign(arena: &Arena, expr: Expr) -> Expr {
    let nodes = arena.postorder(&[expr]);
    let is_absolute_value = |e: &Expr| matches!(arena.node(*e), Node::Call(Function::Abs, _));
    if !nodes.iter().any(is_absolute_value) {
        return expr;
    }
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for e in nodes {
        let rebuilt = arena.rebuild(e, &known);
        let better = match arena.node(rebuilt) {
            Node::Product(product) => cancelled(arena, &product).unwrap_or(rebuilt),
            _ => rebuilt,
        };
        known.insert(e, better);
    }
    known[&expr]
}

/// A product in which an absolute value cancels with its argument, if there is such a pair.
fn cancelled(arena: &Arena, product: &Product) -> Option<Expr> {
    let pair = |(place, (base, power)): (usize, &(Expr, Rational))| {
        let Node::Call(Function::Abs, arguments) = arena.node(*base) else { return None };
        let inside = arguments[0];
        let (other, (_, own)) = product.factors.iter().enumerate().find(|(_, (base, _))| *base == inside)?;
        let sum = power + own;
        // One of the powers in `|a|^m a^n` divides; the quotient does not.
        let divides = own.is_negative() != power.is_negative() && !sum.is_negative();
        let whole = own.is_integer() && (power.is_integer() || own.is_negative());
        (divides && whole).then_some((place, other, inside, sum))
    };
    let (place, other, inside, sum) = product.factors.iter().enumerate().find_map(pair)?;
    let (absolute, power) = &product.factors[place];
    let own = &product.factors[other].1;
    // The dividing one becomes a sign and a power of the other.
    let (left, turned) = if own.is_negative() { (*absolute, own) } else { (inside, power) };
    let is_odd = turned.numerator().trailing_zeros() == 0;
    let sign = is_odd.then(|| (arena.call(Function::Sign, &[inside]), Rational::ONE));
    let others = product.factors.iter().enumerate().filter(|(index, _)| ![place, other].contains(index));
    let factors = others.map(|(_, factor)| factor.clone()).chain([(left, sum)]).chain(sign);
    Some(arena.multiply(&product.coefficient, factors))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sign_divides_by_nothing() {
        let arena = Arena::new();
        let q = arena.variable("q");
        let size = arena.call(Function::Abs, &[q]);
        let power = |base: Expr, n: i64, d: i64| arena.power(base, &Rational::new(n, d).unwrap());
        let cases = [
            (arena.div(size, q), "sign(q)"),
            (arena.div(q, size), "sign(q)"),
            (arena.div(power(size, 3, 2), q), "sign(q)*sqrt(abs(q))"),
            (arena.div(power(q, 3, 1), size), "q^2*sign(q)"),
            (arena.div(power(size, 3, 1), power(q, 2, 1)), "abs(q)"),
            // This divides in any case.
            (arena.div(size, power(q, 2, 1)), "abs(q)/q^2"),
            (arena.mul(size, q), "q*abs(q)"),
        ];
        for (expr, expected) in cases {
            let mut words: Vec<String> = arena.print(as_sign(&arena, expr)).split('*').map(str::to_owned).collect();
            let mut wanted: Vec<&str> = expected.split('*').collect();
            words.sort();
            wanted.sort_unstable();
            assert_eq!(words, wanted, "{}", arena.print(expr));
        }
    }
}
