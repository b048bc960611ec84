//! Settings of a call that replace those of the file.

use pebo_design::model::Estimator;

/// Settings of a call for a run. Keys of the file are set by [`Source::set`](pebo_design::source::Source::set).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The source of the control law's estimates: `observer`, `truth`, or a baseline.
    pub feedback: Option<String>,
    /// The seed of all chance; [`Overrides::SEED`] if absent.
    pub seed: Option<u64>,
    /// The duration in seconds.
    pub duration: Option<f64>,
    /// The sampling period in seconds.
    pub step: Option<f64>,
    /// The time between rows of the table in seconds; a thousandth of the duration if absent.
    pub every: Option<f64>,
    /// The error of the extension at the start, as a multiple of the error without this: 0 begins at phi, so that the
    /// observer knows the state. Bounds of the unknowns hold all the same.
    pub initial_error: Option<f64>,
    /// The estimator. Settings that the file lacks take the values of the corresponding ones of the file's estimator,
    /// or usual values to start from.
    pub estimator: Option<Estimator>,
}

impl Overrides {
    /// The seed where a call names none.
    pub const SEED: u64 = 1;
}
