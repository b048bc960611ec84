//! Finds the numbers of an observer that make a recording most likely.
//!
//! ```text
//! log L = -1/2 sum (e^T S^-1 e + log det S)        e the innovation of a sample, S its covariance
//! ```
//!
//! In: a model with its derivation, the first rows of a recording, and the parameters and late outputs that are sought
//! besides. Out: standard deviations of `sensors` and `disturbance` with which these rows are the most likely (Schweppe,
//! *Evaluation of likelihood functions for Gaussian signals*, IEEE Trans. Information Theory, 1965), beside the `start` that
//! was assumed or written; values of these parameters, and delays of these outputs in whole periods. A disturbance without
//! which the rows are as likely is 0, and one that the author wrote as 0 remains so.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::rc::Rc;

use pebo_cas::Rational;
use pebo_design::analysis::Derivation;
use pebo_design::model::{Decimal, Entry, Model, Spanned};
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Span, listed};

use super::log::Log;
use super::scene::Replay;
use crate::settings::KnownNumbers;
use crate::summary::short;

/// The steps of the search, as factors of a standard deviation: a tenth more or less changes no estimate that can be seen.
const FACTORS: [f64; 4] = [10.0, 3.0, 1.5, 1.1];

/// The steps for a parameter, as factors: what an estimate errs by is about what its parameter does.
const OF_PARAMETER: [f64; 6] = [1.5, 1.2, 1.1, 1.03, 1.01, 1.003];

/// The steps for a delay, in periods: all of them first, as a delay that is off by some periods is about as unlikely as
/// none. A part of one is not sought: between two samples noise is averaged, and a part would be likely for that alone.
const OF_DELAY: [f64; 8] = [1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 21.0, 34.0];

/// The least standard deviation beside the first guess: of a sensor that errs by less, innovations say nothing.
const LEAST: f64 = 1e-4;

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
    /// The delays of the sensors in seconds, as the author wrote them or as they are found.
    pub delay: Vec<(String, f64)>,
    /// The values of the parameters that were sought.
    pub parameters: Vec<(String, f64)>,
    /// The logarithm of the ratio of the likelihoods, with these numbers and with the first guess.
    pub gain: f64,
}

impl FittedNumbers {
    /// The section `observer` as a file would have it, and the parameters that were sought.
    pub fn section(&self) -> String {
        let parts = self.parts().into_iter().map(|(key, values)| format!("  {key}: {values}\n"));
        let values = self.parameters.iter().map(|(name, value)| format!("  {name}: {}\n", digits(*value)));
        let [parts, values] = [parts.collect::<Vec<_>>().concat(), values.collect::<Vec<_>>().concat()];
        let parameters = if values.is_empty() { String::new() } else { format!("parameters:\n{values}") };
        format!("observer:\n{parts}{parameters}")
    }

    /// What the keys of a file would be set to, as `--set` takes it.
    pub fn settings(&self) -> Vec<String> {
        let parts = self.parts().into_iter().map(|(key, values)| format!("observer.{key}={values}"));
        let parameters = self.parameters.iter().map(|(name, value)| format!("parameters.{name}={}", digits(*value)));
        parts.chain(parameters).collect()
    }

