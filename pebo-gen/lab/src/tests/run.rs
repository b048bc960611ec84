use std::ops::ControlFlow;

use crate::{Failure, Overrides, Scenario, Trace};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::source::Code;

use super::{CUK_CASE_2, SPRING, read, resolve, run, with};

fn short(duration: f64) -> Overrides {
    Overrides { duration: Some(duration), ..Overrides::default() }
}

#[test]
fn the_table_has_the_columns_of_the_interface() {
    let trace = run(CUK_CASE_2, &short(0.01));
    let header = "t,i1,v4,v2,i3,d,i1_hat,i1_error,v4_hat,v4_error,immersion.i1_hat,immersion.v4_hat";
    let csv = trace.csv();
    assert_eq!(csv.lines().next(), Some(header));
    assert_eq!(trace.rows().count(), 1001);
    assert_eq!(csv.lines().count(), 1002);
    let mut previous = -1.0;
    for (line, row) in csv.lines().skip(1).zip(trace.rows()) {
        let read: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        assert_eq!(read, row);
        assert!(row[0] > previous);
        previous = row[0];
        // error = estimate - truth
        assert_eq!((row[7], row[9]), (row[6] - row[1], row[8] - row[2]));
    }
    assert!(csv.lines().last().unwrap().starts_with("0.01,"));
}

#[test]
fn rows_are_on_the_grid_that_was_asked_for() {
    let overrides = Overrides { every: Some(0.05), ..short(1.0) };
    let t = run(SPRING, &overrides).column("t").unwrap();
    let expected: Vec<f64> = (0..=20).map(|row| f64::from(row) / 20.0).collect();
    assert_eq!(t, expected);
    // A grid finer than the samples is the samples.
    let overrides = Overrides { every: Some(1e-9), ..short(0.1) };
    assert_eq!(run(SPRING, &overrides).column("t").unwrap().len(), 11);
}

#[test]
fn a_run_can_be_repeated() {
    let scenario = resolve(CUK_CASE_2, &short(0.01)).unwrap();
    let mut reports = Vec::new();
    let mut keep = |part| {
        reports.push(part);
        ControlFlow::Continue(())
    };
    let first = scenario.run_while(&mut keep).unwrap().csv();
    assert_eq!(first, scenario.run().unwrap().csv());
    assert_eq!((reports.first(), reports.last()), (Some(&0.0), Some(&1.0)));
    assert!(reports.is_sorted() && reports.len() < 1000);
}

#[test]
fn the_caller_may_end_a_run() {
    let scenario = resolve(CUK_CASE_2, &short(0.01)).unwrap();
    let half = |part| if part < 0.5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let failure = scenario.run_while(&mut { half }).unwrap_err();
    assert!(matches!(failure, Failure::Stopped { at } if (at - 0.005).abs() < 1e-4), "{failure}");
    assert_eq!(scenario.explain(&failure).code, Code::LimitReached);
}

/// The control signal at the first row and at the last.
fn control(trace: &Trace) -> (f64, f64) {
    let d = trace.column("d").unwrap();
    (d[0], d[d.len() - 1])
}

#[test]
fn the_control_law_sees_the_estimates_that_were_asked_for() {
    let fed = |name: &str| {
        let overrides = Overrides { feedback: Some(name.to_owned()), ..short(0.02) };
        control(&run(CUK_CASE_2, &overrides))
    };
    let law = |i1: f64| {
        let s = 0.0447 * 25.0 * 10.0 + 12.0 * (-1.0 - i1);
        25.0 / 37.0 + 0.1 * (12.0 / 37.0) * s / (1.0 + s * s)
    };
    let (observer, truth, immersion) = (fed("observer"), fed("truth"), fed("immersion"));
    // Both observers start at 0, the truth at 0.5 A.
    assert!((observer.0 - law(0.0)).abs() < 1e-15 && (immersion.0 - law(0.0)).abs() < 1e-15);
    assert!((truth.0 - law(0.5)).abs() < 1e-15);
    assert!((observer.1 - immersion.1).abs() > 1e-4 && (observer.1 - truth.1).abs() > 1e-6);
    // The file says so too.
    let text = with(CUK_CASE_2, "feedback: observer", "feedback: truth");
    assert_eq!(control(&run(&text, &short(0.02))), truth);
}

