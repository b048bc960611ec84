//! Replaces the estimator of a model.
//!
//! In: the model, and the estimator of the call. Out: the model as if its file had it, with settings that correspond to
//! those of the file's own.

use std::borrow::Cow;

use crate::settings::BANDWIDTH;
use pebo_design::model::{Decimal, Estimator, Model, Observer, Spanned};
use pebo_design::source::Span;

use crate::overrides::Overrides;

/// The model with the estimator of the call.
pub(crate) fn overridden<'a>(model: &'a Model, overrides: &Overrides) -> Cow<'a, Model> {
    let Some(estimator) = overrides.estimator else { return Cow::Borrowed(model) };
    let of_file = model.simulation.as_ref().and_then(|simulation| simulation.step.as_ref());
    let step = overrides.step.or(of_file.map(|step| step.value.to_f64()));
    Cow::Owned(Model { observer: with_estimator(&model.observer, estimator, step), ..model.clone() })
}

fn placed<T>(value: T) -> Spanned<T> {
    Spanned { value, span: Span::NOWHERE }
}

/// The section with another estimator, for samples `step` seconds apart.
fn with_estimator(written: &Observer, estimator: Estimator, step: Option<f64>) -> Observer {
    if written.estimator() == estimator {
        return written.clone();
    }
    let written = &if written.has_gains() { written.clone() } else { of_gains(written, step) };
    let has = |key: &str| estimator.needs().contains(&key) || estimator.admits().contains(&key);
    let one = |text: &str| Decimal::parse(text, Span::NOWHERE).ok().map(placed);
    let list = |text: &str| one(text).into_iter().collect::<Vec<_>>();
    // Gradients and least squares have the same speed at the start where a gain is the other's covariance.
    let speed = match written.estimator() {
        Estimator::Gradient | Estimator::NormalisedGradient => &written.gain,
        Estimator::LeastSquares | Estimator::LeastSquaresDrem => &written.covariance,
        Estimator::Drem | Estimator::FiniteTimeDrem | Estimator::GradientDrem => &written.regressor_gain,
    };
    let speed = if speed.is_empty() { list("1") } else { speed.clone() };
    // The scalar estimators of DREM have a gain in 1/s: no faster than the filter in front of them.
    let mixes =
        |estimator| !matches!(estimator, Estimator::Gradient | Estimator::NormalisedGradient | Estimator::LeastSquares);
    let scalar = match &written.filter {
        _ if mixes(written.estimator()) => written.gain.clone(),
        Some(filter) => vec![filter.clone()],
        None => list("1"),
    };
    let keep = |key: &str, values: &[Spanned<Decimal>]| if has(key) { values.to_vec() } else { Vec::new() };
    let or = |key: &str, values: &[Spanned<Decimal>], other: &[Spanned<Decimal>]| match keep(key, values) {
        kept if kept.is_empty() && has(key) => other.to_vec(),
        kept => kept,
    };
    Observer {
        estimator: Some(placed(estimator)),
        gain: if mixes(estimator) { scalar } else { keep("gain", &speed) },
        covariance: or("covariance", &written.covariance, &speed),
        regressor_gain: or("regressor_gain", &written.regressor_gain, &speed),
        forgetting: written.forgetting.clone().filter(|_| has("forgetting")),
        process_noise: keep("process_noise", &written.process_noise),
        normalisation: if has("normalisation") { written.normalisation.clone().or_else(|| one("1")) } else { None },
        clip: if has("clip") { written.clip.clone().or_else(|| one("0.1")) } else { None },
        period: written.period.clone().filter(|_| has("period")),
        ..written.clone()
    }
}

/// A section of known numbers without these, for gains: only least squares use them.
fn of_gains(written: &Observer, step: Option<f64>) -> Observer {
    let filter = step.and_then(|step| Decimal::parse(&format!("{:e}", BANDWIDTH / step), Span::NOWHERE).ok());
    Observer {
        within: written.within.clone(),
        extension: written.extension.clone(),
        filter: written.filter.clone().or(filter.map(placed)),
        window: written.window.clone(),
        limits: written.limits.clone(),
        gap: written.gap.clone(),
        ..Observer::default()
    }
}

/// The estimator with its settings, as a file would have them.
pub(crate) fn estimator_text(observer: &Observer) -> String {
    let one = |number: &Option<Spanned<Decimal>>| number.iter().cloned().collect::<Vec<_>>();
    let settings = [
        ("gain", observer.gain.clone()),
        ("covariance", observer.covariance.clone()),
        ("regressor_gain", observer.regressor_gain.clone()),
        ("forgetting", one(&observer.forgetting)),
        ("process_noise", observer.process_noise.clone()),
        ("normalisation", one(&observer.normalisation)),
        ("clip", one(&observer.clip)),
        ("period", one(&observer.period)),
    ];
    let mut text = observer.estimator().name().to_owned();
    for (key, numbers) in settings {
        let numbers: Vec<&str> = numbers.iter().map(|number| number.value.text()).collect();
        match numbers[..] {
            [] => {}
            [number] => text.extend([", ", key, ": ", number]),
            _ => text.extend([", ", key, ": [", &numbers.join(", "), "]"]),
        }
    }
    text
}
