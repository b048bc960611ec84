//! Verdicts compared with truth: random models whose truth is known by construction, and a judge in floating point
//! that shares no code with the algebra.
//!
//! `PEBO_MODELS` is the number of models, `PEBO_FIRST_MODEL` the first of them; `--nocapture` shows the counts by kind.

mod answers;
mod draw;
mod emitted;
mod formula;
mod judge;
mod make;
mod plant;

use std::collections::BTreeMap;
use std::num::NonZero;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use pebo_gen::Derived;
use pebo_gen::analysis::Outcome;
use pebo_gen::model::Model;
use pebo_gen::report::Report;
use pebo_gen::source::Source;

use make::Truth;
use plant::Plant;

/// The default number of models.
const MODELS: u64 = 60;

/// A longer derivation is slow.
const SLOW: Duration = Duration::from_secs(2);

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |value| value.parse().unwrap_or_else(|_| panic!("{name} is a number")))
}

#[derive(Default)]
struct Counts {
    accepted: usize,
    rejected: usize,
    undecided: usize,
    slow: usize,
    points: usize,
}

/// The observations of one model.
struct Observation {
    kind: &'static str,
    /// None where the model was malformed.
    outcome: Option<Outcome>,
    /// The reason that it is undecided, and the truth of every claim.
    cause: Option<(String, bool)>,
    slow: Option<Duration>,
    points: usize,
    wrong: Vec<String>,
}

/// Checks the model of a seed, and compares the verdict with its truth and its formulas.
fn look(seed: u64) -> Observation {
    let made = make::model(seed);
    let source = Source::new("m", made.text.as_str()).expect("a text");
    let start = Instant::now();
    let model = Model::parse(&source).unwrap_or_else(|d| panic!("{}\n{}", d[0].message, made.text));
    let plant = Plant::read(&source, &model).expect("a plant by its equations");
    let mut seen =
        Observation { kind: made.kind, outcome: None, cause: None, slow: None, points: 0, wrong: Vec::new() };
    let derived = match Derived::of(model) {
        Ok(derived) => derived,
        Err(diagnostics) => {
            seen.wrong.push(format!("malformed, {}\n{}", diagnostics[0].message, made.text));
            return seen;
        }
    };
    let took = start.elapsed();
    seen.slow = (took > SLOW).then_some(took);
    let text = Report::of(&derived.plant, &derived.derivation, &derived.derivation.diagnostics, &source).line();
    let json = serde_json::from_str(&text).expect("a report");
    let (complaints, points) = judge::complaints(&plant, &derived, &json, seed);
    seen.points = points;
    let outcome = derived.derivation.outcome;
    seen.outcome = Some(outcome);
    seen.cause = (outcome == Outcome::Undecided).then(|| {
        let diagnostic = derived.derivation.diagnostics.first();
        let cause = diagnostic.map_or_else(String::new, |d| {
            format!("{}: {}", d.code.name(), d.notes.first().map_or("", |note| note.as_str()))
        });
        (cause, made.truth == Truth::Holds)
    });
    let verdict = match (made.truth, outcome) {
        (Truth::Fails, Outcome::Accepted) => Some("UNSOUND: accepted, though a claim fails"),
        (Truth::Holds, Outcome::Rejected) => Some("FALSELY REFUTED"),
        _ => None,
    };
    let said = verdict.map(str::to_owned).into_iter().chain(complaints);
    seen.wrong = said.map(|what| format!("{what}\n{}", made.text)).collect();
    seen
}

/// Looks at all models, on as many threads as there are processors, and tells how far it is; in the order of the seeds.
fn look_at(seeds: Range<u64>) -> Vec<(u64, Observation)> {
    let next = AtomicU64::new(seeds.start);
    let found = Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if !seeds.contains(&seed) {
                        break;
                    }
                    let seen = look(seed);
                    if let Some(took) = seen.slow {
                        println!("seed {seed} ({}): {took:.1?}", seen.kind);
                    }
                    let mut found = found.lock().expect("no thread panicked");
                    found.push((seed, seen));
                    if found.len() % 500 == 0 {
                        println!("{} models", found.len());
                    }
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no thread panicked");
    found.sort_by_key(|(seed, _)| *seed);
    found
}

#[test]
fn verdicts_agree_with_the_truth() {
    let (first, models) = (setting("PEBO_FIRST_MODEL", 1), setting("PEBO_MODELS", MODELS));
    let mut counts: BTreeMap<&str, Counts> = BTreeMap::new();
    let mut causes: BTreeMap<String, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (seed, seen) in look_at(first..first + models) {
        let kind = seen.kind;
        let count = counts.entry(kind).or_default();
        count.points += seen.points;
        count.slow += usize::from(seen.slow.is_some());
        match seen.outcome {
            Some(Outcome::Accepted) => count.accepted += 1,
            Some(Outcome::Rejected) => count.rejected += 1,
            Some(_) => count.undecided += 1,
            None => {}
        }
        if let Some((cause, holds)) = seen.cause {
            if holds && setting("PEBO_SHOW", 0) > 0 {
                println!("seed {seed} ({kind}) undecided: {cause}");
            }
            *causes.entry(format!("{kind}, {cause}")).or_default() += 1;
        }
        wrong.extend(seen.wrong.into_iter().map(|what| format!("seed {seed} ({kind}): {what}")));
    }
    for (kind, count) in &counts {
        println!(
            "{kind:<20} accepted {:>5}  rejected {:>5}  undecided {:>5}  slow {:>3}  points {:>7}",
            count.accepted, count.rejected, count.undecided, count.slow, count.points
        );
    }
    for (cause, times) in &causes {
        println!("{times:>5} undecided: {cause}");
    }
    assert!(wrong.is_empty(), "{} of {models} are wrong:\n{}", wrong.len(), wrong.join("\n"));
}
