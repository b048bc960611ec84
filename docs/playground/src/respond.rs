//! From a question to its answer.

use std::collections::BTreeMap;

use pebo_gen::model::{Estimator, Model, json_schema};
use pebo_gen::source::{Code, Diagnostic, Source};
use pebo_gen::{Answer, Derived, Request, RunRequest, Solution, Tape, derive_within, solve};
use serde::Serialize;

use super::cache::{ModelCache, budget};
use super::question::Question;

/// The name of the text of a page's editor.
const NAME: &str = "model.yaml";

/// The answer on a model, with the replacements and settings that a page offers.
#[derive(Debug, Serialize)]
struct CheckAnswer {
    #[serde(flatten)]
    answer: Answer,
    /// The replacement at the span of each diagnostic, if that mends it.
    replacements: Vec<Option<String>>,
    /// The settings of the simulation, if there is one and everything is proved.
    knobs: Option<Knobs>,
}

/// The settings of a simulation.
#[derive(Debug, Serialize)]
struct Knobs {
    duration: Option<f64>,
    step: Option<f64>,
    /// Outputs with the standard deviations of their samples.
    noise: Vec<(String, f64)>,
    /// Parameters that have a value.
    parameters: Vec<String>,
    estimator: &'static str,
    estimators: &'static [&'static str],
}

impl Knobs {
    fn of(model: &Model) -> Option<Self> {
        let simulation = model.simulation.as_ref()?;
        let deviation = |output: &str| {
            let entry = simulation.noise.iter().find(|entry| entry.name.value == output);
            entry.map_or(0.0, |entry| entry.value.value.to_f64())
        };
        let valued = model.parameters.iter().filter(|parameter| parameter.value.is_some());
        Some(Self {
            duration: simulation.duration.as_ref().map(|duration| duration.value.to_f64()),
            step: simulation.step.as_ref().map(|step| step.value.to_f64()),
            noise: model.y.iter().map(|output| (output.value.clone(), deviation(&output.value))).collect(),
            parameters: valued.map(|parameter| parameter.name.value.clone()).collect(),
            estimator: model.observer.estimator().name(),
            estimators: Estimator::NAMES,
        })
    }
}

/// A run with its signals as CSV.
#[derive(Debug, Serialize)]
struct RunAnswer {
    #[serde(flatten)]
    answer: Answer,
    csv: Option<String>,
}

/// A replay with its figure as SVG, and its estimates as CSV.
#[derive(Debug, Serialize)]
struct ReplayAnswer {
    #[serde(flatten)]
    answer: Answer,
    figure: Option<String>,
    csv: Option<String>,
}

/// The story of a diagnostic.
#[derive(Debug, Serialize)]
struct Story {
    title: &'static str,
    explanation: &'static str,
    example: &'static str,
    paper: Option<&'static str>,
}

/// The answer to a malformed question.
#[derive(Debug, Serialize)]
struct QuestionError {
    error: String,
}

