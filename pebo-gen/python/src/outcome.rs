//! The outcome of a call as values of Python.
//!
//! In: an answer and its source. Out: JSON with every diagnostic rendered, and a table of numbers if there is one.

use pebo_gen::Answer;
use pebo_gen::simulate::replay::Replayed;
use pebo_gen::source::{Colour, Source, render};
use pyo3::IntoPyObjectExt as _;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::Serialize;

use super::table::Table;

/// An answer as JSON, and the table of its run.
pub(super) struct Outcome {
    json: String,
    table: Option<Table>,
}

/// An answer, with what its diagnostics look like.
#[derive(Serialize)]
struct Shown<'a> {
    #[serde(flatten)]
    answer: &'a Answer,
    /// Each diagnostic as the command line shows it.
    rendered: Vec<String>,
    /// What the command prints of a run or a replay.
    told: Option<String>,
}

impl Outcome {
    /// Without a table.
    pub(super) fn of(answer: Answer, source: &Source) -> Self {
        Self::with(answer, source, None)
    }

    /// With the table of a run or a replay.
    pub(super) fn with(mut answer: Answer, source: &Source, table: Option<Table>) -> Self {
        // The table has it.
        if let Some(run) = &mut answer.run {
            run.trace = None;
        }
        let of_run = answer.run.as_ref().map(|run| match &run.ensemble {
            Some(ensemble) => ensemble.text(),
            None => run.summary.text(),
        });
        let told = of_run.or_else(|| answer.replay.as_ref().map(Replayed::text));
        let one = |diagnostic| render(std::slice::from_ref(diagnostic), source, Colour::Never);
        let rendered = answer.diagnostics.iter().map(one).collect();
        // Answers always serialise: strings, numbers, and maps with string keys.
        let json = serde_json::to_string(&Shown { answer: &answer, rendered, told }).unwrap_or_default();
        Self { json, table }
    }
}

/// `(json, columns, numbers)`, the numbers as bytes of `f64` of this machine, row by row.
impl<'py> IntoPyObject<'py> for Outcome {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        let table = self.table.unwrap_or_default();
        (self.json, &table.columns, PyBytes::new(py, &table.numbers)).into_bound_py_any(py)
    }
}
