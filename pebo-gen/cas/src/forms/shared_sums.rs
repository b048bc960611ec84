//! Long rational formulas over the sums that they hold several times, which are opaque.
//!
//! In: a formula. Out: the formula over a fresh symbol for each such sum, and the sums. If the result is zero for any
//! values of the symbols, so is the formula, and a form of the one is a form of the other. A linear plant in symbols
//! divides by a determinant of hundreds of terms, and multiplies minors that are no shorter: few problems need to
//! expand them. Results that need the expansion are not found.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use crate::Facts;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Symbol};
use crate::tower::Field;

/// Subexpressions of a formula up to which its normal form costs no more than a search for shared sums.
const SHORT: usize = 200;

/// The number of times that shared sums are expanded down to the shared sums within them.
const MOST_LAYERS: usize = 2;

/// A formula over symbols for the sums that it held several times.
pub(crate) struct SharedSums {
    pub expr: Expr,
    values: BTreeMap<Symbol, Expr>,
}

impl SharedSums {
    /// None if a formula is short, holds functions or roots, or holds no sum twice.
    pub(crate) fn of(arena: &Arena, expr: Expr) -> Option<Self> {
        let sums = shared_sums(arena, expr);
        (!sums.is_empty()).then(|| Self::over(arena, expr, &sums))
    }

    fn over(arena: &Arena, expr: Expr, sums: &[Expr]) -> Self {
        let mut values = BTreeMap::new();
        let mut symbols = FxHashMap::default();
        for sum in sums {
            let symbol = arena.generated(&format!("shared{}", values.len() + 1));
            values.insert(symbol, *sum);
            symbols.insert(*sum, arena.of_symbol(symbol));
        }
        Self { expr: arena.replace(expr, &symbols), values }
    }

    /// A formula with the symbols replaced by their sums.
    pub(crate) fn expanded(&self, arena: &Arena, expr: Expr) -> Expr {
        arena.substitute(expr, &self.values)
    }
}

/// True if the expression is zero for any values of its shared sums: the outermost, or those within them.
pub(crate) fn vanishes_over_shared_sums(arena: &Arena, facts: &Facts, expr: Expr) -> bool {
    let mut sums = shared_sums(arena, expr);
    for _ in 0..MOST_LAYERS {
        if sums.is_empty() {
            return false;
        }
        let shared = SharedSums::over(arena, expr, &sums);
        let field = Field::of_long_sums(arena, facts, &[shared.expr]);
        if field.and_then(|field| field.fraction(shared.expr)).is_ok_and(|fraction| fraction.is_zero()) {
            return true;
        }
        let outermost = arena.symbols_of(&[shared.expr]);
        let opened: BTreeSet<Expr> =
            shared.values.iter().filter(|(symbol, _)| outermost.contains(symbol)).map(|(_, sum)| *sum).collect();
        sums.retain(|sum| !opened.contains(sum));
    }
    false
}

/// The sums that a long rational formula holds several times; none for any other formula.
fn shared_sums(arena: &Arena, expr: Expr) -> Vec<Expr> {
    let parts = arena.postorder(&[expr]);
    if parts.len() <= SHORT || !parts.iter().all(|part| is_rational(arena, *part)) {
        return Vec::new();
    }
    let mut holders: FxHashMap<Expr, usize> = FxHashMap::default();
    for operand in parts.iter().flat_map(|part| arena.operands(*part)) {
        *holders.entry(operand).or_default() += 1;
    }
    let is_shared =
        |part: &Expr| holders.get(part).is_some_and(|times| *times > 1) && matches!(arena.node(*part), Node::Sum(_));
    parts.into_iter().filter(is_shared).collect()
}

/// True if the last operation of an expression is one of rational functions.
fn is_rational(arena: &Arena, expr: Expr) -> bool {
    match arena.node(expr) {
        Node::Number(_) | Node::Symbol(_) | Node::Sum(_) => true,
        Node::Product(product) => product.factors.iter().all(|(_, exponent)| exponent.is_integer()),
        Node::Pi | Node::Call(..) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Budget;
    use crate::Domain;
    use crate::domain::zero::is_zero;

    /// `(A B - C (A B/C)) D` over sums of many terms: zero, though written out it would have some 10^9 of them.
    #[test]
    fn differences_of_long_sums_are_zero_without_expansion() {
        let arena = Arena::within(Budget::of_seconds(0.2));
        let sum = |name: &str| arena.sum((0..60).map(|k| arena.variable(&format!("{name}{k}"))));
        let [a, b, c, d] = ["a", "b", "c", "d"].map(sum);
        let powers = |base: Expr| arena.mul(base, arena.add(base, arena.one()));
        let [a, b, c, d] = [a, b, c, d].map(powers);
        let ratio = arena.div(arena.add(a, b), c);
        let difference =
            arena.sub(arena.mul(d, ratio), arena.add(arena.div(arena.mul(a, d), c), arena.div(arena.mul(b, d), c)));
        assert!(is_zero(&arena, difference, &Domain::default()));
        assert!(!is_zero(&arena, arena.add(difference, a), &Domain::default()));
    }

    #[test]
    fn sums_within_sums_are_opened_to_the_last() {
        let arena = Arena::new();
        let sum = |name: &str| arena.sum((0..120).map(|k| arena.variable(&format!("{name}{k}"))));
        let [a, b] = ["a", "b"].map(sum);
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let inner = arena.add(arena.mul(a, x), y);
        let outer = arena.sum([arena.mul(inner, x), arena.mul(inner, y), arena.mul(a, b), arena.div(x, a)]);
        let shared = SharedSums::of(&arena, outer).expect("a sum twice");
        assert_ne!(shared.expr, outer);
        assert_eq!(shared.expanded(&arena, shared.expr), outer);
    }
}