/// Answers a question.
pub(super) fn respond(cache: &mut ModelCache, question: &str) -> String {
    let question = match serde_json::from_str(question) {
        Ok(question) => question,
        Err(error) => return json(&QuestionError { error: error.to_string() }),
    };
    match question {
        Question::Check { text, limit } => {
            let answer = |cache: &ModelCache, derived: &Derived, source: &Source| {
                Answer::on(derived, source, &cache.ask().sections())
            };
            let (answer, model) = of_model(cache, &text, limit, answer);
            let accepted = answer.report.verdict == pebo_gen::analysis::Outcome::Accepted;
            let knobs = model.filter(|_| accepted).and_then(|model| Knobs::of(&model));
            let replacement = |diagnostic: &Diagnostic| diagnostic.replacement().map(str::to_owned);
            let replacements = answer.diagnostics.iter().map(replacement).collect();
            json(&CheckAnswer { answer, replacements, knobs })
        }
        Question::Emit { text, limit, scalar } => json(
            &of_model(cache, &text, limit, |cache, derived, source| {
                Answer::on(derived, source, &cache.ask().emit(scalar.into()))
            })
            .0,
        ),
        Question::Simulate { text, limit, set, how, csv } => {
            let run = RunRequest { overrides: how.into(), trace: csv, figure: true, runs: None };
            let (mut answer, _) = of_setting(cache, (&text, &set), limit, |cache, derived, source| {
                Answer::on(derived, source, &cache.ask().run(run))
            });
            let trace = answer.run.as_mut().and_then(|run| run.trace.take());
            json(&RunAnswer { csv: trace.map(|trace| trace.csv()), answer })
        }
        Question::Solve { text, limit } => json(&match Source::new(NAME, text) {
            Ok(source) => solve(&source, None, &limited(cache.ask(), limit)),
            Err(diagnostic) => Solution::of_unread("model", vec![diagnostic], &Source::unread(NAME)),
        }),
        Question::Replay { text, limit, name, csv } => {
            let mut estimates = Vec::new();
            let (answer, _) = of_model(cache, &text, limit, |cache, derived, source| {
                let tape = Tape { name: &name, recording: &mut csv.as_bytes(), estimates: Some(&mut estimates) };
                Answer::replayed_on(derived, source, &cache.ask(), tape)
            });
            let csv = answer.replay.is_some().then(|| String::from_utf8_lossy(&estimates).into_owned());
            let figure = answer.replay.as_ref().map(|replay| replay.figure.clone());
            json(&ReplayAnswer { answer, figure, csv })
        }
        Question::Stories => {
            let story = |code: Code| Story {
                title: code.title(),
                explanation: code.explanation(),
                example: code.example(),
                paper: code.paper(),
            };
            json(&Code::ALL.iter().map(|code| (code.name(), story(*code))).collect::<BTreeMap<_, _>>())
        }
        Question::Version => json(&env!("CARGO_PKG_VERSION")),
        Question::Schema => json_schema(),
    }
}

fn limited(ask: Request, limit: Option<f64>) -> Request {
    match limit {
        Some(seconds) => ask.limit(seconds),
        None => ask,
    }
}

/// The answer on a text, and the model if it is one.
fn of_model(
    cache: &mut ModelCache,
    text: &str,
    limit: Option<f64>,
    answer: impl FnOnce(&ModelCache, &Derived, &Source) -> Answer,
) -> (Answer, Option<Model>) {
    of_setting(cache, (text, &[]), limit, answer)
}

/// The same on a text with settings. The derivation of the text alone is kept, which settings of its loop do not
/// change.
fn of_setting(
    cache: &mut ModelCache,
    (text, settings): (&str, &[String]),
    limit: Option<f64>,
    answer: impl FnOnce(&ModelCache, &Derived, &Source) -> Answer,
) -> (Answer, Option<Model>) {
    let both = Source::new(NAME, text).and_then(|source| Ok((source.clone(), source.set(settings)?)));
    let (source, set) = match both {
        Ok(both) => both,
        Err(diagnostic) => {
            return (Answer::of_unread("model", vec![diagnostic], &Source::unread(NAME)), None);
        }
    };
    let unread = |diagnostics: Vec<Diagnostic>| (Answer::of_unread("model", diagnostics, &set), None);
    let mut derived = cache.take(&source, limit);
    let answered = match &mut derived {
        Ok(derived) if settings.is_empty() => (answer(cache, derived, &set), Some(derived.model.clone())),
        Ok(derived) => match Model::parse(&set) {
            Ok(model) if derived.holds_of(&model) => {
                let usual = std::mem::replace(&mut derived.model, model);
                let answer = answer(cache, derived, &set);
                (answer, Some(std::mem::replace(&mut derived.model, usual)))
            }
            Ok(_) => match derive_within(&set, budget(limit)) {
                Ok(other) => (answer(cache, &other, &set), Some(other.model)),
                Err(diagnostics) => unread(diagnostics),
            },
            Err(diagnostics) => unread(diagnostics),
        },
        Err(diagnostics) => unread(diagnostics.clone()),
    };
    cache.keep(&source, limit, derived);
    answered
}

/// Values of this crate always serialise: strings, numbers, and maps with string keys.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
