//! Runs the closed loop, sample by sample.
//!
//! ```text
//! y_0 -> observer -> u_0 -> plant over one step, u_0 held -> y_1, u_0 -> observer -> u_1 -> ..
//! ```
//!
//! Between y and the observers are the sensors, whose samples may be late, wrong, or missing. The instants may move
//! at which the loop samples and sets its inputs; observers get the nominal period.

use std::ops::ControlFlow;

use pebo_design::program::{Interpreter, Program};
use pebo_runtime::unwrapped;

use super::baseline::Follower;
use super::failure::Failure;
use super::growth::Growth;
use super::layout::TIME;
use super::ode::Flow;
use super::ode::equation::Standstill;
use super::scenario::{Scenario, ScoredEstimate};
use super::sensor::SensorState;
use super::signal::SignalCursor;
use super::trace::Trace;
use crate::figure::curve::{Curve, drawn};
use crate::observe::certainty::CertaintyMonitor;
use crate::observe::driver::ObserverDriver;
use crate::observe::excitation::ExcitationMonitor;
use crate::observe::padded::observer;
use crate::score::Scorer;
use crate::score::expected::ExpectedErrors;
use crate::summary::{EstimateScore, Summary, contradiction};
use crate::timing::real;

/// The number of reports of progress.
const REPORTS: u64 = 500;

impl Scenario {
    /// Runs the loop from its start to its end.
    pub fn run(&self) -> Result<Trace, Failure> {
        self.run_while(&mut |_| ControlFlow::Continue(()))
    }

