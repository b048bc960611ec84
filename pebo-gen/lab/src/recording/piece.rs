//! A piece of a recording as a source of samples: rows between which the clock goes on.
//!
//! ```text
//! row 0: y_0 -> observer, u_0 held -> row 1: y_1, u_0 -> observer -> ..
//! ```
//!
//! In: rows, one after the other. Out: the sample of each, and in the end the residuals of the outputs over the time since
//! the first. The order is that of a simulation: the outputs of a row are sampled at its instant, its inputs are held from
//! then on. No more than a row is in memory.

use pebo_runtime::{Fault, unwrapped};

use super::failure::Failure;
use super::fault::RowFault;
use super::replayed::OutputResidual;
use super::residual::ResidualState;
use super::scene::Replay;
use super::stream::{Coming, Row, RowStream};
use crate::experiment::layout::{Layout, TIME};
use crate::experiment::source::{Arrival, Due, Sample, Source};
use crate::observe::driver::ObserverDriver;
use crate::score::Scorer;

/// Rows from one evaluation of the excitation to the next.
const GLANCES: u64 = 32;

/// A piece at one row.
pub(super) struct Piece<'a, 'r, 's> {
    replay: &'a Replay,
    layout: &'a Layout,
    stream: &'r mut RowStream<'a, 's>,
    /// True if standard errors are wanted at each row, for a table.
    is_listed: bool,
    /// The last values of the outputs, with the turns of those that are angles.
    last_outputs: Vec<Option<f64>>,
    /// The outputs of the row, and its inputs without the time.
    outputs: Vec<f64>,
    inputs: Vec<f64>,
    /// The inputs as observers take them: during the interval before, then at its end where these are wanted too.
    taken_inputs: Vec<f64>,
    line: u64,
    residuals: ResidualState<'a>,
    misfits: Vec<Scorer>,
    /// Its rows.
    pub(super) rows: u64,
    /// Those of which the observer took the sample.
    samples: u64,
    /// The first instant, and that of the last row.
    first: Option<f64>,
    last: f64,
    /// That of the last sample that had all outputs.
    whole: f64,
    /// True if another piece follows.
    pub(super) goes_on: bool,
}

impl<'a, 'r, 's> Piece<'a, 'r, 's> {
    /// A piece before its first row.
    pub(super) fn new(replay: &'a Replay, stream: &'r mut RowStream<'a, 's>, is_listed: bool) -> Self {
        let layout = &replay.experiment.layout;
        Self {
            replay,
            layout,
            stream,
            is_listed,
            last_outputs: vec![None; layout.y.len()],
            outputs: Vec::new(),
            inputs: Vec::new(),
            taken_inputs: Vec::new(),
            line: 0,
            residuals: replay.residuals.start(),
            // None of these is small in itself: the score is that of the last tenth.
            misfits: replay.residuals.outputs.iter().map(|_| Scorer::new(Some(0.0))).collect(),
            rows: 0,
            samples: 0,
            first: None,
            last: 0.0,
            whole: 0.0,
            goes_on: false,
        }
    }

    /// The first instant.
    pub(super) fn start(&self) -> f64 {
        self.first.unwrap_or_default()
    }

    /// The time from the first row to the last.
    pub(super) fn duration(&self) -> f64 {
        self.last - self.first.unwrap_or(self.last)
    }

    /// The same with the usual time from row to row, until another piece begins.
    pub(super) fn room(&self) -> f64 {
        let duration = self.duration();
        duration + duration / crate::timing::real(self.rows.saturating_sub(1).max(1))
    }

    /// The residuals of the outputs.
    pub(super) fn residuals(&self) -> Vec<OutputResidual> {
        let Replay { experiment, names, residuals, .. } = self.replay;
        let misfit = |((output, _), score): (&(usize, bool), &Scorer)| OutputResidual {
            output: experiment.design.names.outputs[*output].clone(),
            unit: names.units[*output].clone(),
            score: score.finish(),
        };
        let misfits = residuals.outputs.iter().zip(&self.misfits).filter(|_| self.samples > 1);
        misfits.map(misfit).collect()
    }

    /// Counts turns of outputs that are angles; the first one begins the count.
    fn unwrap(&mut self) {
        let periods = &self.replay.experiment.design.periods;
        for ((angle, last), period) in self.outputs.iter_mut().zip(&mut self.last_outputs).zip(periods) {
            if angle.is_finite() {
                *angle = unwrapped(*angle, last.unwrap_or(*angle), *period);
                *last = Some(*angle);
            }
        }
    }

