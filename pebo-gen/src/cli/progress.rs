//! A question that may run the closed loop: the proofs keep to the usual limit, a run to one that is given, and a long run
//! shows how far it is.

use std::cell::OnceCell;
use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use pebo_gen::{Ask, Stage};

use super::arguments::Limit;

/// Runs with fewer samples are over before a bar would be seen.
const LONG_RUN: u64 = 200_000;

/// The resolution of the bar.
const TICKS: u64 = 1000;

/// A question about a model that is begun now.
pub(super) fn ask(limit: Option<Limit>) -> Ask {
    let (proof, run) = (limit.unwrap_or_default().watch(), watch(limit));
    limit.unwrap_or_default().ask().watch(move |stage| match stage {
        Stage::Run { done, samples } => run(done, samples),
        stage => proof(stage),
    })
}

/// Shows how far a run is, and ends it at the limit. A run that nobody limits ends by itself: its samples are counted
/// before it starts.
fn watch(limit: Option<Limit>) -> impl Fn(f64, u64) -> ControlFlow<()> {
    let begun: OnceCell<(Instant, ProgressBar)> = OnceCell::new();
    let most = limit.map(|limit| Duration::from_secs_f64(limit.0));
    move |done, samples| {
        let (start, bar) = begun.get_or_init(|| (Instant::now(), progress(samples)));
        bar.set_position(share(done));
        if done >= 1.0 || most.is_some_and(|most| start.elapsed() > most) {
            bar.finish_and_clear();
        }
        if most.is_some_and(|most| start.elapsed() > most) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
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
