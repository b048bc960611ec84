//! The README shows only what is so.

use std::path::Path;
use std::process::Command;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::Scalar;
use pebo_gen::model::Estimator;
use pebo_gen::simulate::{Overrides, figure};
use pebo_gen::source::{Colour, Source, render};
use pebo_gen::{Derived, derive, report};
use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Bounded, Fault, Hold, LeastSquares, WindowedRegression};
use serde_json::Value;
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

/// CI runs the commands as they stand, in a clean checkout. What went wrong there once is seen here at once: without one
/// default among the programs of the workspace, `cargo run` does not know which is meant.
#[test]
fn the_commands_that_are_shown_mean_one_program() {
    let commands: Vec<&str> = blocks("sh").iter().flat_map(|block| block.lines()).collect();
    assert_eq!(commands, ["cargo run --release -- models/cuk.yaml", "cargo test"]);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["metadata", "--no-deps", "--format-version", "1", "--offline"]);
    let found = cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("..")).output().expect("cargo");
    let workspace: Value = serde_json::from_slice(&found.stdout).expect("the workspace");
    let packages = workspace["packages"].as_array().expect("packages");
    let named: Vec<&str> = packages.iter().filter_map(|package| package["default_run"].as_str()).collect();
    assert_eq!(named, ["pebo-gen"]);
    // `cargo test` is for every member.
    assert_eq!(workspace["workspace_default_members"], workspace["workspace_members"]);
    assert_eq!(packages.len(), workspace["workspace_members"].as_array().map_or(0, Vec::len));
}

fn estimate_currents() -> Result<cuk::X, Fault> {
    let parameters = cuk::Parameters { e: 24.0, ..cuk::Parameters::default() };
    // With the settings of the model. The proofs hold for these parameters too: they have the signs that it gives.
    let mut observer = cuk::Cuk::observer(&parameters)?;
    // Once a period: the outputs now, the input that was held since the sample before, the period.
    observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 10e-6)
}

fn estimate_with_a_window() -> Result<cuk::X, Fault> {
    let estimator = LeastSquares::diagonal(&SVector::from([1e6, 1e10]), 100.0)?;
    let mut observer = pebo_runtime::Observer::with_regression(
        cuk::Cuk::new(&cuk::Parameters::default()),
        Bounded::new(estimator, &SVector::repeat(-100.0), &SVector::from([50.0, 100.0]))?,
        WindowedRegression::<f64, { cuk::NR }, { cuk::NE }, 100>::new(Hold::First),
        SVector::zeros(),
    )?;
    observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 10e-6)
}

#[test]
fn the_examples_of_use_run() {
    let start = cuk::X { i1: 0.0, i3: 0.0 };
    assert_eq!((estimate_currents(), estimate_with_a_window()), (Ok(start), Ok(start)));
    for name in ["estimate_currents", "estimate_with_a_window"] {
        let usage = blocks("rust").into_iter().find(|block| block.contains(name)).expect("the example");
        assert!(USAGE.contains(usage), "{name}");
    }
}

#[test]
fn the_section_observer_that_is_shown_runs() {
    let section = blocks("yaml").into_iter().find(|block| block.starts_with("observer:")).expect("the section");
    let case_2 = model("cuk_case2.yaml");
    let (before, rest) = case_2.split_once("observer:\n").expect("a section to replace");
    let (_, after) = rest.split_once("simulation:\n").expect("a section behind it");
    let text = format!("{before}{section}simulation:\n{after}");
    let overrides = Overrides { duration: Some(2e-3), every: Some(1e-5), ..Overrides::default() };
    let trace = derived(&text).scenario(&overrides).expect("a closed loop").run().expect("a run to the end");
    for name in ["i1_error", "v4_error"] {
        let errors = trace.column(name).expect("a recovered state");
        let late = errors[100..].iter().fold(0.0_f64, |largest, error| largest.max(error.abs()));
        assert!(late < 1e-3 * errors[0].abs(), "{name}: {late} of {}", errors[0]);
    }
    // The table of keys is that of the reader.
    for estimator in Estimator::ALL {
        let list = |keys: &[&str]| keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
        let row = format!("| `{}` | {} | {} |", estimator.name(), list(estimator.needs()), list(estimator.admits()));
        let shown = README.replace("`gain` in 1/s", "`gain`").replace("| |", "|  |");
        assert!(shown.contains(&row), "{row}");
    }
}

#[test]
fn the_section_simulation_that_is_shown_runs() {
    let section = blocks("yaml").into_iter().find(|block| block.starts_with("simulation:")).expect("the section");
    let motor = model("dc_motor.yaml");
    let (head, _) = motor.split_once("simulation:\n").expect("a section");
    let rest = "  duration: 2\n  step: 1e-4\n  initial: {i: 0, omega: 0}\n  control: {v: 12}\n";
    let scenario = derived(&format!("{head}{section}{rest}")).scenario(&Overrides::default()).expect("a closed loop");
    let trace = scenario.run().expect("a run to the end");
    // Their current is 0.105 A too high, as they take the resistance to be lower: so is the torque by 0.1 times that.
    for name in ["T_L_hat", "kalman.T_L_hat", "luenberger.T_L_hat"] {
        let torque = trace.column(name).expect(name);
        let last = &torque[900..];
        let mean = last.iter().sum::<f64>() / 101.0;
        assert!((mean - 0.2105).abs() < 2e-3, "{name} {mean}");
    }
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
    // After the code of the smallest model and the examples of use.
    let shown = &blocks("rust")[3..];
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
    let replaced =
        |line: &str| if line.starts_with("phi:") { "phi: [i1, v4]\nclass: pebo" } else { line }.to_owned() + "\n";
    let wrong: String = case_2.lines().map(replaced).collect();
    let refused = derived(&wrong);
    let source = Source::new("wrong.yaml", wrong).expect("a text");
    assert_eq!(shown[1], render(&refused.advised(), &source, Colour::Never));
}

#[test]
fn the_figure_is_what_the_command_draws() {
    let scenario = derived(&model("cuk.yaml")).scenario(&Overrides::default()).expect("a closed loop");
    let trace = scenario.run().expect("a run to the end");
    assert!(figure::draw(&trace, &scenario) == model("cuk.svg"), "draw models/cuk.svg again");
}
