//! Runs the observer over one piece of a recording: rows between which the clock goes on.
//!
//! ```text
//! row 0: y_0 -> observer, u_0 held -> row 1: y_1, u_0 -> observer -> ..
//! ```
//!
//! In: rows, one after the other. Out: the table of each, and in the end errors, excitation and residuals over the time
//! since the first row. The order is that of a simulation: the outputs of a row are sampled at its instant, its inputs
//! are held from then on. No more than a row is in memory.

use crate::closed_loop::baseline::Follower;
use crate::closed_loop::scenario::ScoredEstimate;
use crate::observe::certainty::CertaintyMonitor;
use crate::observe::driver::ObserverDriver;
use crate::observe::excitation::ExcitationMonitor;
use crate::observe::padded::observer;
use crate::score::Scorer;
use crate::score::domain::DomainMonitor;
use crate::score::expected::ExpectedErrors;
use crate::summary::{EstimateScore, Summary, contradiction, standing_out};
use pebo_design::program::Interpreter;
use pebo_runtime::unwrapped;

use super::clock::{Clock, Held, Instant};
use super::failure::Failure;
use super::fault::{RowFault, RowFaults};
use super::replayed::OutputResidual;
use super::residual;
use super::scene::Replay;

/// Rows from one evaluation of the excitation to the next.
const GLANCES: u64 = 32;

/// The observer and its scores at one row of a piece.
pub(super) struct Piece<'a> {
    replay: &'a Replay,
    clock: Clock,
    /// All values, see [`Layout`](super::layout::Layout).
    pub(super) table: Vec<f64>,
    /// The last values of the outputs, with the turns of those that are angles.
    last_outputs: Vec<Option<f64>>,
    driver: ObserverDriver,
    followers: Vec<Box<dyn Follower>>,
    residuals: residual::ResidualState<'a>,
    errors: (Interpreter, Vec<f64>),
    scores: Vec<Scorer>,
    misfits: Vec<Scorer>,
    watch: ExcitationMonitor,
    expected: ExpectedErrors,
    certain: CertaintyMonitor<'a>,
    assumed: DomainMonitor<'a>,
    /// Its rows, and those of which a sample was taken.
    pub(super) rows: u64,
    samples: u64,
    /// The first instant, and that of the last row.
    first: Option<f64>,
    last: f64,
    /// That of the last sample that was taken, and of the last one that had all outputs.
    taken: f64,
    whole: f64,
}

/// A row of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) enum Placed {
    /// It was taken, at this instant.
    At(f64),
    /// It has no time, which was counted.
    Timeless,
    /// It is astray, and to be held.
    Astray,
}

/// The result of a piece.
#[derive(Debug)]
pub(super) struct PieceResult {
    pub(super) rows: u64,
    /// The first instant.
    pub(super) start: f64,
    pub(super) summary: Summary,
    pub(super) residuals: Vec<OutputResidual>,
}

impl<'a> Piece<'a> {
    /// A piece before its first row; with every sample judged, or some of them.
    pub(super) fn start(replay: &'a Replay, judges_each: bool) -> Result<Self, Failure> {
        let Replay { signals, layout, design, residuals, .. } = replay;
        let driver = ObserverDriver::new(observer(design).map_err(Failure::Refused)?, design.names.clone());
        Ok(Self {
            replay,
            clock: Clock::new(signals.period),
            table: vec![0.0; layout.len()],
            last_outputs: vec![None; layout.y.len()],
            driver: if judges_each { driver.judging_each() } else { driver.judging_first() },
            followers: Vec::new(),
            residuals: residuals.start(),
            errors: (Interpreter::new(&replay.errors), vec![0.0; replay.scored.len()]),
            scores: replay.scored.iter().map(|scored| Scorer::new(scored.period)).collect(),
            // None of these is small in itself: the score is that of the last tenth.
            misfits: residuals.outputs.iter().map(|_| Scorer::new(Some(0.0))).collect(),
            watch: ExcitationMonitor::beside(&design.fixed),
            expected: ExpectedErrors::default(),
            certain: CertaintyMonitor::new(&design.wanted),
            assumed: replay.assumed.watch(),
            rows: 0,
            samples: 0,
            first: None,
            last: 0.0,
            taken: 0.0,
            whole: 0.0,
        })
    }

    /// True if missing outputs are no fault for the observer.
    pub(super) fn admits_partial(&self) -> bool {
        self.driver.observer.admits_partial()
    }

    /// The errors of the estimates that are compared.
    pub(super) fn errors(&self) -> &[f64] {
        &self.errors.1
    }

    /// The residuals of the outputs.
    pub(super) fn residuals(&self) -> &[f64] {
        self.residuals.values()
    }

