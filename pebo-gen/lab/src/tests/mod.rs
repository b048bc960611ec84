//! Runs of scenarios from model files.

mod baseline;

mod estimator;
mod figure;
mod flow;
mod identity;
mod limits;
mod overrides;
mod refusal;
mod run;
mod sensor;
mod switching;
mod time;
mod truth;

use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

use super::{Overrides, Scenario, Trace};

/// A spring and a mass of one kilogram, whose position is measured; 2 rad/s.
const SPRING: &str = "
model: spring
x: [v]
y: [q]
f_x: {v: -k*q}
f_y: {q: v}
parameters: {k: 4}
phi: [v]
observer: {gain: 50, filter: 5}
simulation: {duration: 10, step: 0.01, initial: {v: 0, q: 1}}
";

const CUK: &str = include_str!("../../../../models/cuk.yaml");
const CUK_CASE_2: &str = include_str!("../../../../models/cuk_case2.yaml");

fn read(text: &str) -> Result<Model, Vec<Diagnostic>> {
    let source = Source::new("test", text).map_err(|diagnostic| vec![diagnostic])?;
    Model::parse(&source)
}

fn resolve(text: &str, overrides: &Overrides) -> Result<Scenario, Vec<Diagnostic>> {
    let model = read(text)?;
    let plant = Plant::resolve(&model)?;
    let derivation = Derivation::derive(&plant);
    Scenario::resolve(&model, &plant, &derivation, overrides)
}

fn run(text: &str, overrides: &Overrides) -> Trace {
    resolve(text, overrides).unwrap().run().unwrap()
}

/// A text with one part replaced, which it must have.
fn with(text: &str, part: &str, other: &str) -> String {
    assert!(text.contains(part), "{part}");
    text.replace(part, other)
}