    /// [`run`](Self::run) with reports: `progress` gets the finished share, 0 to 1, now and then, and may end the run
    /// with [`Failure::Stopped`].
    pub fn run_while(&self, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Trace, Failure> {
        let mut record = Record::new(self);
        let summary = self.follow(&mut |sample, table| record.take(sample, table), progress)?;
        Ok(record.finish(summary))
    }

    /// Runs the loop, passes its table at each sample to `show`, and returns the summary.
    pub(crate) fn follow(
        &self,
        show: &mut dyn FnMut(u64, Snapshot<'_>),
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Summary, Failure> {
        let mut machine = LoopState::start(self)?;
        let mut errors = Formulas::new(&self.errors);
        let mut scores: Vec<Scorer> = self.scored.iter().map(|scored| Scorer::new(scored.period)).collect();
        let (mut watch, mut expected) = (ExcitationMonitor::beside(&self.design.fixed), ExpectedErrors::default());
        let mut certain = CertaintyMonitor::new(&self.design.wanted);
        let mut assumed = self.assumed.watch();
        let mut outside = vec![false; self.scored.len()];
        let samples = self.timing.samples;
        let mut next_row = 0;
        let stride = (samples / REPORTS).max(1);
        for sample in 0..=samples {
            if sample > 0 {
                machine.advance(sample)?;
            }
            machine.control()?;
            let table = &machine.table;
            assumed.look(table[TIME], table);
            let errors = errors.of(table);
            for ((score, scored), error) in scores.iter_mut().zip(&self.scored).zip(errors) {
                score.add(table[TIME], *error, table[scored.truth]);
            }
            for (place, (outside, scored)) in outside.iter_mut().zip(&self.scored).enumerate() {
                *outside |= scored.estimate.baseline.is_none() && self.design.is_outside(place, table[scored.truth]);
            }
            let is_row = sample == self.timing.sample_of_row(next_row);
            next_row += u64::from(is_row);
            let is_report = sample % stride == 0 || sample == samples;
            let predicted = if is_row || is_report { machine.predict() } else { None };
            let table = &machine.table;
            show(sample, Snapshot { table, errors, is_row });
            if is_report {
                let information = machine.driver.observer.component_information();
                watch.look(table[TIME], &information, predicted.as_deref());
                certain.look(table[TIME], predicted.as_deref());
                expected.add(table[TIME], predicted);
            }
            if sample % stride == 0 && progress(real(sample) / real(samples)).is_break() {
                return Err(Failure::Stopped { at: machine.table[TIME] });
            }
        }
        let surprise = machine.driver.surprise();
        let contradiction = contradiction(&machine.driver, self.is_noisy());
        let rated = |(place, (scored, score)): (usize, (&ScoredEstimate, &Scorer))| {
            let score = score.finish();
            let own = scored.estimate.baseline.is_none() && contradiction.is_none();
            let expected = own.then(|| expected.beside(&score, place)).flatten();
            EstimateScore {
                estimate: scored.estimate.clone(),
                score,
                expected,
                step: scored.step,
                outside: outside[place],
            }
        };
        Ok(Summary {
            end: machine.table[TIME],
            samples,
            estimates: self.scored.iter().zip(&scores).enumerate().map(rated).collect(),
            excitation: watch.excitation(&self.design.unknown_names),
            faults: machine.driver.faults().clone(),
            dropped: machine.driver.dropped(),
            parted: machine.driver.parted(),
            stateless: machine.driver.stateless(),
            restarts: machine.driver.restarts(),
            outside: assumed.outside(),
            surprise,
            typical: machine.driver.typical(),
            contradiction,
            certainty: certain.certainty(),
            known: self.design.settings.known.clone(),
        })
    }
}

/// The loop's values at a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Snapshot<'a> {
    /// All values.
    pub(crate) table: &'a [f64],
    /// The errors of the estimates.
    pub(crate) errors: &'a [f64],
    /// True if it is a row of the table.
    pub(crate) is_row: bool,
}

/// A program with room for its values.
#[derive(Debug)]
struct Formulas {
    interpreter: Interpreter,
    values: Vec<f64>,
}

impl Formulas {
    fn new(program: &Program) -> Self {
        Self { interpreter: Interpreter::new(program), values: vec![0.0; program.outputs.len()] }
    }

    fn of(&mut self, table: &[f64]) -> &[f64] {
        self.interpreter.run(table, &mut self.values);
        &self.values
    }
}

/// The loop at one sample.
#[derive(Debug)]
pub(crate) struct LoopState<'a> {
    scenario: &'a Scenario,
    /// All values, see [`Layout`](super::layout::Layout).
    pub(crate) table: Vec<f64>,
    pub(crate) driver: ObserverDriver,
    flow: Flow,
    growth: Growth,
    sensor_state: SensorState<'a>,
    signals: Vec<SignalCursor>,
    given: Formulas,
    measured: Formulas,
    baselines: Formulas,
    followers: Vec<Box<dyn Follower>>,
    control: Formulas,
}

impl<'a> LoopState<'a> {
    /// The loop at its first sample, before the first control.
    pub(crate) fn start(scenario: &'a Scenario) -> Result<Self, Failure> {
        let layout = &scenario.layout;
        let refused = |fault| Failure::Refused { at: 0.0, samples: 1, fault };
        let positions = layout.signals.clone().zip(&scenario.signals);
        let mut machine = Self {
            scenario,
            table: vec![0.0; layout.symbols.len()],
            driver: ObserverDriver::new(observer(&scenario.design).map_err(refused)?, scenario.design.names.clone()),
            sensor_state: scenario.sensors.begin(scenario.seed, scenario.timing.slack()),
            flow: Flow::new(
                (&scenario.rates, Some(&scenario.slopes)),
                scenario.switches.as_ref(),
                layout.state.clone(),
                &positions.collect::<Vec<_>>(),
                scenario.timing.slack(),
            )
            .until(scenario.timing.at(scenario.timing.samples)),
            growth: Growth::new(&[]),
            signals: scenario.signals.iter().map(super::signal::Signal::course).collect(),
            given: Formulas::new(&scenario.given.1),
            measured: Formulas::new(&scenario.measured),
            baselines: Formulas::new(&scenario.baseline_estimates),
            followers: Vec::new(),
            control: Formulas::new(&scenario.control),
        };
        machine.read_signals();
        let mut start = Formulas::new(&scenario.start);
        // An output with feedthrough has the input that the law would have set before the start, a law may have the
        // output, and baselines start from the sensors' samples: one round each.
        for _ in 0..3 {
            machine.set_inputs();
            let layout = &scenario.layout;
            let inputs = &mut machine.table[layout.u.clone()];
            // The law may need what is not there yet.
            inputs.iter_mut().filter(|input| !input.is_finite()).for_each(|input| *input = 0.0);
            let state = start.of(&machine.table);
            machine.table[layout.state.clone()].copy_from_slice(state);
            machine.sensor_state = scenario.sensors.begin(scenario.seed, scenario.timing.slack());
            machine.measure(0);
        }
        machine.admit(layout.state.clone())?;
        machine.growth = Growth::new(&machine.table[layout.state.clone()]);
        let (x, y) = (&machine.table[layout.x.clone()], &machine.measured.values);
        let followers = scenario.followers.iter();
        machine.followers = followers.map(|(_, sampled)| sampled.follower(Some(x), y)).collect();
        machine.estimate(0, true)?;
        Ok(machine)
    }

