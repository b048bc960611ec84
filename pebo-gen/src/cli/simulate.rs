//! `pebo-gen simulate`: runs the closed loop that the model file describes.

use pebo_gen::analysis::Outcome;
use pebo_gen::simulate::{Overrides, Trace};
use pebo_gen::{AskRun, FinalError, Run, Standing};

use super::arguments::{Limit, SimulateOptions};
use super::{files, progress, terminal};

pub(super) fn run(options: &SimulateOptions, limit: Option<Limit>) -> Standing {
    let overrides = Overrides {
        feedback: options.feedback.clone(),
        seed: options.seed,
        duration: None,
        step: options.step,
        every: options.every,
    };
    let wanted = AskRun { overrides, trace: options.csv.is_some(), figure: options.plot.is_some() };
    let (source, answer) = files::answer(&options.model, progress::ask(limit).run(wanted));
    // An accepted model has nothing to say here but how it runs.
    if answer.report.verdict != Outcome::Accepted {
        terminal::say(&answer.summary);
    }
    terminal::report(&answer.diagnostics, &source);
    let Some(run) = answer.run else { return answer.standing };
    terminal::say(&outcome(&run));
    let outputs = [(&options.csv, run.trace.as_ref().map(Trace::csv)), (&options.plot, run.figure)];
    for (path, text) in outputs {
        if let (Some(path), Some(text)) = (path, text)
            && let Err(diagnostic) = files::write(path, &text)
        {
            terminal::report(&[diagnostic], &source);
            return Standing::Malformed;
        }
    }
    answer.standing
}

/// A line for each estimate: its error at the start and at the end.
fn outcome(run: &Run) -> String {
    let line = |error: &FinalError| {
        format!("{}_error: {:.3e} at the start, {:.3e} at t = {} s\n", error.state, error.start, error.end, run.end)
    };
    run.errors.iter().map(line).collect()
}
