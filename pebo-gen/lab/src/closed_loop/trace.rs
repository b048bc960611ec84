//! The course of a run: a table on a grid of instants, and the curves of the figure.

use crate::experiment::columns::{self, write_row};
use crate::figure::curve::DrawnCurve;
use crate::summary::Summary;

/// The course of a run. Serialises to `columns`, the names, and `values`, row by row.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Trace {
    columns: Vec<String>,
    /// Row by row.
    values: Vec<f64>,
    /// Each panel's curves.
    #[serde(skip)]
    pub(crate) curves: Vec<Vec<DrawnCurve>>,
    /// The summary of the run.
    #[serde(skip)]
    pub(crate) summary: Summary,
}

impl Trace {
    /// The suffix of the names of error columns.
    pub const ERROR: &str = columns::ERROR;

    /// The suffix of the names of standard errors.
    pub const STANDARD_ERROR: &str = columns::STANDARD_ERROR;

    /// The table row by row, each panel's curves, and the summary of the run.
    pub(crate) fn new(
        (columns, values): (Vec<String>, Vec<f64>),
        curves: Vec<Vec<DrawnCurve>>,
        summary: Summary,
    ) -> Self {
        Self { columns, values, curves, summary }
    }

    /// The summary of the run.
    pub fn summary(&self) -> &Summary {
        &self.summary
    }

    /// The names of the columns: `t`, states of x and y, inputs, `<x>_hat` and `<x>_error` for each recovered state,
    /// `<baseline>.<x>_hat`; `<x>_std`, the standard error that the observer predicts, where it does.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The rows, from the first instant to the last.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.columns.len())
    }

    /// The last instant, in seconds.
    pub fn end(&self) -> f64 {
        self.rows().last().map_or(0.0, |row| row[0])
    }

    /// The values of the column of that name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let position = self.columns.iter().position(|column| column == name)?;
        Some(self.rows().map(|row| row[position]).collect())
    }

    /// The table as CSV: a header row, then numbers with as many digits as it takes to read the same number back.
    pub fn csv(&self) -> String {
        let mut text = self.columns.join(",");
        text.push('\n');
        // No standard error is predicted before the first sample.
        self.rows().for_each(|row| write_row(&mut text, row.iter().copied()));
        text
    }
}
