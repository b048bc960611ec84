//! Numbers that are fitted to a simulation's own table.

use std::ops::ControlFlow;

use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

use super::replay;
use super::truth::{GROWTH, simulated};
use crate::recording::{FittedNumbers, fit};

/// The numbers of a model that fit a recording.
fn numbers(model: &str, csv: &str) -> Result<FittedNumbers, Vec<Diagnostic>> {
    let source = Source::new("test", model).expect("a short text");
    let model = Model::parse(&source)?;
    let plant = Plant::resolve(&model)?;
    let derivation = Derivation::derive(&plant);
    fit((&model, &plant, &derivation), ("log.csv", csv.as_bytes()), &mut |_| ControlFlow::Continue(()))
}

#[test]
fn fitted_numbers_are_those_of_the_simulation() {
    let simulation = "simulation: {duration: 10, step: 0.01, initial: {START}, noise: {q: 0.01}, signals: {s: {0: 0.2, \
                      3: 0.5, 6: 0.2, 9: 0.5, 12: 0.2, 15: 0.5}}, control: {f: s}";
    let fitted = |model: &str, plant: &str| {
        let simulation = simulation.replace("START", if plant.is_empty() { "a: -0.3, q: 1" } else { "q: 1" });
        let csv = simulated(&format!("{GROWTH}{simulation}{plant}}}\n"), (10.0, 0.01)).csv();
        (numbers(model, &csv).expect("numbers"), csv)
    };
    // Nothing but the sensor scatters.
    let (found, csv) = fitted(GROWTH, "");
    assert!((found.sensors[0].1 / 0.01 - 1.0).abs() < 0.1 && found.gain >= 0.0, "{found:?}");
    assert_eq!(found.disturbance, [("a".to_owned(), 0.0)]);
    // The section that is printed is one that a replay takes.
    let (replayed, _) = replay(&format!("{GROWTH}{}", found.section()), &csv).expect("a replay");
    assert!(replayed.summary.contradiction.is_none(), "{}", replayed.text());
    assert!(replayed.summary.estimates[0].expected.is_some_and(|expected| expected < 0.01), "{}", replayed.text());
    // A pace that moves, by its rms rate of some 0.04 per second over times of a second, wanders.
    let (found, _) = fitted(GROWTH, ", plant: {a: -0.3 + 0.05*sin(t)}");
    let wanders = found.disturbance.iter().find(|(name, _)| name == "a").expect("it is sought").1;
    assert!((0.005..0.2).contains(&wanders) && found.gain > 10.0, "{found:?}");
    // What the author wrote as 0 stays 0, and so does the start.
    let told = format!("{GROWTH}observer: {{start: {{a: 1}}, disturbance: {{a: 0}}}}\n");
    let (found, _) = fitted(&told, ", plant: {a: -0.3 + 0.05*sin(t)}");
    assert!(found.disturbance.contains(&("a".to_owned(), 0.0)), "{found:?}");
    assert_eq!(found.start, [("a".to_owned(), 1.0)]);
    let (found, _) = fitted(&told.replace(", disturbance: {a: 0}", ""), ", plant: {a: -0.3 + 0.05*sin(t)}");
    assert!(found.disturbance.iter().any(|(name, value)| name == "a" && *value > 0.005), "{found:?}");
    // Gains are no numbers.
    let gains = format!("{GROWTH}observer: {{gain: 1, filter: 1}}\n");
    assert!(numbers(&gains, &csv).is_err_and(|found| found[0].message.contains("written gains")));
}
