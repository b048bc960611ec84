//! Rewrites absolute values, roots of squares, signs, extremes, saturations and tables by the signs of a domain.
//!
//! In: a domain, as a cell of one, and formulas. Out: the same functions on the domain, where each of these operations
//! is the branch that the domain implies: on a cell with `a < 0`, `max(0, a)` is 0, and so are its derivatives. An
//! operation of undecided sign remains.

use rustc_hash::FxHashMap;

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;
use crate::number::rational::half;
use crate::{Arena, Domain, Product, Rational, Relation};

impl Domain {
    /// The formulas by the branches that the domain implies.
    pub fn analytic(&self, arena: &Arena, exprs: &[Expr]) -> Vec<Expr> {
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        for expr in arena.postorder(exprs) {
            let rebuilt = arena.rebuild(expr, &known);
            let branch = match arena.node(rebuilt) {
                Node::Call(Function::Table, _) => self.piece(arena, rebuilt),
                Node::Call(function, arguments) => self.branch(arena, function, &arguments),
                Node::Product(product) => self.roots_of_squares(arena, &product),
                _ => None,
            };
            known.insert(expr, branch.unwrap_or(rebuilt));
        }
        exprs.iter().map(|expr| known[expr]).collect()
    }

    /// The branches of an expression that are nowhere less than it: `1 - |q|` is at most `1 - q` and `1 + q`. They are
    /// positive where it is, and their implications are easier to find.
    pub fn branches_above(&self, arena: &Arena, expr: Expr) -> Vec<Expr> {
        if arena.dividers(&[expr]).is_empty() {
            return Vec::new();
        }
        let cells = Self::default().cells(arena, &[expr], |_| true).unwrap_or_default();
        let mut above = Vec::new();
        for branch in cells.iter().map(|cell| cell.domain.analytic(arena, &[expr])[0]) {
            let is_above = || self.implies(arena, arena.sub(branch, expr), Relation::NonNegative);
            if branch != expr && !above.contains(&branch) && is_above() {
                above.push(branch);
            }
        }
        above
    }

    /// The domain with its equations by the branches that its inequalities imply.
    pub(super) fn with_branches(self, arena: &Arena) -> Self {
        let written = self.manifold.equations();
        // An equation says nothing of its own branches.
        let equations = self.without_equations().analytic(arena, written);
        if equations == written {
            return self;
        }
        let manifold = self.manifold.of(arena, &self.facts, equations);
        Self { manifold, ..self }
    }

    /// A product with absolute values in place of roots of squares, where the domain implies the signs of these.
    fn roots_of_squares(&self, arena: &Arena, product: &Product) -> Option<Expr> {
        let is_even = |(_, power): &(Expr, Rational)| power.is_integer() && (power * &half()).is_integer();
        let factor = |(base, power): &(Expr, Rational)| {
            let Node::Product(square) = arena.node(*base) else { return None };
            if power.is_integer() || square.coefficient.is_negative() || !square.factors.iter().all(is_even) {
                return None;
            }
            let halves = square.factors.iter().map(|(base, power)| (*base, power * &half()));
            let absolute = self.branch(arena, Function::Abs, &[arena.multiply(&Rational::ONE, halves)])?;
            let coefficient = arena.power(arena.number(square.coefficient.clone()), power);
            Some([(coefficient, Rational::ONE), (absolute, power + power)])
        };
        let found: Vec<Option<[(Expr, Rational); 2]>> = product.factors.iter().map(factor).collect();
        let factors = product.factors.iter().zip(&found).flat_map(|(own, found)| match found {
            Some(roots) => roots.to_vec(),
            None => vec![own.clone()],
        });
        found.iter().any(Option::is_some).then(|| arena.multiply(&product.coefficient, factors))
    }

    /// The polynomial of a table's piece, if the domain implies one.
    fn piece(&self, arena: &Arena, call: Expr) -> Option<Expr> {
        let (table, argument) = Pieces::of(arena, call)?;
        let is_above = |knot: &Rational| {
            let above = arena.sub(argument, arena.number(knot.clone()));
            self.grants(arena, (above, Relation::NonNegative))
        };
        let is_below = |knot: &Rational| {
            let below = arena.sub(arena.number(knot.clone()), argument);
            self.grants(arena, (below, Relation::NonNegative))
        };
        // Between the last knot that it is above and the next where another polynomial begins.
        let begun = table.knots.iter().take_while(|knot| is_above(knot)).count();
        let next = table.meeting(None).into_iter().find(|knot| begun == 0 || *knot > table.knots[begun - 1]);
        let is_inside = next.is_none_or(|next| is_below(&next));
        is_inside.then(|| table.branch(arena, begun, argument))
    }