#[test]
fn estimates_converge_at_every_size_and_in_every_class() {
    let error = |text: &str, duration: f64, names: &[&str]| {
        let trace = run(text, &short(duration));
        let errors = names.iter().map(|name| *trace.column(&format!("{name}_error")).unwrap().last().unwrap());
        errors.map(f64::abs).fold(0.0, f64::max)
    };
    assert!(error(SPRING, 10.0, &["v"]) < 1e-2);
    // Nine masses: padded to 16.
    let list = |entry: &dyn Fn(u32) -> String| (1..=9).map(entry).collect::<Vec<_>>().join(", ");
    let masses = format!(
        "model: masses\nx: [{}]\ny: [{}]\nf_x: {{{}}}\nf_y: {{{}}}\nphi: [{}]\nobserver: {{gain: 50, filter: 5}}\n\
         simulation: {{duration: 3, step: 0.01, initial: {{{}, {}}}}}\n",
        list(&|i| format!("a{i}")),
        list(&|i| format!("q{i}")),
        list(&|i| format!("a{i}: -q{i}")),
        list(&|i| format!("q{i}: a{i}")),
        list(&|i| format!("a{i}")),
        list(&|i| format!("a{i}: {i}")),
        list(&|i| format!("q{i}: 0")),
    );
    assert!(error(&masses, 3.0, &["a1", "a9"]) < 1e-2);
    assert!(error(ROTATION, 20.0, &["a", "b"]) < 1e-2);
    assert!(error(ROTOR, 1.0, &["q"]) < 1e-2);
}

/// A generalised cascade: a vector that turns with a known speed.
pub(super) const ROTATION: &str = "
model: rotation
x: [a, b]
y: [q]
u: [omega]
f_x: {a: omega*b, b: -omega*a}
f_y: {q: a}
phi: [a, b]
observer: {gain: 1, filter: 5}
simulation: {duration: 20, step: 0.01, initial: {a: 1, b: -2, q: 0}, control: {omega: 2 + sin(t)}}
";

#[test]
fn estimates_remain_within_the_bounds_of_the_states() {
    let bounded = with(ROTATION, "filter: 5}", "filter: 5, within: {lower: [0.5, -9], upper: [3, -0.5]}}");
    let (bounded, free) = (run(&bounded, &short(1.0)), run(ROTATION, &short(1.0)));
    let column = |trace: &Trace, name: &str| trace.column(name).unwrap();
    for (name, least, greatest) in [("a_hat", 0.5, 3.0), ("b_hat", -9.0, -0.5)] {
        let (bounded, free) = (column(&bounded, name), column(&free, name));
        assert!(free.iter().any(|x| !(least..=greatest).contains(x)), "{name} is never beyond");
        let clamped: Vec<f64> = free.iter().map(|x| x.clamp(least, greatest)).collect();
        assert_eq!(bounded, clamped);
    }
}

/// A motor, whose angle is known modulo its period only.
const ROTOR: &str = "
model: rotor
x: [q]
y: [i1, i2]
u: [v1, v2, omega]
parameters: {R: 8.875, L: 0.04003, n_p: 5, lambda_m: 0.2086}
f_x: {q: omega}
f_y:
  i1: (v1 - R*i1)/L + n_p*omega*lambda_m/L*sin(n_p*q)
  i2: (v2 - R*i2)/L - n_p*omega*lambda_m/L*cos(n_p*q)
