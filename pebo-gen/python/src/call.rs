//! A call on a model: its text, its settings and its limit.
//!
//! In: bytes, and a task on the library. Out: the task's result, or the exception of an interrupt. Holds: the
//! interpreter's lock is free while the library works.

use std::cell::{Cell, OnceCell, RefCell};
use std::ops::ControlFlow;
use std::path::Path;
use std::rc::Rc;
use std::time::{Duration, Instant};

use pebo_gen::cli::Limit;
use pebo_gen::source::Source;
use pebo_gen::{Answer, Request, Stage};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::outcome::Outcome;

/// The time between two looks for an interrupt: short for a person, and long beside the look.
const PATIENCE: Duration = Duration::from_millis(50);

/// A model with the settings of a call.
pub(super) struct Call {
    /// The name of the text in diagnostics.
    name: String,
    text: Vec<u8>,
    /// Settings that override the text, each `NAME=VALUE`.
    settings: Vec<String>,
    limit: Option<Limit>,
}

impl Call {
    /// A call; an exception if the limit is not a positive number.
    pub(super) fn new((name, text): (String, Vec<u8>), settings: Vec<String>, limit: Option<f64>) -> PyResult<Self> {
        let limit = limit.map(Limit::of_seconds).transpose().map_err(PyValueError::new_err)?;
        Ok(Self { name, text, settings, limit })
    }

    /// The answer on the model of this request, which begins now.
    pub(super) fn answer(self, py: Python<'_>, request: impl FnOnce(Request) -> Request + Send) -> PyResult<Outcome> {
        self.answer_by(py, |source, begun| Outcome::of(pebo_gen::answer(source, &request(begun)), source))
    }

    /// The outcome of a task on the model; that of a text that cannot be read if it is none.
    pub(super) fn answer_by(
        self,
        py: Python<'_>,
        task: impl FnOnce(&Source, Request) -> Outcome + Send,
    ) -> PyResult<Outcome> {
        py.detach(|| {
            let stem = Path::new(&self.name).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
            let source = Source::from_bytes(&self.name, self.text).and_then(|source| source.set(self.settings));
            let source = match source {
                Ok(source) => source,
                Err(diagnostic) => {
                    let unread = Source::unread(&self.name);
                    return Ok(Outcome::of(Answer::of_unread(&stem, vec![diagnostic], &unread), &unread));
                }
            };
            let interrupt = Rc::default();
            let outcome = task(&source, within(self.limit, &interrupt).named(stem));
            match interrupt.take() {
                Some(error) => Err(error),
                None => Ok(outcome),
            }
        })
    }
}

/// A request within the limit, begun now. As of the commands, the usual limit is one of the proofs, and a given one of
/// the run too. An exception that a signal raises, as Ctrl-C does, ends the call and is kept.
fn within(limit: Option<Limit>, interrupt: &Rc<RefCell<Option<PyErr>>>) -> Request {
    let of_proof = limit.unwrap_or_default().watch();
    // The run begins when the proofs have ended.
    let of_run = OnceCell::new();
    let (interrupt, looked) = (interrupt.clone(), Cell::new(Instant::now()));
    limit.unwrap_or_default().request().watch(move |stage| {
        if looked.get().elapsed() >= PATIENCE {
            looked.set(Instant::now());
            match Python::try_attach(look) {
                Some(Ok(())) => {}
                Some(Err(error)) => drop(interrupt.replace(Some(error))),
                // The interpreter ends, and nobody waits for the answer.
                None => return ControlFlow::Break(()),
            }
        }
        if interrupt.borrow().is_some() {
            return ControlFlow::Break(());
        }
        if stage == Stage::Proof {
            return of_proof(stage);
        }
        let Some(limit) = limit else { return ControlFlow::Continue(()) };
        of_run.get_or_init(|| limit.watch())(stage)
    })
}

/// Looks for an interrupt, which is for the main thread alone.
fn look(py: Python<'_>) -> PyResult<()> {
    py.check_signals()
}
