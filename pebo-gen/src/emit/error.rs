//! Reasons that nothing was emitted.

use std::fmt;

use pebo_cas::Rational;

/// The reason for which a derivation was not emitted.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum EmitError {
    /// A claim is refuted or undecided.
    NotAccepted,
    /// The derivation is accepted, but lacks this result.
    Missing(&'static str),
    /// A function depends on a symbol that it does not get.
    UndeclaredSymbol {
        /// The symbol.
        symbol: String,
    },
    /// The target scalar cannot represent a number of the model.
    OutOfRange {
        /// The number.
        number: Rational,
    },
    /// The emitted code contains something that cannot be read back.
    Unreadable {
        /// The code.
        code: String,
    },
    /// The budget ended before the emitted code was read back.
    LimitReached,
    /// A function loses digits that neither the rounding of its arguments nor the author's own formulas lose.
    Inaccurate {
        /// The function.
        function: String,
        /// The point.
        place: String,
        /// The error, in units of the effect of rounding the arguments.
        units: String,
        /// The type of the numbers.
        scalar: &'static str,
    },
    /// The emitted code does not compute the derived formulas.
    Differs {
        /// The function.
        function: String,
        /// The row of its result, from 1.
        row: usize,
        /// The column of its result, from 1.
        column: usize,
    },
}

impl fmt::Display for EmitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAccepted => f.write_str("not every claim is proved"),
            Self::Missing(what) => write!(f, "the derivation lacks its {what}"),
            Self::UndeclaredSymbol { symbol } => {
                write!(f, "`{symbol}` occurs in a function that does not receive it")
            }
            Self::OutOfRange { number } => {
                write!(f, "the target scalar cannot represent {number}")
            }
            Self::Unreadable { code } => write!(f, "the emitted code cannot be read back: {code}"),
            Self::LimitReached => f.write_str(
                "the limit on time or memory was reached in the check of the emitted code; allow more with `--limit SECONDS`",
            ),
            Self::Inaccurate { function, place, units, scalar } => {
                let mend = match function.as_str() {
                    "recover" => "give `phi_left` in the form in which it is to be computed",
                    _ => "write in another form what cancels there, as `x/(sqrt(1 + x) + 1)` for `sqrt(1 + x) - 1`",
                };
                write!(
                    f,
                    "`{function}` would lose digits in `{scalar}`: at {place} its error is {units} times what rounding \
                     of its arguments causes; {mend}, or assume what keeps the formulas away from there"
                )
            }
            Self::Differs { function, row, column } => {
                write!(f, "the emitted `{function}` differs from the derived one in row {row}, column {column}")
            }
        }
    }
}

impl std::error::Error for EmitError {}
