//! Drives an observer sample by sample, with missing samples bridged.
//!
//! In: each interval with its input, and the outputs at its end if they are there. Out: estimates. An observer with
//! outputs among its states goes on without a sample, with the outputs that it expects. Else, and where a sample is
//! refused, the gap is bridged as on the target: the next sample covers the time since the last accepted one, with the
//! mean of the inputs (the runtime's [`Gap`]). Independent of the source of samples.

use pebo_runtime::{Fault, Gap};

use super::padded::{DynObserver, Judgement};
use super::sizes::{LARGEST, pad};
use crate::score::faults::{Faults, SignalNames};

/// The most refused samples in a row: an observer that refuses as many has lost its state, and a later sample will not
/// restore it.
const PATIENCE: u64 = 100;

/// The square of five standard deviations: a sample beyond is no measure of the others.
const OUTSTANDING: f64 = 25.0;

/// Samples from one judged innovation to the next: each costs a step.
const JUDGING_INTERVAL: u64 = 16;

/// The first samples of a recording are all judged: one that is off by far is not passed over.
const RECORDED_JUDGED: u64 = 4096;

/// The first innovations are those of the start: a wrong one says nothing of what follows.
const OF_START: u64 = 32;

/// A running observer.
#[derive(Debug)]
pub(crate) struct ObserverDriver {
    pub(crate) observer: Box<dyn DynObserver>,
    /// Intervals since the last accepted sample, if there are any but the current one.
    gap: Option<Gap<f64, LARGEST>>,
    started: bool,
    /// The samples that were refused since the last accepted one.
    pub(crate) refused: u64,
    names: SignalNames,
    /// The samples that were refused.
    pub(crate) faults: Faults,
    /// The samples that never arrived.
    pub(crate) dropped: u64,
    /// The samples that were taken without some of their outputs.
    pub(crate) parted: u64,
    /// Those at which there was no estimate.
    pub(crate) stateless: u64,
    /// Samples since an innovation was judged.
    unjudged: u64,
    /// Samples from one judged innovation to the next, after so many that are all judged.
    interval: u64,
    all_of_first: u64,
    /// The sum of the normalised squares of innovations, and their number.
    surprise: (f64, u64),
    /// Their sum with each at most [`OUTSTANDING`].
    typical: f64,
    /// The number of those beyond, after the first ones.
    outstanding: u64,
    /// The logarithm of the likelihood of the judged samples.
    likelihood: f64,
}

impl ObserverDriver {
    /// The observer before the first sample; the names are those of its signals.
    pub(crate) fn new(observer: Box<dyn DynObserver>, names: SignalNames) -> Self {
        Self {
            observer,
            gap: None,
            started: false,
            refused: 0,
            names,
            faults: Faults::default(),
            dropped: 0,
            parted: 0,
            stateless: 0,
            unjudged: 0,
            interval: JUDGING_INTERVAL,
            all_of_first: 0,
            surprise: (0.0, 0),
            typical: 0.0,
            outstanding: 0,
            likelihood: 0.0,
        }
    }

    /// The same, with every sample judged.
    pub(crate) fn judging_each(self) -> Self {
        Self { interval: 1, ..self }
    }

    /// The same, with the first samples of a recording judged.
    pub(crate) fn judging_first(self) -> Self {
        Self { all_of_first: RECORDED_JUDGED, ..self }
    }

