//! How large a formula may be.
//!
//! A formula from outside must end in a diagnostic, not in a stack overflow or in a power with a
//! million digits. Definitions can still multiply sizes; that is for the algebra to bound.

use super::{Formula, Operator, Term};
use crate::source::{Code, Diagnostic};

/// Most levels of a formula. A sum of n terms has n levels.
pub const DEPTH_LIMIT: usize = 200;

/// Most bytes of a formula's text.
pub const LENGTH_LIMIT: usize = 32 * 1024;

/// Largest magnitude of a constant exponent.
pub const EXPONENT_LIMIT: f64 = 64.0;

/// Largest total degree, for powers of powers. Digits of a number count as degree, ten to one.
const DEGREE_LIMIT: f64 = 4096.0;

/// A formula with its size, as the parser builds it.
pub(super) struct Measured {
    pub(super) formula: Formula,
    depth: usize,
    degree: f64,
}

impl Measured {
    /// A formula without parts.
    pub(super) fn leaf(formula: Formula) -> Self {
        let degree = match &formula.term {
            Term::Number(number) => {
                let parts = number.parts();
                let digits = i32::try_from(parts.digits.len()).unwrap_or(i32::MAX);
                (f64::from(digits.max(parts.exponent.abs())) / 10.0).max(1.0)
            }
            _ => 1.0,
        };
        Self { formula, depth: 1, degree }
    }

    /// `formula`, made of parts that were so deep together and have such a degree.
    pub(super) fn node(formula: Formula, depth: usize, degree: f64) -> Result<Self, Diagnostic> {
        if depth >= DEPTH_LIMIT {
            return Err(too_deep(&formula));
        }
        if degree > DEGREE_LIMIT {
            let message = format!("the formula has a total degree of {degree:.0}");
            return Err(Diagnostic::error(Code::FormulaTooLarge, formula.span, message)
                .help(format!("keep powers of powers below {DEGREE_LIMIT:.0}")));
        }
        Ok(Self { formula, depth: depth + 1, degree })
    }

    pub(super) fn depth(&self) -> usize {
        self.depth
    }

    pub(super) fn degree(&self) -> f64 {
        self.degree
    }
}

/// The diagnostic of a formula beyond [`DEPTH_LIMIT`].
fn too_deep(formula: &Formula) -> Diagnostic {
    let message = format!("the formula has more than {DEPTH_LIMIT} levels");
    Diagnostic::error(Code::FormulaTooDeep, formula.span, message).help("name parts of it under `define`")
}

/// The degree of `base ^ exponent`, where the exponent is not a constant out of range.
pub(super) fn power_degree(base: f64, exponent: &Formula) -> Result<f64, Diagnostic> {
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
        Term::Name(_) | Term::Estimate(_) | Term::Call(..) => return None,
    })
}