    /// Goes on to this sample, with the inputs held.
    pub(crate) fn advance(&mut self, sample: u64) -> Result<(), Failure> {
        let Scenario { timing, sensors, seed, .. } = self.scenario;
        let (from, to) = (self.table[TIME], sensors.instant(timing, *seed, sample));
        if let Err(standstill) = self.flow.advance(&mut self.table, from, to) {
            return Err(self.standstill(standstill));
        }
        self.table[TIME] = to;
        self.read_signals();
        let given = self.given.of(&self.table);
        for (position, value) in self.scenario.given.0.iter().zip(given) {
            self.table[*position] = *value;
        }
        let arrives = self.measure(sample);
        if let Some(measured_time) = self.scenario.layout.measured_time {
            // An input holds for an interval, so the time is its mean there. Nobody measures how far it is from its place.
            self.table[measured_time] = timing.at(sample) - timing.step / 2.0;
        }
        let state = self.scenario.layout.state.clone();
        self.admit(state.clone())
            .map_err(|failure| self.diverged(&self.table[state.clone()], to).unwrap_or(failure))?;
        self.growth.add(&self.table[state]);
        if !self.followers.is_empty() {
            let mut y = self.measured.values.clone();
            self.scenario.sensors.leave_out(sample, &mut y);
            let y = Some(y.as_slice()).filter(|_| arrives);
            let u = &self.table[self.scenario.layout.u.clone()];
            self.followers.iter_mut().for_each(|follower| follower.sample(y, [u, u], self.scenario.timing.step));
        }
        self.estimate(sample, arrives)
    }

    /// The failure for a standstill of the integration.
    fn standstill(&self, Standstill { steps, at, state, fast }: Standstill) -> Failure {
        let slow = fast.map(|(place, rate)| Failure::Slow {
            at,
            steps,
            fastest: self.scenario.names[self.scenario.layout.state.start + place].clone(),
            constant: 1.0 / rate,
        });
        self.diverged(&state, at).or(slow).unwrap_or(Failure::Stuck { at, steps })
    }

    /// The state that runs away, if one does.
    fn diverged(&self, state: &[f64], at: f64) -> Option<Failure> {
        let (place, value) = self.growth.away(state)?;
        let name = self.scenario.names[self.scenario.layout.state.start + place].clone();
        Some(Failure::Diverged { name, value, at })
    }

    /// Sets the inputs for the interval to come.
    pub(crate) fn control(&mut self) -> Result<(), Failure> {
        self.set_inputs();
        self.admit(self.scenario.layout.u.clone())
    }

    fn set_inputs(&mut self) {
        let inputs = self.control.of(&self.table);
        self.table[self.scenario.layout.u.clone()].copy_from_slice(inputs);
    }

    fn read_signals(&mut self) {
        let t = self.table[TIME];
        for (position, signal) in self.scenario.layout.signals.clone().zip(&mut self.signals) {
            signal.select(t + self.scenario.timing.slack());
            self.table[position] = signal.value(t);
        }
    }

    /// Lets the sensors take this sample into `measured`; returns true if it arrives.
    fn measure(&mut self, sample: u64) -> bool {
        let layout = &self.scenario.layout;
        let (before, after) = self.table.split_at_mut(layout.last_samples.start);
        let (outputs, last_samples) = (&before[layout.y.clone()], &mut after[..layout.last_samples.len()]);
        let arrives = self.sensor_state.sample(sample, before[TIME], outputs, last_samples);
        self.measured.of(&self.table);
        arrives
    }

