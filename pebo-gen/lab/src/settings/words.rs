//! The known numbers behind an observer's settings, in words.

use serde::Serialize;

use pebo_cas::Rational;
use pebo_design::model::Model;
use pebo_design::plant::Plant;

use super::kind::ObserverKind;
use super::magnitude::Deviations;
use super::prediction::{Prediction, UNWEIGHED};
use super::shown::Shown;

/// The known numbers of sensors, start and disturbances, with the derived ones.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KnownNumbers {
    /// The kind of the observer, in words.
    pub observer: String,
    /// Each kind of number with its values.
    pub numbers: Vec<Numbers>,
    /// The reason why no standard errors are predicted; none where they are.
    pub unpredicted: Option<String>,
    /// True for a regression of first order, with which these numbers hold near the state.
    #[serde(skip)]
    pub(crate) is_local: bool,
}

/// Numbers of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Numbers {
    /// Their kind, in words.
    pub what: String,
    /// True if they are assumed, not written by the author.
    pub assumed: bool,
    /// True if they are those that the first rows of a recording show.
    pub recorded: bool,
    /// Names and values, with units.
    pub values: Vec<Value>,
}

/// The value of a name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Value {
    /// The name.
    pub name: String,
    /// The value.
    pub value: f64,
    /// The unit, if the model has one.
    pub unit: Option<String>,
}

impl KnownNumbers {
    /// The kind of the sensors' standard deviations.
    pub(crate) const SENSORS: &str = "sensors";

    /// The kind of those of the states at the start.
    pub(crate) const START: &str = "start";

    /// The kind of the states' disturbances.
    pub(crate) const DISTURBANCE: &str = "disturbance";

    /// The numbers of this kind.
    pub(crate) fn of(&self, kind: &str) -> Vec<Value> {
        self.numbers.iter().filter(|numbers| numbers.what == kind).flat_map(|numbers| numbers.values.clone()).collect()
    }

    pub(super) fn new(
        plant: &Plant,
        (model, shown): (&Model, &Shown),
        deviations: &Deviations,
        (kind, rebased, adapts): (ObserverKind, bool, bool),
        [covariance, noise]: [&[f64]; 2],
    ) -> Self {
        let filter = if deviations.is_local { "an extended Kalman filter" } else { "a Kalman filter" };
        let observer = match (kind, rebased) {
            (ObserverKind::Output, _) => format!("output form, {filter} of the transformed plant"),
            (ObserverKind::Sampled, true) => format!("least squares of samples, {filter} of the transformed plant"),
            (ObserverKind::Sampled, false) => "least squares of samples".to_owned(),
            (ObserverKind::Filtered, _) => "least squares through a filter".to_owned(),
        };
        let observer =
            if adapts { format!("{observer}, with as much of the disturbance as samples show") } else { observer };
        let derived = [("covariance", coordinates(covariance)), ("process noise", coordinates(noise))];
        Self::with(observer, plant, (model, shown), deviations, derived.into())
    }

    /// Those of a gradient, with its gain and normalisation.
    pub(super) fn of_gradient(
        plant: &Plant,
        (model, shown): (&Model, &Shown),
        deviations: &Deviations,
        (gain, mu): (&[Rational], &Rational),
    ) -> Self {
        let gain: Vec<f64> = gain.iter().map(Rational::to_f64).collect();
        let mu = Value { name: "mu".to_owned(), value: mu.to_f64(), unit: None };
        let derived = [("gain", coordinates(&gain)), ("normalisation", vec![mu])];
        let observer = "normalised gradient of samples, with the slopes at the estimate".to_owned();
        let known = Self::with(observer, plant, (model, shown), deviations, derived.into());
        Self { unpredicted: Some(UNWEIGHED.to_owned()), is_local: false, ..known }
    }

    fn with(
        observer: String,
        plant: &Plant,
        (model, shown): (&Model, &Shown),
        deviations: &Deviations,
        derived: Vec<(&str, Vec<Value>)>,
    ) -> Self {
        let arena = &plant.arena;
        let x: Vec<_> = plant.x.iter().map(|state| state.symbol).collect();
        let y: Vec<_> = plant.y.iter().map(|output| output.symbol).collect();
        let named = |symbols: &[pebo_cas::Symbol], values: &[f64], per: &str| -> Vec<Value> {
            let value = |(symbol, value): (&pebo_cas::Symbol, &f64)| Value {
                name: arena.name(*symbol),
                value: *value,
                unit: plant.units.get(symbol).map(|unit| format!("{unit}{per}")),
            };
            symbols.iter().zip(values).map(value).collect()
        };
        let written = &model.observer;
        let lacks = |symbols: &[pebo_cas::Symbol], entries: &[pebo_design::model::Entry<_>]| {
            let known = |symbol| {
                entries.iter().any(|entry: &pebo_design::model::Entry<_>| entry.name.value == arena.name(symbol))
            };
            !symbols.iter().all(|symbol| known(*symbol))
        };
        let root = " per root second";
        let mut drifts = named(&x, &deviations.disturbance, root);
        drifts.extend(named(&y, &deviations.of_outputs, root).into_iter().filter(|drift| drift.value > 0.0));
        let numbers = |what: &str, assumed, values| Numbers { what: what.to_owned(), assumed, recorded: false, values };
        let are_assumed = lacks(&y, &written.sensors);
        // A sensor that shows nothing of its noise has an assumed one.
        let are_shown = are_assumed && y.iter().all(|output| shown.deviations.contains_key(output));
        let delays = plant.y.iter().filter_map(|output| {
            let name = arena.name(output.symbol);
            let value = written.delay.of(&name)?.value.to_f64();
            (value > 0.0).then(|| Value { name, value, unit: Some("s".to_owned()) })
        });
        let delays: Vec<Value> = delays.collect();
        let silent = written.known().is_none_or(|(key, _)| key == "form");
        Self {
            observer,
            numbers: vec![Numbers {
                recorded: are_shown,
                ..numbers(Self::SENSORS, are_assumed && !are_shown, named(&y, &deviations.sensors, ""))
            }]
            .into_iter()
            .chain((!delays.is_empty()).then(|| numbers("delay", false, delays)))
            .chain([
                numbers(Self::START, lacks(&x, &written.start), named(&x, &deviations.start, "")),
                numbers(Self::DISTURBANCE, silent, drifts),
            ])
            .chain(derived.into_iter().map(|(what, values)| numbers(what, false, values)))
            .collect(),
            unpredicted: None,
            is_local: deviations.is_local,
        }
    }

    /// The same with the reason why nothing is predicted, if there is one.
    pub(super) fn predicted(self, prediction: &Prediction) -> Self {
        let unpredicted = match prediction {
            Prediction::None(reason) => Some((*reason).to_owned()),
            Prediction::Covariance | Prediction::Noise(_) => None,
        };
        Self { unpredicted, ..self }
    }
}

/// The numbers of coordinates, by their names.
fn coordinates(values: &[f64]) -> Vec<Value> {
    let value = |(place, value): (usize, &f64)| Value { name: format!("z{}", place + 1), value: *value, unit: None };
    values.iter().enumerate().map(value).collect()
}
