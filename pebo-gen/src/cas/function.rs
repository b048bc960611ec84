//! The one table of functions: name, value, where it has one and where it is differentiable, derivative,
//! symmetry, inverse, Rust path and LaTeX, a row each.
//!
//! The parser, the derivative, the enclosure, the printers, the interpreter, the conditions ([`super::asks`], which
//! has the rows of division and powers) and the tests all read this table; a new function is a variant, a row, and
//! its cases in [`super::field`].

use super::arena::Arena;
use super::expr::Expr;
use super::facts::Relation;
use super::interval::{Interval, Precision};
use super::rational::Rational;

/// A function of the expression language.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// Inverse sine on [-1, 1].
    Asin,
    /// Inverse cosine on [-1, 1].
    Acos,
    /// Inverse tangent.
    Atan,
    /// Angle of the point (second argument, first argument), in (-pi, pi].
    Atan2,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Positive square root; kept as a power in the graph.
    Sqrt,
    /// Absolute value.
    Abs,
}

/// What happens to the value when the argument changes sign.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Parity {
    /// The value stays.
    Even,
    /// The value changes sign.
    Odd,
}

/// Value in floating point.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// Of one argument.
    Unary(fn(f64) -> f64),
    /// Of two arguments.
    Binary(fn(f64, f64) -> f64),
}

/// What there is to know of one function.
#[derive(Debug)]
pub struct Row {
    /// The function.
    pub function: Function,
    /// Its name in a formula.
    pub name: &'static str,
    /// Other names that formulas may use.
    pub aliases: &'static [&'static str],
    /// The number of arguments.
    pub arity: usize,
    /// The value at zero, where it is rational.
    pub at_zero: Option<i64>,
    /// Even, odd, or neither.
    pub parity: Option<Parity>,
    /// The method of the runtime's `Real`.
    pub rust: &'static str,
    /// The LaTeX command.
    pub latex: &'static str,
    /// The value.
    pub value: Value,
    /// An enclosure of the values over the arguments, or none where it cannot be given.
    pub enclosure: fn(&[Interval], Precision) -> Option<Interval>,
    /// What must hold of the arguments for the function to have a value.
    pub asks: fn(&Arena, &[Expr]) -> Asks,
    /// What must hold for it to be differentiable, if that is more.
    pub smooth: Option<fn(&Arena, &[Expr]) -> Asks>,
    /// The partial derivatives at the arguments.
    pub derivative: fn(&Arena, &[Expr]) -> Vec<Expr>,
    /// The function that undoes this one on its principal branch.
    pub inverse: Option<Function>,
}

/// Comparisons with zero.
pub type Asks = Vec<(Expr, Relation)>;

impl Function {
    /// The row of this function.
    pub fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }

    /// The function of this name or alias.
    pub fn named(name: &str) -> Option<Self> {
        TABLE.iter().find(|row| row.name == name || row.aliases.contains(&name)).map(|row| row.function)
    }

    /// All rows, in the order of the enumeration.
    pub fn table() -> &'static [Row] {
        &TABLE
    }
}

/// `a^2`
fn square(arena: &Arena, a: Expr) -> Expr {
    arena.power(a, &Rational::from(2))
}

/// `1/a`
fn recip(arena: &Arena, a: Expr) -> Expr {
    arena.power(a, &Rational::from(-1))
}

/// `1 - a^2`
fn beyond(arena: &Arena, a: Expr) -> Expr {
    arena.sub(arena.one(), square(arena, a))
}

/// `1/sqrt(1 - a^2)`
fn inverse_circle(arena: &Arena, a: Expr) -> Expr {
    recip(arena, arena.sqrt(beyond(arena, a)))
}

/// `a^2 + b^2`
fn radius(arena: &Arena, a: &[Expr]) -> Expr {
    arena.add(square(arena, a[0]), square(arena, a[1]))
}

/// Of a function that has a value everywhere.
fn nothing(_: &Arena, _: &[Expr]) -> Asks {
    Vec::new()
}

/// Of an inverse sine or cosine: an argument within [-1, 1].
fn within_one(arena: &Arena, a: &[Expr]) -> Asks {
    vec![(beyond(arena, a[0]), Relation::NonNegative)]
}

/// Of their derivatives: an argument strictly within.
fn strictly_within_one(arena: &Arena, a: &[Expr]) -> Asks {
    vec![(beyond(arena, a[0]), Relation::Positive)]
}

