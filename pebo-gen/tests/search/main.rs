//! Searches for transforms: found and proved, bounded, or reported to be neither.
#![cfg(feature = "yaml")]

mod filled;
mod literature;
mod plants;
mod refusals;

use pebo_gen::analysis::{Class, Outcome};
use pebo_gen::model::Model;
use pebo_gen::plant::Plant;
use pebo_gen::search::{Search, SearchVerdict, solve};
use pebo_gen::source::Source;

/// The plant of these lines, and the result of a search for its transform.
fn search(lines: &str, class: Option<Class>) -> (Plant, Search) {
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).expect("a text");
    let model = Model::parse(&source).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message));
    let plant = Plant::resolve(&model).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message));
    let search = solve(&plant, class);
    (plant, search)
}

/// Asserts the property of a found transform: with it written in, every claim of the model is proved, as with any
/// transform of an author.
fn written(lines: &str, search: &Search) -> (Class, usize) {
    let best = search.candidates.first().expect("a candidate");
    assert_eq!(search.verdict, SearchVerdict::Found, "{lines}");
    let phi: Vec<String> = best.formulas().iter().map(|formula| format!("\"{formula}\"")).collect();
    let text = format!("model: m\n{lines}\nphi: [{}]\n", phi.join(", "));
    let derived = pebo_gen::derive(&Source::new("m.yaml", text.as_str()).expect("a text"));
    let derived = derived.unwrap_or_else(|d| panic!("{text}: {}", d[0].message));
    assert_eq!(derived.derivation.outcome, Outcome::Accepted, "{text}");
    let recovered = derived.derivation.left_inverse.result.expect("a left inverse").x.len();
    assert_eq!(recovered, derived.plant.x.len(), "{text}");
    (derived.derivation.class, derived.plant.phi.len())
}