    /// The time from the first row to an instant.
    pub(super) fn since_start(&self, t: f64) -> f64 {
        t - self.first.unwrap_or(t)
    }

    /// The time from the first row to the last, and the usual one from row to row.
    pub(super) fn duration(&self) -> (f64, f64) {
        let duration = self.since_start(self.last);
        (duration, duration / crate::timing::real(self.rows.saturating_sub(1).max(1)))
    }

    /// Takes a row with its time, where that is recorded, and its signals; `is_listed` if its standard errors are wanted
    /// for a table.
    pub(super) fn row(
        &mut self,
        (line, measured_time): (u64, f64),
        signals: &[f64],
        is_listed: bool,
        faults: &mut RowFaults,
    ) -> (Placed, Held) {
        let (instant, held) = self.clock.row(measured_time);
        let (t, dt) = match instant {
            Instant::First(t) => (t, None),
            Instant::Later { t, dt, gap } => {
                if gap {
                    faults.count(RowFault::Gap, line);
                }
                (t, Some(dt))
            }
            Instant::Astray => return (Placed::Astray, held),
            Instant::Timeless => {
                faults.count(RowFault::Timeless, line);
                return (Placed::Timeless, held);
            }
        };
        self.first.get_or_insert(t);
        (self.rows, self.last) = (self.rows + 1, t);
        let layout = &self.replay.layout;
        let outputs = layout.y.end;
        self.table[..outputs].copy_from_slice(&signals[..outputs]);
        let periods = &self.replay.design.periods;
        for ((angle, last), period) in self.table[layout.y.clone()].iter_mut().zip(&mut self.last_outputs).zip(periods)
        {
            if angle.is_finite() {
                // The first one begins the count of turns.
                *angle = unwrapped(*angle, last.unwrap_or(*angle), *period);
                *last = Some(*angle);
            }
        }
        let inputs = &signals[outputs..];
        if self.rows == 1 {
            // An output with feedthrough has the first input at the first row.
            self.hold(inputs);
        }
        let accepted = self.sample(t, dt, inputs);
        for (input, value) in inputs.iter().enumerate() {
            if !value.is_finite() {
                faults.count(RowFault::Input(input), line);
            }
        }
        self.hold(inputs);
        self.assumed.look(self.since_start(t), &self.table);
        if !accepted || is_listed || self.rows % GLANCES == 1 {
            self.predict(accepted);
        }
        if accepted {
            // Residuals need a sample with all outputs.
            if self.is_whole() {
                let y = self.replay.layout.y.clone();
                self.residuals.begin(&self.table, &self.table[y]);
                self.whole = t;
            }
        } else {
            self.table[self.replay.layout.hat.clone()].fill(f64::NAN);
            self.errors.1.fill(f64::NAN);
        }
        if self.rows.is_multiple_of(GLANCES) {
            self.look();
        }
        (Placed::At(t), held)
    }

    /// Holds the inputs that have a value.
    fn hold(&mut self, inputs: &[f64]) {
        let cells = self.table[self.replay.layout.u.clone()].iter_mut();
        cells.zip(inputs).filter(|(_, value)| value.is_finite()).for_each(|(cell, value)| *cell = *value);
    }

    /// Passes to the observer the outputs at the end of an interval, which the first row has not, with the inputs of the
    /// table; returns true if it took them.
    fn sample(&mut self, t: f64, dt: Option<f64>, inputs: &[f64]) -> bool {
        // It begins where the inputs of the interval to come are known.
        if !self.driver.has_started() && inputs.iter().any(|input| !input.is_finite()) {
            return false;
        }
        let layout = &self.replay.layout;
        // The observer's first call gives its step no effect.
        let step = dt.unwrap_or(1.0);
        // An input holds for an interval, so the time is its mean there. Residuals are of the instant.
        layout.measured_time.into_iter().for_each(|measured_time| self.table[measured_time] = t - step / 2.0);
        let (given, hat) = self.table.split_at_mut(layout.hat.start);
        let (y, u) = (&given[layout.y.clone()], &given[layout.u.clone()]);
        let is_first = !self.driver.has_started();
        let with_instant = self.replay.design.with_instant;
        let instant = inputs.iter().zip(u).filter(|_| with_instant);
        let instant = instant.map(|(now, before)| if now.is_finite() { *now } else { *before });
        let time = layout.measured_time.filter(|_| with_instant).map(|_| t);
        let both: Vec<f64> = u.iter().copied().chain(instant).chain(time).collect();
        let taken = self.driver.arrive(y, &both, step, &mut hat[..layout.hat.len()]);
        let after = if with_instant { &both[u.len()..] } else { u };
        if is_first {
            let begun = self.replay.baselines.iter().filter(|_| taken.is_ok());
            self.followers = begun.map(|(_, sampled)| sampled.follower(None, y)).collect();
        } else {
            self.followers.iter_mut().for_each(|follower| follower.sample(Some(y), [u, after], step));
        }
        layout.measured_time.into_iter().for_each(|measured_time| self.table[measured_time] = t);
        for ((place, _), follower) in self.replay.baselines.iter().zip(&self.followers) {
            follower.write(&mut self.table[place.clone()]);
        }
        if taken.is_err() {
            return false;
        }
        if with_instant {
            self.hold(inputs);
        }
        let (since, whole) = (t - self.whole, self.is_whole());
        (self.taken, self.samples) = (t, self.samples + 1);
        if whole {
            let y = self.replay.layout.y.clone();
            self.residuals.sample(&self.table, &self.table[y], since);
        }
        let elapsed = self.since_start(t);
        if whole && self.samples > 1 {
            for (place, misfit) in self.misfits.iter_mut().enumerate() {
                let output = self.replay.residuals.outputs[place].0;
                misfit.add(elapsed, self.residuals.values()[place], self.table[self.replay.layout.y.start + output]);
            }
        }
        let (errors, values) = &mut self.errors;
        errors.run(&self.table, values);
        for ((score, scored), error) in self.scores.iter_mut().zip(&self.replay.scored).zip(values) {
            // A cell without a number has been counted.
            if error.is_finite() {
                score.add(elapsed, *error, self.table[scored.truth]);
            }
        }
        true
    }

