//! The settings of an observer, from the known numbers of its sensors, its start and its disturbances.
//!
//! ```text
//! sensors, start, disturbance -> operating point -> slopes of phi, h and the regression -> covariance, process noise
//! ```
//!
//! In: a model with its proved derivation. Out: the settings of the runtime's observer, the same for emitted code and
//! for a run, and the numbers behind them, for reports. Where the author wrote gains these are the settings, and
//! nothing is derived.
//!
//! The observer of known numbers is least squares on samples weighted by their sensors: in the output form where the
//! regression is of rates, re-based at every sample, which makes it a Kalman filter of the transformed plant. Where the
//! regression cannot be re-based, its unknowns being functions of theta, it is least squares through a filter.

mod derived;

#[cfg(feature = "simulate")]
mod words;

mod derive;
mod digits;
mod equations;
mod feedthrough;
mod kind;
mod known;
mod late;
mod local;
mod magnitude;
mod monotone;
mod point;
#[cfg(feature = "simulate")]
mod prediction;
mod shown;
mod spread;
mod start;

#[cfg(test)]
pub mod tests;

use pebo_cas::Rational;
use pebo_design::analysis::Derivation;
use pebo_design::model::{Decimal, Model};
use pebo_design::plant::settings::{Limits, Rebase, cannot_rebase};
use pebo_design::plant::{Plant, Settings};
use pebo_design::source::{Diagnostic, Diagnostics};

pub use derived::DerivedSettings;
pub use shown::Shown;
pub(crate) use start::start;

#[cfg(feature = "simulate")]
pub(crate) use derive::BANDWIDTH;
#[cfg(feature = "simulate")]
pub(crate) use equations::SampleRows;
#[cfg(feature = "simulate")]
pub(crate) use prediction::Prediction;
#[cfg(feature = "simulate")]
pub use words::{KnownNumbers, Numbers, Value};

/// The refusal of settings that the regression or the known start of the plant does not admit.
pub(crate) fn refused(model: &Model, plant: &Plant, derivation: &Derivation) -> Option<Diagnostic> {
    let at_estimate = local::refused(model, derivation).or_else(|| monotone::refused(model, derivation));
    at_estimate.or_else(|| known::refused(model, plant, derivation))
}

impl DerivedSettings {
    /// The settings of a model's observer, with what samples show besides; none where the model is incomplete. Mistakes in
    /// it are reported.
    pub fn of(
        model: &Model,
        plant: &Plant,
        derivation: &Derivation,
        shown: &Shown,
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let inverse = derivation.left_inverse.result.as_ref()?;
        let regression = derivation.regression.result.as_ref()?;
        if let Some(rebase) = model.observer.rebase.span().filter(|_| !derivation.can_rebase(plant)) {
            problems.push(cannot_rebase(&plant.name, rebase));
            return None;
        }
        if let Some(refusal) = refused(model, plant, derivation) {
            problems.push(refusal);
            return None;
        }
        let read = |number: &Decimal| Rational::from_decimal(number.text()).ok();
        let limits = Limits::of(model, read);
        if model.observer.has_gains() {
            let sizes = (regression.eta.len(), plant.phi.len(), inverse.x.len());
            let settings = Settings::resolve(&model.observer, sizes, read, problems)?;
            let begun = Some(()).filter(|()| model.observer.extension.is_empty());
            let chi_0 = begun.and_then(|()| start(model, plant, derivation, shown)).unwrap_or(settings.chi_0);
            let rebase =
                if regression.is_at_estimate() { Some(Rebase::Samples(Rational::ONE)) } else { settings.rebase };
            return Some(Self {
                settings: Settings { chi_0, limits, rebase, ..settings },
                #[cfg(feature = "simulate")]
                known: None,
                #[cfg(feature = "simulate")]
                prediction: Prediction::None("gains do not say what sensors err by"),
            });
        }
        let by_kind = if monotone::is_monotone(derivation) { monotone::derive } else { derive::derive };
        let mut derived = by_kind(model, plant, derivation, shown, problems)?;
        derived.settings.limits = limits;
        Some(derived)
    }
}