    /// Holds the inputs that have a value.
    fn hold(&self, table: &mut [f64]) {
        let cells = table[self.layout.u.clone()].iter_mut();
        cells.zip(&self.inputs).filter(|(_, value)| value.is_finite()).for_each(|(cell, value)| *cell = *value);
    }

    /// True if all outputs of the row are there.
    fn is_whole(&self) -> bool {
        self.outputs.iter().all(|output| output.is_finite())
    }

    /// Compares a sample that was taken with the estimates.
    fn compare(&mut self, table: &mut [f64]) {
        self.samples += 1;
        if !self.is_whole() {
            return;
        }
        self.residuals.sample(table, &self.outputs, self.last - self.whole);
        table[self.layout.residuals.clone()].copy_from_slice(self.residuals.values());
        if self.samples > 1 {
            let elapsed = self.duration();
            let places = self.misfits.iter_mut().zip(&self.replay.residuals.outputs).zip(self.residuals.values());
            for ((misfit, (output, _)), residual) in places {
                misfit.add(elapsed, *residual, self.outputs[*output]);
            }
        }
    }
}

impl Source for Piece<'_, '_, '_> {
    type Failure = Failure;

    fn next(&mut self, table: &mut [f64]) -> Result<Option<Sample<'_>>, Failure> {
        let coming = self.stream.next()?;
        self.goes_on = matches!(coming, Coming::Piece);
        let Coming::Row(Row { line, signals, .. }, t, dt) = coming else { return Ok(None) };
        let has_begun = self.samples > 0;
        let Layout { x, y, u, measured_time, .. } = self.layout;
        self.first.get_or_insert(t);
        (self.rows, self.last, self.line) = (self.rows + 1, t, line);
        table[TIME] = t;
        let (states, others) = signals.split_at(x.len());
        let (outputs, inputs) = others.split_at(y.len());
        table[x.clone()].copy_from_slice(states);
        (self.outputs, self.inputs) = (outputs.to_vec(), inputs.to_vec());
        self.unwrap();
        table[y.clone()].copy_from_slice(&self.outputs);
        if self.rows == 1 {
            // An output with feedthrough has the first input at the first row.
            self.hold(table);
        }
        // The observer's first call gives its step no effect.
        let dt = dt.unwrap_or(1.0);
        let elapsed = self.duration();
        // It begins where the inputs of the interval to come are known.
        if !has_begun && self.inputs.iter().any(|input| !input.is_finite()) {
            return Ok(Some(Sample { elapsed, dt, truth: None, own: Arrival::Early, outputs: None, inputs: &[] }));
        }
        // An input holds for an interval, so the time is its mean there.
        if let Some(place) = *measured_time {
            table[place] = t - dt / 2.0;
        }
        self.taken_inputs.clear();
        self.taken_inputs.extend(&table[u.clone()]);
        if self.replay.experiment.design.with_instant {
            let instant = self.inputs.iter().zip(&table[u.clone()]);
            self.taken_inputs.extend(instant.map(|(now, before)| if now.is_finite() { now } else { before }));
            self.taken_inputs.extend(measured_time.map(|_| t));
        }
        // Residuals are of the instant.
        if let Some(place) = *measured_time {
            table[place] = t;
        }
        let own = Arrival::Whole(&self.outputs);
        Ok(Some(Sample { elapsed, dt, truth: None, own, outputs: Some(&self.outputs), inputs: &self.taken_inputs }))
    }

    fn settle(
        &mut self,
        table: &mut [f64],
        _: &ObserverDriver,
        taken: Option<Result<(), Fault>>,
    ) -> Result<Due, Failure> {
        let is_taken = taken == Some(Ok(()));
        if is_taken {
            if self.replay.experiment.design.with_instant {
                self.hold(table);
            }
            self.compare(table);
        } else {
            table[self.layout.hat.clone()].fill(f64::NAN);
        }
        for (input, value) in self.inputs.iter().enumerate() {
            if !value.is_finite() {
                self.stream.faults.count(RowFault::Input(input), self.line);
            }
        }
        self.hold(table);
        // Residuals need a sample with all outputs.
        if is_taken && self.is_whole() {
            self.residuals.begin(table, &self.outputs);
            self.whole = self.last;
        }
        Ok(Due {
            scores: is_taken,
            standard_errors: !is_taken || self.is_listed || self.rows % GLANCES == 1,
            monitors: self.rows.is_multiple_of(GLANCES),
        })
    }
}
