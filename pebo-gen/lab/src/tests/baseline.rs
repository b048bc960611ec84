//! Baselines by name, against their known properties.

use crate::{Overrides, Trace};
use pebo_design::source::Code;

use super::{SPRING, resolve, run, with};

fn every_sample(text: &str) -> Trace {
    run(text, &Overrides { every: Some(1e-9), ..Overrides::default() })
}

fn errors(trace: &Trace, baseline: &str, state: &str) -> Vec<f64> {
    let (truth, hat) = (trace.column(state).unwrap(), trace.column(&format!("{baseline}.{state}_hat")).unwrap());
    hat.iter().zip(truth).map(|(hat, truth)| hat - truth).collect()
}

/// A measured constant: the filter's estimate is a mean, which is computed here.
#[test]
fn the_filter_of_a_constant_is_the_mean_of_its_samples() {
    let text = "
model: constant
x: [c]
y: [p]
f_x: {c: 0}
g_y: {p: c}
phi: [c]
observer: {gain: 1, filter: 5}
simulation: {duration: 1, step: 0.01, initial: {c: 2}, noise: {p: 0.5}, baselines: {kalman: {start: {c: 3}}}}
";
    let trace = every_sample(text);
    let (p, hat) = (trace.column("p").unwrap(), trace.column("kalman.c_hat").unwrap());
    assert_eq!(hat[0].to_bits(), 0);
    let mut sum = 0.0;
    for (samples, (p, hat)) in (1_u32..).zip(p.iter().zip(&hat).skip(1)) {
        sum += p;
        // The start counts as one more sample of 0, with the weight of its variance.
        let mean = sum / (f64::from(samples) + 0.5_f64.powi(2) / 3.0_f64.powi(2));
        assert!((hat - mean).abs() < 1e-12, "{hat} {mean}");
    }
}

/// With a bias and dropped samples it is the mean of those that arrived, the same as the observer's.
#[test]
fn a_baseline_gets_the_samples_of_the_observer() {
    let text = "
model: constant
x: [c]
y: [p]
f_x: {c: 0}
g_y: {p: c}
phi: [c]
observer: {gain: 1, filter: 5}
simulation:
  {duration: 2, step: 0.01, initial: {c: 2}, noise: {p: 0.5}, bias: {p: 1}, dropped: 0.4, baselines: {kalman: {start: {c: 3}}}}
";
    let trace = every_sample(text);
    let (p, hat) = (trace.column("p").unwrap(), trace.column("kalman.c_hat").unwrap());
    let (mut sum, mut samples) = (0.0, 0.5_f64.powi(2) / 3.0_f64.powi(2));
    for row in 1..p.len() {
        // A sample that did not arrive leaves the one before: with noise no two are the same.
        if p[row].to_bits() != p[row - 1].to_bits() {
            (sum, samples) = (sum + p[row], samples + 1.0);
        }
        assert!((hat[row] - sum / samples).abs() < 1e-12, "{row} {} {}", hat[row], sum / samples);
    }
    assert!((samples - 120.0).abs() < 30.0 && (hat[200] - 3.0).abs() < 0.2, "{samples} {}", hat[200]);
}

/// Three states, the first two observable from one output, and an output of another kind.
const CHAIN: &str = "
model: chain
x: [a, b]
y: [p, q]
u: [v]
f_x: {a: b - a, b: v - 2*b}
f_y: {p: a - p, q: b - 3*q + v}
phi: [a, b]
observer: {gain: 1, filter: 5}
simulation:
  duration: 1
  step: 0.01
  initial: {a: 1, b: -2, p: 0.5, q: 3}
  control: {v: sin(t)}
  baselines: {luenberger: {poles: [-5, -6, -7, -8]}}
";

/// The error obeys the recurrence that has the poles for roots.
#[test]
fn the_error_of_luenbergers_observer_has_its_poles() {
    let trace = every_sample(CHAIN);
    let roots = [-5.0, -6.0, -7.0, -8.0_f64].map(|pole| (pole * 0.01).exp());
    let mut polynomial = vec![1.0];
    for root in roots {
        polynomial.push(0.0);
        for place in (1..polynomial.len()).rev() {
            polynomial[place] -= root * polynomial[place - 1];
        }
    }
    for state in ["a", "b"] {
        let errors = errors(&trace, "luenberger", state);
        let largest = errors.iter().fold(0.0_f64, |most, error| most.max(error.abs()));
        for window in errors.windows(5) {
            let rest: f64 = polynomial.iter().zip(window.iter().rev()).map(|(factor, error)| factor * error).sum();
            // Rounding, and the relative accuracy of the plant's integration.
            assert!(rest.abs() < 1e-9 * largest, "{state} {rest}");
        }
        assert!(errors[0].abs() > 0.5 && errors[100].abs() < 0.2 * errors[0].abs(), "{errors:?}");
    }
}