    /// The keys of the section, each with its value.
    fn parts(&self) -> Vec<(&'static str, String)> {
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

/// A parameter in five digits: an estimate needs more of them than of a standard deviation.
fn digits(value: f64) -> String {
    format!("{value:.4e}")
}

/// Finds the numbers for these rows; `name` is that of the recording in messages, and `sought` has names of parameters and
/// of outputs whose delays are sought. `watch` gets the number of replays so far, and may end the search with what it has.
pub fn fit(
    (model, plant, derivation): (&Model, &Plant, &Derivation),
    (name, rows): (&str, &[u8]),
    sought: &[String],
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
    let mut search =
        Search { model: silent, plant, derivation, still, name, rows, watch, count: 0, judged: None, stopped: false };
    let (mut start, guess) = search.guess()?;
    // First of all: while these are wrong, disturbances stand in for them.
    let mut numbers = sought.iter().map(|name| search.sought(name)).collect::<Result<Vec<_>, _>>()?;
    numbers.extend(guess);
    for (name, deviation) in &mut start {
        let known = written.iter().find(|entry| entry.name.value == *name);
        *deviation = known.map_or(*deviation, |entry| entry.value.value.to_f64());
    }
    let first = search.likelihood(&start, &numbers).ok_or_else(|| vec![unlikely(span)])?;
    let guess = numbers.clone();
    let mut best = search.climb(&start, &mut numbers, first);
    if !sought.is_empty() {
        // Standard deviations that made up for what was wrong then begin anew.
        let mut anew = numbers.clone();
        for (number, guess) in anew.iter_mut().zip(guess).filter(|(number, _)| number.is_deviation()) {
            *number = guess;
        }
        if let Some(begun) = search.likelihood(&start, &anew) {
            let found = search.climb(&start, &mut anew, begun);
            if found > best {
                (best, numbers) = (found, anew);
            }
        }
    }
    for place in 0..numbers.len() {
        let mut without = numbers.clone();
        without[place].value = 0.0;
        let may_be_none = matches!(without[place].kind, Kind::Disturbance | Kind::Delay(_));
        let found = if may_be_none { search.likelihood(&start, &without) } else { None };
        if let Some(found) = found.filter(|found| *found > best - GROWTH) {
            (best, numbers) = (found, without);
        }
    }
    let named = |of_kind: fn(Kind) -> bool| -> Named {
        let of_kind = numbers.iter().filter(|number| of_kind(number.kind));
        of_kind.map(|number| (number.name.clone(), number.value)).collect()
    };
    let (sensors, mut disturbance) = (named(|kind| kind == Kind::Sensor), named(|kind| kind == Kind::Disturbance));
    let (delays, parameters) = (named(|kind| matches!(kind, Kind::Delay(_))), named(|kind| kind == Kind::Parameter));
    disturbance.extend(search.still.iter().map(|name| (name.clone(), 0.0)));
    // An output that does nothing besides its rate is not listed.
    disturbance.retain(|(name, value)| *value > 0.0 || sensors.iter().all(|(sensor, _)| sensor != name));
    let delay = model.y.iter().filter_map(|output| {
        let found = delays.iter().find(|(name, _)| *name == output.value).map(|(_, delay)| *delay);
        let written = || model.observer.delay.of(&output.value).map(|delay| delay.value.to_f64());
        found.or_else(written).filter(|delay| *delay > 0.0).map(|delay| (output.value.clone(), delay))
    });
    let delay = delay.collect();
    Ok(FittedNumbers { sensors, start, disturbance, delay, parameters, gain: best - first })
}

fn unlikely(span: Span) -> Diagnostic {
    Diagnostic::error(Code::SettingConflict, span, "this observer does not say how likely a sample is")
        .help("fit an observer in the output form, or of samples: one that goes through a filter has no innovations of its own")
}

/// The kind of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// A standard deviation of samples.
    Sensor,
    /// A drift.
    Disturbance,
    /// The delay of an output, beside the period of samples.
    Delay(f64),
    /// The value of a parameter.
    Parameter,
}

/// A number that is sought.
#[derive(Clone, Debug)]
struct Number {
    name: String,
    value: f64,
    /// The least value that is tried.
    least: f64,
    kind: Kind,
}

impl Number {
    /// True for a standard deviation.
    fn is_deviation(&self) -> bool {
        matches!(self.kind, Kind::Sensor | Kind::Disturbance)
    }

