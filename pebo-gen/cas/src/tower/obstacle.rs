//! Reasons for open decisions of the normal form.

use std::fmt;

use crate::poly::TooLarge;

/// The reason for an open decision.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Obstacle {
    /// The polynomials grow past the work limit.
    TooLarge,
    /// The budget of all problems combined is used up.
    OutOfBudget,
    /// A denominator vanishes identically.
    DivisionByZero,
    /// Two kernels that were not proved independent, or one that has no rules here.
    Kernel(String),
    /// Roots that have no values together modulo any prime that was tried.
    NoResidue,
    /// No point of the assumed domain was found at which the expression has a value.
    NoPoint,
    /// An equation of the domain that the normal form does not use.
    Unsolved(String),
    /// The normal form is not zero, but no point proves it.
    NoWitness,
    /// The same, and it has two kernels that were not proved independent.
    Related(String, String),
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => f.write_str("the expressions grow beyond the work limit"),
            Self::OutOfBudget => f.write_str("the limit on time or memory is reached"),
            Self::DivisionByZero => f.write_str("a denominator is zero everywhere"),
            Self::Kernel(what) => write!(f, "no rule decides {what}"),
            Self::NoResidue => f.write_str("its roots have no values together modulo the primes that were tried"),
            Self::NoPoint => f.write_str("no point of the assumed domain was found where the formula has a value"),
            Self::Unsolved(equation) => {
                write!(f, "the identity `{equation}` could not be solved for a symbol without losing solutions")
            }
            Self::NoWitness => f.write_str(
                "the expression does not simplify to zero, but no point was found where it is provably not zero",
            ),
            Self::Related(a, b) => write!(f, "no rule shows whether {a} and {b} are independent"),
        }
    }
}

impl std::error::Error for Obstacle {}

impl From<TooLarge> for Obstacle {
    fn from(_: TooLarge) -> Self {
        Self::TooLarge
    }
}
