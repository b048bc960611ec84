//! Sensors: make the samples that observers get of the true outputs.
//!
//! In: the outputs at the instants of the loop. Out: a sample of every output at each instant, or its loss.
//!
//! ```text
//! y(t - delay) + bias + deviation * (normal number)  ->  nearest multiple of the step  ->  arrives, or is dropped
//! ```
//!
//! A delay that ends between two instants is interpolated linearly between the outputs at these: an observer knows no
//! more of an output, and the line does not overshoot as a polynomial of higher degree would where an input jumps. Its
//! error is at most an eighth of the step squared times the output's second derivative. Before its start the plant is
//! constant.

use std::collections::VecDeque;

use pebo_design::model::{Decimal, Simulation, Spanned};
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

use super::noise::{DROPPED, JITTER, even, normal};
use super::scope::number;
use crate::timing::{Timing, whole};

/// The most steps of a delay: all samples in between are kept.
const LONGEST: f64 = 1e6;

/// The imperfections of a plant's sensors; none where they are perfect.
#[derive(Debug, Default)]
pub(crate) struct Sensors {
    each: Vec<Sensor>,
    /// The probability that a sample is dropped.
    dropped: f64,
    /// The largest distance of an instant from its nominal time, in steps.
    jitter: f64,
}

/// The imperfections of one sensor.
#[derive(Clone, Copy, Debug)]
struct Sensor {
    delay: f64,
    bias: f64,
    deviation: f64,
    /// The step of which samples are multiples; 0 for none.
    step: f64,
    /// The period in instants: one sample of this many arrives.
    every: u64,
}

impl Sensors {
    /// The sensors of a simulation; `timing` has been resolved.
    pub(crate) fn resolve(
        plant: &Plant,
        simulation: &Simulation,
        (timing, span): (&Timing, Span),
        problems: &mut Diagnostics,
    ) -> Self {
        let share = |number: &Option<Spanned<Decimal>>| number.as_ref().map_or(0.0, |share| share.value.to_f64());
        let perfect = Self { jitter: share(&simulation.jitter), ..Self::default() };
        if !simulation.is_imperfect() {
            return perfect;
        }
        if let Some(delay) = simulation.delay.written().find(|delay| delay.value.to_f64() > LONGEST * timing.step) {
            let place = if delay.span == Span::NOWHERE { span } else { delay.span };
            let message = format!("a delay of {} s is too long to be simulated", delay.value.text());
            problems.push(Diagnostic::error(Code::SimulationUnsupported, place, message).help(format!(
                "the simulator has room for {LONGEST:.0e} samples on their way: shorten the delay, or choose a longer step"
            )));
            return perfect;
        }
        let sensor = |output: String| {
            let of = |entries| number(entries, &output).unwrap_or_default();
            Sensor {
                delay: simulation.delay.of(&output).map_or(0.0, |delay| delay.value.to_f64()),
                bias: of(&simulation.bias),
                deviation: of(&simulation.noise),
                step: of(&simulation.quantisation),
                every: whole(of(&simulation.every)).max(1),
            }
        };
        let outputs = plant.y.iter().map(|output| plant.arena.name(output.symbol));
        Self { each: outputs.map(sensor).collect(), dropped: share(&simulation.dropped), ..perfect }
    }

    /// The sensors before their first sample, with this seed. Instants closer than `slack` are one.
    pub(crate) fn begin(&self, seed: u64, slack: f64) -> SensorState<'_> {
        SensorState { sensors: self, seed, slack, past: vec![VecDeque::new(); self.each.len()] }
    }
}

/// The state of the sensors in a run.
#[derive(Debug)]
pub(crate) struct SensorState<'a> {
    sensors: &'a Sensors,
    seed: u64,
    slack: f64,
    /// Instants and values of each delayed output, from the last one that is old enough on.
    past: Vec<VecDeque<(f64, f64)>>,
}

impl SensorState<'_> {
    /// Takes the outputs at the instant `t` of a sample. Writes the samples and returns true if it arrives; perfect
    /// sensors write nothing.
    pub(crate) fn sample(&mut self, sample: u64, t: f64, outputs: &[f64], samples: &mut [f64]) -> bool {
        let Self { sensors, seed, slack, past } = self;
        // The first sample starts the clock.
        let arrives = sample == 0 || sensors.dropped == 0.0 || even(*seed, DROPPED, sample) > sensors.dropped;
        let values = sensors.each.iter().zip(past).zip(outputs).zip(samples).zip(0_u64..);
        for ((((sensor, past), value), held), output) in values {
            let value = if sensor.delay > 0.0 { delayed(past, (t, *value), t - sensor.delay, *slack) } else { *value };
            if arrives && sample.is_multiple_of(sensor.every) {
                *held = sensor.show(value, || normal(*seed, output, sample));
            }
        }
        arrives
    }
}

impl Sensors {
    /// The instant of a sample, with jitter. The first and the last are exact, as a run begins and ends there.
    pub(crate) fn instant(&self, timing: &Timing, seed: u64, sample: u64) -> f64 {
        let place = timing.at(sample);
        if self.jitter > 0.0 && sample > 0 && sample < timing.samples {
            place + timing.step * self.jitter * (2.0 * even(seed, JITTER, sample) - 1.0)
        } else {
            place
        }
    }

    /// Makes NaN of the outputs whose sensors have no sample at this instant.
    pub(crate) fn leave_out(&self, sample: u64, outputs: &mut [f64]) {
        for (sensor, output) in self.each.iter().zip(outputs) {
            if !sample.is_multiple_of(sensor.every) {
                *output = f64::NAN;
            }
        }
    }
}

impl Sensor {
    /// The sample of a value, with a random number that is drawn if it is needed.
    fn show(&self, value: f64, number: impl FnOnce() -> f64) -> f64 {
        let noise = if self.deviation > 0.0 { self.deviation * number() } else { 0.0 };
        let value = value + self.bias + noise;
        let count = (value / self.step).round();
        // A zero is a positive one. A step too small to be counted has no effect.
        if self.step > 0.0 && count.is_finite() { self.step * count + 0.0 } else { value }
    }
}

/// Keeps the newest value, and returns the one at `wanted`, which never decreases.
fn delayed(past: &mut VecDeque<(f64, f64)>, newest: (f64, f64), wanted: f64, slack: f64) -> f64 {
    past.push_back(newest);
    while past.get(1).is_some_and(|second| second.0 <= wanted + slack) {
        past.pop_front();
    }
    let first = past[0];
    match past.get(1) {
        Some(second) if wanted > first.0 + slack => {
            first.1 + (second.1 - first.1) * ((wanted - first.0) / (second.0 - first.0))
        }
        _ => first.1,
    }
}
