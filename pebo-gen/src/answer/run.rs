//! What came of a run of the closed loop.
//!
//! In: an accepted derivation and what to keep. Out: how far the estimates were from the truth when it began and when
//! it ended, and what was asked for; or the diagnostics of a loop that is not described, or did not come to its end.

use std::ops::ControlFlow;

use serde::Serialize;

use crate::derived::Derived;
use crate::simulate::{Trace, figure};
use crate::source::Diagnostic;

use super::ask::{Ask, AskRun, Stage};
use super::standing::Standing;

/// What came of a run.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Run {
    /// When it ended, in seconds.
    pub end: f64,
    /// The error of each estimate.
    pub errors: Vec<FinalError>,
    /// All signals over time, if they were asked for.
    pub trace: Option<Trace>,
    /// The figure as SVG, if it was asked for.
    pub figure: Option<String>,
}

/// How far the estimate of a state is from it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FinalError {
    /// The state.
    pub state: String,
    /// Estimate less truth when the run began.
    pub start: f64,
    /// Estimate less truth when it ended.
    pub end: f64,
}

/// Runs the loop; a loop that is not described well is the caller's mistake, one that fails is not.
pub(super) fn run(derived: &Derived, ask: &Ask, wanted: &AskRun) -> Result<Run, (Standing, Vec<Diagnostic>)> {
    let scenario = derived.scenario(&wanted.overrides).map_err(|found| (Standing::Malformed, found))?;
    let samples = scenario.samples();
    let mut progress = |done| match &ask.watch {
        Some(watch) => watch(Stage::Run { done, samples }),
        None => ControlFlow::Continue(()),
    };
    let failed = |failure| (Standing::Refused, vec![scenario.explain(&failure)]);
    let trace = scenario.run_while(&mut progress).map_err(failed)?;
    let figure = wanted.figure.then(|| figure::draw(&trace, &scenario));
    Ok(Run { end: trace.end(), errors: errors(&trace), figure, trace: wanted.trace.then_some(trace) })
}

fn errors(trace: &Trace) -> Vec<FinalError> {
    let states = trace.columns().iter().filter_map(|name| name.strip_suffix(Trace::ERROR));
    let error = |state: &str| {
        let values = trace.column(&format!("{state}{}", Trace::ERROR))?;
        Some(FinalError { state: state.to_owned(), start: *values.first()?, end: *values.last()? })
    };
    states.filter_map(error).collect()
}
