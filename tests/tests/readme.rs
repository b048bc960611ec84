//! The README shows only what is so.

use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::Scalar;
use pebo_gen::simulate::{Overrides, figure};
use pebo_gen::source::{Colour, Source, render};
use pebo_gen::{Derived, derive, report};
use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Fault, Filter, Gradient, Hold};
use tests::emitted::cuk_f64 as cuk;

const README: &str = include_str!("../../README.md");
const USAGE: &str = include_str!("readme.rs");

fn model(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name);
    std::fs::read_to_string(path).expect("a model of the project")
}

fn derived(text: &str) -> Derived {
    derive(&Source::new("wrong.yaml", text).expect("a text")).expect("a model")
}

/// The README's fenced blocks of a language.
fn blocks(language: &str) -> Vec<&'static str> {
    let fence = format!("```{language}\n");
    README.split(fence.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

fn estimate_currents() -> Result<SVector<f64, 2>, Fault> {
    let mut observer = cuk::Observer::new(
        cuk::Cuk::new(&cuk::Parameters::default()),
        Gradient::diagonal(&SVector::from([0.001, 0.001]))?,
        Filter::new(0.5, Hold::First)?,
        SVector::zeros(),
    )?;
    // Once a period: the outputs now, the input that was held since the sample before, the period.
    let (v2, v4, duty_cycle) = (10.0, -12.0, 0.68);
    observer.step(&SVector::from([v2, v4]), &SVector::from([duty_cycle]), 10e-6)
}

#[test]
fn the_example_of_use_runs() {
    assert_eq!(estimate_currents(), Ok(SVector::zeros()));
    let usage = blocks("rust").into_iter().find(|b| b.contains("estimate_currents")).expect("the example");
    assert!(USAGE.contains(usage));
}

#[test]
fn the_smallest_model_and_its_code_are_real() {
    assert_eq!(blocks("yaml")[0], model("pendulum.yaml"));
    let text = derived(&model("pendulum.yaml")).emit(Scalar::F64).expect("an accepted model").text;
    assert!(text.contains(blocks("rust")[0]), "{text}");
}

#[test]
fn the_ways_to_the_code_are_those_of_the_examples() {
    let sources = [
        include_str!("../examples/attribute/src/main.rs"),
        include_str!("../examples/firmware/src/lib.rs"),
        include_str!("../examples/build-script/build.rs"),
    ];
    // After the code of the smallest model and the example of use.
    let shown = &blocks("rust")[2..];
    assert_eq!(shown.len(), 3);
    for block in shown {
        assert!(sources.iter().any(|source| source.contains(block)), "{block}");
    }
    let refusal = include_str!("../mistakes/cascade_refuted.stderr");
    assert_eq!(blocks("text")[2], refusal);
}

#[test]
fn the_class_that_is_shown_is_accepted() {
    let class = blocks("yaml")[1];
    let leg = derived(&format!(
        "model: leg\nparameters: {{m: 2, g: 9.81}}\nx: [p_r, p_theta]\ny: [r, theta]\nu: [f, tau]\n\
         assume: [m > 0, r > 0]\n{class}"
    ));
    assert_eq!(leg.derivation.outcome, Outcome::Accepted);
}

#[test]
fn verdicts_are_printed_as_shown() {
    let shown = blocks("text");
    let cuk = derived(&model("cuk.yaml"));
    assert_eq!(shown[0], report::summary(&cuk.plant, &cuk.derivation));
    let case_2 = model("cuk_case2.yaml");
    let replaced = |line: &str| if line.starts_with("phi:") { "phi: [i1, v4]" } else { line }.to_owned() + "\n";
    let wrong: String = case_2.lines().map(replaced).collect();
    let refused = derived(&wrong);
    let source = Source::new("wrong.yaml", wrong).expect("a text");
    assert_eq!(shown[1], render(&refused.derivation.diagnostics, &source, Colour::Never));
}

#[test]
fn the_figure_is_what_the_command_draws() {
    let scenario = derived(&model("cuk.yaml")).scenario(&Overrides::default()).expect("a closed loop");
    let trace = scenario.run(&mut |_| {}).expect("a run to the end");
    assert!(figure::draw(&trace, &scenario) == model("cuk.svg"), "draw models/cuk.svg again");
}