    /// Takes the outputs at the end of an interval of `dt` seconds and the inputs during it; writes the estimates. A
    /// fault is counted, and leaves the estimates as they are.
    ///
    /// # Errors
    /// The fault of a sample that was refused.
    pub(crate) fn arrive(&mut self, y: &[f64], u: &[f64], dt: f64, hat: &mut [f64]) -> Result<(), Fault> {
        let is_parted = y.iter().any(|output| output.is_nan());
        self.unjudged += 1;
        let is_due = (self.unjudged >= self.interval || self.surprise.1 < self.all_of_first) && self.gap.is_none();
        let judgement = is_due.then(|| self.observer.judge(y, u, dt)).flatten();
        let taken = match &self.gap {
            None => self.observer.sample(y, u, dt, hat),
            Some(gap) => {
                let mut whole = *gap;
                whole.add(&pad(u), dt).and_then(|()| {
                    let (mut mean, time) = whole.take();
                    // Inputs of the instant are no mean.
                    let during = self.names.inputs.len();
                    mean.iter_mut().zip(u).skip(during).for_each(|(mean, now)| *mean = *now);
                    self.observer.sample(y, &mean.as_slice()[..u.len()], time, hat)
                })
            }
        };
        // An outlier that is refused says nothing of the numbers.
        if let Some(Judgement { square, likelihood }) = judgement.filter(|_| !matches!(taken, Err(Fault::Outlier))) {
            self.unjudged = 0;
            self.surprise = (self.surprise.0 + square, self.surprise.1 + 1);
            self.typical += square.min(OUTSTANDING);
            self.outstanding += u64::from(square > OUTSTANDING && self.surprise.1 > OF_START);
            self.likelihood += likelihood;
        }
        let fault = match taken {
            Ok(has_state) => {
                (self.gap, self.started, self.refused) = (None, true, 0);
                self.parted += u64::from(is_parted);
                self.stateless += u64::from(!has_state);
                return Ok(());
            }
            Err(fault) => fault,
        };
        self.faults.add(fault, &self.names);
        // Samples out of the range of their sensor say nothing of the observer, however many there are.
        self.refused += u64::from(!matches!(fault, Fault::OutputRange { .. } | Fault::InputRange { .. }));
        if self.started {
            self.wait(u, dt);
        }
        Err(fault)
    }

    /// True once the observer has refused its first sample, or many in a row.
    pub(crate) fn has_given_up(&self) -> bool {
        self.refused > 0 && (!self.has_started() || self.refused >= PATIENCE)
    }

    /// True if a sample has been accepted.
    pub(crate) fn has_started(&self) -> bool {
        self.started
    }

    /// Takes an interval without a sample at its end, of so many outputs. An observer that may lack outputs goes on with
    /// those that it expects, and writes its estimates; another waits for the next sample.
    pub(crate) fn miss(&mut self, outputs: usize, u: &[f64], dt: f64, hat: &mut [f64]) {
        self.dropped += 1;
        let goes_on = self.started && self.gap.is_none() && self.observer.admits_partial();
        let missing = vec![f64::NAN; outputs];
        if !goes_on || self.observer.sample(&missing, u, dt, hat).is_err() {
            self.wait(u, dt);
        }
    }

    fn wait(&mut self, u: &[f64], dt: f64) {
        // Of a time that is none nothing is taken: it was refused with its sample.
        let _ = self.gap.get_or_insert_default().add(&pad(u), dt);
    }

    /// The normalised square of innovations, on average over samples and rows: 1 where model and numbers are right.
    pub(crate) fn surprise(&self) -> Option<f64> {
        (self.surprise.1 > 0).then(|| self.surprise.0 / crate::timing::real(self.surprise.1))
    }

    /// The logarithm of the likelihood of the judged samples, but for a constant; none where there are none.
    pub(crate) fn likelihood(&self) -> Option<f64> {
        (self.surprise.1 > 0 && self.likelihood.is_finite()).then_some(self.likelihood)
    }

    /// The same without what stands out, as a step of a load does: at most five standard deviations of each count.
    pub(crate) fn typical(&self) -> Option<f64> {
        (self.surprise.1 > 0).then(|| self.typical / crate::timing::real(self.surprise.1))
    }

    /// True if innovations stand out that are not those of the start.
    pub(crate) fn stands_out(&self) -> bool {
        self.outstanding > 0
    }

    /// The number of innovations behind that.
    pub(crate) fn judged(&self) -> u64 {
        self.surprise.1
    }

    /// The standard errors of the estimates now, some time after the last accepted sample.
    pub(crate) fn standard_errors(&self) -> Option<Vec<f64>> {
        let age = self.gap.map_or(0.0, |mut gap| gap.take().1);
        self.observer.standard_errors(age)
    }
}
