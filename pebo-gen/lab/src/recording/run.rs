//! Runs the observer over the rows of a log.
//!
//! ```text
//! row 0: y_0 -> observer, u_0 held -> row 1: y_1, u_0 -> observer -> ..
//! ```
//!
//! The same order as in a simulation: the outputs of a row are sampled at its instant, its inputs are held from then
//! on. No more than a row is in memory, and the record of the run does not grow with it.

use std::io::Write;
use std::ops::ControlFlow;

use crate::closed_loop::scenario::ScoredEstimate;
use crate::closed_loop::trace::write_number;
use crate::figure::Sheet;
use crate::figure::label::Label;
use crate::observe::certainty::CertaintyMonitor;
use crate::observe::driver::ObserverDriver;
use crate::observe::excitation::ExcitationMonitor;
use crate::observe::interpreted::observer;
use crate::score::Scorer;
use crate::score::domain::DomainMonitor;
use crate::score::expected::ExpectedErrors;
use crate::summary::{EstimateScore, Summary};
use pebo_design::program::Interpreter;
use pebo_runtime::unwrapped;

use super::clock::{Clock, Instant};
use super::failure::Failure;
use super::fault::{RowFault, RowFaults};
use super::log::{Blank, Log, Next};
use super::panels::Curves;
use super::replayed::{OutputResidual, Replayed};
use super::residual;
use super::scene::Replay;

/// Rows from one evaluation of the excitation to the next.
const GLANCES: u64 = 32;

/// Rows from one report of progress to the next.
const LOOKS: u64 = 1024;

/// Times that are this many durations away from zero are shown from the first row on.
const FAR: f64 = 20.0;

impl Replay {
    /// Runs the observer over all rows; estimates go to `estimates` as CSV, row by row. `watch` gets the numbers of
    /// rows and bytes now and then, and may end the run there.
    pub fn run(
        &self,
        log: &mut Log,
        estimates: Option<&mut dyn Write>,
        watch: &mut dyn FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Replayed, Failure> {
        let mut machine = ReplayState::start(self, estimates)?;
        machine.header()?;
        loop {
            let next = machine.read(log)?;
            let line = match next {
                Next::Row(line) => line,
                Next::Cut(line) => {
                    machine.faults.count(RowFault::Cut, line);
                    break;
                }
                Next::End => break,
            };
            machine.row(line)?;
            if machine.rows % GLANCES == 0 {
                machine.look();
            }
            if machine.rows % LOOKS == 0 && watch(machine.rows, log.bytes()).is_break() {
                return Err(Failure::Stopped { line });
            }
        }
        machine.finish()
    }
}

/// The observer at one row.
struct ReplayState<'a, 'w> {
    replay: &'a Replay,
    clock: Clock,
    signals: Interpreter,
    /// The cells of the row, and the values of their signals.
    cells: Vec<f64>,
    values: Vec<f64>,
    /// All values, see [`Layout`](super::layout::Layout).
    table: Vec<f64>,
    /// The last values of the outputs, with the turns of those that are angles.
    last_outputs: Vec<Option<f64>>,
    driver: ObserverDriver,
    residuals: residual::ResidualState<'a>,
    errors: (Interpreter, Vec<f64>),
    faults: RowFaults,
    curves: Curves<'a>,
    scores: Vec<Scorer>,
    misfits: Vec<Scorer>,
    watch: ExcitationMonitor,
    expected: ExpectedErrors,
    certain: CertaintyMonitor<'a>,
    assumed: DomainMonitor<'a>,
    rows: u64,
    samples: u64,
    /// The first instant, and that of the last accepted sample.
    first: Option<f64>,
    last: f64,
    /// That of the last one that had all outputs.
    whole: f64,
    estimates: Option<&'w mut dyn Write>,
    text: String,
}

impl<'a, 'w> ReplayState<'a, 'w> {
    fn start(replay: &'a Replay, estimates: Option<&'w mut dyn Write>) -> Result<Self, Failure> {
        let Replay { signals, layout, design, residuals, .. } = replay;
        Ok(Self {
            replay,
            clock: Clock::new(signals.period),
            signals: Interpreter::new(&signals.program),
            cells: vec![0.0; signals.wanted.len()],
            values: vec![0.0; signals.program.outputs.len()],
            table: vec![0.0; layout.len()],
            last_outputs: vec![None; layout.y.len()],
            driver: ObserverDriver::new(observer(design).map_err(Failure::Refused)?, design.names.clone()),
            residuals: residuals.start(),
            errors: (Interpreter::new(&replay.errors), vec![0.0; replay.measured.len()]),
            faults: RowFaults::default(),
            curves: replay.panels.start(),
            scores: replay.scored.iter().map(|scored| Scorer::new(scored.period)).collect(),
            // None of these is small in itself: the score is that of the last tenth.
            misfits: residuals.outputs.iter().map(|_| Scorer::new(Some(0.0))).collect(),
            watch: ExcitationMonitor::default(),
            expected: ExpectedErrors::default(),
            certain: CertaintyMonitor::new(&design.wanted),
            assumed: replay.assumed.watch(),
            rows: 0,
            samples: 0,
            first: None,
            last: 0.0,
            whole: 0.0,
            estimates,
            text: String::new(),
        })
    }

