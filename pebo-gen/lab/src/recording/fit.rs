//! Finds the numbers of an observer that make a recording most likely.
//!
//! ```text
//! log L = -1/2 sum (e^T S^-1 e + log det S)        e the innovation of a sample, S its covariance
//! ```
//!
//! In: a model with its derivation, and the first rows of a recording. Out: standard deviations of `sensors` and
//! `disturbance` with which these rows are the most likely (Schweppe, *Evaluation of likelihood functions for Gaussian
//! signals*, IEEE Trans. Information Theory, 1965), beside the `start` that was assumed or written. A disturbance without
//! which the rows are as likely is 0, and one that the author wrote as 0 remains so.

use std::ops::ControlFlow;

use pebo_design::analysis::Derivation;
use pebo_design::model::{Decimal, Entry, Model, Spanned};
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Span};

use super::log::Log;
use super::scene::Replay;
use crate::settings::KnownNumbers;
use crate::summary::short;

/// The steps of the search, as factors of a standard deviation: a tenth more or less changes no estimate that can be seen.
const FACTORS: [f64; 4] = [10.0, 3.0, 1.5, 1.1];

/// The most rounds for each factor: each makes the rows more likely, and few are needed.
const MOST_ROUNDS: usize = 12;

/// The least growth of log L that counts: two numbers that differ by less are as likely.
const GROWTH: f64 = 0.1;

/// Numbers with their names.
type Named = Vec<(String, f64)>;

/// The standard deviations that make rows most likely.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedNumbers {
    /// Those of the sensors.
    pub sensors: Vec<(String, f64)>,
    /// Those of the states at the start.
    pub start: Vec<(String, f64)>,
    /// The disturbances.
    pub disturbance: Vec<(String, f64)>,
    /// The delays of the sensors, as the author wrote them.
    pub delay: Vec<(String, f64)>,
    /// The logarithm of the ratio of the likelihoods, with these numbers and with the first guess.
    pub gain: f64,
}

impl FittedNumbers {
    /// The section `observer`, as a file would have it.
    pub fn section(&self) -> String {
        let parts = self.parts().into_iter().map(|(key, values)| format!("  {key}: {values}\n"));
        format!("observer:\n{}", parts.collect::<String>())
    }

    /// Its keys, each with its value.
    pub fn parts(&self) -> Vec<(&'static str, String)> {
        let map = |numbers: &[(String, f64)]| {
            let entries: Vec<String> =
                numbers.iter().map(|(name, value)| format!("{name}: {}", short(*value))).collect();
            format!("{{{}}}", entries.join(", "))
        };
        let found = [("sensors", &self.sensors), ("start", &self.start), ("disturbance", &self.disturbance)];
        let written = Some(("delay", &self.delay)).filter(|(_, delays)| !delays.is_empty());
        found.into_iter().chain(written).map(|(key, numbers)| (key, map(numbers))).collect()
    }
}

/// Finds the numbers for these rows; `name` is that of the recording in messages. `watch` gets the number of replays so
/// far, and may end the search with what it has.
pub fn fit(
    (model, plant, derivation): (&Model, &Plant, &Derivation),
    (name, rows): (&str, &[u8]),
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<FittedNumbers, Vec<Diagnostic>> {
    let span = model.name.span;
    if model.observer.has_gains() {
        let message = "an observer of written gains has no numbers to be fitted";
        return Err(vec![
            Diagnostic::error(Code::SettingConflict, span, message)
                .help("remove the gains under `observer`: known numbers then take their place"),
        ]);
    }
    // From a guess that does not depend on what the author wrote.
    let mut silent = model.clone();
    silent.observer.sensors.clear();
    silent.observer.disturbance.clear();
    let written = std::mem::take(&mut silent.observer.start);
    let still = model.observer.disturbance.iter().filter(|entry| entry.value.value.to_f64() == 0.0);
    let still: Vec<String> = still.map(|entry| entry.name.value.clone()).collect();
    let mut search = Search { model: silent, plant, derivation, still, name, rows, watch, count: 0, stopped: false };
    let (mut start, mut numbers) = search.guess()?;
    for (name, deviation) in &mut start {
        let known = written.iter().find(|entry| entry.name.value == *name);
        *deviation = known.map_or(*deviation, |entry| entry.value.value.to_f64());
    }
    let first = search.likelihood(&start, &numbers).ok_or_else(|| vec![unlikely(span)])?;
    let mut best = first;
    for factor in FACTORS {
        for _ in 0..MOST_ROUNDS {
            let before = best;
            for place in 0..numbers.len() {
                for factor in [factor, 1.0 / factor] {
                    let mut other = numbers.clone();
                    other[place].value *= factor;
                    let found = search.likelihood(&start, &other);
                    if let Some(found) = found.filter(|found| *found > best) {
                        (best, numbers) = (found, other);
                        break;
                    }
                }
            }
            if best - before < GROWTH || search.stopped {
                break;
            }
        }
    }
    for place in 0..numbers.len() {
        let mut without = numbers.clone();
        without[place].value = 0.0;
        let found = if without[place].is_sensor { None } else { search.likelihood(&start, &without) };
        if let Some(found) = found.filter(|found| *found > best - GROWTH) {
            (best, numbers) = (found, without);
        }
    }
    let named = |is_sensor: bool| {
        let of_kind = numbers.iter().filter(move |number| number.is_sensor == is_sensor);
        of_kind.map(|number| (number.name.clone(), number.value)).collect::<Vec<_>>()
    };
    let (sensors, mut disturbance) = (named(true), named(false));
    disturbance.extend(search.still.iter().map(|name| (name.clone(), 0.0)));
    // An output that does nothing besides its rate is not listed.
    disturbance.retain(|(name, value)| *value > 0.0 || sensors.iter().all(|(sensor, _)| sensor != name));
    let delay = model.y.iter().filter_map(|output| {
        let delay = model.observer.delay.of(&output.value)?.value.to_f64();
        (delay > 0.0).then(|| (output.value.clone(), delay))
    });
    Ok(FittedNumbers { sensors, start, disturbance, delay: delay.collect(), gain: best - first })
}

fn unlikely(span: Span) -> Diagnostic {
    Diagnostic::error(Code::SettingConflict, span, "this observer does not say how likely a sample is")
        .help("fit an observer in the output form, or of samples: one that goes through a filter has no innovations of its own")
}

/// A standard deviation that is sought.
#[derive(Clone, Debug)]
struct Number {
    name: String,
    value: f64,
    is_sensor: bool,
}

struct Search<'a> {
    /// Without numbers of sensors and disturbances.
    model: Model,
    plant: &'a Plant,
    derivation: &'a Derivation,
    /// The states and outputs whose disturbance the author wrote as 0: it stays so.
    still: Vec<String>,
    name: &'a str,
    rows: &'a [u8],
    watch: &'a mut dyn FnMut(u64) -> ControlFlow<()>,
    count: u64,
    stopped: bool,
}

