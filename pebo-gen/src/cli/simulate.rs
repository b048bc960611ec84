//! `pebo-gen simulate`: runs the closed loop that the model file describes.

use crate::analysis::Outcome;
use crate::simulate::{Ensemble, Overrides, Trace};
use crate::source::Source;
use crate::{RunRequest, Standing};

use super::arguments::SimulateOptions;
use super::budget::Limit;
use super::{files, progress, standard, terminal};

pub(super) fn run(options: &SimulateOptions, limit: Option<Limit>) -> Standing {
    if let Some(diagnostic) = options.plot.as_deref().and_then(files::not_a_figure) {
        terminal::report(&[diagnostic], &Source::unread("the call"));
        return Standing::Malformed;
    }
    let overrides = Overrides {
        feedback: options.feedback.clone(),
        seed: options.seed,
        duration: None,
        step: options.step,
        every: options.every,
        ..Overrides::default()
    };
    let (trace, figure) = (options.csv.is_some(), options.plot.is_some());
    let wanted = RunRequest { overrides, trace, figure, runs: options.runs };
    let (source, answer) = files::answer_with(&options.model, &options.set, progress::request(limit).run(wanted));
    // An accepted model prints its run alone.
    if answer.report.verdict != Outcome::Accepted {
        terminal::say(&answer.summary);
    }
    if let Some(run) = &answer.run {
        let text = run.ensemble.as_ref().map_or_else(|| run.summary.text(), Ensemble::text);
        if let Err(diagnostic) = files::summarise(&text, options.csv.as_deref()) {
            return standard::refuse(diagnostic);
        }
    }
    terminal::report(&answer.diagnostics, &source);
    let Some(run) = answer.run else { return answer.standing };
    let csv = run.ensemble.as_ref().map(Ensemble::csv).or(run.trace.as_ref().map(Trace::csv));
    let outputs = [(&options.csv, csv), (&options.plot, run.figure)];
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
