//! Closed loops from the model files against independent curves.
//!
//! The curves are those of plant and observer integrated together as one stiff ODE in continuous time
//! (LSODA, relative tolerance 1e-8), with the gains of the paper and without sampling.

use pebo_gen::simulate::{Overrides, Trace, figure};
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};

const CASE_1: &str = include_str!("../../models/cuk.yaml");
const CASE_2: &str = include_str!("../../models/cuk_case2.yaml");

/// Errors of two estimates at a time, in A or V, to four decimals: a tenth of what is compared and better.
type Row = (f64, f64, f64);

const CASE_1_GRADIENT: [Row; 5] = [
    (0.002, -0.5002, 0.9982),
    (0.01, -0.5245, 0.8059),
    (0.02, -0.5698, 0.2263),
    (0.05, -0.1594, 0.0261),
    (0.1, 0.0, 0.0),
];
const CASE_2_LOW: [Row; 5] = [
    (0.002, -0.4971, -7.5196),
    (0.01, -0.2505, -7.5172),
    (0.02, -0.0022, -7.4999),
    (0.1, 0.0, -5.5182),
    (0.3, 0.0, -0.0054),
];
const CASE_2_HIGH: [Row; 5] =
    [(0.002, -0.2769, -7.5176), (0.01, 0.0, -7.2749), (0.02, 0.0, -5.7824), (0.05, 0.0, -0.1358), (0.1, 0.0, 0.0)];
const IMMERSION: [Row; 5] =
    [(0.002, -0.492, 0.2415), (0.01, -0.4619, 0.0), (0.05, -0.3381, 0.0), (0.3, -0.0513, 0.0), (0.7, -0.0005, 0.0)];

/// Sampling at 10 us leaves differences of at most 1.7e-3 of the initial error, and they fall in
/// proportion to the step: the control law and the observer see samples, the curves do not.
const SHARE: f64 = 0.005;

fn derived(text: &str) -> Derived {
    derive(&Source::new("model", text).expect("a text")).expect("a model")
}

fn run(text: &str, overrides: &Overrides) -> Trace {
    let scenario = derived(text).scenario(overrides).expect("a closed loop");
    scenario.run().expect("a run to the end")
}

fn feedback(name: &str) -> Overrides {
    Overrides { feedback: Some(name.to_owned()), ..Overrides::default() }
}

/// Compares errors of two estimates, given by the names of their columns and of the truth.
fn agrees(trace: &Trace, estimates: [(&str, &str); 2], curve: &[Row]) {
    let time = trace.column("t").expect("time");
    for (which, (estimate, truth)) in estimates.into_iter().enumerate() {
        let (estimate, truth) = (trace.column(estimate).expect(estimate), trace.column(truth).expect(truth));
        let error = |row: usize| estimate[row] - truth[row];
        for &(at, first, second) in curve {
            let row = time.iter().position(|t| (t - at).abs() < 1e-7).expect("a row at the time");
            let expected = if which == 0 { first } else { second };
            let off = (error(row) - expected).abs() / error(0).abs();
            assert!(off < SHARE, "estimate {which} at {at} s: {} is not {expected}", error(row));
        }
    }
}

#[test]
fn case_1_gradient() {
    let trace = run(CASE_1, &Overrides::default());
    agrees(&trace, [("i1_hat", "i1"), ("i3_hat", "i3")], &CASE_1_GRADIENT);
}

#[test]
fn case_2_gradient_with_low_gains() {
    let trace = run(CASE_2, &Overrides::default());
    agrees(&trace, [("i1_hat", "i1"), ("v4_hat", "v4")], &CASE_2_LOW);
}

#[test]
fn case_2_gradient_with_high_gains() {
    let high = CASE_2.replace("gain: [0.01, 0.1]", "gain: [1, 10]");
    assert_ne!(high, CASE_2);
    let trace = run(&high, &Overrides::default());
    agrees(&trace, [("i1_hat", "i1"), ("v4_hat", "v4")], &CASE_2_HIGH);
}

#[test]
fn case_2_immersion_and_invariance() {
    let trace = run(CASE_2, &feedback("immersion"));
    agrees(&trace, [("immersion.i1_hat", "i1"), ("immersion.v4_hat", "v4")], &IMMERSION);
}

/// The paper prints `zeta2 + L3 gamma2 y2`; only with the minus sign does the estimate converge.
#[test]
fn the_printed_sign_of_the_immersion_observer_does_not_converge() {
    let printed = CASE_2
        .replace("v4: zeta_2 - L3*gamma_2*i3", "v4: zeta_2 + L3*gamma_2*i3")
        .replace("zeta_2: L3*gamma_2*i3}", "zeta_2: -L3*gamma_2*i3}");
    assert_ne!(printed, CASE_2);
    let error_at_end = |text: &str| {
        let trace = run(text, &Overrides::default());
        // Half-way between two set points, where the circuit has settled after the first transient.
        let (hat, truth) = (trace.column("immersion.v4_hat").expect("hat"), trace.column("v4").expect("v4"));
        let time = trace.column("t").expect("time");
        let moving = time.iter().position(|t| (t - 0.402).abs() < 1e-7).expect("a row after a jump");
        (hat[moving] - truth[moving]).abs()
    };
    let (right, wrong) = (error_at_end(CASE_2), error_at_end(&printed));
    assert!(right < 1e-6, "with the minus sign the error is {right} V");
    assert!(wrong > 1e3 * right.max(1e-9), "with the plus sign the error is {wrong} V");
}

#[test]
fn shorter_steps_approach_continuous_time() {
    // The error of i3 at 0.02 s, to all digits of the reference.
    let exact = 0.226_270_996;
    let difference = |step: f64| {
        let overrides = Overrides { step: Some(step), duration: Some(0.02), every: Some(1e-3), ..Overrides::default() };
        let error = run(CASE_1, &overrides).column("i3_error").expect("an error");
        (error[20] - exact).abs()
    };
    let ratio = difference(1e-5) / difference(1e-6);
    // First order in the step, plus a second-order term that still counts at the longer one.
    assert!((5.0..20.0).contains(&ratio), "{ratio}");
}

#[test]
fn figures_show_every_panel_and_stay_small() {
    for text in [CASE_1, CASE_2] {
        let scenario = derived(text).scenario(&Overrides::default()).expect("a closed loop");
        let trace = scenario.run().expect("a run to the end");
        let svg = figure::draw(&trace, &scenario);
        let panels = text.matches("- {title:").count();
        assert!(panels >= 3);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.len() < 100_000, "{} bytes", svg.len());
    }
}