    /// Passes the present sample, if it arrives, and the inputs of the interval before to all observers.
    fn estimate(&mut self, sample: u64, arrives: bool) -> Result<(), Failure> {
        let layout = &self.scenario.layout;
        for ((place, _), follower) in self.scenario.followers.iter().zip(&self.followers) {
            follower.write(&mut self.table[place.clone()]);
            self.admit(place.clone())?;
        }
        let estimates = self.baselines.of(&self.table);
        self.table[layout.baseline_estimates.clone()].copy_from_slice(estimates);
        // The observer's first call gives its step no effect.
        let y = &mut self.measured.values;
        if self.driver.observer.admits_partial() {
            self.scenario.sensors.leave_out(sample, y);
        }
        let (before, after) = self.table.split_at_mut(layout.hat.start);
        let hat = &mut after[..layout.hat.len()];
        let (u, step) = (&before[layout.u.clone()], self.scenario.timing.step);
        if !arrives {
            self.driver.miss(y.len(), u, step, hat);
            return Ok(());
        }
        // The sensor of an angle reads it within a turn.
        for (angle, period) in y.iter_mut().zip(&self.scenario.design.periods) {
            *angle = unwrapped(*angle, 0.0, *period);
        }
        match self.driver.arrive(y, u, step, hat) {
            Err(fault) if self.driver.has_given_up() => {
                let samples = self.driver.refused();
                let first = sample.saturating_sub(samples.saturating_sub(1));
                Err(Failure::Refused { at: self.scenario.timing.at(first), samples, fault })
            }
            _ => Ok(()),
        }
    }

    /// Writes the standard errors that the observer predicts into the table.
    fn predict(&mut self) -> Option<Vec<f64>> {
        let predicted = self.driver.standard_errors();
        let place = self.scenario.layout.standard_errors.clone();
        let known = predicted.iter().flatten().copied().chain(std::iter::repeat(f64::NAN));
        self.table[place].iter_mut().zip(known).for_each(|(cell, value)| *cell = value);
        predicted
    }

    /// Checks that the values at these positions are finite.
    fn admit(&self, range: std::ops::Range<usize>) -> Result<(), Failure> {
        match range.into_iter().find(|position| !self.table[*position].is_finite()) {
            None => Ok(()),
            Some(position) => {
                Err(Failure::NotFinite { name: self.scenario.names[position].clone(), at: self.table[TIME] })
            }
        }
    }
}

/// The rows and curves that are kept of a run.
#[derive(Debug)]
struct Record<'a> {
    scenario: &'a Scenario,
    rows: Vec<f64>,
    measured: Formulas,
    values: Formulas,
    curves: Vec<Curve>,
}

impl<'a> Record<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        Self {
            scenario,
            rows: Vec::new(),
            measured: Formulas::new(&scenario.measured),
            values: Formulas::new(&scenario.curves),
            curves: vec![Curve::default(); scenario.curves.outputs.len()],
        }
    }

    fn take(&mut self, sample: u64, Snapshot { table, errors, is_row }: Snapshot<'_>) {
        let timing = &self.scenario.timing;
        for (curve, value) in self.curves.iter_mut().zip(self.values.of(table)) {
            curve.add(sample, timing.samples, (table[TIME], *value));
        }
        if !is_row {
            return;
        }
        let layout = &self.scenario.layout;
        self.rows.push(table[TIME]);
        self.rows.extend(&table[layout.x.clone()]);
        self.rows.extend(self.measured.of(table));
        self.rows.extend(&table[layout.commanded()]);
        // The errors of the observer's estimates are the first.
        for (hat, error) in table[layout.hat.clone()].iter().zip(errors) {
            self.rows.extend([*hat, *error]);
        }
        self.rows.extend(&table[layout.baseline_estimates.clone()]);
        self.rows.extend(&table[layout.standard_errors.clone()]);
    }

    fn finish(self, summary: Summary) -> Trace {
        let curves = drawn(&self.scenario.panels, self.curves.into_iter().map(Curve::finish));
        Trace::new((self.scenario.columns.clone(), self.rows), curves, summary)
    }
}
