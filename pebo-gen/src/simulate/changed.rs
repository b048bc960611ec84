//! A model with what a call sets in its sections.
//!
//! In: the model, and the settings of the call. Out: the model as if its file had them, without a place where they would
//! stand.

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::model::{Decimal, Entry, Estimator, Formula, Model, Observer, Operator, Piece, Simulation, Spanned, Term};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest};
use crate::tuning::BANDWIDTH;

use super::overrides::Overrides;

/// The model with noise, true parameters and estimator of the call; names and numbers that cannot be are reported.
pub(super) fn changed<'a>(model: &'a Model, overrides: &Overrides, problems: &mut Diagnostics) -> Cow<'a, Model> {
    if overrides.noise.is_empty() && overrides.plant.is_empty() && overrides.estimator.is_none() {
        return Cow::Borrowed(model);
    }
    let mut changed = model.clone();
    if let Some(simulation) = &mut changed.simulation {
        let outputs: Vec<&str> = model.y.iter().map(|output| output.value.as_str()).collect();
        for (name, deviation) in each(&overrides.noise, &outputs, "an output", |value| value >= 0.0, problems) {
            simulation.noise.retain(|entry| entry.name.value != *name);
            if deviation.to_f64() > 0.0 {
                simulation.noise.push(Entry { name: placed(name.clone()), value: placed(deviation) });
            }
        }
        let parameters: Vec<&str> = model.parameters.iter().map(|entry| entry.name.value.as_str()).collect();
        for (name, factor) in each(&overrides.plant, &parameters, "a parameter", |value| value > 0.0, problems) {
            multiply(simulation, name, &factor);
        }
    }
    if let Some(estimator) = overrides.estimator {
        let of_file = model.simulation.as_ref().and_then(|simulation| simulation.step.as_ref());
        let step = overrides.step.or(of_file.map(|step| step.value.to_f64()));
        changed.observer = with_estimator(&model.observer, estimator, step);
    }
    Cow::Owned(changed)
}

/// The entries of a call whose names are among these, with numbers as a file would have them.
fn each<'o>(
    entries: &'o BTreeMap<String, f64>,
    names: &[&str],
    what: &str,
    admitted: fn(f64) -> bool,
    problems: &mut Diagnostics,
) -> Vec<(&'o String, Decimal)> {
    let mut found = Vec::new();
    for (name, value) in entries {
        if !names.contains(&name.as_str()) {
            let message = format!("`{name}`, which the call sets, is not {what} of the model");
            let diagnostic = Diagnostic::error(Code::UnknownName, Span::NOWHERE, message);
            problems.push(match nearest(name, names.iter().copied()) {
                Some(near) => diagnostic.suggest(Some(near)),
                None => diagnostic.help(format!("choose one of {}", listed(names.iter().copied()))),
            });
            continue;
        }
        match Decimal::parse(&format!("{value:e}"), Span::NOWHERE).ok().filter(|_| admitted(*value)) {
            Some(number) => found.push((name, number)),
            None => problems.push(
                Diagnostic::error(Code::NumberOutOfRange, Span::NOWHERE, format!("`{name}` of the call is {value}"))
                    .help("give a number above zero"),
            ),
        }
    }
    found
}

fn placed<T>(value: T) -> Spanned<T> {
    Spanned { value, span: Span::NOWHERE }
}

/// Multiplies the true value of a parameter.
fn multiply(simulation: &mut Simulation, name: &str, factor: &Decimal) {
    let formula = |term| Formula { span: Span::NOWHERE, term };
    let times = |value: Formula| {
        let factor = formula(Term::Number(factor.clone()));
        formula(Term::Binary(Operator::Multiply, Box::new(factor), Box::new(value)))
    };
    if let Some(entry) = simulation.plant.iter_mut().find(|entry| entry.name.value == name) {
        for piece in &mut entry.value {
            piece.formula = times(piece.formula.clone());
        }
        return;
    }
    let piece = Piece { from: placed(Decimal::zero()), formula: times(formula(Term::Name(name.to_owned()))) };
    simulation.plant.push(Entry { name: placed(name.to_owned()), value: vec![piece] });
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
    // Gradients and least squares turn at the same rate at the start where a gain is the other's covariance.
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

/// A section of known numbers without these, for gains: only least squares has a use for them.
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
pub(super) fn told(observer: &Observer) -> String {
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
