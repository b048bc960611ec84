//! Parameters into sums whose summands all have parameters: `K*(a*x + b*y)` becomes `K*a*x + K*b*y`, where `K*a` and
//! `K*b` are stored.
//!
//! In: expressions, and the symbols that seldom change. Out: equal expressions with one multiplication less for each
//! such sum. Values with more than one use are left as they are.

use rustc_hash::FxHashMap;

use super::fixed::fixed;
use pebo_cas::{Arena, Expr, Node, Rational, Sum, Symbol};

/// The expressions with parameters spread over sums.
pub(super) fn spread(arena: &Arena, roots: &[Expr], parameters: &[Symbol]) -> Vec<Expr> {
    let fixed = fixed(arena, roots, parameters);
    let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
    let all = arena.postorder(roots);
    for operand in all.iter().flat_map(|expr| arena.operands(*expr)).chain(roots.iter().copied()) {
        *uses.entry(operand).or_insert(0) += 1;
    }
    let has_parameter = |term: Expr| match arena.node(term) {
        _ if fixed.contains(&term) => true,
        Node::Product(product) => {
            uses.get(&term) == Some(&1) && product.factors.iter().any(|(base, _)| fixed.contains(base))
        }
        _ => false,
    };
    let takes = |base: Expr, sum: &Sum| {
        let here = uses.get(&base) == Some(&1) && !fixed.contains(&base);
        here && sum.constant.is_zero() && sum.terms.iter().all(|(term, _)| has_parameter(*term))
    };
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for &expr in &all {
        let rebuilt = arena.rebuild(expr, &known);
        let Node::Product(product) = arena.node(expr) else {
            known.insert(expr, rebuilt);
            continue;
        };
        let (stored, rest): (Vec<_>, Vec<_>) = product.factors.iter().cloned().partition(|f| fixed.contains(&f.0));
        let spread = match rest.as_slice() {
            [(base, exponent)] if !stored.is_empty() && exponent.is_one() => match arena.node(*base) {
                Node::Sum(sum) if takes(*base, &sum) => {
                    let factor = arena.multiply(&product.coefficient, stored);
                    let terms = sum.terms.iter();
                    let terms = terms.map(|(term, number)| (arena.mul(factor, known[term]), number.clone()));
                    Some(arena.combine(&Rational::ZERO, terms))
                }
                _ => None,
            },
            _ => None,
        };
        known.insert(expr, spread.unwrap_or(rebuilt));
    }
    roots.iter().map(|root| known[root]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_go_where_parameters_are() {
        let arena = Arena::new();
        let [a, b, k, x, y] = ["a", "b", "k", "x", "y"].map(|name| arena.variable(name));
        let parameters = ["a", "b", "k"].map(|name| arena.symbol(name));
        let spread = |expr: Expr| super::spread(&arena, &[expr], &parameters)[0];
        let sum = arena.add(arena.mul(a, x), arena.mul(b, y));
        let both = arena.add(arena.product([a, k, x]), arena.product([b, k, y]));
        assert_eq!(spread(arena.mul(k, sum)), both);
        let with_number = arena.add(arena.product([a, k, x]), arena.mul(b, k));
        assert_eq!(spread(arena.mul(k, arena.add(arena.mul(a, x), b))), with_number);
        // `y` alone would have to be multiplied; a value with two uses would be computed twice.
        let plain = arena.mul(k, arena.add(arena.mul(a, x), y));
        let repeated = arena.add(arena.mul(k, sum), arena.power(sum, &Rational::from(2)));
        for unchanged in [plain, repeated] {
            assert_eq!(spread(unchanged), unchanged);
        }
    }
}
