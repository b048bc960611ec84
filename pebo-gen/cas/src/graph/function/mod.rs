//! The one table of functions: name, value, domain conditions of value and derivative, derivative, symmetry, inverse,
//! Rust path and LaTeX, a row each.
//!
//! The parser, the derivative, the enclosure, the printers, the interpreter, the conditions
//! ([`crate::graph::conditions`], which has the rows of division and powers) and the tests all read this table; a new
//! function is a variant, a row, and its cases in [`crate::tower`].

mod formulas;
mod kind;
pub mod pieces;

use super::arena::Arena;
use super::expr::Expr;
use crate::number::interval::{Interval, Precision};
use crate::{Rational, Relation};

use formulas::{
    above_one, acosh, apart, atanh, beyond, distance, edges, half_of, hypotenuse, inverse_circle, leg, nothing, radius,
    recip, shares, square, strictly_within_one, within_one,
};

pub use formulas::Conditions;
pub use kind::Function;

/// The effect of the argument's sign on the value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Parity {
    /// The value is invariant.
    Even,
    /// The value changes sign.
    Odd,
}

/// Value in floating point.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// One argument.
    Unary(fn(f64) -> f64),
    /// Two arguments.
    Binary(fn(f64, f64) -> f64),
    /// An argument, and numbers.
    Tabulated(fn(&[f64]) -> f64),
}

/// All properties of one function.
#[derive(Debug)]
pub struct FunctionRow {
    /// The function.
    pub function: Function,
    /// Its name in a formula.
    pub name: &'static str,
    /// Other names that formulas may use.
    pub aliases: &'static [&'static str],
    /// The number of arguments; 0 of a function that formulas cannot call by its name.
    pub arity: usize,
    /// The value at zero, where it is rational.
    pub at_zero: Option<i64>,
    /// The value at rational arguments, of a function whose values there are rational.
    pub rational: Option<RationalEvaluation>,
    /// Even, odd, or neither.
    pub parity: Option<Parity>,
    /// The method of the runtime's `Real`.
    pub rust: &'static str,
    /// The LaTeX command.
    pub latex: &'static str,
    /// The value.
    pub value: Value,
    /// An enclosure of the values over the arguments, or none if there is none.
    pub enclosure: fn(&[Interval], Precision) -> Option<Interval>,
    /// The domain conditions of its value.
    pub conditions: fn(&Arena, &[Expr]) -> Conditions,
    /// The further conditions of its derivative, if there are any.
    pub smooth: Option<fn(&Arena, &[Expr]) -> Conditions>,
    /// The partial derivatives at the arguments.
    pub derivative: fn(&Arena, &[Expr]) -> Vec<Expr>,
    /// The same in terms of functions with relations in the normal form, wherever this one has a value.
    pub in_terms: Option<fn(&Arena, &[Expr]) -> Expr>,
    /// The function that undoes this one on its principal branch.
    pub inverse: Option<Function>,
}

/// A value at rational arguments, where there is one.
pub type RationalEvaluation = fn(&[Rational]) -> Option<Rational>;

impl FunctionRow {
    /// The name as it is typeset, upright: that of the LaTeX command.
    pub fn typeset(&self) -> &'static str {
        let command = self.latex.trim_start_matches('\\');
        command.strip_prefix("operatorname{").map_or(command, |name| name.trim_end_matches('}'))
    }
}

impl Function {
    /// The row of this function.
    pub fn row(self) -> &'static FunctionRow {
        &TABLE[self as usize]
    }

    /// The function of this name or alias.
    pub fn named(name: &str) -> Option<Self> {
        Self::table().iter().find(|row| row.name == name || row.aliases.contains(&name)).map(|row| row.function)
    }

    /// The function that Rust's numbers have as this method.
    pub fn of_method(name: &str) -> Option<Self> {
        Self::table().iter().find(|row| row.rust == name).map(|row| row.function)
    }

    /// Every name that formulas can call a function by.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::table().iter().flat_map(|row| std::iter::once(row.name).chain(row.aliases.iter().copied()))
    }

    /// The rows of the functions that formulas call by their names, in the order of the enumeration.
    pub fn table() -> &'static [FunctionRow] {
        &TABLE[..Self::Table as usize]
    }
}

