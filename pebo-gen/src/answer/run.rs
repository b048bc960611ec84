//! The result of a run of the closed loop.
//!
//! In: an accepted derivation and the results to keep. Out: the errors of the estimates at the start and at the end of
//! the run, and the requested results; or the diagnostics of a loop that is not described, or ended early.

use std::ops::ControlFlow;

use serde::Serialize;

use crate::derived::Derived;
use pebo_design::source::Diagnostic;
use pebo_lab::{Ensemble, EstimateScore, Scenario, Summary, Trace, draw};

use super::request::{Request, RunRequest, Stage};
use super::standing::Standing;

/// The result of a run.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Run {
    /// Its end, in seconds.
    pub end: f64,
    /// The estimator with its settings, as a file would have them.
    pub estimator: String,
    /// The error of each estimate.
    pub errors: Vec<FinalError>,
    /// The settling of each estimate and its error after; lost samples; excitation. Of many runs, those of the first
    /// that came to its end.
    pub summary: Summary,
    /// The spread of estimates over many runs, if these were requested.
    pub ensemble: Option<Ensemble>,
    /// All signals over time, if they were requested.
    pub trace: Option<Trace>,
    /// The figure as SVG, if it was requested.
    pub figure: Option<String>,
}

/// The error of the estimate of a state.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FinalError {
    /// The state.
    pub state: String,
    /// Estimate minus truth at the start of the run.
    pub start: f64,
    /// Estimate minus truth at its end.
    pub end: f64,
}

/// Runs the loop; a flawed description is the caller's mistake, a failed run is not. Gives the run with diagnostics if
/// it did not converge.
pub(super) fn run(
    derived: &Derived,
    request: &Request,
    wanted: &RunRequest,
) -> Result<(Run, Vec<Diagnostic>), (Standing, Vec<Diagnostic>)> {
    let mut scenario = derived.scenario(&wanted.overrides).map_err(|found| (Standing::Malformed, found))?;
    let runs = wanted.runs.unwrap_or(1).max(1);
    let samples = scenario.samples().saturating_mul(runs);
    let mut progress = |done| match &request.watch {
        Some(watch) => watch(Stage::Run { done, samples }),
        None => ControlFlow::Continue(()),
    };
    if wanted.runs.is_some() {
        let ran = scenario.run_often(runs, &mut progress);
        let (ensemble, first) = ran.map_err(|failure| (Standing::Refused, vec![scenario.explain(&failure)]))?;
        let figure = wanted.figure.then(|| ensemble.figure(&scenario));
        let advice = scenario.advise_on(&ensemble);
        let run = Run { figure, ensemble: Some(ensemble), ..Run::of(&scenario, first) };
        return Ok((run, advice));
    }
    let ran = scenario.run_while(&mut progress);
    let trace = ran.map_err(|failure| (Standing::Refused, vec![scenario.explain(&failure)]))?;
    let figure = wanted.figure.then(|| draw(&trace, &scenario));
    let summary = trace.summary().clone();
    let advice = scenario.advise(&summary);
    Ok((Run { figure, trace: wanted.trace.then_some(trace), ..Run::of(&scenario, summary) }, advice))
}

impl Run {
    /// A run without further requests.
    fn of(scenario: &Scenario, summary: Summary) -> Self {
        let own = summary.estimates.iter().filter(|rated| rated.estimate.baseline.is_none());
        let error = |rated: &EstimateScore| FinalError {
            state: rated.estimate.state.clone(),
            start: rated.score.first,
            end: rated.score.last,
        };
        let errors = own.map(error).collect();
        let estimator = scenario.estimator().to_owned();
        Self { end: summary.end, estimator, errors, summary, ensemble: None, trace: None, figure: None }
    }
}
