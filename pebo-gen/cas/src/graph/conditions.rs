//! Domain conditions: the comparisons with zero under which an expression has a value, or is differentiable.
//!
//! In: an expression, or an operation that is about to be built. Out: comparisons with zero. This module has the
//! conditions of the operations, [`super::function`] those of the functions; parser, derivative and emitter share them.

use super::arena::Arena;
use super::enclosure::Point;
use super::expr::{Expr, Node};
use super::function::{Conditions, Function};
use crate::{Rational, Relation};

/// The regularity demanded of an operation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Regularity {
    /// A value.
    Defined,
    /// A value and a derivative.
    Differentiable,
}

impl Arena {
    /// The domain condition of `base ^ exponent`.
    ///
    /// A root is differentiable at zero only from an exponent of one on: `p^(3/2)` is, `p^(1/2)` is not.
    pub fn power_condition(&self, base: Expr, exponent: &Rational, regularity: Regularity) -> Option<(Expr, Relation)> {
        let relation = match (exponent.is_integer(), exponent.is_negative()) {
            (true, false) => return None,
            (true, true) => Relation::NonZero,
            (false, true) => Relation::Positive,
            (false, false) if regularity == Regularity::Differentiable && *exponent < Rational::ONE => {
                Relation::Positive
            }
            (false, false) => Relation::NonNegative,
        };
        Some((base, relation))
    }

    /// The domain condition of `base ^ exponent` for a symbolic exponent: it is `exp(exponent * log(base))`.
    pub fn symbolic_power_condition(&self, base: Expr) -> (Expr, Relation) {
        (base, Relation::Positive)
    }

    /// The domain conditions of a division: for a root that its radicand is not zero, which is easier to prove than of
    /// the root.
    pub fn division_conditions(&self, denominator: Expr) -> Conditions {
        let Node::Product(product) = self.node(denominator) else { return vec![(denominator, Relation::NonZero)] };
        let roots = product.factors.iter().filter(|(_, exponent)| !exponent.is_integer());
        let mut conditions: Conditions = roots.map(|(base, _)| (*base, Relation::Positive)).collect();
        if conditions.len() < product.factors.len() {
            conditions.push((denominator, Relation::NonZero));
        }
        conditions
    }

    /// The domain conditions of a function.
    pub fn call_conditions(&self, function: Function, arguments: &[Expr], regularity: Regularity) -> Conditions {
        let row = function.row();
        match row.smooth {
            Some(smooth) if regularity == Regularity::Differentiable => smooth(self, arguments),
            _ => (row.conditions)(self, arguments),
        }
    }

    /// The domain conditions of the outermost operation.
    pub fn operation_conditions(&self, expr: Expr, regularity: Regularity) -> Conditions {
        match self.node(expr) {
            Node::Product(product) => product
                .factors
                .iter()
                .filter_map(|(base, exponent)| self.power_condition(*base, exponent, regularity))
                .collect(),
            Node::Call(function, arguments) => self.call_conditions(function, &arguments, regularity),
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Sum(_) => Vec::new(),
        }
    }

    /// The domain conditions of the expressions and their subexpressions, each once, operands first; without those that
    /// hold of numbers.
    pub fn domain_conditions(&self, exprs: &[Expr], regularity: Regularity) -> Conditions {
        let mut found = Conditions::new();
        for operand in self.postorder(exprs) {
            for condition in self.operation_conditions(operand, regularity) {
                if !found.contains(&condition) && !self.holds_of_number(condition) {
                    found.push(condition);
                }
            }
        }
        found
    }

    /// True if this is a comparison of a number with zero that provably holds.
    pub fn holds_of_number(&self, (expr, relation): (Expr, Relation)) -> bool {
        if !self.symbols_of(&[expr]).is_empty() {
            return false;
        }
        if self.is_zero(expr) {
            return relation == Relation::NonNegative;
        }
        let value = self.separated_from_zero(expr, &Point::new());
        value.is_some_and(|value| relation == Relation::NonZero || value.is_positive())
    }

    /// True if this is a comparison of a number with zero that provably fails.
    pub fn fails_of_number(&self, (expr, relation): (Expr, Relation)) -> bool {
        if !self.symbols_of(&[expr]).is_empty() {
            return false;
        }
        if self.is_zero(expr) {
            return relation != Relation::NonNegative;
        }
        let negative = || self.separated_from_zero(expr, &Point::new()).is_some_and(|value| value.is_negative());
        relation != Relation::NonZero && negative()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Conditions as `expression relation`.
    type Expected = &'static [&'static str];

    /// The conditions as `expression relation`, for a formula in a and b.
    fn conditions(build: impl Fn(&Arena, Expr, Expr) -> Expr, regularity: Regularity) -> Vec<String> {
        let arena = Arena::new();
        let expr = build(&arena, arena.variable("a"), arena.variable("b"));
        let shown = |(operand, relation): &(Expr, Relation)| format!("{} {}", arena.print(*operand), relation.sign());
        arena.domain_conditions(&[expr], regularity).iter().map(shown).collect()
    }

    fn power(numerator: i64, denominator: i64) -> impl Fn(&Arena, Expr, Expr) -> Expr {
        move |arena, a, _| arena.power(a, &Rational::new(numerator, denominator).expect("a rational"))
    }

    fn call(function: Function) -> impl Fn(&Arena, Expr, Expr) -> Expr {
        move |arena, a, b| {
            let arguments = if function.row().arity == 2 { vec![a, b] } else { vec![a] };
            arena.call(function, &arguments)
        }
    }

