//! The simulated plant as a source of samples.
//!
//! ```text
//! y_0 -> observer -> u_0 -> plant over one step, u_0 held -> y_1, u_0 -> observer -> u_1 -> ..
//! ```
//!
//! Between y and the observers are the sensors, whose samples may be late, wrong, or missing. The instants may move
//! at which the loop samples and sets its inputs; observers get the nominal period.

use std::ops::{ControlFlow, Range};

use pebo_runtime::{Fault, unwrapped};

use super::failure::Failure;
use super::growth::Growth;
use super::ode::Flow;
use super::ode::equation::Standstill;
use super::scenario::Scenario;
use super::sensor::SensorState;
use super::signal::{Signal, SignalCursor};
use crate::experiment::formulas::Formulas;
use crate::experiment::layout::{Layout, TIME};
use crate::experiment::source::{Arrival, Due, Sample, Source};
use crate::observe::driver::ObserverDriver;
use crate::timing::real;

/// The number of reports of progress.
const REPORTS: u64 = 500;

/// A plant with its sensors and the control law, at one sample.
pub(crate) struct SimulatedPlant<'a> {
    scenario: &'a Scenario,
    layout: &'a Layout,
    flow: Flow,
    growth: Growth,
    sensor_state: SensorState<'a>,
    signals: Vec<SignalCursor>,
    given: Formulas,
    baselines: Formulas,
    control: Formulas,
    /// The number of the present sample; none before the first.
    sample: Option<u64>,
    next_row: u64,
    next_report: u64,
    /// True if the present sample is a row of the table.
    pub(crate) is_row: bool,
    /// The states at the first sample.
    x: Vec<f64>,
    inputs: Vec<f64>,
    /// The outputs for baselines, and for the model's observer.
    outputs: Vec<f64>,
    own: Vec<f64>,
    /// Gets the finished share now and then, and may end the run.
    progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl<'a> SimulatedPlant<'a> {
    /// The plant before its first sample.
    pub(crate) fn new(scenario: &'a Scenario, progress: &'a mut dyn FnMut(f64) -> ControlFlow<()>) -> Self {
        let Scenario { timing, .. } = scenario;
        let layout = &scenario.experiment.layout;
        let positions = layout.signals.clone().zip(&scenario.signals);
        Self {
            scenario,
            layout,
            sensor_state: scenario.sensors.begin(scenario.seed, timing.slack()),
            flow: Flow::new(
                (&scenario.rates, Some(&scenario.slopes)),
                scenario.switches.as_ref(),
                layout.state.clone(),
                &positions.collect::<Vec<_>>(),
                timing.slack(),
            )
            .until(timing.at(timing.samples)),
            growth: Growth::new(&[]),
            signals: scenario.signals.iter().map(Signal::course).collect(),
            given: Formulas::new(&scenario.given.1),
            baselines: Formulas::new(&scenario.baseline_estimates),
            control: Formulas::new(&scenario.control),
            sample: None,
            next_row: 0,
            next_report: 0,
            is_row: false,
            x: Vec::new(),
            inputs: vec![0.0; layout.u.len()],
            outputs: vec![0.0; layout.y.len()],
            own: vec![0.0; layout.y.len()],
            progress,
        }
    }

    /// The number of the present sample.
    pub(crate) fn sample(&self) -> u64 {
        self.sample.unwrap_or_default()
    }

    /// Begins at the first sample.
    fn begin(&mut self, table: &mut [f64]) -> Result<(), Failure> {
        let Self { scenario, layout, .. } = *self;
        self.read_signals(table);
        let mut start = Formulas::new(&scenario.start);
        // An output with feedthrough has the input that the law would have set before the start, a law may have the
        // output, and baselines start from the sensors' samples: one round each.
        for _ in 0..3 {
            self.set_inputs(table);
            let inputs = &mut table[layout.u.clone()];
            // The law may need what is not there yet.
            inputs.iter_mut().filter(|input| !input.is_finite()).for_each(|input| *input = 0.0);
            let state = start.of(table);
            table[layout.state.clone()].copy_from_slice(state);
            self.sensor_state = scenario.sensors.begin(scenario.seed, scenario.timing.slack());
            self.measure(table, 0);
        }
        self.admit(table, layout.state.clone())?;
        self.growth = Growth::new(&table[layout.state.clone()]);
        self.x.extend(&table[layout.x.clone()]);
        Ok(())
    }

    /// Goes on to this sample, with the inputs held; true if it arrives.
    fn advance(&mut self, table: &mut [f64], sample: u64) -> Result<bool, Failure> {
        let Self { scenario: Scenario { timing, sensors, seed, .. }, layout, .. } = *self;
        let (from, to) = (table[TIME], sensors.instant(timing, *seed, sample));
        if let Err(standstill) = self.flow.advance(table, from, to) {
            return Err(self.standstill(standstill));
        }
        table[TIME] = to;
        self.read_signals(table);
        let given = self.given.of(table);
        for (position, value) in self.scenario.given.0.iter().zip(given) {
            table[*position] = *value;
        }
        let arrives = self.measure(table, sample);
        if let Some(measured_time) = layout.measured_time {
            // An input holds for an interval, so the time is its mean there. Nobody measures how far it is from its place.
            table[measured_time] = timing.at(sample) - timing.step / 2.0;
        }
        let state = layout.state.clone();
        self.admit(table, state.clone())
            .map_err(|failure| self.diverged(&table[state.clone()], to).unwrap_or(failure))?;
        self.growth.add(&table[state]);
        Ok(arrives)
    }

    /// The failure for a standstill of the integration.
    fn standstill(&self, Standstill { steps, at, state, fast }: Standstill) -> Failure {
        let slow = fast.map(|(place, rate)| Failure::Slow {
            at,
            steps,
            fastest: self.scenario.names[self.layout.state.start + place].clone(),
            constant: 1.0 / rate,
        });
        self.diverged(&state, at).or(slow).unwrap_or(Failure::Stuck { at, steps })
    }

    /// The state that runs away, if one does.
    fn diverged(&self, state: &[f64], at: f64) -> Option<Failure> {
        let (place, value) = self.growth.away(state)?;
        let name = self.scenario.names[self.layout.state.start + place].clone();
        Some(Failure::Diverged { name, value, at })
    }

    fn set_inputs(&mut self, table: &mut [f64]) {
        let inputs = self.control.of(table);
        table[self.layout.u.clone()].copy_from_slice(inputs);
    }

    fn read_signals(&mut self, table: &mut [f64]) {
        let t = table[TIME];
        for (position, signal) in self.layout.signals.clone().zip(&mut self.signals) {
            signal.select(t + self.scenario.timing.slack());
            table[position] = signal.value(t);
        }
    }

    /// Lets the sensors take this sample; returns true if it arrives.
    fn measure(&mut self, table: &mut [f64], sample: u64) -> bool {
        let (before, after) = table.split_at_mut(self.layout.last_samples.start);
        let (outputs, last_samples) = (&before[self.layout.y.clone()], &mut after[..self.layout.last_samples.len()]);
        self.sensor_state.sample(sample, before[TIME], outputs, last_samples)
    }

    /// Checks that the values at these positions are finite.
    fn admit(&self, table: &[f64], mut range: Range<usize>) -> Result<(), Failure> {
        match range.find(|position| !table[*position].is_finite()) {
            None => Ok(()),
            Some(position) => Err(Failure::NotFinite { name: self.scenario.names[position].clone(), at: table[TIME] }),
        }
    }
}