    /// The values one step to either side; none where there is no such step.
    fn beside(&self, step: usize) -> Vec<f64> {
        let by = |factors: &[f64]| {
            let beside = factors.get(step).into_iter().flat_map(|factor| [self.value * factor, self.value / factor]);
            beside.filter(|value| value.abs() >= self.least).collect()
        };
        match self.kind {
            Kind::Sensor | Kind::Disturbance => by(&FACTORS),
            Kind::Parameter => by(&OF_PARAMETER),
            Kind::Delay(period) => {
                let steps = if step == 0 { OF_DELAY.as_slice() } else { &OF_DELAY[..1] };
                let beside = steps.iter().flat_map(|periods| [*periods, -periods]);
                beside.map(|periods| self.value + periods * period).filter(|delay| *delay > -0.5 * period).collect()
            }
        }
    }
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
    /// The innovations that the first replay judged.
    judged: Option<f64>,
    stopped: bool,
}

impl Search<'_> {
    fn replay(&self, model: &Model, plant: &Plant) -> Result<(Replay, Log<'_>), Vec<Diagnostic>> {
        let mut log = Log::open(self.name, self.rows).map_err(|found| vec![found.explain(self.name)])?;
        let replay = Replay::resolve(model, plant, self.derivation, &mut log)?;
        Ok((replay, log))
    }

    /// The start, and the first guess of the others: that of an observer without numbers.
    fn guess(&self) -> Result<(Named, Vec<Number>), Vec<Diagnostic>> {
        let (replay, _) = self.replay(&self.model, self.plant)?;
        let Some(known) = replay.known() else { return Err(vec![unlikely(self.model.name.span)]) };
        let of = |kind: &str| -> Named { known.of(kind).into_iter().map(|value| (value.name, value.value)).collect() };
        let number =
            |kind: Kind| move |(name, value): (String, f64)| Number { name, value, least: LEAST * value, kind };
        let sensors: Vec<Number> = of(KnownNumbers::SENSORS).into_iter().map(number(Kind::Sensor)).collect();
        let disturbances = of(KnownNumbers::DISTURBANCE).into_iter().map(number(Kind::Disturbance));
        // An output may move besides its rate; as a guess, by as much as its sensor scatters, in a thousand samples.
        let root = (1000.0 * replay.period().unwrap_or(1.0)).sqrt();
        let outputs = sensors
            .iter()
            .filter(|sensor| replay.has_rate(&sensor.name))
            .map(|sensor| number(Kind::Disturbance)((sensor.name.clone(), sensor.value / root)));
        let others = disturbances.chain(outputs).filter(|number| !self.still.contains(&number.name));
        let numbers = sensors.iter().cloned().chain(others).collect();
        Ok((of(KnownNumbers::START), numbers))
    }

    /// Improves numbers whose likelihood is known, one after another, with ever smaller steps; gives the likelihood.
    fn climb(&mut self, start: &[(String, f64)], numbers: &mut Vec<Number>, likelihood: f64) -> f64 {
        let mut best = likelihood;
        for step in 0..OF_PARAMETER.len() {
            for _ in 0..MOST_ROUNDS {
                let before = best;
                for place in 0..numbers.len() {
                    for value in numbers[place].beside(step) {
                        let mut other = numbers.clone();
                        other[place].value = value;
                        let found = self.likelihood(start, &other);
                        if let Some(found) = found.filter(|found| *found > best) {
                            (best, *numbers) = (found, other);
                            // The other side is no better; of many delays the best counts.
                            if !matches!(numbers[place].kind, Kind::Delay(_)) {
                                break;
                            }
                        }
                    }
                }
                if best - before < GROWTH || self.stopped {
                    break;
                }
            }
        }
        best
    }

