//! Every model of the project, simulated with noise-free data until its estimates are those of the plant.

use std::collections::BTreeSet;
use std::path::Path;

use pebo_gen::derive;
use pebo_gen::simulate::{Overrides, Trace};
use pebo_gen::source::Source;

/// The estimation error has fallen for good to this share of the error at the start. What is left is that of
/// sampling, second order in the step, while the signals move.
const SHARE: f64 = 1e-6;

/// A model with the time in s after which the error remains below [`SHARE`], and the changes for this test.
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
    case("motor_currents", 0.4),
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
    case("range_only", 20.0),
    case("robotic_leg", 0.9),
    case("sepic", 0.3),
    case("two_mass_drive", 0.8),
    Case { model: "wind_turbine", within: 60.0, changes: &[("  noise: {w: 2e-3}\n", "")] },
    case("zeta", 0.2),
];

fn text(model: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(model).with_extension("yaml");
    std::fs::read_to_string(&path).unwrap_or_else(|unread| panic!("{}: {unread}", path.display()))
}

fn run(text: &str) -> Trace {
    run_with(text, &Overrides::default())
}

fn run_with(text: &str, overrides: &Overrides) -> Trace {
    let derived = derive(&Source::new("model", text).expect("a text")).expect("a model");
    let scenario = derived.scenario(overrides).expect("a closed loop");
    scenario.run().expect("a run to the end")
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

/// Models whose plant steps half way: the times within which the errors fall for good below 1 % of the states' largest
/// absolute values, after the start and after the step, in s. A quarter more than measured.
const STEPS: &[(&str, f64, f64)] = &[
    ("battery", 440.0, 1.0),
    ("battery_curve", 123.0, 1.0),
    ("bearing_only", 95.0, 920.0),
    ("bicycle", 0.025, 1e-3),
    ("boost_load", 0.0045, 0.3),
    ("boost_resistive", 2e-5, 1e-5),
    ("dc_motor", 0.0055, 0.052),
    ("feed_axis", 26.0, 1.0),
    ("hydraulic_cylinder", 7e-4, 0.027),
    ("induction_motor", 0.003, 0.044),
    ("induction_motor_stator", 0.003, 0.044),
    ("motor_warm", 0.004, 0.32),
    ("reactor", 22.0, 47.0),
];

/// Of these the step lasts and no output tells of it: the errors after it remain below a share of the states' largest
/// absolute values, a quarter more than measured. The offset of the current's sensor holds the voltage `v1` at `R_1 I_0` off
/// its estimate, and that of a Kalman filter too; `v2` follows in its own time.
const LASTING: &[(&str, &str, f64)] = &[("battery", "v1", 0.048), ("battery", "v2", 0.021)];

/// A model without the baselines beside its observer, and without their panels.
fn without_baselines(text: &str) -> String {
    let mut is_left_out = false;
    let kept = text.lines().filter(|line| {
        if !line.starts_with("   ") {
            is_left_out = ["  baselines:", "  panels:"].iter().any(|section| line.starts_with(section));
        }
        !is_left_out
    });
    kept.flat_map(|line| [line, "\n"]).collect()
}

/// The step of the plant is there: without the observer's correction its error would stay or grow.
#[test]
fn estimates_recover_from_a_step_of_the_plant() {
    for &(model, after_start, after_step) in STEPS {
        let text = without_baselines(&text(model));
        assert!(text.contains("\n  plant:\n"), "{model} has no step");
        let every_sample = Overrides { every: Some(f64::MIN_POSITIVE), ..Overrides::default() };
        let trace = run_with(&text, &every_sample);
        let time = trace.column("t").expect("time");
        let half = time.iter().position(|t| *t >= time[time.len() - 1] / 2.0).expect("a half");
        let mut shares = vec![0.0_f64; time.len()];
        for state in trace.columns().iter().filter_map(|name| name.strip_suffix(Trace::ERROR)) {
            let scale = trace.column(state).expect(state).into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let errors = trace.column(&format!("{state}{}", Trace::ERROR)).expect(state);
            let lasting = LASTING.iter().find(|(name, lasting, _)| (*name, *lasting) == (model, state));
            let lasting = lasting.map_or(1.0, |(.., share)| share / 0.01);
            for (row, (share, error)) in shares.iter_mut().zip(errors).enumerate() {
                let admitted = if row < half { 1.0 } else { lasting };
                *share = share.max(error.abs() / scale / admitted);
            }
        }
        assert!(shares[0] > 0.1, "{model} starts with the right estimate");
        for (from, to, within) in [(0, half, after_start), (half, time.len(), after_step)] {
            let last = (from..to).rev().find(|row| shares[*row] >= 0.01);
            let settled = last.map_or(0.0, |row| time.get(row + 1).map_or(f64::INFINITY, |after| after - time[from]));
            println!("{model}: below 1 % after {settled} s, {:.1e} in the end", shares[to - 1]);
            assert!(last.is_none_or(|row| row + 1 < to) && settled < within, "{model}: {settled} s");
        }
    }
}

#[test]
fn no_model_is_left_out() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let files = std::fs::read_dir(folder).expect("the models").flatten().map(|entry| entry.path());
    let models = files.filter(|path| path.extension().is_some_and(|e| e == "yaml"));
    let stems: BTreeSet<String> =
        models.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
    let known = CASES.iter().map(|case| case.model).chain(STEPS.iter().map(|(model, ..)| *model));
    assert_eq!(stems, known.map(str::to_owned).collect());
}