    fn read(&mut self, log: &mut Log) -> Result<Next, Failure> {
        let Self { faults, replay, cells, driver, .. } = self;
        let wanted = &replay.signals.wanted;
        // A missing output is no fault for an observer that leaves its row out.
        let is_part = |column: usize, blank| {
            matches!(blank, Blank::Empty) && driver.observer.admits_partial() && replay.signals.of_outputs[column]
        };
        let place = |column: usize| wanted.iter().position(|known| *known == column).unwrap_or_default();
        let mut count = |column, blank, line| {
            if !is_part(place(column), blank) {
                faults.count(RowFault::of_cell(place(column), blank), line);
            }
        };
        log.next(wanted, cells, &mut count).map_err(Failure::Unreadable)
    }

    /// Takes the row that was read.
    fn row(&mut self, line: u64) -> Result<(), Failure> {
        self.rows += 1;
        self.signals.run(&self.cells, &mut self.values);
        let (measured_time, signals) = match self.replay.signals.period {
            Some(_) => (f64::NAN, self.values.as_slice()),
            None => (self.values[0], &self.values[1..]),
        };
        let (t, dt) = match self.clock.row(measured_time) {
            Instant::First(t) => (t, 1.0),
            Instant::Later { t, dt, gap } => {
                if gap {
                    self.faults.count(RowFault::Gap, line);
                }
                (t, dt)
            }
            Instant::Backwards => {
                self.faults.count(RowFault::Backwards, line);
                return Ok(());
            }
            Instant::Timeless => {
                self.faults.count(RowFault::Timeless, line);
                return Ok(());
            }
        };
        self.first.get_or_insert(t);
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
        let inputs = signals[outputs..].to_vec();
        let accepted = self.sample(t, dt, &inputs);
        for (input, value) in inputs.into_iter().enumerate() {
            if value.is_finite() {
                self.table[layout.u.start + input] = value;
            } else {
                self.faults.count(RowFault::Input(input), line);
            }
        }
        self.assumed.look(t, &self.table);
        if accepted {
            // Residuals need a sample with all outputs.
            if self.is_whole() {
                self.residuals.begin(&self.table, &self.table[layout.y.clone()]);
                self.whole = t;
            }
        } else {
            self.table[layout.hat.clone()].fill(f64::NAN);
            self.errors.1.fill(f64::NAN);
        }
        self.curves.add(t, &self.table, &self.errors.1, self.residuals.values());
        self.write(t)
    }

    /// Passes to the observer the outputs at the end of an interval with the inputs of the table; returns true if it
    /// took them.
    fn sample(&mut self, t: f64, dt: f64, inputs: &[f64]) -> bool {
        // It begins where the inputs of the interval to come are known.
        if !self.driver.has_started() && inputs.iter().any(|input| !input.is_finite()) {
            return false;
        }
        let layout = &self.replay.layout;
        // An input holds for an interval, so the time is its mean there. Residuals are of the instant.
        layout.measured_time.into_iter().for_each(|measured_time| self.table[measured_time] = t - dt / 2.0);
        let (given, hat) = self.table.split_at_mut(layout.hat.start);
        let taken = self.driver.arrive(&given[layout.y.clone()], &given[layout.u.clone()], dt, hat);
        layout.measured_time.into_iter().for_each(|measured_time| self.table[measured_time] = t);
        if taken.is_err() {
            return false;
        }
        let since = t - self.whole;
        (self.last, self.samples) = (t, self.samples + 1);
        let is_whole = self.is_whole();
        let layout = &self.replay.layout;
        if is_whole {
            self.residuals.sample(&self.table, &self.table[layout.y.clone()], since);
        }
        if is_whole && self.samples > 1 {
            for (place, misfit) in self.misfits.iter_mut().enumerate() {
                let output = self.replay.residuals.outputs[place].0;
                misfit.add(t, self.residuals.values()[place], self.table[layout.y.start + output]);
            }
        }
        let (errors, values) = &mut self.errors;
        errors.run(&self.table, values);
        for ((score, scored), error) in self.scores.iter_mut().zip(&self.replay.scored).zip(values) {
            // A cell without a number has been counted.
            if error.is_finite() {
                score.add(t, *error, self.table[scored.truth]);
            }
        }
        true
    }