phi: [L*i1 + lambda_m*cos(n_p*q), L*i2 + lambda_m*sin(n_p*q)]
phi_left: {q: \"atan2(z2 - L*i2, z1 - L*i1)/n_p\"}
angles: {q: 2*pi/n_p}
assume: [L > 0, lambda_m > 0, n_p > 0]
observer: {gain: 10, filter: 20}
simulation:
  duration: 2
  step: 1e-4
  initial: {q: 1, i1: 0, i2: 0}
  control: {v1: cos(40*t), v2: sin(40*t), omega: 3}
";

/// The same motor with its flux for a state, its speed unknown to the observer: a static regression.
const FLUX: &str = "
model: flux
x: [l1, l2]
y: [i1, i2]
u: [v1, v2]
w: [omega]
parameters: {R: 8.875, L: 0.04003, n_p: 5, lambda_m: 0.2086}
f_x: {l1: v1 - R*i1, l2: v2 - R*i2}
f_y:
  i1: (v1 - R*i1 + n_p*omega*(l2 - L*i2))/L
  i2: (v2 - R*i2 - n_p*omega*(l1 - L*i1))/L
phi: [l1, l2]
identities: [\"(l1 - L*i1)^2 + (l2 - L*i2)^2 - lambda_m^2\"]
observer: {gain: 30, filter: 100}
simulation:
  duration: 10
  step: 1e-4
  signals: {speed: {0: 10, 0.5: 20}}
  initial: {l1: lambda_m, l2: 0, i1: 0, i2: 0}
  control: {v1: 10*cos(40*t), v2: 10*sin(40*t)}
";

#[test]
fn an_unmeasured_signal_runs_its_course() {
    let without = resolve(FLUX, &Overrides::default()).unwrap_err();
    assert_eq!(without[0].code, Code::SimulationIncomplete);
    assert!(without[0].message.contains("`omega`"));

    let model = read(&FLUX.replace("speed:", "omega:")).unwrap();
    let plant = Plant::resolve(&model).unwrap();
    let derivation = Derivation::derive(&plant);
    let scenario = Scenario::resolve(&model, &plant, &derivation, &Overrides::default()).unwrap();
    let trace = scenario.run().unwrap();
    let column = |name: &str| trace.column(name).unwrap();
    for ((l1, l2), (i1, i2)) in column("l1").iter().zip(column("l2")).zip(column("i1").iter().zip(column("i2"))) {
        // The magnet keeps its flux: the regression's equation.
        let flux = (l1 - 0.04003 * i1).hypot(l2 - 0.04003 * i2);
        assert!((flux - 0.2086).abs() < 1e-7, "{flux}");
    }
    for name in ["l1_error", "l2_error"] {
        let errors = column(name);
        assert!(errors.last().unwrap().abs() < 1e-3, "{name} {:?}", errors.last());
    }
}

#[test]
fn the_error_of_an_angle_is_the_shorter_way_round() {
    let trace = run(ROTOR, &short(2.0));
    let column = |name: &str| trace.column(name).unwrap();
    let period = std::f64::consts::TAU / 5.0;
    for ((q, hat), error) in column("q").iter().zip(column("q_hat")).zip(column("q_error")) {
        assert!(error.abs() <= period / 2.0 + 1e-12);
        let turns = (hat - q - error) / period;
        assert!((turns - turns.round()).abs() < 1e-9, "{q} {hat} {error}");
    }
    // So it is drawn, by itself or as a panel says it.
    let panels = "  panels: [{title: Error, curves: [hat(q) - q, 2*(hat(q) - q)]}]\n";
    let drawn = run(&format!("{ROTOR}{panels}"), &short(2.0));
    let highest = |curve: &Vec<(f64, f64)>| curve.iter().fold(0.0_f64, |most, (_, error)| most.max(error.abs()));
    assert!(highest(&drawn.curves[0][0].line) <= period / 2.0 + 1e-12);
    assert!(highest(&drawn.curves[0][1].line) > 10.0, "no error, but what was written");
    // The angle itself has turned several periods by then.
    assert!(column("q").last().unwrap() > &6.9 && column("q_hat").last().unwrap() < &0.7);
}

/// An estimate of a state that the outputs determine only up to a turn may settle a turn away: no gain mends that.
#[test]
fn an_estimate_a_turn_away_is_reported() {
    let rotor = "model: rotor\nx: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\nf_y: {a: sin(q), b: cos(q)}\nphi: [q]\n\
                 simulation: {duration: 10, step: 0.01, initial: {q: 7, a: 0, b: 1}, control: {w: 0.5}}\n";
    let advice = |text: &str| {
        let scenario = resolve(text, &Overrides::default()).unwrap();
        let trace = scenario.run().unwrap();
        scenario.advise(trace.summary()).pop().map(|found| (found.notes.join("\n"), found.help.unwrap_or_default()))
    };
    let (note, help) = advice(rotor).expect("it is no angle");
    assert_eq!(note, "the estimate of `q` is one step of 6.28 off, which the outputs do not show");
    assert!(help.contains("declare its period under `angles`"), "{help}");
    assert_eq!(advice(&format!("{rotor}angles: {{q: 2*pi}}\n")), None);
    assert_eq!(advice(&format!("{rotor}observer: {{extension: [6]}}\n")), None);
    let (note, _) = advice(&with(rotor, "q: 7", "q: -14")).expect("it is no angle");
    assert!(note.contains("is 2 steps of 6.28 off"), "{note}");
}

/// A regression with a primitive: a shift from the extension into the unknown changes no estimate.
#[test]
fn rebasing_changes_no_estimate_of_a_relation_under_the_derivative() {
    let motor = include_str!("../../../../models/motor_currents.yaml");
    let motor =
        with(motor, "estimator: gradient", "estimator: least-squares").replace("  gain: 0.1 ", "  covariance: 1 ");
    let estimates = |rebase: &str| {
        let text = with(&motor, "\n  filter: 1000\n", &format!("\n  filter: 1000\n{rebase}"));
        run(&text, &short(0.3)).column("q_hat").unwrap()
    };
    let plain = estimates("");
    assert!(plain.first() != plain.last(), "nothing was estimated");
    for form in ["1", "100", "{samples: 7}", "{above: 0.05}", "{leak: 5}"] {
        // Thirty thousand steps round by 2^-53 each, of which the sum is 3e-12 and the root of the sum of squares
        // 2e-14.
        for (one, other) in plain.iter().zip(estimates(&format!("  rebase: {form}\n"))) {
            assert!((one - other).abs() < 1e-12, "{form}: {one} {other}");
        }
    }
}

#[test]
fn an_output_with_feedthrough_has_the_first_input_at_the_start() {
    // By the value 0 it would be infinite there.
    let text = "
model: feed
x: [a]
y: [s]
u: [v]
assume: [v > 1]
f_x: {a: -a}
g_y: {s: a/v}
phi: [a]
observer: {gain: 50, filter: 5}
simulation: {duration: 1, step: 0.01, initial: {a: 1}, control: {v: 25 + t}}
";
    let s = run(text, &Overrides::default()).column("s").unwrap();
    assert!((s[0] - 0.04).abs() < 1e-15, "{}", s[0]);
    // A law that has the output, whose value has the input: the law's own answer to that output.
    let fed = run(&with(text, "v: 25 + t", "v: 20 + s"), &Overrides::default());
    let (s, v) = (fed.column("s").unwrap()[0], fed.column("v").unwrap()[0]);
    assert!((v - (20.0 + s)).abs() < 1e-15 && (s - 0.05).abs() < 1e-3, "{s} {v}");
}

#[test]
fn standard_errors_are_columns_where_they_are_predicted() {
    let known = SPRING.split("observer:").next().unwrap().to_owned()
        + "observer: {sensors: {q: 0.01}, start: {v: 1}, disturbance: {v: 0}}\nsimulation:"
        + SPRING.split("simulation:").nth(1).unwrap();
    // An estimate that begins right has first errors that are left out.
    let trace = run(&with(&known, "v: 0, q", "v: 1, q"), &Overrides::default());
    assert_eq!(trace.columns().last().map(String::as_str), Some("v_std"));
    let errors = trace.column("v_std").unwrap();
    // That of the start, then ever smaller ones, whose root mean square once the error has settled is the expected one.
    assert!((errors[0] - 1.0).abs() < 1e-9, "{}", errors[0]);
    let score = &trace.summary().estimates[0];
    let (mut sum, mut count) = (0.0, 0.0);
    // The expected one is of every second row.
    for (t, error) in trace.column("t").unwrap().iter().zip(&errors).step_by(2) {
        if *t >= score.score.since {
            sum += error * error;
            count += 1.0;
        }
    }
    let (seen, expected) = ((sum / count).sqrt(), score.expected.unwrap());
    assert!((seen / expected - 1.0).abs() < 1e-9, "{seen} {expected}");
    // Gains do not say what sensors err by.
    assert!(run(SPRING, &Overrides::default()).column("v_std").is_none());
}