impl Source for SimulatedPlant<'_> {
    type Failure = Failure;

    fn next(&mut self, table: &mut [f64]) -> Result<Option<Sample<'_>>, Failure> {
        let sample = self.sample.map_or(0, |sample| sample + 1);
        let Scenario { timing, sensors, experiment, .. } = self.scenario;
        if sample > timing.samples {
            return Ok(None);
        }
        let arrives = match sample {
            0 => self.begin(table).map(|()| true)?,
            _ => self.advance(table, sample)?,
        };
        self.sample = Some(sample);
        self.is_row = sample == timing.sample_of_row(self.next_row);
        self.next_row += u64::from(self.is_row);
        let Self { layout, x, inputs, outputs, own, .. } = self;
        inputs.copy_from_slice(&table[layout.u.clone()]);
        outputs.copy_from_slice(&table[layout.measured()]);
        // The sensor of an angle reads it within a turn.
        for ((own, output), period) in own.iter_mut().zip(&*outputs).zip(&experiment.design.periods) {
            *own = unwrapped(*output, 0.0, *period);
        }
        if experiment.design.partial.is_some() {
            sensors.leave_out(sample, own);
        }
        sensors.leave_out(sample, outputs);
        Ok(Some(Sample {
            elapsed: table[TIME],
            // The observer's first call gives its step no effect.
            dt: timing.step,
            truth: (sample == 0).then_some(x),
            own: if arrives { Arrival::Whole(own) } else { Arrival::Lost },
            outputs: Some(outputs.as_slice()).filter(|_| arrives),
            inputs,
        }))
    }

    fn settle(
        &mut self,
        table: &mut [f64],
        observer: &ObserverDriver,
        taken: Option<Result<(), Fault>>,
    ) -> Result<Due, Failure> {
        let (layout, timing, sample) = (self.layout, &self.scenario.timing, self.sample());
        for (place, _) in &self.scenario.experiment.followers {
            self.admit(table, place.clone())?;
        }
        let estimates = self.baselines.of(table);
        table[layout.baseline_estimates.clone()].copy_from_slice(estimates);
        if let Some(Err(fault)) = taken.filter(|_| observer.has_given_up()) {
            let samples = observer.refused;
            let first = sample.saturating_sub(samples.saturating_sub(1));
            return Err(Failure::Refused { at: timing.at(first), samples, fault });
        }
        self.set_inputs(table);
        self.admit(table, layout.u.clone())?;
        let is_report = sample == self.next_report;
        self.next_report += if is_report { (timing.samples / REPORTS).max(1) } else { 0 };
        if is_report && (self.progress)(real(sample) / real(timing.samples)).is_break() {
            return Err(Failure::Stopped { at: table[TIME] });
        }
        let is_last = sample == timing.samples;
        let standard_errors = self.is_row || is_report || is_last;
        Ok(Due { scores: true, standard_errors, monitors: is_report && !is_last })
    }
}