    /// The parameter or the delay of the output that is sought by this name.
    fn sought(&self, name: &str) -> Result<Number, Vec<Diagnostic>> {
        let (span, arena) = (self.model.name.span, &self.plant.arena);
        let refused = |code: Code, message: String, help: &str| {
            Err(vec![Diagnostic::error(code, span, message).help(help.to_owned())])
        };
        let name = name.to_owned();
        if let Some(parameter) = self.plant.parameters.iter().find(|known| arena.name(known.symbol) == name) {
            let value = parameter.value.as_ref().map(Rational::to_f64).filter(|value| *value != 0.0);
            let help = "give it one of the right sign and size: the proofs hold for this sign";
            return match value {
                Some(value) => Ok(Number { name, value, least: 0.0, kind: Kind::Parameter }),
                None => refused(Code::SettingConflict, format!("`{name}` has no value to begin with"), help),
            };
        }
        if !self.model.y.iter().any(|output| output.value == name) {
            let parameters = self.plant.parameters.iter().map(|parameter| arena.name(parameter.symbol));
            let names: Vec<String> = parameters.chain(self.model.y.iter().map(|y| y.value.clone())).collect();
            let help = format!("there are {}", listed(names.iter().map(String::as_str)));
            return refused(Code::UnknownEntry, format!("`{name}` is neither a parameter nor an output"), &help);
        }
        let Some(period) = self.replay(&self.model, self.plant)?.0.period() else {
            let help = "say it, as `simulation: {step: 1e-3}`: a delay is sought in whole periods";
            return refused(Code::SimulationIncomplete, "the period of the samples is not known".to_owned(), help);
        };
        // An output that cannot be late is refused here, with the reason.
        let mut late = self.model.clone();
        late.observer.delay.each.retain(|entry| entry.name.value != name);
        late.observer.delay.each.extend(entry(&name, period));
        let sought = |found: Diagnostic| found.note(format!("a delay of `{name}` was to be fitted"));
        self.replay(&late, self.plant).map_err(|found| found.into_iter().map(sought).collect::<Vec<_>>())?;
        let written = self.model.observer.delay.of(&name).map_or(0.0, |delay| delay.value.to_f64());
        let value = (written / period).round() * period;
        Ok(Number { name, value, least: 0.0, kind: Kind::Delay(period) })
    }

    /// The logarithm of the likelihood of the rows with these numbers, as of so many samples as the first replay judged; none where there is no observer with them, or the
    /// search is to end.
    fn likelihood(&mut self, start: &[(String, f64)], numbers: &[Number]) -> Option<f64> {
        if self.stopped {
            return None;
        }
        self.count += 1;
        self.stopped = (self.watch)(self.count).is_break();
        let mut model = self.model.clone();
        let written = |kind: Kind| {
            let of_kind = numbers.iter().filter(move |number| number.kind == kind);
            of_kind.map(|number| entry(&number.name, number.value)).collect::<Option<Vec<_>>>()
        };
        (model.observer.sensors, model.observer.disturbance) = (written(Kind::Sensor)?, written(Kind::Disturbance)?);
        for delayed in numbers.iter().filter(|number| matches!(number.kind, Kind::Delay(_))) {
            model.observer.delay.each.retain(|entry| entry.name.value != delayed.name);
            model.observer.delay.each.push(entry(&delayed.name, delayed.value.max(0.0))?);
        }
        let mut plant = Cow::Borrowed(self.plant);
        for Number { name, value, .. } in numbers.iter().filter(|number| number.kind == Kind::Parameter) {
            let plant = plant.to_mut();
            let arena = Rc::clone(&plant.arena);
            let parameter = plant.parameters.iter_mut().find(|known| arena.name(known.symbol) == *name)?;
            parameter.value = Some(Rational::from_decimal(&format!("{value:e}")).ok()?);
        }
        let still = self.still.iter().map(|name| entry(name, 0.0)).collect::<Option<Vec<_>>>()?;
        model.observer.disturbance.extend(still);
        model.observer.start = start.iter().map(|(name, value)| entry(name, *value)).collect::<Option<_>>()?;
        let found = self.replay(&model, &plant).ok();
        let (likelihood, judged) = found.and_then(|(replay, mut log)| replay.likelihood(&mut log))?;
        // A late sample is judged when it has arrived: of a longer delay there are fewer.
        let first = *self.judged.get_or_insert(judged);
        Some(likelihood * (first / judged)).filter(|found| found.is_finite())
    }
}

fn entry(name: &str, value: f64) -> Option<Entry<Spanned<Decimal>>> {
    let value = Decimal::parse(&format!("{value:e}"), Span::NOWHERE).ok()?;
    let name = Spanned { value: name.to_owned(), span: Span::NOWHERE };
    Some(Entry { name, value: Spanned { value, span: Span::NOWHERE } })
}