#[test]
fn the_extended_filter_of_an_affine_plant_is_the_filter() {
    let settings = "{sensors: {p: 0.1, q: 0.2}, start: {a: 1, b: 2}, disturbance: {b: 0.5, p: 0.1}, initial: {a: p}}";
    let both = format!("baselines: {{kalman: {settings}, ekf: {settings}}}\n  noise: {{p: 0.1, q: 0.2}}");
    let trace = every_sample(&with(CHAIN, "baselines: {luenberger: {poles: [-5, -6, -7, -8]}}", &both));
    for state in ["a", "b"] {
        assert_eq!(trace.column(&format!("kalman.{state}_hat")), trace.column(&format!("ekf.{state}_hat")));
    }
    // The start is the sensor's sample.
    let first = |name: &str| trace.column(name).unwrap()[0].to_bits();
    assert_eq!(first("kalman.a_hat"), first("p"));
    let error = errors(&trace, "kalman", "b");
    assert!(error[0].abs() > 1.9 && error[100].abs() < 0.5, "{}", error[100]);
}

/// A pendulum, in which the filter has to follow a sine.
const PENDULUM: &str = "
model: pendulum
x: [v]
y: [q]
f_x: {v: -9.81*sin(q)}
f_y: {q: v}
phi: [v]
observer: {gain: 50, filter: 5}
simulation:
  duration: 5
  step: 0.01
  initial: {v: 1, q: 2}
  noise: {q: 1e-3}
  baselines: {ekf: {}, luenberger: {poles: [-10, -12]}}
";

#[test]
fn a_plant_that_is_not_affine_is_linearised() {
    let trace = every_sample(PENDULUM);
    for (name, bound) in [("ekf", 5e-3), ("luenberger", 5e-2)] {
        let error = errors(&trace, name, "v");
        // The rest is the noise, by the gain of the observer. Without disturbances the filter averages it.
        assert!((error[0] + 1.0).abs() < 1e-12 && error[500].abs() < bound, "{name} {}", error[500]);
    }
}

#[test]
fn a_baseline_without_sensors_has_those_of_the_observer() {
    let of = |observer: &str, baseline: &str| {
        let text = with(SPRING, "{gain: 50, filter: 5}", observer);
        let initial = "initial: {v: 0, q: 1}";
        every_sample(&with(&text, initial, &format!("{initial}, baselines: {{kalman: {baseline}}}")))
    };
    let known = "{sensors: {q: 0.02}, start: {v: 1}}";
    let [without, same, other] = ["", ", sensors: {q: 0.02}", ", sensors: {q: 0.5}"]
        .map(|sensors| of(known, &format!("{{initial: {{v: 1}}{sensors}}}")).csv());
    assert!(without == same && without != other);
}

#[test]
fn missing_settings_of_a_baseline_are_reported() {
    let spring = |baseline: &str| {
        with(SPRING, "initial: {v: 0, q: 1}", &format!("initial: {{v: 0, q: 1}}, baselines: {{{baseline}}}"))
    };
    for (text, code, message) in [
        (spring("kalman: {}"), Code::SimulationIncomplete, "`kalman` needs the standard deviation of `q`"),
        (spring("kalman: {sensors: {v: 1}}"), Code::UnknownEntry, "`v` under `sensors` is not an output of y"),
        (spring("kalman: {sensors: {q: 0}}"), Code::NumberOutOfRange, "of a sensor must be positive"),
        (spring("kalman: {start: {v: -1}}"), Code::NumberOutOfRange, "must not be negative"),
        (spring("kalman: {start: {q: 1}}"), Code::UnknownEntry, "`q` under `start` is not a state of x"),
        (spring("kalman: {disturbance: {w: 1}}"), Code::UnknownEntry, "`w` under `disturbance`"),
        (spring("kalman: {poles: [-1]}"), Code::UnknownKey, "unknown key `poles`"),
        (spring("kalman: {initial: {v: v}}"), Code::SimulationIncomplete, "standard deviation"),
        (spring("luenberger: {}"), Code::MissingKey, "the key `poles` is missing"),
        (spring("luenberger: {poles: [-1]}"), Code::WrongShape, "`luenberger` has 1 poles, and 2 states"),
        (spring("luenberger: {poles: [-1, 1]}"), Code::NumberOutOfRange, "a pole must be negative"),
        (spring("luenberger: {poles: [-1, -1.0]}"), Code::NumberOutOfRange, "this pole is there twice"),
        (spring("observed: {poles: [-1, -2]}"), Code::UnknownKey, "unknown key `poles`"),
        (with(PENDULUM, "ekf: {}", "kalman: {}"), Code::SettingConflict, "`kalman` needs a plant that is affine"),
    ] {
        let found = resolve(&text, &Overrides::default()).expect_err(&text);
        let hit = found.iter().find(|d| d.code == code && d.message.contains(message));
        assert!(hit.is_some_and(|d| d.help.is_some()), "{message}: {found:#?}");
    }
}

#[test]
fn a_baseline_that_starts_out_of_its_domain_is_named_with_its_start() {
    let text = "
model: log
x: [a]
y: [s]
assume: [a > 0]
f_x: {a: 0}
g_y: {s: log(a)}
phi: [log(a)]
simulation: {duration: 1, step: 0.01, initial: {a: 2}, baselines: {ekf: {sensors: {s: 0.1}, start: {a: 1}}}}
";
    let failure = resolve(text, &Overrides::default()).expect("a scenario").run().expect_err("log(0) has no value");
    assert!(failure.to_string().contains("`ekf.hat(a)`") && failure.help().contains("`initial: {"), "{failure}");
    run(&with(text, "start: {a: 1}", "start: {a: 1}, initial: {a: 1}"), &Overrides::default());
}