    #[test]
    fn powers_have_conditions_on_their_base() {
        let cases: [((i64, i64), Expected, Expected); 6] = [
            ((3, 1), &[], &[]),
            ((-1, 1), &["a != 0"], &["a != 0"]),
            ((1, 2), &["a >= 0"], &["a > 0"]),
            ((3, 2), &["a >= 0"], &["a >= 0"]),
            ((-1, 2), &["a > 0"], &["a > 0"]),
            ((1, 3), &["a >= 0"], &["a > 0"]),
        ];
        for ((n, d), value, slope) in cases {
            assert_eq!(conditions(power(n, d), Regularity::Defined), value, "{n}/{d}");
            assert_eq!(conditions(power(n, d), Regularity::Differentiable), slope, "{n}/{d}");
        }
        assert_eq!(conditions(|arena, a, b| arena.div(b, a), Regularity::Defined), ["a != 0"]);
        assert_eq!(conditions(Arena::raise, Regularity::Defined), ["a > 0"]);
    }

    #[test]
    fn a_division_by_a_root_has_a_condition_on_the_radicand() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let cases: [(Expr, Expected); 4] = [
            (a, &["a != 0"]),
            (arena.mul(a, b), &["a*b != 0"]),
            (arena.sqrt(a), &["a > 0"]),
            (arena.mul(arena.sqrt(a), b), &["a > 0", "sqrt(a)*b != 0"]),
        ];
        for (denominator, expected) in cases {
            let conditions = arena.division_conditions(denominator);
            let shown =
                conditions.iter().map(|(operand, relation)| format!("{} {}", arena.print(*operand), relation.sign()));
            assert_eq!(shown.collect::<Vec<_>>(), expected);
        }
    }

    #[test]
    fn functions_have_conditions_on_their_arguments() {
        let cases: [(Function, Expected, Expected); 16] = [
            (Function::Sin, &[], &[]),
            (Function::Tanh, &[], &[]),
            (Function::Asinh, &[], &[]),
            (Function::Acosh, &["a - 1 >= 0"], &["a - 1 > 0"]),
            (Function::Atanh, &["1 - a^2 > 0"], &["1 - a^2 > 0"]),
            (Function::Tan, &["cos(a) != 0"], &["cos(a) != 0"]),
            (Function::Log, &["a > 0"], &["a > 0"]),
            (Function::Asin, &["1 - a^2 >= 0"], &["1 - a^2 > 0"]),
            (Function::Acos, &["1 - a^2 >= 0"], &["1 - a^2 > 0"]),
            (Function::Sqrt, &["a >= 0"], &["a > 0"]),
            (Function::Abs, &[], &["a != 0"]),
            (Function::Sign, &["a != 0"], &["a != 0"]),
            (Function::Min, &[], &["a - b != 0"]),
            (Function::Max, &[], &["a - b != 0"]),
            (Function::Sat, &[], &["1 - a^2 != 0"]),
            (
                Function::Atan2,
                &["a^2 + b^2 != 0"],
                // The root of the radius occurs in the second condition, not in the formula.
                &["b + sqrt(a^2 + b^2) > 0"],
            ),
        ];
        for (function, value, slope) in cases {
            assert_eq!(conditions(call(function), Regularity::Defined), value, "{function:?}");
            assert_eq!(conditions(call(function), Regularity::Differentiable), slope, "{function:?}");
        }
    }

    #[test]
    fn numbers_answer_for_themselves() {
        let arena = Arena::new();
        let condition = |value: Expr, relation: Relation| {
            (arena.holds_of_number((value, relation)), arena.fails_of_number((value, relation)))
        };
        let number = |n: i64| arena.number(n);
        let short = arena.sub(arena.pi(), number(4));
        let cases = [
            (number(0), Relation::NonNegative, (true, false)),
            (number(0), Relation::Positive, (false, true)),
            (number(0), Relation::NonZero, (false, true)),
            (number(-1), Relation::NonZero, (true, false)),
            (number(-1), Relation::NonNegative, (false, true)),
            (short, Relation::Positive, (false, true)),
            (arena.neg(short), Relation::Positive, (true, false)),
            (arena.variable("a"), Relation::Positive, (false, false)),
        ];
        for (value, relation, expected) in cases {
            assert_eq!(condition(value, relation), expected, "{} {relation:?}", arena.print(value));
        }
    }

    #[test]
    fn conditions_of_a_row_hold_where_its_enclosure_exists() {
        let arena = Arena::new();
        let (a, b) = (arena.variable("a"), arena.variable("b"));
        let symbols = [a, b].map(|e| arena.as_symbol(e).expect("a symbol"));
        let values = [-2, -1, 0, 1, 2].map(Rational::from);
        for row in Function::table() {
            let arguments = if row.arity == 2 { vec![a, b] } else { vec![a] };
            let expr = arena.call(row.function, &arguments);
            for (u, v) in values.iter().flat_map(|u| values.iter().map(move |v| (u, v))) {
                let point: Point = symbols.into_iter().zip([u, v].map(|value| arena.number(value.clone()))).collect();
                let at = &point;
                let asked = arena.call_conditions(row.function, &arguments, Regularity::Defined);
                let held = asked.iter().all(|(e, r)| arena.holds_of_number((arena.substitute(*e, at), *r)));
                assert_eq!(arena.exists_at(expr, &point), held, "{} at {u:?}, {v:?}", row.name);
            }
        }
    }
}
