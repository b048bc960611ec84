//! What came of a run of the closed loop.
//!
//! In: an accepted derivation and what to keep. Out: how far the estimates were from the truth when it began and when
//! it ended, and what was asked for; or the diagnostics of a loop that is not described, or did not come to its end.

use std::ops::ControlFlow;

use serde::Serialize;

use crate::derived::Derived;
use pebo_design::source::Diagnostic;
use pebo_lab::{Ensemble, EstimateScore, Scenario, Summary, Trace, draw};

use super::ask::{Ask, AskRun, Stage};
use super::standing::Standing;

/// What came of a run.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Run {
    /// When it ended, in seconds.
    pub end: f64,
    /// The estimator with its settings, as a file would have them.
    pub estimator: String,
    /// The error of each estimate.
    pub errors: Vec<FinalError>,
    /// How each estimate settled and how large its error was then; samples that were lost; excitation. Of many runs, of the
    /// first that came to its end.
    pub summary: Summary,
    /// How estimates are spread over many runs, if these were asked for.
    pub ensemble: Option<Ensemble>,
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

/// Runs the loop; a loop that is not described well is the caller's mistake, one that fails is not. Beside it what there is
/// to say of one that did not converge.
pub(super) fn run(
    derived: &Derived,
    ask: &Ask,
    wanted: &AskRun,
) -> Result<(Run, Option<Diagnostic>), (Standing, Vec<Diagnostic>)> {
    let mut scenario = derived.scenario(&wanted.overrides).map_err(|found| (Standing::Malformed, found))?;
    let runs = wanted.runs.unwrap_or(1).max(1);
    let samples = scenario.samples().saturating_mul(runs);
    let mut progress = |done| match &ask.watch {
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
    /// A run of which nothing else was asked for.
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
