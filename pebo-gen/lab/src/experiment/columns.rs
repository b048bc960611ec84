//! The columns of an experiment's table, and its rows as CSV.
//!
//! `t`; signals; each estimate of the observer, with its error where the state is known; estimates of baselines; then the
//! standard errors, where they are predicted.

use std::fmt::Write as _;

use pebo_design::plant::Plant;

use super::layout::{Layout, PlacedEstimate, TIME};

/// The suffix of the names of error columns.
pub(crate) const ERROR: &str = "_error";

/// The suffix of the names of standard errors.
pub(crate) const STANDARD_ERROR: &str = "_std";

/// The columns: their names, and the positions of their values in the table of an instant.
#[derive(Debug)]
pub(crate) struct Columns {
    pub(crate) names: Vec<String>,
    places: Vec<usize>,
}

impl Columns {
    /// The columns, with states, outputs and inputs if these are not recorded elsewhere.
    pub(crate) fn new(plant: &Plant, layout: &Layout, has_signals: bool) -> Self {
        let mut columns = vec![("t".to_owned(), TIME)];
        let signals = plant.x.iter().map(|state| state.symbol).chain(plant.y.iter().map(|output| output.symbol));
        let places = layout.x.clone().chain(layout.measured()).chain(layout.u.clone());
        let signals = signals.chain(plant.commanded()).zip(places).filter(|_| has_signals);
        columns.extend(signals.map(|(signal, place)| (plant.arena.name(signal), place)));
        for PlacedEstimate { estimate, hat, error, .. } in &layout.estimates {
            columns.push((format!("{}_hat", estimate.name()), *hat));
            if let Some(error) = error.filter(|_| estimate.baseline.is_none()) {
                columns.push((format!("{}{ERROR}", estimate.state), error));
            }
        }
        let predicted = layout.estimates.iter().zip(layout.standard_errors.clone());
        columns.extend(predicted.map(|(of, place)| (format!("{}{STANDARD_ERROR}", of.estimate.state), place)));
        let (names, places) = columns.into_iter().unzip();
        Self { names, places }
    }

    /// The row of a table.
    pub(crate) fn row<'a>(&'a self, table: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.places.iter().map(|place| table[*place])
    }
}

/// Writes a row with as many digits as it takes to read the same numbers back; a value that is not known is an empty cell.
pub(crate) fn write_row(text: &mut String, row: impl Iterator<Item = f64>) {
    for (place, value) in row.enumerate() {
        if place > 0 {
            text.push(',');
        }
        let written = if value.is_finite() { write_number(text, value) } else { Ok(()) };
        debug_assert!(written.is_ok(), "a string takes everything");
    }
    text.push('\n');
}

/// The shortest text that reads back as the same number; an exponent where that is shorter than zeros.
fn write_number(text: &mut String, value: f64) -> std::fmt::Result {
    let magnitude = value.abs();
    if value == 0.0 {
        text.write_char('0')
    } else if (1e-5..1e16).contains(&magnitude) {
        write!(text, "{value}")
    } else {
        write!(text, "{value:e}")
    }
}
