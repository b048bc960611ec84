//! Settings with the known numbers behind them.

use pebo_cas::Rational;
use pebo_design::plant::Settings;

#[cfg(feature = "simulate")]
use super::prediction::Prediction;
#[cfg(feature = "simulate")]
use crate::settings::words::KnownNumbers;

/// Settings, with the known numbers behind them where they were derived.
#[derive(Clone, Debug)]
pub struct DerivedSettings {
    /// The settings that an observer is built with.
    pub settings: Settings<Rational>,
    /// The numbers that they were derived from; none where the author chose the settings.
    #[cfg(feature = "simulate")]
    pub known: Option<KnownNumbers>,
    /// The prediction of the estimates' errors.
    #[cfg(feature = "simulate")]
    pub(crate) prediction: Prediction,
}