/// The unknown speed's course in the model file, and the voltages there.
const COURSE: &str = "omega: 20 + 15*sin(2*t)";
const NO_VOLTAGE: &str = "control: {v1: 0, v2: 0}";

/// Voltages that keep the currents moving whatever the rotor does.
const TURNING: &str = "control: {v1: 10*cos(40*t), v2: 10*sin(40*t)}";

/// The motor with the currents alone measured, with this speed, these voltages and this period.
fn motor(course: &str, voltages: &str, step: &str) -> Trace {
    let text = text("motor_currents");
    for part in [COURSE, NO_VOLTAGE, "step: 1e-5"] {
        assert!(text.contains(part), "{part}");
    }
    run(&text.replace(COURSE, course).replace(NO_VOLTAGE, voltages).replace("step: 1e-5", &format!("step: {step}")))
}

/// The instants from `from` on with the position's error, in rad.
fn position_errors(trace: &Trace, from: f64) -> Vec<(f64, f64)> {
    let (time, error) = (trace.column("t").expect("time"), trace.column("q_error").expect("an error"));
    time.into_iter().zip(error).filter(|(t, _)| *t >= from).collect()
}

fn largest(errors: &[(f64, f64)]) -> f64 {
    errors.iter().map(|(_, error)| error.abs()).fold(0.0, f64::max)
}

/// The largest departure of the error from its first value.
fn wander(errors: &[(f64, f64)]) -> f64 {
    errors.iter().map(|(_, error)| (error - errors[0].1).abs()).fold(0.0, f64::max)
}

/// The position, 0.3 rad off at the start, from currents alone while the speed varies between 5 and 35 rad/s.
#[test]
fn a_motor_of_varying_speed_is_followed_by_its_currents() {
    let trace = motor(COURSE, NO_VOLTAGE, "1e-5");
    // A decade in 60 ms, by the gain and the speed; the bounds are a quarter more than measured.
    for (from, bound) in [(0.1, 2.4e-2), (0.15, 4.8e-3), (0.2, 8.2e-4), (0.3, 1.8e-5), (0.4, 2.4e-7)] {
        let error = largest(&position_errors(&trace, from));
        println!("from {from} s on: {error:.1e} rad");
        assert!(error < bound, "from {from} s on: {error}");
    }
    // The remaining error is that of sampling, of second order in the period.
    let left = |trace: &Trace| largest(&position_errors(trace, 1.0));
    let (fine, coarse) = (left(&trace), left(&motor(COURSE, NO_VOLTAGE, "2e-5")));
    println!("from 1 s on: {fine:.1e} rad, at twice the period {coarse:.1e} rad");
    assert!((3.8..4.2).contains(&(coarse / fine)), "{fine} {coarse}");
}

/// The rotor stands still for an instant now and then, and turns back.
#[test]
fn a_motor_that_reverses_is_followed_by_its_currents() {
    let errors = position_errors(&motor("omega: 30*cos(2*t)", NO_VOLTAGE, "1e-5"), 0.9);
    println!("from 0.9 s on: {:.1e} rad", largest(&errors));
    assert!(largest(&errors) < 1e-6 * 0.3, "{}", largest(&errors));
}

/// At standstill nothing excites the fluxes' circle, whatever the currents do: the estimate must hold its value.
#[test]
fn a_motor_at_standstill_keeps_its_estimate() {
    // From the beginning without current: every signal is constant, so not a digit moves.
    let never = position_errors(&motor("omega: 0", NO_VOLTAGE, "1e-5"), 0.0);
    println!("standing, no current: {:.1e} rad", wander(&never));
    assert!(wander(&never) < 1e-12, "{}", wander(&never));

    // With currents that turn, the sampled extension follows the coils' flux but for what the trapezoidal rule
    // leaves, dt^2/12 (40 rad/s)^2 = 1.3e-8 of 0.07 Wb, of a magnet of 0.2 Wb, at 5 pole pairs: some 1e-9 rad. At the
    // start the currents' transient adds dt^2/12 (R/L)^2 = 4e-7 of that: in all a wander of 1e-7 rad at most.
    let turning = position_errors(&motor("omega: 0", TURNING, "1e-5"), 0.0);
    println!("standing, currents turn: {:.1e} rad", wander(&turning));
    assert!(wander(&turning) < 1e-7, "{}", wander(&turning));

    // A quarter of a second is enough to come near; then the rotor stands. The currents settle within some L/R = 4.5 ms
    // and the estimator with them, to the one direction that is still observable: after 0.3 s, 66 times that, nothing
    // is left.
    for (voltages, rests) in [(NO_VOLTAGE, 1e-9), ("control: {v1: 1, v2: 0.5}", 1e-9), (TURNING, 1e-7)] {
        let errors = position_errors(&motor("omega: {0: 20, 0.25: 0}", voltages, "1e-5"), 0.55);
        println!("stopped, {voltages}: {:.4e} rad, wanders by {:.1e} rad", errors[0].1, wander(&errors));
        assert!(largest(&errors) < 0.02 * 0.3, "it has come near: {}", largest(&errors));
        assert!(wander(&errors) < rests, "{voltages}: {}", wander(&errors));
    }

    // And when it turns again the estimate goes on to the position.
    let again = position_errors(&motor("omega: {0: 20, 0.25: 0, 1: 20}", NO_VOLTAGE, "1e-5"), 1.6);
    println!("turning again: {:.1e} rad", largest(&again));
    assert!(largest(&again) < 1e-6 * 0.3, "{}", largest(&again));
}
