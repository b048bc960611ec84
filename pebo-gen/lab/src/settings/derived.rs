//! Settings beside what they were derived from.

use pebo_cas::Rational;
use pebo_design::plant::Settings;

#[cfg(feature = "simulate")]
use super::prediction::Prediction;
#[cfg(feature = "simulate")]
use crate::settings::words::KnownNumbers;

/// Settings, and what they were derived from where they were.
#[derive(Clone, Debug)]
pub struct DerivedSettings {
    /// With which an observer can be built.
    pub settings: Settings<Rational>,
    /// What they were derived from; none where the author chose them.
    #[cfg(feature = "simulate")]
    pub known: Option<KnownNumbers>,
    /// How the errors of the estimates are predicted.
    #[cfg(feature = "simulate")]
    pub(crate) prediction: Prediction,
}
