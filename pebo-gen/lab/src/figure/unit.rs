//! The unit of a formula, from those that the model gives its signals.
//!
//! In: a formula, and the units of names. Out: the unit of its value, where it follows without arithmetic of units: of
//! a name, of an estimate, and of sums and differences of what has one unit.

use pebo_design::model::formula::{Formula, Operator, Term};

/// The unit of a formula; none where one of its names has none, or where units are multiplied.
pub(crate) fn of<'u>(formula: &Formula, unit: &impl Fn(&str) -> Option<&'u str>) -> Option<&'u str> {
    match &formula.term {
        Term::Name(name) | Term::Estimate(name) => unit(name),
        Term::Negative(operand) => of(operand, unit),
        Term::Binary(Operator::Add | Operator::Subtract, left, right) => same([of(left, unit), of(right, unit)]),
        Term::Number(_) | Term::Binary(..) | Term::Call(..) | Term::Table(..) => None,
    }
}

/// The unit that all have.
pub(crate) fn same<'u>(units: impl IntoIterator<Item = Option<&'u str>>) -> Option<&'u str> {
    let mut units = units.into_iter();
    let first = units.next()??;
    units.all(|unit| unit == Some(first)).then_some(first)
}
