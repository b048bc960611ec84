//! What a call sets instead of the file.

/// Settings of a call, which go before those of the file.
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
}

impl Overrides {
    /// The seed where a call names none.
    pub const SEED: u64 = 1;
}
