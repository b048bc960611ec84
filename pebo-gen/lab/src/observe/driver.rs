//! An observer fed sample by sample, some of which are missing.
//!
//! In: each interval with its input, and the outputs at its end if they are there. Out: estimates. What is missing or
//! refused is bridged as on the target: the next sample covers the time since the last one that was accepted, with the mean
//! of the inputs (the runtime's [`Gap`]). Knows nothing of where samples are from.

use pebo_runtime::{Fault, Gap};

use super::interpreted::DynObserver;
use super::sizes::{LARGEST, pad};
use crate::score::faults::Faults;

/// Samples in a row that may be refused: an observer that refuses as many has lost its state, and a later sample will not
/// bring it back.
const PATIENCE: u64 = 100;

/// Samples from one innovation that is scored to the next: each costs a step.
const JUDGING_INTERVAL: u64 = 16;

/// An observer at work.
#[derive(Debug)]
pub(crate) struct ObserverDriver {
    pub(crate) observer: Box<dyn DynObserver>,
    /// Intervals since the last accepted sample, if there are any but the current one.
    gap: Option<Gap<f64, LARGEST>>,
    started: bool,
    refused: u64,
    faults: Faults,
    dropped: u64,
    /// The samples that lacked outputs.
    parted: u64,
    /// Samples since an innovation was scored.
    unjudged: u64,
    /// The sum of the normalised squares of innovations, and their number.
    surprise: (f64, u64),
}

impl ObserverDriver {
    /// Before the first sample.
    pub(crate) fn new(observer: Box<dyn DynObserver>) -> Self {
        Self {
            observer,
            gap: None,
            started: false,
            refused: 0,
            faults: Faults::default(),
            dropped: 0,
            parted: 0,
            unjudged: 0,
            surprise: (0.0, 0),
        }
    }

    /// Takes the outputs at the end of an interval of `dt` seconds and the inputs during it; writes the estimates. A fault
    /// is counted, and leaves the estimates as they are.
    ///
    /// # Errors
    /// The fault of a sample that was refused.
    pub(crate) fn arrive(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<(), Fault> {
        let is_parted = y.iter().any(|output| output.is_nan());
        self.unjudged += 1;
        if self.unjudged >= JUDGING_INTERVAL
            && self.gap.is_none()
            && !is_parted
            && let Some(square) = self.observer.surprise(y, u, dt)
        {
            self.unjudged = 0;
            self.surprise = (self.surprise.0 + square, self.surprise.1 + 1);
        }
        let taken = match &self.gap {
            None => self.observer.sample(y, u, dt, hat),
            Some(gap) => {
                let mut whole = *gap;
                whole.add(&pad(u), dt);
                let (mean, time) = whole.take();
                self.observer.sample(y, &mean.as_slice()[..u.len()], time, hat)
            }
        };
        let Err(fault) = taken else {
            (self.gap, self.started, self.refused) = (None, true, 0);
            self.parted += u64::from(is_parted);
            return Ok(());
        };
        self.faults.add(fault);
        // A sample off the range of its sensor says nothing of the observer, however many there are.
        self.refused += u64::from(!matches!(fault, Fault::OutputRange { .. } | Fault::InputRange { .. }));
        if self.started {
            self.wait(u, dt);
        }
        Err(fault)
    }

    /// Whether nothing good is to be expected of the observer any more: it refused its first sample, or many in a row.
    pub(crate) fn has_given_up(&self) -> bool {
        self.refused > 0 && (!self.has_started() || self.refused >= PATIENCE)
    }

    /// Whether a sample has been accepted.
    pub(crate) fn has_started(&self) -> bool {
        self.started
    }

    /// Takes an interval at whose end no sample arrived.
    pub(crate) fn miss(&mut self, u: &[f64], dt: f64) {
        self.dropped += 1;
        self.wait(u, dt);
    }

    fn wait(&mut self, u: &[f64], dt: f64) {
        self.gap.get_or_insert_default().add(&pad(u), dt);
    }

    /// The samples that were refused.
    pub(crate) fn faults(&self) -> &Faults {
        &self.faults
    }

    /// The samples that were taken without some of their outputs.
    pub(crate) fn parted(&self) -> u64 {
        self.parted
    }

    /// The normalised square of innovations, on average over samples and rows: 1 where model and numbers are right.
    pub(crate) fn surprise(&self) -> Option<f64> {
        (self.surprise.1 > 0).then(|| self.surprise.0 / crate::timing::real(self.surprise.1))
    }

    /// The standard errors of the estimates, with what has passed since the last accepted sample.
    pub(crate) fn standard_errors(&self) -> Option<Vec<f64>> {
        let age = self.gap.map_or(0.0, |mut gap| gap.take().1);
        self.observer.standard_errors(age)
    }

    /// How often the observer began anew after a gap.
    pub(crate) fn restarts(&self) -> u64 {
        self.observer.restarts()
    }

    /// The samples that never arrived.
    pub(crate) fn dropped(&self) -> u64 {
        self.dropped
    }
}
