//! The last model with its derivation.

use std::ops::ControlFlow;

use pebo_cas::Budget;
use pebo_gen::source::{Diagnostic, Source};
use pebo_gen::{Derived, Request, Stage, derive_within};

/// The last model with its derivation, and the observer of a call's progress.
#[derive(Debug)]
pub(super) struct ModelCache {
    progress: fn(f64),
    last: Option<Last>,
}

/// A text, its limit, and its derivation.
type Last = (String, Option<f64>, Result<Derived, Vec<Diagnostic>>);

impl ModelCache {
    /// Nothing yet. A run of the closed loop tells which part of it is done, 0 to 1.
    pub(super) fn new(progress: fn(f64)) -> Self {
        Self { progress, last: None }
    }

    /// The request for every model, within so many seconds.
    pub(super) fn ask(&self) -> Request {
        let progress = self.progress;
        Request::new().named("model").watch(move |stage| {
            if let Stage::Run { done, .. } = stage {
                progress(done);
            }
            ControlFlow::Continue(())
        })
    }

    /// The model as it was derived, now or before.
    pub(super) fn take(&mut self, source: &Source, limit: Option<f64>) -> Result<Derived, Vec<Diagnostic>> {
        let wanted = (source.text(), limit);
        let known = self.last.take().filter(|(text, within, _)| (text.as_str(), *within) == wanted);
        match known {
            Some((_, _, derived)) => derived,
            None => derive_within(source, budget(limit)),
        }
    }

    /// Keeps the model.
    pub(super) fn keep(&mut self, source: &Source, limit: Option<f64>, derived: Result<Derived, Vec<Diagnostic>>) {
        self.last = Some((source.text().to_owned(), limit, derived));
    }
}

/// The budget within so many seconds.
pub(super) fn budget(limit: Option<f64>) -> Budget {
    Budget::of_seconds(limit.unwrap_or(Budget::SECONDS))
}
