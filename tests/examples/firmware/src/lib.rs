//! Observers without `std` and without an allocator, for single precision: a converter and a sensorless motor.
#![no_std]
#[cfg(test)]
extern crate std;

pub mod servo;

use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Extension, Fault, Filter, Gap, Gradient, Hold, Limits};

/// The converter that is observed.
#[pebo_macros::pebo_model("models/cuk.yaml", scalar = f32)]
pub struct Cuk;

/// The observer with its gains.
///
/// # Errors
/// None with these gains, which are positive.
pub fn observer() -> Result<cuk::Observer, Fault> {
    cuk::Observer::new(
        Cuk::new(&cuk::Parameters::default()),
        Gradient::diagonal(&SVector::from([0.001, 0.001]))?,
        Filter::new(0.5, Hold::First)?,
        SVector::zeros(),
    )
}

/// The state of the converter's interrupt from period to period.
pub struct Task {
    observer: cuk::Observer,
    limits: Limits<f32, 2, 1>,
    gap: Gap<f32, 1>,
}

impl Task {
    /// Before the first sample.
    ///
    /// # Errors
    /// None with these settings.
    pub fn new() -> Result<Self, Fault> {
        // The sensors show -50 V to 50 V; without a sample for a millisecond the observer is to start again.
        let limits = Limits::none().outputs(&SVector::repeat(-50.0), &SVector::repeat(50.0))?.gap(1e-3)?;
        Ok(Self { observer: observer()?, limits, gap: Gap::new() })
    }

    /// The currents, from the voltages now, the duty cycle of the period that ends now, and its length.
    ///
    /// # Errors
    /// The fault of a sample that is left out: the next good one covers its period too.
    pub fn period(&mut self, v2: f32, v4: f32, d: f32, dt: f32) -> Result<cuk::X, Fault> {
        // A duty cycle that there cannot be is unknown: it shall not be part of a mean.
        let d = if (0.0..=1.0).contains(&d) { d } else { f32::NAN };
        self.gap.add(&SVector::from([d]), dt)?;
        let mut gap = self.gap;
        let (u, time) = gap.take();
        let y = SVector::from([v2, v4]);
        let estimate = match self.limits.check(&y, &u, time) {
            Err(Fault::Gap) => {
                // From the last estimate of z, without unknowns then.
                let z = self.observer.extension().coordinates(&self.observer.theta());
                self.observer.restart(z, &SVector::zeros())?;
                self.observer.step(y, u, time)?
            }
            checked => checked.and_then(|()| self.observer.step(y, u, time))?,
        };
        // The sample is in: no interval is open any more.
        self.gap = gap;
        Ok(estimate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_taken() {
        let mut observer = observer().expect("positive gains");
        let estimate = observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 1e-5);
        assert_eq!(estimate, Ok(cuk::X { i1: 0.0, i3: 0.0 }));
    }

    /// The task with a sample left out agrees with an observer that is given the whole of both periods.
    #[test]
    fn a_bad_sample_is_left_out() {
        let (mut task, mut whole) = (Task::new().expect("settings"), observer().expect("positive gains"));
        let good = |d| (cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d });
        let (y, u) = good(0.6);
        assert_eq!(task.period(10.0, -12.0, 0.6, 1e-5), whole.step(y, u, 1e-5));
        assert_eq!(task.period(f32::NAN, -12.0, 0.5, 1e-5), Err(Fault::OutputRange { index: 0 }));
        assert_eq!(task.period(10.0, 60.0, 0.5, 1e-5), Err(Fault::OutputRange { index: 1 }));
        let late = task.period(10.0, -12.0, 0.5, 1e-5).expect("a good sample");
        let (y, u) = good(0.5);
        let once = whole.step(y, u, 3e-5).expect("a good sample");
        // Three periods are summed up in one and not in the other: a rounding of the time, of currents below 0.1 A.
        assert!((late.i1 - once.i1).abs() < 1e-7 && (late.i3 - once.i3).abs() < 1e-7, "{late:?} {once:?}");
    }

    /// Whatever a sensor, a counter or a timer gives in one period, the next good one is accepted, with the estimate that
    /// it has without the bad one.
    #[test]
    fn no_bad_value_outlives_its_period() {
        let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN];
        let values = bad.into_iter().chain([-1.0, 0.0]);
        for (place, value) in (0..4).flat_map(|place| values.clone().map(move |value| (place, value))) {
            // Zero is a good voltage and a good duty cycle; a volt too little is one.
            if place < 2 && value.abs() < 2.0 || place == 2 && value == 0.0 {
                continue;
            }
            let (mut task, mut whole) = (Task::new().expect("settings"), observer().expect("positive gains"));
            let mut period = [10.0, -12.0, 0.6, 1e-5];
            let good = |task: &mut Task| task.period(10.0, -12.0, 0.6, 1e-5);
            let (y, u) = (cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.6 });
            assert_eq!(good(&mut task), whole.step(y, u, 1e-5));
            period[place] = value;
            let [v2, v4, d, dt] = period;
            assert!(task.period(v2, v4, d, dt).is_err() || value > 1.0, "{place}: {value}");
            let next = good(&mut task).expect("a good sample");
            if place == 3 && value > 1.0 {
                // So long that the observer has started again.
                continue;
            }
            // Of a bad time nothing is known; otherwise the bad period is covered by the next one.
            let time = if place == 3 { 1e-5 } else { 2e-5 };
            let once = whole.step(y, u, time).expect("a good sample");
            // A rounding of the time, of currents below 0.1 A.
            assert!((next.i1 - once.i1).abs() < 1e-7 && (next.i3 - once.i3).abs() < 1e-7, "{place}: {value}");
        }
    }

    #[test]
    fn after_an_outage_it_starts_again() {
        let mut task = Task::new().expect("settings");
        for _ in 0..100 {
            task.period(10.0, -12.0, 0.6, 1e-5).expect("a good sample");
        }
        let z = task.observer.extension().coordinates(&task.observer.theta());
        assert!(task.period(10.0, -12.0, 0.6, 0.1).is_ok());
        assert_eq!(task.observer.extension().chi(), &z);
    }
}
