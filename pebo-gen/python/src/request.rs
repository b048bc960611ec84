//! What the package `pebo` asks: each function is one request to the library.
//!
//! In: the model as `(name, text)`, settings as `NAME=VALUE`, a limit in seconds, and what the request needs. Out: an
//! outcome. Exceptions are those of arguments; a flawed model is an outcome.

use std::fs::File;
use std::io::{Cursor, Read, Write};
use std::path::PathBuf;

use pebo_gen::emit::Scalar;
use pebo_gen::simulate::{Ensemble, Overrides, Trace};
use pebo_gen::source::nearest;
use pebo_gen::{Request, RunRequest, Tape};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;

use super::call::Call;
use super::outcome::Outcome;
use super::table::Table;

/// A model: the name of its text in diagnostics, and the text.
type Model = (String, Vec<u8>);

/// The verdict, with the sections of the page about the derivation.
#[pyfunction]
pub(super) fn check(py: Python<'_>, model: Model, settings: Vec<String>, limit: Option<f64>) -> PyResult<Outcome> {
    Call::new(model, settings, limit)?.answer(py, Request::sections)
}

/// The observer as Rust, with a crate around it for C projects if that is asked for.
#[pyfunction]
pub(super) fn code(
    py: Python<'_>,
    model: Model,
    settings: Vec<String>,
    limit: Option<f64>,
    scalar: &str,
    c: bool,
) -> PyResult<Outcome> {
    let scalar = scalar_named(scalar)?;
    Call::new(model, settings, limit)?.answer(py, |request| {
        let request = request.emit(scalar);
        if c { request.c_project() } else { request }
    })
}

/// The page that explains the proof.
#[pyfunction]
pub(super) fn page(py: Python<'_>, model: Model, settings: Vec<String>, limit: Option<f64>) -> PyResult<Outcome> {
    Call::new(model, settings, limit)?.answer(py, Request::page)
}

/// The script that proves the claims again.
#[pyfunction]
pub(super) fn certificate(
    py: Python<'_>,
    model: Model,
    settings: Vec<String>,
    limit: Option<f64>,
) -> PyResult<Outcome> {
    Call::new(model, settings, limit)?.answer(py, Request::certificate)
}

/// The closed loop, with the table of all signals; of many runs, that of the quantiles.
#[pyfunction]
#[pyo3(signature = (model, settings, limit, *, duration, step, every, seed, initial_error, feedback, runs))]
#[expect(clippy::too_many_arguments, reason = "each is a setting by its name")]
pub(super) fn simulate(
    py: Python<'_>,
    model: Model,
    settings: Vec<String>,
    limit: Option<f64>,
    duration: Option<f64>,
    step: Option<f64>,
    every: Option<f64>,
    seed: Option<u64>,
    initial_error: Option<f64>,
    feedback: Option<String>,
    runs: Option<u64>,
) -> PyResult<Outcome> {
    let overrides = Overrides { feedback, seed, duration, step, every, initial_error, ..Overrides::default() };
    let wanted = RunRequest { overrides, trace: true, figure: true, runs };
    Call::new(model, settings, limit)?.answer_by(py, |source, request| {
        let answer = pebo_gen::answer(source, &request.run(wanted));
        let csv = answer
            .run
            .as_ref()
            .and_then(|run| run.ensemble.as_ref().map(Ensemble::csv).or(run.trace.as_ref().map(Trace::csv)));
        Outcome::with(answer, source, csv.as_deref().map(Table::of))
    })
}

/// A recording: CSV in a file, or at hand.
#[derive(FromPyObject)]
pub(super) enum Recording {
    Path(PathBuf),
    Text(PyBackedBytes),
}

/// The observer over recorded data, with the table of its estimates; `name` is the recording's name in diagnostics.
#[pyfunction]
pub(super) fn replay(
    py: Python<'_>,
    model: Model,
    settings: Vec<String>,
    limit: Option<f64>,
    name: String,
    recording: Recording,
) -> PyResult<Outcome> {
    let mut recording: Box<dyn Read + Send> = match recording {
        Recording::Path(path) => Box::new(File::open(path)?),
        Recording::Text(text) => Box::new(Cursor::new(text)),
    };
    Call::new(model, settings, limit)?.answer_by(py, move |source, request| {
        let mut table = Table::default();
        let estimates: &mut dyn Write = &mut table;
        let tape = Tape { name: &name, recording: &mut recording, estimates: Some(estimates) };
        let answer = pebo_gen::replay(source, &request, tape);
        let table = answer.replay.is_some().then_some(table);
        Outcome::with(answer, source, table)
    })
}

/// The type of numbers of that name.
fn scalar_named(name: &str) -> PyResult<Scalar> {
    Scalar::from_name(name).ok_or_else(|| {
        let names = Scalar::ALL.map(Scalar::name);
        let near = nearest(name, names).map_or_else(String::new, |near| format!(": did you mean `{near}`?"));
        PyValueError::new_err(format!("there is no scalar `{name}`, only {}{near}", names.join(" and ")))
    })
}
