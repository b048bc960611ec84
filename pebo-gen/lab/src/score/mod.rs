//! Scores the estimate of a state by its errors, one after the other.
//!
//! In: the error and the state at each instant. Out: the time at which the error fell for good below a hundredth of the
//! state's largest absolute value, and its size from then on. Knows nothing of plants or observers, and keeps some
//! thousand numbers in a run of any length: the threshold is known only at its end.

pub(crate) mod domain;
pub(crate) mod expected;
pub(crate) mod faults;

use serde::Serialize;

use super::timing::real;

/// The share of a state's largest absolute value within which an estimate has settled.
pub const SETTLED: f64 = 0.01;

/// The share of a run, at its end, whose errors are scored where they have not settled.
const END: f64 = 0.1;

/// The share of a run whose errors are compared with those of an equal share before.
const TREND: f64 = 0.25;

/// The least share of a run for which an error must remain small: noise makes it small for a moment.
const HELD: f64 = 0.01;

/// Errors with a ratio below this are merged: the larger one, at the later instant.
const ALIKE: f64 = 1.005;

/// The most spans of time in which errors are summed; at least half of them are used.
const SPANS: usize = 512;

/// The score of an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The error at the first instant, estimate less truth.
    pub first: f64,
    /// The error at the last instant.
    pub last: f64,
    /// The time in seconds from which on the error remains below a hundredth of the state's largest absolute value (of
    /// an angle: of its period; of a state that is always 0: of its largest error); none if there is no such time, or
    /// it is in the last hundredth of the run.
    pub settled: Option<f64>,
    /// The time from which on errors are scored, in seconds: when they have settled, else the start of the last tenth.
    pub since: f64,
    /// Their root mean square, in the unit of the state.
    pub rms: f64,
    /// Their largest absolute value.
    pub worst: f64,
    /// The root mean square in the last quarter of the run, over that in the quarter before.
    pub trend: f64,
}

/// The errors of an estimate so far.
#[derive(Clone, Debug)]
pub(super) struct Scorer {
    /// The reference of the threshold, if that is not the state's largest absolute value.
    period: Option<f64>,
    largest: f64,
    /// Errors in descending order: each larger than all after it.
    stairs: Vec<Stair>,
    spans: Vec<Span>,
    /// Samples in a span that is full.
    width: u64,
    /// The last instant with its error.
    last: (f64, f64),
    /// The first instant with its error.
    first: Option<(f64, f64)>,
}

/// The absolute value of an error.
#[derive(Clone, Copy, Debug)]
struct Stair {
    error: f64,
    /// Its instant, and that of the next sample.
    at: f64,
    next: f64,
}

/// Errors of some samples in a row.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    /// The first instant and the last.
    start: f64,
    end: f64,
    samples: u64,
    squares: f64,
    largest: f64,
}

impl Span {
    fn and(self, later: Self) -> Self {
        Self {
            start: self.start,
            end: later.end,
            samples: self.samples + later.samples,
            squares: self.squares + later.squares,
            largest: self.largest.max(later.largest),
        }
    }
}

impl Scorer {
    /// The score before the first sample; `period` is that of an angle.
    pub(super) fn new(period: Option<f64>) -> Self {
        Self { period, largest: 0.0, stairs: Vec::new(), spans: Vec::new(), width: 1, last: (0.0, 0.0), first: None }
    }

    /// Takes the error at an instant, at which the state has this value.
    pub(super) fn add(&mut self, t: f64, error: f64, truth: f64) {
        self.first.get_or_insert((t, error));
        self.last = (t, error);
        let error = if error.is_nan() { f64::INFINITY } else { error.abs() };
        self.largest = self.largest.max(truth.abs());
        self.step(t, error);
        let sample = Span { start: t, end: t, samples: 1, squares: error * error, largest: error };
        match self.spans.last_mut() {
            Some(last) if last.samples < self.width => *last = last.and(sample),
            _ => {
                if self.spans.len() == SPANS {
                    self.spans =
                        self.spans.chunks(2).map(|pair| pair.iter().skip(1).fold(pair[0], |a, b| a.and(*b))).collect();
                    self.width *= 2;
                }
                self.spans.push(sample);
            }
        }
    }

    fn step(&mut self, at: f64, error: f64) {
        if let Some(last) = self.stairs.last_mut() {
            last.next = last.next.min(at);
        }
        while self.stairs.last().is_some_and(|last| last.error <= error) {
            self.stairs.pop();
        }
        match self.stairs.last_mut() {
            Some(last) if last.error <= error * ALIKE => (last.at, last.next) = (at, f64::INFINITY),
            _ => self.stairs.push(Stair { error, at, next: f64::INFINITY }),
        }
    }

