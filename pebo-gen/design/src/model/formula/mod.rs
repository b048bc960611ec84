//! The expression language.
//!
//! In: a text and the [`SpanMap`] of its bytes in the file. Out: a [`Formula`], a tree with a span on every node; or
//! one diagnostic, for the first mistake.
//!
//! ```text
//! comparison  formula (relation formula)+          relation: < <= > >= !=
//! formula     product (("+" | "-") product)*
//! product     factor (("*" | "/") factor)*
//! factor      "-" factor | power
//! power       atom (("^" | "**") factor)?          so -x^2 = -(x^2), 2^3^2 = 2^(3^2), x^-1 works
//! atom        number | name | function "(" formula ("," formula)* ")" | "(" formula ")"
//! ```
//!
//! After this layer: depth is at most [`DEPTH_LIMIT`], so recursion over a formula (dropping it
//! included) is safe; numbers are bounded, and so are constant exponents; functions exist and have
//! the right number of arguments. Names are *not* resolved: any name may be declared, and a
//! declared name wins over the constant `pi` and over `t`, time in a simulation. A name is a
//! function exactly where an opening parenthesis follows; the tables of a model are functions too.

mod spans;

mod bounds;
mod complaints;
mod decimal;
mod display;
mod foreign;
mod lexer;
mod parser;
mod state;
mod sum;
mod table;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::source::Span;
use pebo_cas::Function;

pub(super) use bounds::SizedFormula;
pub use bounds::{DEPTH_LIMIT, EXPONENT_LIMIT, LENGTH_LIMIT};
pub use decimal::{Decimal, DecimalParts};
pub(super) use lexer::greek;
pub use parser::{parse_comparison, parse_formula};
pub use spans::SpanMap;
pub use state::{Estimates, Permitted};
pub use table::{Interpolation, Table};

/// The constant of a circle: this name, unless the model declares it.
pub const PI: &str = "pi";

/// A formula as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    /// The span, parentheses included.
    pub span: Span,
    /// The outermost operation or operand.
    pub term: Term,
}

/// The outermost operation or operand of a formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// A decimal, not negative.
    Number(Decimal),
    /// A declared name, or `pi`, or `t`.
    Name(String),
    /// `hat(x)`: the observer's estimate of the named state.
    Estimate(String),
    /// Unary minus.
    Negative(Box<Formula>),
    /// Two operands.
    Binary(Operator, Box<Formula>, Box<Formula>),
    /// A function applied to as many arguments as it takes.
    Call(Function, Vec<Formula>),
    /// A table, or its derivative of that order, at an argument.
    Table(Arc<Table>, usize, Box<Formula>),
}

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^` or `**`
    Power,
}

/// An assumption: formulas with relations between neighbours, as in `0 < d < 1`.
///
/// Holds: at least one relation.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The span.
    pub span: Span,
    /// The first formula.
    pub first: Formula,
    /// Each relation with the formula to its right; its left side is the formula before.
    pub rest: Vec<(Relation, Formula)>,
}

/// The comparison between two sides of an assumption.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Relation {
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `!=`
    NotEqual,
}

impl Comparison {
    /// The comparisons one by one: `0 < d < 1` gives `0 < d` and `d < 1`.
    pub fn pairs(&self) -> impl Iterator<Item = (&Formula, Relation, &Formula)> {
        let left = std::iter::once(&self.first).chain(self.rest.iter().map(|(_, side)| side));
        left.zip(&self.rest).map(|(left, (relation, right))| (left, *relation, right))
    }
}

impl Formula {
    /// The direct subformulas, from left to right.
    pub fn parts(&self) -> Vec<&Formula> {
        match &self.term {
            Term::Number(_) | Term::Name(_) | Term::Estimate(_) => Vec::new(),
            Term::Negative(operand) | Term::Table(_, _, operand) => vec![operand],
            Term::Binary(_, left, right) => vec![left, right],
            Term::Call(_, arguments) => arguments.iter().collect(),
        }
    }

    /// The names in it and their spans, from left to right; estimates are not among them.
    pub fn names(&self) -> Vec<(&str, Span)> {
        let mut found = Vec::new();
        let mut waiting = vec![self];
        while let Some(formula) = waiting.pop() {
            if let Term::Name(name) = &formula.term {
                found.push((name.as_str(), formula.span));
            }
            waiting.extend(formula.parts().into_iter().rev());
        }
        found
    }
}
