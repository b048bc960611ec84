//! Functions that are given by points.
//!
//! In: points as they are written. Out: the function through them, exact, with its name; or a diagnostic at the first
//! point that is out of order.

use crate::source::{Code, Diagnostic, Span};
use pebo_cas::Rational;
use pebo_cas::graph::function::pieces::{Pieces, suffix, through};

use super::Decimal;
use crate::model::choice::choices;
use crate::model::spanned::Spanned;

choices! {
    /// A function between points.
    #[derive(Default)]
    pub enum Interpolation {
        /// Monotone cubics.
        #[default]
        Cubic = "cubic",
        /// Straight lines.
        Linear = "linear",
    }
}

/// Claims are proved on each piece: a domain has at most that many cells.
const MOST_POINTS: usize = 50;

/// A table with its name.
#[derive(Clone, PartialEq, Debug)]
pub struct Table {
    /// Its name, by which formulas call it.
    pub name: String,
    /// Its points, as they are written.
    pub points: Vec<(Decimal, Decimal)>,
    /// The function between them.
    pub interpolation: Interpolation,
    /// The function.
    pub pieces: Pieces,
}

impl Table {
    /// The table through points, each with its span.
    pub fn through(
        name: &str,
        points: &[Vec<Spanned<Decimal>>],
        (interpolation, span): (Interpolation, Span),
    ) -> Result<Self, Diagnostic> {
        if points.len() > MOST_POINTS {
            let message = format!("a table has at most {MOST_POINTS} points, and this has {}", points.len());
            return Err(Diagnostic::error(Code::WrongShape, span, message)
                .help("leave out points between which a cubic is near enough"));
        }
        let mut exact: Vec<(Rational, Rational)> = Vec::with_capacity(points.len());
        for point in points {
            let [at, value] = point.as_slice() else {
                let message = format!("a point of a table has two numbers, and this has {}", point.len());
                let place = point.first().map_or(span, |number| number.span);
                return Err(Diagnostic::error(Code::WrongShape, place, message)
                    .help("write the argument and the value, as `[0.5, 3.7]`"));
            };
            let number = |number: &Spanned<Decimal>| {
                let out = || Diagnostic::error(Code::NumberTooLarge, number.span, "this number is out of range");
                Rational::from_decimal(number.value.text())
                    .map_err(|_| out().help("keep the exponent between -308 and 308"))
            };
            let (place, value) = (number(at)?, number(value)?);
            if exact.last().is_some_and(|(before, _)| *before >= place) {
                return Err(Diagnostic::error(
                    Code::WrongShape,
                    at.span,
                    "the arguments of a table ascend, and this does not",
                )
                .help("sort the points by their first numbers, each once"));
            }
            exact.push((place, value));
        }
        let pieces = through(&exact, interpolation == Interpolation::Cubic).ok_or_else(|| {
            Diagnostic::error(Code::WrongShape, span, "a table has at least two points")
                .help("write for example `points: [[0, 3.0], [1, 4.2]]`")
        })?;
        let written =
            points.iter().filter_map(|point| Some((point.first()?.value.clone(), point.get(1)?.value.clone())));
        Ok(Self { name: name.to_owned(), points: written.collect(), interpolation, pieces })
    }

    /// The order of the derivative that a function's name means, if it is of this table.
    pub fn order(&self, name: &str) -> Option<usize> {
        let orders = self.pieces.coefficients.first().map_or(0, Vec::len);
        let behind = name.strip_prefix(self.name.as_str())?;
        (0..orders).find(|order| suffix(*order) == behind)
    }
}
