//! Settings beside what they were derived from.

use crate::cas::rational::Rational;
use crate::plant::Settings;

#[cfg(feature = "simulate")]
use super::told::Known;

/// Settings, and what they were derived from where they were.
#[derive(Clone, Debug)]
pub(crate) struct Tuned {
    /// With which an observer can be built.
    pub settings: Settings<Rational>,
    /// What they were derived from; none where the author chose them.
    #[cfg(feature = "simulate")]
    pub known: Option<Known>,
    /// How the errors of the estimates are predicted.
    #[cfg(feature = "simulate")]
    pub prediction: Prediction,
}

/// How the standard errors of estimates follow from the numbers that are known.
#[cfg(feature = "simulate")]
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
#[cfg(feature = "simulate")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    /// The standard deviation of the samples of each output.
    pub sensors: Vec<f64>,
    /// What each unknown drifts by besides, as a variance per second.
    pub drift: Vec<f64>,
}
