//! Plants with verified answers: derivations compared with them formula by formula.
//!
//! The answers stand in the comments at the head of each file of `tests/cases`; they were made with another computer
//! algebra system and by integrating the plants.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value as Json;

use pebo_gen::model::Model;
use pebo_gen::report::Report;
use pebo_gen::source::Source;

use super::draw::Draw;
use super::formula::{Formula, Values};
use super::plant::Plant;

/// Points at which two formulas are compared, and how many may be drawn to find them in the domain.
const POINTS: usize = 20;
const DRAWS: usize = 1000;

/// An answer: lists of formulas by their names.
type Answer = BTreeMap<String, Json>;

fn answer(text: &str) -> Answer {
    let entry = |line: &str| {
        let (key, value) = line.strip_prefix("#   ")?.split_once(": ")?;
        Some((key.to_owned(), serde_json::from_str(value).ok()?))
    };
    text.lines().map_while(|line| line.strip_prefix('#').map(|_| line)).filter_map(entry).collect()
}

/// The formulas of a list, or of a list of lists, in order.
fn formulas(json: &Json) -> Vec<Formula> {
    match json {
        Json::String(text) => vec![Formula::read(text)],
        Json::Array(list) => list.iter().flat_map(formulas).collect(),
        _ => Vec::new(),
    }
}

/// Values for every name that one of the formulas uses; the names of the paper and the answers for one thing agree.
fn values(names: &[&Formula], draw: &mut Draw) -> Values {
    let mut values = Values::new();
    for name in names.iter().flat_map(|formula| formula.names()) {
        let plain = name.replace("theta", "th").replace("xi", "chi");
        let value = values.get(&plain).copied().unwrap_or((0.2 + draw.unit(), 0.0));
        values.insert(plain, value);
        values.insert(name, value);
    }
    values
}

/// The formulas are equal, one by one, where the plant's assumptions hold.
fn equal(plant: &Plant, found: &[Formula], wanted: &[Formula], draw: &mut Draw) -> bool {
    let same = |(a, b): (&Formula, &Formula), draw: &mut Draw| {
        let points = (0..DRAWS).map(|_| values(&[a, b], draw)).filter(|values| plant.admits(values)).take(POINTS);
        let equal: Vec<bool> = points
            .map(|values| {
                let (a, b) = (a.at(&values), b.at(&values));
                // Rounding of some ten operations on the values met.
                (a.value - b.value).abs() <= 1e-12 * a.size.max(b.size).max(1.0)
            })
            .collect();
        equal.len() == POINTS && equal.iter().all(|equal| *equal)
    };
    found.len() == wanted.len() && found.iter().zip(wanted).all(|pair| same(pair, draw))
}

/// The regression as one formula a row, at an unknown theta.
fn totals(known: &Json, factors: &Json, eta: &Json) -> Vec<Formula> {
    let (known, factors, eta) = (formulas(known), formulas(factors), formulas(eta));
    let sum = |a: Formula, b: Formula| Formula::Binary('+', Box::new(a), Box::new(b));
    let product = |a: &Formula, b: &Formula| Formula::Binary('*', Box::new(a.clone()), Box::new(b.clone()));
    let row = |(known, factors): (&Formula, &[Formula])| {
        factors.iter().zip(&eta).fold(known.clone(), |total, (factor, eta)| sum(total, product(factor, eta)))
    };
    known.iter().zip(factors.chunks(eta.len().max(1))).map(row).collect()
}

#[test]
fn formulas_are_those_of_the_verified_answers() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/cases");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder).expect("the cases").map(|entry| entry.expect("a case").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    let draw = &mut Draw::new(7);
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for path in &paths {
        let text = std::fs::read_to_string(path).expect("a case");
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let answer = answer(&text);
        let source = Source::new(&name, text.as_str()).expect("a text");
        let plant = Plant::read(&source, &Model::parse(&source).expect("a model")).expect("a plant by its equations");
        let derived = pebo_gen::derive(&source).unwrap_or_else(|d| panic!("{name}: {}", d[0].message));
        let report = Report::of(&derived.plant, &derived.derivation, &derived.derivation.diagnostics, &source);
        let report: Json = serde_json::from_str(&report.line()).expect("a report");
        let mut compare = |what: &str, found: &[Formula], wanted: &[Formula]| {
            compared += wanted.len();
            if !equal(&plant, found, wanted, draw) {
                wrong.push(format!("{name}: another {what}"));
            }
        };
        let accepted = report["verdict"] == "accepted";
        for (key, found) in [("h", "h"), ("B", "h"), ("Lambda", "lambda")] {
            // A claim that is refused has no formulas to compare.
            if let Some(wanted) = answer.get(key).filter(|_| report["cascade"]["verdict"] == "proved") {
                compare(key, &formulas(&report["cascade"][found]), &formulas(wanted));
            }
        }
        let regression = &report["regression"];
        if !accepted || regression["kind"] != "dynamic" {
            continue;
        }
        if let (Some(known), Some(factors)) = (answer.get("Phi0"), answer.get("Phi1")) {
            compare("Phi_0", &formulas(&regression["phi_0"]), &formulas(known));
            compare("Phi_1", &formulas(&regression["phi_1"]), &formulas(factors));
        }
        if let (Some(known), Some(factors), Some(eta)) = (answer.get("Phi0"), answer.get("S"), answer.get("eta")) {
            let found = totals(&regression["phi_0"], &regression["phi_1"], &regression["eta"]);
            let th: Json = serde_json::from_str(&eta.to_string().replace("th", "theta")).expect("a list");
            compare("regression", &found, &totals(known, factors, &th));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared > 50, "only {compared} formulas were compared");
}
