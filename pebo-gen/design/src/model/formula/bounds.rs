//! Limits on the size of a formula.
//!
//! A formula from outside must end in a diagnostic, not in a stack overflow or in a power with a million digits.
//! Definitions can still multiply sizes; the algebra bounds these.

use std::sync::Arc;

use super::{Formula, Operator, Table, Term};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::Function;

/// Most levels of a formula. A product of n factors has n levels; a sum has few, however many terms it has.
pub const DEPTH_LIMIT: usize = 200;

/// Most bytes of a formula's text.
pub const LENGTH_LIMIT: usize = 32 * 1024;

/// Largest absolute value of a constant exponent.
pub const EXPONENT_LIMIT: f64 = 64.0;

/// Largest total degree, for powers of powers. Digits of a number count as degree, ten to one.
const DEGREE_LIMIT: f64 = 4096.0;

/// Most parts of a formula. No text within [`LENGTH_LIMIT`] has as many; names that stand for formulas, as those of
/// Rust's `let`, multiply them.
const PARTS_LIMIT: usize = LENGTH_LIMIT;

/// A formula with its size, as a reader builds it.
#[derive(Clone, Debug)]
pub(in crate::model) struct SizedFormula {
    pub(in crate::model) formula: Formula,
    depth: usize,
    degree: f64,
    parts: usize,
}

impl SizedFormula {
    /// A formula without parts.
    pub(in crate::model) fn leaf(formula: Formula) -> Self {
        let degree = match &formula.term {
            Term::Number(number) => {
                let parts = number.parts();
                let digits = i32::try_from(parts.digits.len()).unwrap_or(i32::MAX);
                (f64::from(digits.max(parts.exponent.abs())) / 10.0).max(1.0)
            }
            _ => 1.0,
        };
        Self { formula, depth: 1, degree, parts: 1 }
    }

    /// `-operand`.
    pub(in crate::model) fn negative(operand: Self, span: Span) -> Result<Self, Diagnostic> {
        let (depth, degree, parts) = (operand.depth, operand.degree, operand.parts);
        Self { formula: Formula { span, term: Term::Negative(Box::new(operand.formula)) }, depth, degree, parts }
            .grown()
    }

    /// Two operands.
    pub(in crate::model) fn binary(
        operator: Operator,
        left: Self,
        right: Self,
        span: Span,
    ) -> Result<Self, Diagnostic> {
        let degree = match operator {
            Operator::Add | Operator::Subtract => left.degree.max(right.degree),
            Operator::Multiply | Operator::Divide => left.degree + right.degree,
            Operator::Power => power_degree(left.degree, &right.formula)?,
        };
        let (depth, parts) = (left.depth.max(right.depth), left.parts + right.parts);
        let term = Term::Binary(operator, Box::new(left.formula), Box::new(right.formula));
        Self { formula: Formula { span, term }, depth, degree, parts }.grown()
    }

    /// A call of a function with as many arguments as it takes.
    pub(in crate::model) fn call(function: Function, arguments: Vec<Self>, span: Span) -> Result<Self, Diagnostic> {
        let depth = arguments.iter().map(|argument| argument.depth).max().unwrap_or(0);
        let parts = arguments.iter().map(|argument| argument.parts).sum();
        let arguments = arguments.into_iter().map(|argument| argument.formula).collect();
        // A call is one unknown quantity to the algebra, whatever its arguments are.
        Self { formula: Formula { span, term: Term::Call(function, arguments) }, depth, degree: 1.0, parts }.grown()
    }

    /// A table at an argument.
    pub(in crate::model) fn table(
        (table, order): (Arc<Table>, usize),
        argument: Self,
        span: Span,
    ) -> Result<Self, Diagnostic> {
        let (depth, parts) = (argument.depth, argument.parts);
        let term = Term::Table(table, order, Box::new(argument.formula));
        Self { formula: Formula { span, term }, depth, degree: 1.0, parts }.grown()
    }

    /// The number of its parts.
    pub(in crate::model) fn parts(&self) -> usize {
        self.parts
    }

    /// One level and one part more than its parts have, if that is within bounds.
    fn grown(self) -> Result<Self, Diagnostic> {
        let Self { formula, depth, degree, parts } = self;
        if depth >= DEPTH_LIMIT {
            return Err(too_deep(&formula));
        }
        if parts >= PARTS_LIMIT {
            let message = format!("the formula has more than {PARTS_LIMIT} parts");
            return Err(Diagnostic::error(Code::FormulaTooLarge, formula.span, message)
                .help("simplify it, or split it by components of the transform"));
        }
        if degree > DEGREE_LIMIT {
            let message = format!("the formula has a total degree of {degree:.0}");
            return Err(Diagnostic::error(Code::FormulaTooLarge, formula.span, message)
                .help(format!("keep powers of powers below {DEGREE_LIMIT:.0}")));
        }
        Ok(Self { formula, depth: depth + 1, degree, parts: parts + 1 })
    }
}

/// The diagnostic of a formula beyond [`DEPTH_LIMIT`].
fn too_deep(formula: &Formula) -> Diagnostic {
    let message = format!("the formula has more than {DEPTH_LIMIT} levels");
    Diagnostic::error(Code::FormulaTooDeep, formula.span, message).help("name parts of it under `define`")
}

/// The degree of `base ^ exponent`, where the exponent is not a constant out of range.
fn power_degree(base: f64, exponent: &Formula) -> Result<f64, Diagnostic> {
    let Some(value) = constant(exponent) else { return Ok(base) };
    if value.abs() <= EXPONENT_LIMIT {
        return Ok(base * value.abs().max(1.0));
    }
    // Also where the value is no number, as 0/0.
    let message = "the exponent is too large".to_owned();
    Err(Diagnostic::error(Code::ExponentTooLarge, exponent.span, message)
        .help(format!("keep constant exponents between -{EXPONENT_LIMIT} and {EXPONENT_LIMIT}")))
}

/// The approximate value of a formula without names and functions.
fn constant(formula: &Formula) -> Option<f64> {
    Some(match &formula.term {
        Term::Number(number) => number.to_f64(),
        Term::Negative(operand) => -constant(operand)?,
        Term::Binary(operator, left, right) => {
            let (left, right) = (constant(left)?, constant(right)?);
            match operator {
                Operator::Add => left + right,
                Operator::Subtract => left - right,
                Operator::Multiply => left * right,
                Operator::Divide => left / right,
                Operator::Power => left.powf(right),
            }
        }
        Term::Name(_) | Term::Estimate(_) | Term::Call(..) | Term::Table(..) => return None,
    })
}
