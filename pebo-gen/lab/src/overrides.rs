//! What a call sets instead of the file.

use pebo_design::model::Estimator;

/// How a call runs a scenario. What a file has a key for is set by that: [`Source::set`](pebo_design::source::Source::set).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Whose estimates the control law sees: `observer`, `truth`, or a baseline.
    pub feedback: Option<String>,
    /// The seed of all chance: noise, jitter, dropped samples; [`Overrides::SEED`] if absent.
    pub seed: Option<u64>,
    /// The duration in seconds.
    pub duration: Option<f64>,
    /// The sampling period in seconds.
    pub step: Option<f64>,
    /// The time between rows of the table in seconds; a thousandth of the duration if absent.
    pub every: Option<f64>,
    /// How wrong the extension is at the start, as a multiple of how wrong it is without this: 0 where it begins at phi,
    /// so that the observer knows the state. Bounds of the unknowns hold all the same.
    pub initial_error: Option<f64>,
    /// The estimator. Settings that it needs and the file does not have take the values of those that play their part in
    /// the file's estimator, or usual ones: a place to start from.
    pub estimator: Option<Estimator>,
}

impl Overrides {
    /// The seed where a call names none.
    pub const SEED: u64 = 1;
}
