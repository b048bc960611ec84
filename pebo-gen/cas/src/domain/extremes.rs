//! Consequences of inequalities with absolute values, maxima and minima, written without these.
//!
//! In: an expression that is positive, or not negative. Out: expressions that are at least as large wherever it has a
//! value, in which `|a|` under a minus is `a` and `-a`, and so is each argument of a greatest or least value: `1 - |q|`
//! is at most `1 - q` and `1 + q`. Combined they are equivalent, and the implications of each are easier to find.

use crate::Rational;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;

/// The greatest number of absolute values, maxima and minima of one inequality that are expanded.
const MOST_EXTREMES: usize = 3;

impl Arena {
    /// The expressions without extremes that are nowhere less than this one; none if it has no such term.
    pub fn above_extremes(&self, expr: Expr) -> Vec<Expr> {
        let mut above = vec![expr];
        for _ in 0..MOST_EXTREMES {
            above = above.into_iter().flat_map(|expr| self.above_an_extreme(expr)).collect();
        }
        above.retain(|other| *other != expr);
        above
    }

    /// The same for the first such term; the expression itself if it has none.
    fn above_an_extreme(&self, expr: Expr) -> Vec<Expr> {
        let summands = match self.node(expr) {
            Node::Sum(sum) => sum.terms.clone(),
            Node::Product(product) => match product.factors.as_slice() {
                [(base, power)] if power.is_one() => vec![(*base, product.coefficient.clone())],
                _ => Vec::new(),
            },
            _ => vec![(expr, Rational::ONE)],
        };
        let bounds = |(term, slope): &(Expr, Rational)| {
            let Node::Call(function, arguments) = self.node(*term) else { return None };
            let bounds = match (function, slope.is_negative()) {
                (Function::Abs, true) => vec![arguments[0], self.neg(arguments[0])],
                (Function::Max, true) | (Function::Min, false) => arguments.to_vec(),
                _ => return None,
            };
            Some((*term, slope.clone(), bounds))
        };
        let Some((term, slope, bounds)) = summands.iter().find_map(bounds) else { return vec![expr] };
        let with = |bound: Expr| self.add(expr, self.scale(self.sub(bound, term), &slope));
        bounds.into_iter().map(with).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_of_an_extreme_are_bounds_of_its_arguments() {
        let arena = Arena::new();
        let [q, u] = ["q", "u"].map(|name| arena.variable(name));
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let one = arena.one();
        let cases = [
            (arena.sub(one, call(Function::Abs, &[q])), vec!["1 - q", "q + 1"]),
            (arena.sub(one, call(Function::Max, &[q, u])), vec!["1 - q", "1 - u"]),
            (call(Function::Min, &[q, u]), vec!["q", "u"]),
            (arena.scale(call(Function::Min, &[q, u]), &Rational::from(2)), vec!["2*q", "2*u"]),
            (
                arena.sum([one, arena.neg(call(Function::Abs, &[q])), arena.neg(call(Function::Abs, &[u]))]),
                vec!["1 - q - u", "1 - q + u", "q - u + 1", "q + u + 1"],
            ),
            // A large absolute value implies nothing of its argument.
            (arena.sub(call(Function::Abs, &[q]), one), vec![]),
            (arena.neg(call(Function::Min, &[q, u])), vec![]),
            (arena.mul(u, call(Function::Abs, &[q])), vec![]),
        ];
        for (expr, expected) in cases {
            let found: Vec<String> = arena.above_extremes(expr).iter().map(|e| arena.print(*e)).collect();
            assert_eq!(found, expected, "{}", arena.print(expr));
        }
    }
}