impl Search<'_> {
    fn replay(&self, model: &Model) -> Result<(Replay, Log<'_>), Vec<Diagnostic>> {
        let mut log = Log::open(self.name, self.rows).map_err(|found| vec![found.explain(self.name)])?;
        let replay = Replay::resolve(model, self.plant, self.derivation, &mut log)?;
        Ok((replay, log))
    }

    /// The start, and the first guess of the others: that of an observer without numbers.
    fn guess(&self) -> Result<(Named, Vec<Number>), Vec<Diagnostic>> {
        let (replay, _) = self.replay(&self.model)?;
        let Some(known) = replay.known() else { return Err(vec![unlikely(self.model.name.span)]) };
        let of = |kind: &str| -> Named { known.of(kind).into_iter().map(|value| (value.name, value.value)).collect() };
        let number = |is_sensor: bool| move |(name, value): (String, f64)| Number { name, value, is_sensor };
        let sensors: Vec<Number> = of(KnownNumbers::SENSORS).into_iter().map(number(true)).collect();
        let disturbances = of(KnownNumbers::DISTURBANCE).into_iter().map(number(false));
        // An output may move besides its rate; as a guess, by as much as its sensor scatters, in a thousand samples.
        let root = (1000.0 * replay.period().unwrap_or(1.0)).sqrt();
        let outputs = sensors
            .iter()
            .filter(|sensor| replay.has_rate(&sensor.name))
            .map(|sensor| number(false)((sensor.name.clone(), sensor.value / root)));
        let others = disturbances.chain(outputs).filter(|number| !self.still.contains(&number.name));
        let numbers = sensors.iter().cloned().chain(others).collect();
        Ok((of(KnownNumbers::START), numbers))
    }

    /// The logarithm of the likelihood of the rows with these numbers; none where there is no observer with them, or the
    /// search is to end.
    fn likelihood(&mut self, start: &[(String, f64)], numbers: &[Number]) -> Option<f64> {
        if self.stopped {
            return None;
        }
        self.count += 1;
        self.stopped = (self.watch)(self.count).is_break();
        let mut model = self.model.clone();
        let written = |is_sensor: bool| {
            let of_kind = numbers.iter().filter(move |number| number.is_sensor == is_sensor);
            of_kind.map(|number| entry(&number.name, number.value)).collect::<Option<Vec<_>>>()
        };
        (model.observer.sensors, model.observer.disturbance) = (written(true)?, written(false)?);
        let still = self.still.iter().map(|name| entry(name, 0.0)).collect::<Option<Vec<_>>>()?;
        model.observer.disturbance.extend(still);
        model.observer.start = start.iter().map(|(name, value)| entry(name, *value)).collect::<Option<_>>()?;
        let (replay, mut log) = self.replay(&model).ok()?;
        replay.likelihood(&mut log).filter(|found| found.is_finite())
    }
}

fn entry(name: &str, value: f64) -> Option<Entry<Spanned<Decimal>>> {
    let value = Decimal::parse(&format!("{value:e}"), Span::NOWHERE).ok()?;
    let name = Spanned { value: name.to_owned(), span: Span::NOWHERE };
    Some(Entry { name, value: Spanned { value, span: Span::NOWHERE } })
}
