//! Every model of the project, simulated with noise-free data until its estimates are those of the plant.

use std::collections::BTreeSet;
use std::path::Path;

use pebo_gen::derive;
use pebo_gen::simulate::{Overrides, Trace};
use pebo_gen::source::Source;

/// The estimation error has fallen for good to this share of the error at the start. What is left is that of
/// sampling, second order in the step, while the signals move.
const SHARE: f64 = 1e-6;

/// A model with the time in s after which the error stays below [`SHARE`], and what is changed for this test.
struct Case {
    model: &'static str,
    within: f64,
    changes: &'static [(&'static str, &'static str)],
}

const fn case(model: &'static str, within: f64) -> Case {
    Case { model, within, changes: &[] }
}

/// The set point of the paper's Cuk converter jumps; each jump shows in the error, sampled as it is.
const CALM: (&str, &str) = ("V_d: {0: 25, 0.2: 30, 0.4: 15, 0.6: 5, 0.8: 20}", "V_d: 25");

const CASES: &[Case] = &[
    case("boost", 0.4),
    case("buck_boost", 0.4),
    case("cart_pendulum", 1.6),
    Case { model: "cuk", within: 0.5, changes: &[CALM] },
    Case { model: "cuk_case2", within: 0.9, changes: &[CALM] },
    case("inertia_wheel", 1.6),
    case("levitated_ball", 1.4),
    case("motor", 0.4),
    case("motor_currents", 1.1),
    case("motor_flux", 1.1),
    // The smallest model says nothing about simulation.
    Case {
        model: "pendulum",
        within: 0.6,
        changes: &[(
            "phi: [p]",
            "observer: {filter: 20, gain: 2}\n\
             simulation: {duration: 4, step: 1e-4, initial: {p: 0.5, q: 1}, control: {tau: 0}}\nphi: [p]",
        )],
    },
    case("robotic_leg", 0.9),
    case("sepic", 0.3),
    case("two_mass_drive", 0.8),
    case("zeta", 0.2),
];

fn text(model: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(model).with_extension("yaml");
    std::fs::read_to_string(&path).unwrap_or_else(|unread| panic!("{}: {unread}", path.display()))
}

fn run(text: &str) -> Trace {
    let derived = derive(&Source::new("model", text).expect("a text")).expect("a model");
    let scenario = derived.scenario(&Overrides::default()).expect("a closed loop");
    scenario.run(&mut |_| {}).expect("a run to the end")
}

/// The norm of the errors of all estimates, row by row.
fn errors(trace: &Trace) -> Vec<f64> {
    let header = trace.csv().lines().next().unwrap_or_default().to_owned();
    let columns: Vec<Vec<f64>> =
        header.split(',').filter(|name| name.ends_with("_error")).filter_map(|name| trace.column(name)).collect();
    assert!(!columns.is_empty());
    (0..columns[0].len()).map(|row| columns.iter().map(|c| c[row] * c[row]).sum::<f64>().sqrt()).collect()
}

#[test]
fn estimates_become_the_states() {
    for case in CASES {
        let mut text = text(case.model);
        for (from, to) in case.changes {
            assert!(text.contains(from), "{}: {from}", case.model);
            text = text.replace(from, to);
        }
        let trace = run(&text);
        let (time, errors) = (trace.column("t").expect("time"), errors(&trace));
        assert!(errors[0] > 0.0, "{} starts with the right estimate", case.model);
        let share = |row: usize| errors[row] / errors[0];
        let settled = (0..errors.len()).rev().find(|row| share(*row) >= SHARE).map_or(0.0, |row| time[row]);
        println!("{}: below {SHARE:e} after {settled:.3} s, {:.1e} at the end", case.model, share(errors.len() - 1));
        assert!(settled < case.within, "{}: {settled} s", case.model);
        assert!(settled < *time.last().expect("rows"), "{} never settles", case.model);
    }
}

#[test]
fn no_model_is_left_out() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let files = std::fs::read_dir(folder).expect("the models").flatten().map(|entry| entry.path());
    let models = files.filter(|path| path.extension().is_some_and(|e| e == "yaml"));
    let stems: BTreeSet<String> =
        models.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    assert_eq!(stems, CASES.iter().map(|case| case.model.to_owned()).collect());
}

/// Without motion nothing excites the fluxes' circle: the estimate must hold where it is.
#[test]
fn a_motor_at_standstill_keeps_its_estimate() {
    let moving = text("motor_currents");
    let course = "omega: 20 + 15*sin(2*t)";
    assert!(moving.contains(course));
    // Half a second is enough to come near; then the rotor stands for the rest, with current in its coils.
    let standing = moving
        .replace(course, "omega: {0: 20, 0.5: 0}")
        .replace("control: {v1: 0, v2: 0}", "control: {v1: 1, v2: 0.5}");
    let trace = run(&standing);
    let (time, error) = (trace.column("t").expect("time"), trace.column("q_error").expect("an error"));
    let row = |at: f64| time.iter().position(|t| *t >= at).expect("a row at the time");
    // The currents take some milliseconds to settle; the coils' time constant is L/R = 4.5 ms.
    let (start, held) = (row(0.55), error[row(0.55)]);
    assert!(held.abs() < 0.05 * error[0].abs(), "it has come near: {held}");
    for (at, error) in time.iter().zip(&error).skip(start) {
        // One regressor direction is still seen: the error may shrink along it, and moves by no more than it has.
        assert!((error - held).abs() <= 1.5 * held.abs() + 1e-6, "{at} s: {error}, was {held}");
    }
    // Standing still from the beginning, the estimate is the one that the observer started with.
    let never = run(&moving.replace(course, "omega: 0"));
    let error = never.column("q_error").expect("an error");
    let wandered = error.iter().map(|e| (e - error[0]).abs()).fold(0.0, f64::max);
    assert!(wandered < 0.5, "{wandered}");
}