static TABLE: [FunctionRow; 22] = [
    FunctionRow {
        function: Function::Sin,
        name: "sin",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "sin",
        latex: r"\sin",
        value: Value::Unary(f64::sin),
        enclosure: |a, p| a[0].sin(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Cos, a)],
        in_terms: None,
        inverse: Some(Function::Asin),
    },
    FunctionRow {
        function: Function::Cos,
        name: "cos",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        rational: None,
        parity: Some(Parity::Even),
        rust: "cos",
        latex: r"\cos",
        value: Value::Unary(f64::cos),
        enclosure: |a, p| a[0].cos(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.neg(arena.call(Function::Sin, a))],
        in_terms: None,
        inverse: Some(Function::Acos),
    },
    FunctionRow {
        function: Function::Tan,
        name: "tan",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "tan",
        latex: r"\tan",
        value: Value::Unary(f64::tan),
        enclosure: |a, p| a[0].tan(p),
        conditions: |arena, a| vec![(arena.call(Function::Cos, a), Relation::NonZero)],
        smooth: None,
        derivative: |arena, a| vec![arena.add(arena.one(), square(arena, arena.call(Function::Tan, a)))],
        in_terms: None,
        inverse: Some(Function::Atan),
    },
    FunctionRow {
        function: Function::Asin,
        name: "asin",
        aliases: &["arcsin"],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "asin",
        latex: r"\arcsin",
        value: Value::Unary(f64::asin),
        enclosure: |a, p| a[0].asin(p),
        conditions: within_one,
        smooth: Some(strictly_within_one),
        derivative: |arena, a| vec![inverse_circle(arena, a[0])],
        in_terms: None,
        inverse: Some(Function::Sin),
    },
    FunctionRow {
        function: Function::Acos,
        name: "acos",
        aliases: &["arccos"],
        arity: 1,
        at_zero: None,
        rational: None,
        parity: None,
        rust: "acos",
        latex: r"\arccos",
        value: Value::Unary(f64::acos),
        enclosure: |a, p| a[0].acos(p),
        conditions: within_one,
        smooth: Some(strictly_within_one),
        derivative: |arena, a| vec![arena.neg(inverse_circle(arena, a[0]))],
        in_terms: None,
        inverse: Some(Function::Cos),
    },
    FunctionRow {
        function: Function::Atan,
        name: "atan",
        aliases: &["arctan"],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "atan",
        latex: r"\arctan",
        value: Value::Unary(f64::atan),
        enclosure: |a, p| a[0].atan(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![recip(arena, arena.add(arena.one(), square(arena, a[0])))],
        in_terms: None,
        inverse: Some(Function::Tan),
    },
    FunctionRow {
        function: Function::Atan2,
        name: "atan2",
        aliases: &["arctan2"],
        arity: 2,
        at_zero: None,
        rational: None,
        parity: None,
        rust: "atan2",
        latex: r"\operatorname{atan2}",
        value: Value::Binary(f64::atan2),
        enclosure: |a, p| a[0].atan2(&a[1], p),
        conditions: |arena, a| vec![(radius(arena, a), Relation::NonZero)],
        // Off the negative half of the axis, where the angle jumps by a turn.
        smooth: Some(|arena, a| vec![(arena.add(a[1], arena.sqrt(radius(arena, a))), Relation::Positive)]),
        derivative: |arena, a| {
            let squared = recip(arena, radius(arena, a));
            vec![arena.mul(a[1], squared), arena.neg(arena.mul(a[0], squared))]
        },
        in_terms: None,
        inverse: None,
    },
    FunctionRow {
        function: Function::Sinh,
        name: "sinh",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "sinh",
        latex: r"\sinh",
        value: Value::Unary(f64::sinh),
        enclosure: |a, p| a[0].sinh(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Cosh, a)],
        in_terms: None,
        inverse: Some(Function::Asinh),
    },
    FunctionRow {
        function: Function::Cosh,
        name: "cosh",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        rational: None,
        parity: Some(Parity::Even),
        rust: "cosh",
        latex: r"\cosh",
        value: Value::Unary(f64::cosh),
        enclosure: |a, p| a[0].cosh(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Sinh, a)],
        in_terms: None,
        inverse: Some(Function::Acosh),
    },
    FunctionRow {
        function: Function::Tanh,
        name: "tanh",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "tanh",
        latex: r"\tanh",
        value: Value::Unary(f64::tanh),
        enclosure: |a, p| a[0].tanh(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.sub(arena.one(), square(arena, arena.call(Function::Tanh, a)))],
        in_terms: None,
        inverse: Some(Function::Atanh),
    },
    FunctionRow {
        function: Function::Asinh,
        name: "asinh",
        aliases: &["arcsinh"],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "asinh",
        latex: r"\operatorname{arsinh}",
        value: Value::Unary(f64::asinh),
        enclosure: |a, p| a[0].asinh(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![recip(arena, hypotenuse(arena, a[0]))],
        in_terms: Some(|arena, a| arena.call(Function::Log, &[arena.add(a[0], hypotenuse(arena, a[0]))])),
        inverse: Some(Function::Sinh),
    },
    FunctionRow {
        function: Function::Acosh,
        name: "acosh",
        aliases: &["arccosh"],
        arity: 1,
        at_zero: None,
        rational: None,
        parity: None,
        rust: "acosh",
        latex: r"\operatorname{arcosh}",
        value: Value::Unary(acosh),
        enclosure: |a, p| a[0].acosh(p),
        conditions: |arena, a| vec![(above_one(arena, a[0]), Relation::NonNegative)],
        smooth: Some(|arena, a| vec![(above_one(arena, a[0]), Relation::Positive)]),
        derivative: |arena, a| vec![recip(arena, leg(arena, a[0]))],
        in_terms: Some(|arena, a| arena.call(Function::Log, &[arena.add(a[0], leg(arena, a[0]))])),
        inverse: Some(Function::Cosh),
    },
    FunctionRow {
        function: Function::Atanh,
        name: "atanh",
        aliases: &["arctanh"],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: Some(Parity::Odd),
        rust: "atanh",
        latex: r"\operatorname{artanh}",
        value: Value::Unary(atanh),
        enclosure: |a, p| a[0].atanh(p),
        conditions: strictly_within_one,
        smooth: None,
        derivative: |arena, a| vec![recip(arena, beyond(arena, a[0]))],
        in_terms: Some(|arena, a| {
            let [numerator, denominator] = [arena.add(arena.one(), a[0]), arena.sub(arena.one(), a[0])];
            half_of(arena, arena.call(Function::Log, &[arena.div(numerator, denominator)]))
        }),
        inverse: Some(Function::Tanh),
    },
    FunctionRow {
        function: Function::Exp,
        name: "exp",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        rational: None,
        parity: None,
        rust: "exp",
        latex: r"\exp",
        value: Value::Unary(f64::exp),
        enclosure: |a, p| a[0].exp(p),
        conditions: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Exp, a)],
        in_terms: None,
        inverse: Some(Function::Log),
    },
    FunctionRow {
        function: Function::Log,
        name: "log",
        aliases: &["ln"],
        arity: 1,
        at_zero: None,
        rational: None,
        parity: None,
        rust: "ln",
        latex: r"\ln",
        value: Value::Unary(f64::ln),
        enclosure: |a, p| a[0].log(p),
        conditions: |_, a| vec![(a[0], Relation::Positive)],
        smooth: None,
        derivative: |arena, a| vec![recip(arena, a[0])],
        in_terms: None,
        inverse: Some(Function::Exp),
    },
    FunctionRow {
        function: Function::Sqrt,
        name: "sqrt",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: None,
        parity: None,
        rust: "sqrt",
        latex: r"\sqrt",
        value: Value::Unary(f64::sqrt),
        enclosure: |a, p| a[0].sqrt(p),
        conditions: |_, a| vec![(a[0], Relation::NonNegative)],
        smooth: Some(|_, a| vec![(a[0], Relation::Positive)]),
        derivative: |arena, a| vec![recip(arena, arena.scale(arena.sqrt(a[0]), &Rational::from(2)))],
        in_terms: None,
        inverse: None,
    },
    FunctionRow {
        function: Function::Abs,
        name: "abs",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: Some(|a| Some(a[0].abs())),
        parity: Some(Parity::Even),
        rust: "abs",
        latex: r"\operatorname{abs}",
        value: Value::Unary(f64::abs),
        enclosure: |a, _| Some(a[0].abs()),
        conditions: nothing,
        smooth: Some(|_, a| vec![(a[0], Relation::NonZero)]),
        derivative: |arena, a| vec![arena.call(Function::Sign, a)],
        in_terms: None,
        inverse: None,
    },
    FunctionRow {
        function: Function::Sign,
        name: "sign",
        aliases: &["sgn"],
        arity: 1,
        at_zero: None,
        rational: Some(|a| (!a[0].is_zero()).then(|| a[0].signum().into())),
        parity: Some(Parity::Odd),
        rust: "sign",
        latex: r"\operatorname{sign}",
        value: Value::Unary(|a| if a == 0.0 { a } else { a.signum() }),
        // It computes 0 at 0, and proofs leave that point out: the sign is a quotient to them.
        enclosure: |a, _| a[0].sign(),
        conditions: |_, a| vec![(a[0], Relation::NonZero)],
        smooth: None,
        derivative: |arena, _| vec![arena.zero()],
        in_terms: Some(|arena, a| arena.div(a[0], arena.call(Function::Abs, a))),
        inverse: None,
    },
    FunctionRow {
        function: Function::Min,
        name: "min",
        aliases: &[],
        arity: 2,
        at_zero: None,
        rational: Some(|a| Some(a[0].clone().min(a[1].clone()))),
        parity: None,
        rust: "smaller",
        latex: r"\min",
        value: Value::Binary(f64::min),
        enclosure: |a, _| Some(a[0].min(&a[1])),
        conditions: nothing,
        smooth: Some(apart),
        derivative: |arena, a| shares(arena, arena.sub(a[1], a[0])),
        in_terms: Some(|arena, a| half_of(arena, arena.sub(arena.add(a[0], a[1]), distance(arena, a)))),
        inverse: None,
    },
    FunctionRow {
        function: Function::Max,
        name: "max",
        aliases: &[],
        arity: 2,
        at_zero: None,
        rational: Some(|a| Some(a[0].clone().max(a[1].clone()))),
        parity: None,
        rust: "larger",
        latex: r"\max",
        value: Value::Binary(f64::max),
        enclosure: |a, _| Some(a[0].max(&a[1])),
        conditions: nothing,
        smooth: Some(apart),
        derivative: |arena, a| shares(arena, arena.sub(a[0], a[1])),
        in_terms: Some(|arena, a| half_of(arena, arena.sum([a[0], a[1], distance(arena, a)]))),
        inverse: None,
    },
    FunctionRow {
        function: Function::Sat,
        name: "sat",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        rational: Some(|a| Some(a[0].clone().max(Rational::from(-1)).min(Rational::ONE))),
        parity: Some(Parity::Odd),
        rust: "sat",
        latex: r"\operatorname{sat}",
        value: Value::Unary(|a| a.clamp(-1.0, 1.0)),
        enclosure: |a, _| Some(a[0].sat()),
        conditions: nothing,
        smooth: Some(|arena, a| vec![(beyond(arena, a[0]), Relation::NonZero)]),
        derivative: |arena, a| {
            let [above, below] = edges(arena, a[0]).map(|edge| arena.call(Function::Sign, &[edge]));
            vec![half_of(arena, arena.sub(above, below))]
        },
        in_terms: Some(|arena, a| {
            let [above, below] = edges(arena, a[0]).map(|edge| arena.call(Function::Abs, &[edge]));
            half_of(arena, arena.sub(above, below))
        }),
        inverse: None,
    },
    FunctionRow {
        function: Function::Table,
        name: "table",
        aliases: &[],
        arity: 0,
        at_zero: None,
        rational: Some(pieces::rational),
        parity: None,
        rust: "value",
        latex: r"\operatorname{table}",
        value: Value::Tabulated(pieces::value),
        enclosure: pieces::enclosure,
        conditions: pieces::conditions,
        smooth: Some(pieces::smooth),
        derivative: pieces::derivative,
        in_terms: None,
        inverse: None,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_indexed_by_the_enumeration() {
        for (index, row) in TABLE.iter().enumerate() {
            assert_eq!(row.function as usize, index, "{}", row.name);
            assert_eq!(Function::named(row.name), (row.arity > 0).then_some(row.function));
        }
    }
}
