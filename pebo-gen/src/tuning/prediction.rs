//! How far the errors of an observer follow from the numbers that are known.

/// How the standard errors of estimates follow from the numbers that are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Prediction {
    /// The covariance of least squares is that of the unknown.
    Covariance,
    /// Not that alone: the noise of a sample is elsewhere than in its row of the regression too.
    Noise(Noise),
    /// Not at all, and why.
    None(&'static str),
}

/// Noise that an observer has to do with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    /// The standard deviation of the samples of each output.
    pub sensors: Vec<f64>,
    /// What each unknown drifts by besides, as a variance per second.
    pub drift: Vec<f64>,
}