    /// True if all outputs of the row are there.
    fn is_whole(&self) -> bool {
        self.table[self.replay.layout.y.clone()].iter().all(|output| output.is_finite())
    }

    /// Evaluates excitation and certainty.
    fn look(&mut self) {
        self.watch.look(self.last, &self.driver.observer.component_information());
        let predicted = self.driver.standard_errors();
        self.certain.look(self.last, predicted.as_deref());
        self.expected.add(self.last, predicted);
    }

    fn header(&mut self) -> Result<(), Failure> {
        let Some(file) = &mut self.estimates else { return Ok(()) };
        writeln!(file, "{}", self.replay.columns.join(",")).map_err(Failure::Unwritten)
    }

    /// Writes the row, with empty cells for unknown values.
    fn write(&mut self, t: f64) -> Result<(), Failure> {
        let Some(file) = &mut self.estimates else { return Ok(()) };
        let text = &mut self.text;
        text.clear();
        let mut cell = |value: f64| {
            if !text.is_empty() {
                text.push(',');
            }
            if value.is_finite() {
                let written = write_number(text, value);
                debug_assert!(written.is_ok(), "a string takes everything");
            }
        };
        cell(t);
        let mut errors = self.replay.measured.iter().zip(&self.errors.1).peekable();
        for (recovered, hat) in self.table[self.replay.layout.hat.clone()].iter().enumerate() {
            cell(*hat);
            if let Some((_, error)) = errors.next_if(|(state, _)| **state == recovered) {
                cell(*error);
            }
        }
        text.push('\n');
        file.write_all(text.as_bytes()).map_err(Failure::Unwritten)
    }

    fn finish(mut self) -> Result<Replayed, Failure> {
        self.look();
        let Replay { names, panels, residuals, title, design, .. } = self.replay;
        let faults = self.faults.worded([&names.columns, &names.u]);
        let Some(first) = self.first.filter(|_| self.samples > 0) else {
            let refused = self.driver.faults().iter().map(|(reason, _)| reason.to_owned()).collect();
            return Err(Failure::Silent { rows: self.rows, faults, refused });
        };
        let rated = |((scored, score), place): ((&ScoredEstimate, &Scorer), &usize)| {
            let score = score.finish();
            let expected = self.expected.since(score.since, *place);
            EstimateScore { estimate: scored.estimate.clone(), score, expected, step: scored.step, outside: false }
        };
        let misfit = |((output, _), score): (&(usize, bool), &Scorer)| OutputResidual {
            output: names.y[*output].clone(),
            unit: names.units[*output].clone(),
            score: score.finish(),
        };
        let misfits = residuals.outputs.iter().zip(&self.misfits).filter(|_| self.samples > 1);
        let far = first.abs() > FAR * (self.last - first);
        let (zero, name) = if far { (first, "t since the first row") } else { (0.0, "") };
        let mut curves = self.curves.finish();
        curves.iter_mut().flatten().flatten().for_each(|point| point.0 -= zero);
        let time = if far { Label::text(name) } else { Label::name("t") };
        let sheet = Sheet {
            title: (title, Label::text(title).remark("replay")),
            time: ([first - zero, self.last - zero], time),
            panels: panels.panels(),
            curves: &curves,
        };
        Ok(Replayed {
            rows: self.rows,
            start: first,
            summary: Summary {
                end: self.last,
                samples: self.rows - 1,
                estimates: self.replay.scored.iter().zip(&self.scores).zip(&self.replay.measured).map(rated).collect(),
                excitation: self.watch.excitation(&design.unknown_names),
                faults: self.driver.faults().clone(),
                dropped: 0,
                parted: self.driver.parted(),
                restarts: self.driver.restarts(),
                outside: self.assumed.outside(),
                surprise: self.driver.surprise(),
                certainty: self.certain.certainty(),
                known: design.settings.known.clone(),
            },
            residuals: misfits.map(misfit).collect(),
            faults,
            figure: sheet.draw(),
        })
    }
}