    /// The branch of a non-smooth operation, if the domain implies one.
    fn branch(&self, arena: &Arena, function: Function, arguments: &[Expr]) -> Option<Expr> {
        let implies = |expr: Expr, relation| self.grants(arena, (expr, relation));
        let is_above = |a: Expr, b: Expr| implies(arena.sub(a, b), Relation::NonNegative);
        let (zero, one) = (arena.zero(), arena.one());
        let minus_one = arena.neg(one);
        // Each value with the comparison that makes it the operation's.
        match (function, arguments) {
            (Function::Abs, &[a]) => is_above(a, zero).then_some(a).or_else(|| is_above(zero, a).then(|| arena.neg(a))),
            (Function::Sign, &[a]) => {
                let is_positive = |a: Expr| implies(a, Relation::Positive);
                let outside = is_positive(a).then_some(one).or_else(|| is_positive(arena.neg(a)).then_some(minus_one));
                outside.or_else(|| (is_above(a, zero) && is_above(zero, a)).then_some(zero))
            }
            (Function::Max, &[a, b]) => is_above(a, b).then_some(a).or_else(|| is_above(b, a).then_some(b)),
            (Function::Min, &[a, b]) => is_above(a, b).then_some(b).or_else(|| is_above(b, a).then_some(a)),
            (Function::Sat, &[a]) => {
                let is_inside = || is_above(one, a) && is_above(a, minus_one);
                let outside = is_above(a, one).then_some(one).or_else(|| is_above(minus_one, a).then_some(minus_one));
                outside.or_else(|| is_inside().then_some(a))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_their_branches_where_the_domain_has_one() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let (zero, one) = (arena.zero(), arena.one());
        let on = |positive: Expr, expr: Expr| {
            let mut domain = Domain::default();
            domain.facts.assume(positive, Relation::Positive);
            arena.print(domain.analytic(&arena, &[expr])[0])
        };
        let minus = |e| arena.neg(e);
        assert_eq!(on(a, call(Function::Abs, &[a])), "a");
        assert_eq!(on(minus(a), call(Function::Abs, &[a])), "-a");
        assert_eq!(on(minus(a), arena.sqrt(call(Function::Max, &[zero, a]))), "0");
        assert_eq!(on(minus(a), call(Function::Sign, &[a])), "-1");
        assert_eq!(on(arena.sub(a, one), call(Function::Sat, &[a])), "1");
        assert_eq!(on(arena.sub(a, b), call(Function::Min, &[a, b])), "b");
        assert_eq!(on(b, call(Function::Abs, &[a])), "abs(a)");
        let square = arena.mul(a, a);
        assert_eq!(on(minus(a), arena.mul(b, arena.sqrt(square))), "-a*b");
        assert_eq!(on(a, arena.sqrt(arena.mul(square, square))), "a^2");
        assert_eq!(on(b, arena.sqrt(square)), "sqrt(a^2)");
        // A function of a function.
        let inner = arena.sub(call(Function::Abs, &[a]), a);
        assert_eq!(on(a, call(Function::Max, &[inner, minus(a)])), "0");
    }

    #[test]
    fn branches_bound_an_extreme_on_one_side() {
        let arena = Arena::new();
        let [q, u] = ["q", "u"].map(|name| arena.variable(name));
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let one = arena.one();
        let cases = [
            (arena.sub(one, call(Function::Abs, &[q])), vec!["1 - q", "q + 1"]),
            (arena.sub(one, call(Function::Max, &[q, u])), vec!["1 - q", "1 - u"]),
            (call(Function::Min, &[q, u]), vec!["u", "q"]),
            (arena.scale(call(Function::Min, &[q, u]), &Rational::from(2)), vec!["2*u", "2*q"]),
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
            let found: Vec<String> =
                Domain::default().branches_above(&arena, expr).iter().map(|e| arena.print(*e)).collect();
            assert_eq!(found, expected, "{}", arena.print(expr));
        }
        let small = arena.sub(one, arena.mul(u, call(Function::Abs, &[q])));
        assert!(Domain::default().branches_above(&arena, small).is_empty());
        let mut domain = Domain::default();
        domain.facts.assume(u, Relation::Positive);
        assert_eq!(domain.branches_above(&arena, small).len(), 2);
    }
}