    /// The score of the errors so far.
    pub(super) fn finish(&self) -> Score {
        let scale = match self.period {
            Some(period) => period,
            None if self.largest > 0.0 => self.largest,
            None => self.stairs.first().map_or(0.0, |first| first.error),
        };
        let ((start, first), (end, last)) = (self.first.unwrap_or_default(), self.last);
        let last_above = self.stairs.iter().rev().find(|stair| stair.error > SETTLED * scale);
        let ending = |share: f64| end - share * (end - start);
        let settled = last_above.map_or(Some(start), |stair| Some(stair.next).filter(|next| *next <= ending(HELD)));
        let since = settled.unwrap_or_else(|| ending(END));
        let over = |from: f64, to: f64| {
            let spans = self.spans.iter().filter(|span| span.start >= from && span.end <= to);
            spans.copied().reduce(Span::and).or_else(|| self.spans.last().copied()).unwrap_or_default()
        };
        let rms = |span: Span| (span.squares / real(span.samples.max(1))).sqrt();
        // The span in which it settled has larger errors too.
        let after = over(since, end);
        let worst = match settled {
            // Exact up to merged errors.
            Some(since) => {
                self.stairs.iter().find(|stair| stair.at >= since).map_or(after.largest, |stair| stair.error)
            }
            None => after.largest,
        };
        let trend = rms(over(ending(TREND), end)) / rms(over(ending(2.0 * TREND), ending(TREND)));
        Score { first, last, settled, since, rms: rms(after), worst, trend }
    }
}

#[cfg(test)]
mod tests {
    use super::{Score, Scorer};

    /// The score of an error over `count + 1` instants from 0 to 10.
    fn score(count: u32, period: Option<f64>, error: impl Fn(f64) -> f64, truth: impl Fn(f64) -> f64) -> Score {
        let mut scoring = Scorer::new(period);
        for sample in 0..=count {
            let t = 10.0 * f64::from(sample) / f64::from(count);
            scoring.add(t, error(t), truth(t));
        }
        assert!(scoring.spans.len() <= super::SPANS && scoring.stairs.len() < 3000, "{}", scoring.stairs.len());
        scoring.finish()
    }

    #[test]
    fn an_error_that_decays_settles_when_it_is_a_hundredth_of_the_state() {
        for count in [100, 10_000, 1_000_000] {
            let score = score(count, None, |t| -2.0 * (-t).exp(), |t| 4.0 * t.sin());
            // 2 exp(-t) = 0.04, to half a percent of the error and a sample.
            let settled = score.settled.expect("it settles");
            assert!((settled - 50.0_f64.ln()).abs() < 0.006 + 10.0 / f64::from(count), "{count} {settled}");
            assert!((score.first + 2.0).abs() < 1e-12 && score.worst <= 0.04 && score.worst > 0.035, "{score:?}");
            // The root mean square of exp(-t) from there on, within a span or a sample at its start.
            let expected = (0.04_f64.powi(2) / 2.0 / (10.0 - settled)).sqrt();
            assert!(
                (score.rms / expected - 1.0).abs() < 0.05 + 5.0 / f64::from(count),
                "{count} {} {expected}",
                score.rms
            );
            assert!((score.trend - (-2.5_f64).exp()).abs() < 0.03, "{}", score.trend);
        }
    }

    #[test]
    fn an_error_that_comes_back_settles_after_it() {
        let bump = |t: f64| if (t - 6.0).abs() < 0.001 { 1.0 } else { 1e-3 };
        let found = score(10_000, None, bump, |_| 1.0);
        assert!((found.settled.expect("it settles") - 6.0).abs() < 2e-3, "{found:?}");
        assert!((found.rms - 1e-3).abs() < 1e-9 && (found.worst - 1e-3).abs() < 1e-5, "{found:?}");
        // At the very end it does not settle: the score is that of the last tenth.
        let found = score(10_000, None, |t| if t > 9.999 { 1.0 } else { 1e-3 }, |_| 1.0);
        assert_eq!((found.settled, found.since.round()), (None, 9.0));
        assert!((found.worst - 1.0).abs() < 1e-12);
        // Nor does one that is small for a moment at the end.
        let found = score(10_000, None, |t| if t < 9.95 { 1.0 } else { 1e-3 }, |_| 1.0);
        assert_eq!(found.settled, None);
    }

    #[test]
    fn the_threshold_of_settling_depends_on_the_state() {
        // From the start on, of a large state; never, of a small one; of an angle by its period; of a zero by its
        // error.
        let settled = |period, truth: f64| score(100, period, |t| 0.5 * (-t / 50.0).exp(), |_| truth).settled;
        assert_eq!((settled(None, 100.0), settled(None, 1.0)), (Some(0.0), None));
        assert_eq!((settled(Some(100.0), 1.0), settled(None, 0.0)), (Some(0.0), None));
        // NaN is no small error.
        assert_eq!(score(100, None, |_| f64::NAN, |_| 1.0).settled, None);
        assert!(score(100, None, |_| 0.0, |_| 0.0).settled.is_some_and(|t| t < 1e-12));
    }
}
