//! A request that may run the closed loop: the proofs keep to the usual limit, a run to a given one, and a long run
//! shows its progress.

use std::cell::OnceCell;
use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use crate::{Request, Stage};
use indicatif::{ProgressBar, ProgressStyle};

use super::budget::Limit;

/// Runs with fewer samples end before a progress bar would be visible.
const LONG_RUN: u64 = 200_000;

/// Recordings of fewer bytes do too.
const LARGE: u64 = 16 << 20;

/// The resolution of the progress bar.
const TICKS: u64 = 1000;

/// A request about a model, begun now.
pub(super) fn request(limit: Option<Limit>) -> Request {
    let (proof, run) = (limit.unwrap_or_default().watch(), watch(limit));
    limit.unwrap_or_default().request().watch(move |stage| match stage {
        Stage::Run { done, samples } => run(done, samples),
        stage => proof(stage),
    })
}

/// A request about a model, begun now, and a recording of this many bytes.
pub(super) fn replaying(limit: Option<Limit>, size: Option<u64>) -> Request {
    let proof = limit.unwrap_or_default().watch();
    let most = limit.map(|limit| Duration::from_secs_f64(limit.0));
    let begun: OnceCell<(Instant, ProgressBar)> = OnceCell::new();
    limit.unwrap_or_default().request().watch(move |stage| {
        let Stage::Replay { bytes, .. } = stage else { return proof(stage) };
        let (start, bar) = begun.get_or_init(|| (Instant::now(), bar(size.is_some_and(|size| size > LARGE))));
        bar.set_position(share(real(bytes) / real(size.unwrap_or(1))));
        let is_over = most.is_some_and(|most| start.elapsed() > most);
        if is_over || size.is_some_and(|size| bytes >= size) {
            bar.finish_and_clear();
        }
        if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
}

/// Shows the progress of a run, and ends it at the limit. A run without a limit ends by itself: its samples are counted
/// before it starts.
fn watch(limit: Option<Limit>) -> impl Fn(f64, u64) -> ControlFlow<()> {
    let begun: OnceCell<(Instant, ProgressBar)> = OnceCell::new();
    let most = limit.map(|limit| Duration::from_secs_f64(limit.0));
    move |done, samples| {
        let (start, bar) = begun.get_or_init(|| (Instant::now(), bar(samples >= LONG_RUN)));
        bar.set_position(share(done));
        if done >= 1.0 || most.is_some_and(|most| start.elapsed() > most) {
            bar.finish_and_clear();
        }
        if most.is_some_and(|most| start.elapsed() > most) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A progress bar for a long run at a terminal; hidden otherwise.
fn bar(is_long: bool) -> ProgressBar {
    if !is_long || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(TICKS);
    // The template is a constant that indicatif accepts.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}

#[expect(clippy::cast_precision_loss, reason = "for the eye")]
fn real(bytes: u64) -> f64 {
    bytes as f64
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