    /// True if all outputs of the row are there.
    fn is_whole(&self) -> bool {
        self.table[self.replay.layout.y.clone()].iter().all(|output| output.is_finite())
    }

    /// Writes the standard errors of the row's estimates into the table.
    fn predict(&mut self, accepted: bool) {
        let place = self.replay.layout.standard_errors.clone();
        let known = Some(()).filter(|()| accepted && !place.is_empty()).and_then(|()| self.driver.standard_errors());
        let known = known.into_iter().flatten().chain(std::iter::repeat(f64::NAN));
        self.table[place].iter_mut().zip(known).for_each(|(cell, value)| *cell = value);
    }

    /// Evaluates excitation and certainty.
    fn look(&mut self) {
        let t = self.since_start(self.taken);
        let predicted = self.driver.standard_errors();
        self.watch.look(t, &self.driver.observer.component_information(), predicted.as_deref());
        self.certain.look(t, predicted.as_deref());
        self.expected.add(t, predicted);
    }

    /// The logarithm of the likelihood of the judged samples, and their number.
    pub(super) fn likelihood(&self) -> Option<(f64, f64)> {
        Some((self.driver.likelihood()?, crate::timing::real(self.driver.judged())))
    }

    /// The reasons for which the observer refused samples.
    pub(super) fn refusals(&self) -> Vec<String> {
        self.driver.faults().iter().map(|(reason, _)| reason.to_owned()).collect()
    }

    /// The result after the last row; none where no sample was taken.
    pub(super) fn finish(&mut self) -> Option<PieceResult> {
        let start = self.first.filter(|_| self.samples > 0)?;
        self.look();
        let Replay { names, residuals, design, scored, measured, .. } = self.replay;
        let surprise = self.driver.surprise();
        let contradiction = contradiction(&self.driver, true).or_else(|| standing_out(&self.driver));
        let rated = |(place, (scored, score)): (usize, (&ScoredEstimate, &Scorer))| {
            let score = score.finish();
            let own = measured.get(place).filter(|_| contradiction.is_none());
            let expected = own.and_then(|estimate| self.expected.beside(&score, *estimate));
            EstimateScore { estimate: scored.estimate.clone(), score, expected, step: scored.step, outside: false }
        };
        let misfit = |((output, _), score): (&(usize, bool), &Scorer)| OutputResidual {
            output: names.y[*output].clone(),
            unit: names.units[*output].clone(),
            score: score.finish(),
        };
        let misfits = residuals.outputs.iter().zip(&self.misfits).filter(|_| self.samples > 1);
        Some(PieceResult {
            rows: self.rows,
            start,
            summary: Summary {
                end: self.since_start(self.taken),
                samples: self.rows - 1,
                estimates: scored.iter().zip(&self.scores).enumerate().map(rated).collect(),
                excitation: self.watch.excitation(&design.unknown_names),
                faults: self.driver.faults().clone(),
                dropped: 0,
                parted: self.driver.parted(),
                stateless: self.driver.stateless(),
                restarts: self.driver.restarts(),
                outside: self.assumed.outside(),
                surprise,
                typical: self.driver.typical(),
                contradiction,
                certainty: self.certain.certainty(),
                known: design.settings.known.clone(),
            },
            residuals: misfits.map(misfit).collect(),
        })
    }
}
