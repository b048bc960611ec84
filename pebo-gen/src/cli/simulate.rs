//! `pebo-gen simulate`: runs the closed loop that the model file describes.

use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use pebo_gen::analysis::Outcome;
use pebo_gen::report;
use pebo_gen::simulate::{Overrides, Trace, figure};

use super::arguments::{Limit, SimulateOptions};
use super::{Ending, files, terminal};

/// Runs with fewer samples are over before a bar would be seen.
const LONG_RUN: u64 = 200_000;

/// The resolution of the bar.
const TICKS: u64 = 1000;

pub(super) fn run(options: &SimulateOptions, limit: Option<Limit>) -> Ending {
    let (source, derived) = match files::derive(&options.model, limit.unwrap_or_default()) {
        Ok(read) => read,
        Err(ending) => return ending,
    };
    if derived.derivation.outcome != Outcome::Accepted {
        terminal::say(&report::summary(&derived.plant, &derived.derivation));
        terminal::report(&derived.derivation.diagnostics, &source);
        return Ending::Refused;
    }
    let overrides =
        Overrides { feedback: options.feedback.clone(), duration: None, step: options.step, every: options.every };
    let scenario = match derived.scenario(&overrides) {
        Ok(scenario) => scenario,
        Err(diagnostics) => {
            terminal::report(&diagnostics, &source);
            return Ending::Malformed;
        }
    };
    let bar = progress(scenario.samples());
    // A run that nobody limits ends by itself: its samples are counted before it starts, and it shows how far it is.
    let (start, most) = (Instant::now(), limit.map(|limit| Duration::from_secs_f64(limit.0)));
    let run = scenario.run_while(&mut |done| {
        bar.set_position(share(done));
        if most.is_some_and(|most| start.elapsed() > most) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    let trace = match run {
        Ok(trace) => trace,
        Err(failure) => {
            terminal::report(&[scenario.explain(&failure)], &source);
            return Ending::Refused;
        }
    };
    terminal::say(&outcome(&trace));
    let outputs = [
        options.csv.as_deref().map(|path| (path, trace.csv())),
        options.plot.as_deref().map(|path| (path, figure::draw(&trace, &scenario))),
    ];
    for (path, text) in outputs.into_iter().flatten() {
        if let Err(diagnostic) = files::write(path, &text) {
            terminal::report(&[diagnostic], &source);
            return Ending::Malformed;
        }
    }
    Ending::Accepted
}

/// A bar for a long run at a terminal; hidden otherwise.
fn progress(samples: u64) -> ProgressBar {
    if samples < LONG_RUN || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(TICKS);
    // The template is a constant that indicatif accepts.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a share of the ticks, for the eye"
)]
fn share(done: f64) -> u64 {
    (done.clamp(0.0, 1.0) * TICKS as f64) as u64
}

/// A line for each estimate: its error at the start and at the end.
fn outcome(trace: &Trace) -> String {
    let errors = trace.columns().iter().enumerate().filter(|(_, name)| name.ends_with("_error"));
    errors
        .filter_map(|(index, name)| {
            let (first, last) = (trace.rows().next()?, trace.rows().last()?);
            Some(format!("{name}: {:.3e} at the start, {:.3e} at t = {} s\n", first[index], last[index], last[0]))
        })
        .collect()
}
