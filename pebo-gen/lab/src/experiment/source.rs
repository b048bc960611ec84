//! The source of an experiment's samples.

use pebo_runtime::Fault;

use crate::observe::driver::ObserverDriver;

/// A source of samples, which knows the plant, its clock and its sensors, or has a recording of them.
pub(crate) trait Source {
    /// The reason for which it ends early.
    type Failure;

    /// Goes on to the next sample and writes the signals of its instant into the table, with the inputs held until then.
    /// None after the last.
    fn next(&mut self, table: &mut [f64]) -> Result<Option<Sample<'_>>, Self::Failure>;

    /// Sets the inputs from this sample on, by the estimates in the table; `taken` is what the observer made of the sample,
    /// if it was given one.
    fn settle(
        &mut self,
        table: &mut [f64],
        observer: &ObserverDriver,
        taken: Option<Result<(), Fault>>,
    ) -> Result<Due, Self::Failure>;
}

/// A sample for the observers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample<'a> {
    /// The time since the first one, in seconds.
    pub(crate) elapsed: f64,
    /// The time since the one before, as observers know it.
    pub(crate) dt: f64,
    /// The states x at the first sample, where they are known for sure.
    pub(crate) truth: Option<&'a [f64]>,
    /// The outputs for the model's observer.
    pub(crate) own: Arrival<'a>,
    /// The outputs for baselines, NaN where one is missing; none where the sample is.
    pub(crate) outputs: Option<&'a [f64]>,
    /// The inputs during the interval before, then those at its end where the observer takes these too.
    pub(crate) inputs: &'a [f64],
}

/// The outputs for the model's observer.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Arrival<'a> {
    /// They are there, but for those that are NaN.
    Whole(&'a [f64]),
    /// The sample is missing.
    Lost,
    /// The observer cannot begin here.
    Early,
}

/// What is due at a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Due {
    /// The table has estimates to be scored.
    pub(crate) scores: bool,
    /// The standard errors are wanted in the table.
    pub(crate) standard_errors: bool,
    /// Excitation and certainty are evaluated; at the end they always are.
    pub(crate) monitors: bool,
}
