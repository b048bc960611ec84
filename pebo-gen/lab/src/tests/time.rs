//! Plants whose rates depend on time.

use crate::Overrides;

use super::run;

/// A mass that a known force pushes back and forth; its position is measured.
const SHAKEN: &str = "
model: shaken
x: [v]
y: [q]
f_x: {v: 3*sin(2*t) - k*q}
f_y: {q: v}
parameters: {k: 1}
phi: [v]
observer: {sensors: {q: 0.001}, start: {v: 5}}
simulation: {duration: 10, step: 0.01, initial: {v: 2, q: 1}}
";

#[test]
fn the_plant_uses_the_time_and_the_observer_measures_it() {
    let trace = run(SHAKEN, &Overrides::default());
    // The time is the first column, and stands there once.
    assert!(trace.csv().starts_with("t,v,q,v_hat,v_error,v_std\n"), "{}", &trace.csv()[..40]);
    let [t, v, q] = ["t", "v", "q"].map(|name| trace.column(name).expect("a column"));
    for ((t, v), q) in t.iter().zip(&v).zip(&q) {
        // q'' + q = 3 sin(2 t) is solved by 4 sin(t) - sin(2 t) + cos(t).
        assert!((q - (4.0 * t.sin() - (2.0 * t).sin() + t.cos())).abs() < 1e-8, "{t} {q}");
        assert!((v - (4.0 * t.cos() - 2.0 * (2.0 * t).cos() - t.sin())).abs() < 1e-8, "{t} {v}");
    }
    let score = &trace.summary().estimates[0].score;
    assert!(score.settled.is_some_and(|settled| settled < 0.1), "{}", trace.summary().text());
    // The force is held over each step at its middle: its second derivative of 12 N/kg/s^2 times dt^2/24, for the time
    // that the observer remembers, of some tenths of a second, and the outputs joined by straight lines the same.
    assert!(trace.column("v_error").expect("a column").iter().skip(100).all(|error| error.abs() < 1e-3));
}

#[test]
fn a_sign_of_time_changes_when_it_does() {
    // A square wave of 1 s: q'' = sign(sin(pi t)), so v rises and falls between 0 and 1.
    let text = SHAKEN.replace("3*sin(2*t) - k*q", "k*sign(sin(pi*t + 0.05))").replace("{v: 2, q: 1}", "{v: 0, q: 0}");
    let trace = run(&text, &Overrides::default());
    let [t, v] = ["t", "v"].map(|name| trace.column(name).expect("a column"));
    let shift = 0.05 / std::f64::consts::PI;
    for (t, v) in t.iter().zip(&v) {
        let phase = (t + shift).rem_euclid(2.0);
        let expected = if phase < 1.0 { phase } else { 2.0 - phase } - shift;
        assert!((v - expected).abs() < 1e-8, "{t} {v} {expected}");
    }
}

#[test]
fn baselines_measure_the_time_too() {
    let text = SHAKEN.replace("initial: {v: 2, q: 1}", "initial: {v: 2, q: 1}, baselines: {kalman: {sensors: {q: 0.001}, \
         start: {v: 5}}, own: {state: {a: 3*sin(2*t) - q + 5*(q - b), b: a + 5*(q - b)}, initial: {b: q}, estimate: {v: a}}}");
    let trace = run(&text, &Overrides::default());
    for estimate in &trace.summary().estimates {
        assert!(estimate.score.settled.is_some(), "{}", trace.summary().text());
    }
}