static TABLE: [Row; 14] = [
    Row {
        function: Function::Sin,
        name: "sin",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "sin",
        latex: r"\sin",
        value: Value::Unary(f64::sin),
        enclosure: |a, p| a[0].sin(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Cos, a)],
        inverse: Some(Function::Asin),
    },
    Row {
        function: Function::Cos,
        name: "cos",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        parity: Some(Parity::Even),
        rust: "cos",
        latex: r"\cos",
        value: Value::Unary(f64::cos),
        enclosure: |a, p| a[0].cos(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.neg(arena.call(Function::Sin, a))],
        inverse: Some(Function::Acos),
    },
    Row {
        function: Function::Tan,
        name: "tan",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "tan",
        latex: r"\tan",
        value: Value::Unary(f64::tan),
        enclosure: |a, p| a[0].tan(p),
        asks: |arena, a| vec![(arena.call(Function::Cos, a), Relation::NonZero)],
        smooth: None,
        derivative: |arena, a| vec![arena.add(arena.one(), square(arena, arena.call(Function::Tan, a)))],
        inverse: Some(Function::Atan),
    },
    Row {
        function: Function::Asin,
        name: "asin",
        aliases: &["arcsin"],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "asin",
        latex: r"\arcsin",
        value: Value::Unary(f64::asin),
        enclosure: |a, p| a[0].asin(p),
        asks: within_one,
        smooth: Some(strictly_within_one),
        derivative: |arena, a| vec![inverse_circle(arena, a[0])],
        inverse: Some(Function::Sin),
    },
    Row {
        function: Function::Acos,
        name: "acos",
        aliases: &["arccos"],
        arity: 1,
        at_zero: None,
        parity: None,
        rust: "acos",
        latex: r"\arccos",
        value: Value::Unary(f64::acos),
        enclosure: |a, p| a[0].acos(p),
        asks: within_one,
        smooth: Some(strictly_within_one),
        derivative: |arena, a| vec![arena.neg(inverse_circle(arena, a[0]))],
        inverse: Some(Function::Cos),
    },
    Row {
        function: Function::Atan,
        name: "atan",
        aliases: &["arctan"],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "atan",
        latex: r"\arctan",
        value: Value::Unary(f64::atan),
        enclosure: |a, p| a[0].atan(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![recip(arena, arena.add(arena.one(), square(arena, a[0])))],
        inverse: Some(Function::Tan),
    },
    Row {
        function: Function::Atan2,
        name: "atan2",
        aliases: &["arctan2"],
        arity: 2,
        at_zero: None,
        parity: None,
        rust: "atan2",
        latex: r"\operatorname{atan2}",
        value: Value::Binary(f64::atan2),
        enclosure: |a, p| a[0].atan2(&a[1], p),
        asks: |arena, a| vec![(radius(arena, a), Relation::NonZero)],
        // Off the negative half of the axis, where the angle jumps by a turn.
        smooth: Some(|arena, a| vec![(arena.add(a[1], arena.sqrt(radius(arena, a))), Relation::Positive)]),
        derivative: |arena, a| {
            let squared = recip(arena, radius(arena, a));
            vec![arena.mul(a[1], squared), arena.neg(arena.mul(a[0], squared))]
        },
        inverse: None,
    },
    Row {
        function: Function::Sinh,
        name: "sinh",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "sinh",
        latex: r"\sinh",
        value: Value::Unary(f64::sinh),
        enclosure: |a, p| a[0].sinh(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Cosh, a)],
        inverse: None,
    },
    Row {
        function: Function::Cosh,
        name: "cosh",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        parity: Some(Parity::Even),
        rust: "cosh",
        latex: r"\cosh",
        value: Value::Unary(f64::cosh),
        enclosure: |a, p| a[0].cosh(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Sinh, a)],
        inverse: None,
    },
    Row {
        function: Function::Tanh,
        name: "tanh",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Odd),
        rust: "tanh",
        latex: r"\tanh",
        value: Value::Unary(f64::tanh),
        enclosure: |a, p| a[0].tanh(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.sub(arena.one(), square(arena, arena.call(Function::Tanh, a)))],
        inverse: None,
    },
    Row {
        function: Function::Exp,
        name: "exp",
        aliases: &[],
        arity: 1,
        at_zero: Some(1),
        parity: None,
        rust: "exp",
        latex: r"\exp",
        value: Value::Unary(f64::exp),
        enclosure: |a, p| a[0].exp(p),
        asks: nothing,
        smooth: None,
        derivative: |arena, a| vec![arena.call(Function::Exp, a)],
        inverse: Some(Function::Log),
    },
    Row {
        function: Function::Log,
        name: "log",
        aliases: &["ln"],
        arity: 1,
        at_zero: None,
        parity: None,
        rust: "ln",
        latex: r"\ln",
        value: Value::Unary(f64::ln),
        enclosure: |a, p| a[0].log(p),
        asks: |_, a| vec![(a[0], Relation::Positive)],
        smooth: None,
        derivative: |arena, a| vec![recip(arena, a[0])],
        inverse: Some(Function::Exp),
    },
    Row {
        function: Function::Sqrt,
        name: "sqrt",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: None,
        rust: "sqrt",
        latex: r"\sqrt",
        value: Value::Unary(f64::sqrt),
        enclosure: |a, p| a[0].sqrt(p),
        asks: |_, a| vec![(a[0], Relation::NonNegative)],
        smooth: Some(|_, a| vec![(a[0], Relation::Positive)]),
        derivative: |arena, a| vec![recip(arena, arena.scale(arena.sqrt(a[0]), &Rational::from(2)))],
        inverse: None,
    },
    Row {
        function: Function::Abs,
        name: "abs",
        aliases: &[],
        arity: 1,
        at_zero: Some(0),
        parity: Some(Parity::Even),
        rust: "abs",
        latex: r"\operatorname{abs}",
        value: Value::Unary(f64::abs),
        enclosure: |a, _| Some(a[0].abs()),
        asks: nothing,
        smooth: Some(|_, a| vec![(a[0], Relation::NonZero)]),
        // The sign, where the argument is not zero.
        derivative: |arena, a| vec![arena.div(a[0], arena.call(Function::Abs, a))],
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
            assert_eq!(Function::named(row.name), Some(row.function));
        }
    }
}
