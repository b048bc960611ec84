//! Verdicts held against truth: random models whose truth is known by construction, and a judge in floating point
//! that shares no code with the algebra.
//!
//! `PEBO_MODELS` is the number of models, `PEBO_FIRST_MODEL` the first of them; `--nocapture` shows the counts by kind.

mod answers;
mod draw;
mod formula;
mod judge;
mod make;
mod plant;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use pebo_gen::Derived;
use pebo_gen::analysis::Outcome;
use pebo_gen::model::Model;
use pebo_gen::report;
use pebo_gen::source::Source;

use make::Truth;
use plant::Plant;

/// Models of a run that nobody asked more of.
const MODELS: u64 = 150;

/// What counts as slow.
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

#[test]
fn verdicts_agree_with_what_is_true() {
    let (first, models) = (setting("PEBO_FIRST_MODEL", 1), setting("PEBO_MODELS", MODELS));
    let mut counts: BTreeMap<&str, Counts> = BTreeMap::new();
    let mut causes: BTreeMap<String, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for seed in first..first + models {
        let made = make::model(seed);
        let source = Source::new("m", made.text.as_str()).expect("a text");
        let start = Instant::now();
        let model = Model::parse(&source).unwrap_or_else(|d| panic!("{}\n{}", d[0].message, made.text));
        let plant = Plant::read(&source, &model).expect("a plant by its equations");
        let derived = match Derived::of(model) {
            Ok(derived) => derived,
            Err(diagnostics) => {
                wrong.push(format!("seed {seed} ({}): malformed, {}", made.kind, diagnostics[0].message));
                continue;
            }
        };
        let took = start.elapsed();
        let text = report::check(&derived.plant, &derived.derivation, &source);
        let json = serde_json::from_str(&text).expect("a report");
        let (complaints, points) = judge::complaints(&plant, &derived, &json, seed);
        let count = counts.entry(made.kind).or_default();
        count.points += points;
        count.slow += usize::from(took > SLOW);
        if took > SLOW {
            println!("seed {seed} ({}): {took:.1?}", made.kind);
        }
        match derived.derivation.outcome {
            Outcome::Accepted => count.accepted += 1,
            Outcome::Rejected => count.rejected += 1,
            Outcome::Undecided => {
                count.undecided += 1;
                let diagnostic = derived.derivation.diagnostics.first();
                let cause = diagnostic.map_or_else(String::new, |d| {
                    format!("{}: {}", d.code.name(), d.notes.first().map_or("", |note| note.as_str()))
                });
                if setting("PEBO_SHOW", 0) > 0 && made.truth == Truth::Holds {
                    println!("seed {seed} ({}) undecided: {cause}", made.kind);
                }
                *causes.entry(format!("{}, {cause}", made.kind)).or_default() += 1;
            }
        }
        let verdict = match (made.truth, derived.derivation.outcome) {
            (Truth::Fails, Outcome::Accepted) => Some("UNSOUND: accepted, though a claim fails"),
            (Truth::Holds, Outcome::Rejected) => Some("FALSELY REFUTED"),
            _ => None,
        };
        let said = verdict.map(str::to_owned).into_iter().chain(complaints);
        wrong.extend(said.map(|what| format!("seed {seed} ({}): {what}\n{}", made.kind, made.text)));
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
