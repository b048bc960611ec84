//! Sensors and instants that are not perfect, sample by sample.

use std::collections::BTreeMap;

use crate::{Overrides, Trace};
use pebo_design::source::Code;

use super::{CUK_CASE_2, SPRING, resolve, run, with};

/// The spring with this beside its initial state.
fn spring(more: &str) -> String {
    with(SPRING, "initial: {v: 0, q: 1}", &format!("initial: {{v: 0, q: 1}}, {more}"))
}

/// Every sample of a run with this seed.
fn sampled(text: &str, seed: u64) -> Trace {
    run(text, &Overrides { seed: Some(seed), duration: Some(5.0), every: Some(1e-9), ..Overrides::default() })
}

fn column(trace: &Trace, name: &str) -> Vec<f64> {
    trace.column(name).unwrap()
}

#[test]
fn a_bias_is_added_to_every_sample() {
    let (ideal, biased) = (sampled(SPRING, 1), sampled(&spring("bias: {q: -0.25}"), 1));
    let (ideal, biased) = (column(&ideal, "q"), column(&biased, "q"));
    assert!(ideal.iter().zip(&biased).all(|(ideal, biased)| (ideal - 0.25).to_bits() == biased.to_bits()));
}

#[test]
fn a_quantised_sample_is_the_nearest_multiple_of_the_step() {
    for step in [0.125, 0.1, 0.07] {
        let quantised = column(&sampled(&spring(&format!("quantisation: {{q: {step}}}")), 1), "q");
        let ideal = column(&sampled(SPRING, 1), "q");
        for (ideal, quantised) in ideal.iter().zip(&quantised) {
            let count = (quantised / step).round();
            assert_eq!(quantised.to_bits(), (step * count + 0.0).to_bits(), "{step}");
            // To rounding of the product.
            assert!((ideal - quantised).abs() <= step / 2.0 + 1e-15, "{ideal} {quantised}");
        }
        let levels: std::collections::BTreeSet<u64> = quantised.iter().map(|q| q.to_bits()).collect();
        assert!(levels.len() > 10, "{step}: {}", levels.len());
    }
}

#[test]
fn a_delay_of_whole_samples_is_a_shift() {
    let ideal = column(&sampled(SPRING, 1), "q");
    for (delay, samples) in [("0.01", 1), ("{q: 0.05}", 5), ("0", 0)] {
        let late = column(&sampled(&spring(&format!("delay: {delay}")), 1), "q");
        for (sample, late) in late.iter().enumerate() {
            // Before the start the output is constant.
            assert_eq!(late.to_bits(), ideal[sample.saturating_sub(samples)].to_bits(), "{delay} {sample}");
        }
    }
}

#[test]
fn a_part_of_a_step_is_interpolated_between_its_ends() {
    let (ideal, late) = (sampled(SPRING, 1), sampled(&spring("delay: 0.0225"), 1));
    let (t, ideal, late) = (column(&ideal, "t"), column(&ideal, "q"), column(&late, "q"));
    for sample in 3..t.len() {
        let [before, after] = [ideal[sample - 3], ideal[sample - 2]];
        assert!((late[sample] - (before + 0.75 * (after - before))).abs() < 1e-14, "{sample}");
        // An eighth of the step squared times the largest second derivative, which is 4.
        assert!((late[sample] - (2.0 * (t[sample] - 0.0225)).cos()).abs() < 0.5e-4 + 1e-8);
    }
}

#[test]
fn jitter_moves_the_instants_unmeasured() {
    let trace = sampled(&spring("jitter: 0.3"), 1);
    let (t, q) = (column(&trace, "t"), column(&trace, "q"));
    let places = (0_u32..).map(|sample| f64::from(sample) * 0.01);
    let late: Vec<f64> = t.iter().zip(places).map(|(t, place)| (t - place) / 0.01).collect();
    assert!(late.iter().all(|late| late.abs() <= 0.3 + 1e-9) && late[0].abs() + late[500].abs() < 1e-12);
    let mean_square = late.iter().map(|late| late * late).sum::<f64>() / 501.0;
    // That of an even spread is 0.03; known within a tenth from so many.
    assert!((mean_square - 0.03).abs() < 0.003, "{mean_square}");
    assert!(t.windows(2).all(|pair| pair[1] > pair[0]));
    // The plant does not know of it.
    assert!(t.iter().zip(&q).all(|(t, q)| (q - (2.0 * t).cos()).abs() < 1e-8));
    // The observer takes the samples for those of other instants: its estimates are off by as much as that tells.
    let (quiet, error) = (column(&sampled(SPRING, 1), "v_error"), column(&trace, "v_error"));
    assert!(quiet[500].abs() < 1e-3 && error[400..].iter().any(|error| error.abs() > 1e-2));
    // Chance is another for another seed.
    assert_ne!(column(&sampled(&spring("jitter: 0.3"), 2), "t"), t);
}

#[test]
fn a_dropped_sample_reaches_nobody() {
    let text = spring("dropped: 0.3, baselines: {kalman: {sensors: {q: 0.1}}}");
    let trace = sampled(&text, 3);
    let (q, hat) = (column(&trace, "q"), column(&trace, "v_hat"));
    let ideal = column(&sampled(SPRING, 3), "q");
    let mut dropped = 0;
    for sample in 1..q.len() {
        if q[sample].to_bits() == ideal[sample].to_bits() {
            continue;
        }
        // The last one that arrived stands, and so does the estimate.
        assert_eq!((q[sample].to_bits(), hat[sample].to_bits()), (q[sample - 1].to_bits(), hat[sample - 1].to_bits()));
        dropped += 1;
    }
    assert_eq!(trace.summary().dropped, dropped);
    // Of 500 with probability 0.3: four standard deviations are 41.
    assert!((109..=191).contains(&dropped), "{dropped}");
    assert_eq!(trace.summary().faults.count(), 0);
    // Over a longer period the same regression holds to the order of the period: the estimate converges all the same.
    assert!(column(&trace, "v_error")[500].abs() < 2e-2, "{:?}", column(&trace, "v_error")[500]);
    // The filter goes on predicting where there is no sample, and is exact without noise.
    assert!((column(&trace, "kalman.v_hat")[500] - column(&trace, "v")[500]).abs() < 1e-2);
}

/// Without dropped samples the bridging of gaps changes no bit.
#[test]
fn absent_imperfections_change_no_bit() {
    let quiet = sampled(SPRING, 1).csv();
    for none in ["noise: {q: 0}", "bias: {q: 0}", "quantisation: {q: 0}", "delay: 0", "jitter: 0", "dropped: 0"] {
        assert_eq!(sampled(&spring(none), 1).csv(), quiet, "{none}");
    }
}

#[test]
fn the_same_seed_has_the_same_bits_with_everything_at_once() {
    let all = "noise: {v2: 0.1, i3: 0.01}\n  bias: {v2: 0.1}\n  quantisation: {i3: 0.01}\n  delay: {v2: 2.5e-5}\n  \
               jitter: 0.3\n  dropped: 0.2\n  plant: {G: 0.05}\n  step: 1e-5";
    let text = with(CUK_CASE_2, "step: 1e-5", all);
    let short = |seed: u64| Overrides { duration: Some(0.02), seed: Some(seed), ..Overrides::default() };
    let first = run(&text, &short(4));
    assert_eq!(first.csv(), run(&text, &short(4)).csv());
    assert_eq!(first.summary(), run(&text, &short(4)).summary());
    assert_ne!(first.csv(), run(&text, &short(5)).csv());
}

/// Samples of one output's sensor do not depend on the imperfections of the other's.
#[test]
fn sensors_do_not_disturb_one_another() {
    let noisy = |more: &str| {
        let text =
            with(CUK_CASE_2, "step: 1e-5", &format!("noise: {{i3: 0.01{more}}}\n  feedback: truth\n  step: 1e-5"));
        let text = text.replace("  feedback: observer", "  #");
        let text = text.replace("d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: V_d/(V_d + E)");
        column(&run(&text, &Overrides { duration: Some(1e-3), ..Overrides::default() }), "i3")
    };
    assert_eq!(noisy(""), noisy(", v2: 0.5"));
}

/// A plant whose sample is out of the domain of the observer's formulas now and then.
const ROOT: &str = "
model: root
x: [a]
y: [p]
f_x: {a: 0}
f_y: {p: a*sqrt(p)}
phi: [a]
assume: [p > 0]
observer: {gain: 10, filter: 5}
simulation: {duration: 5, step: 0.01, initial: {a: 0.1, p: 0.04}, noise: {p: 0.02}}
";

#[test]
fn faults_are_counted_and_the_run_goes_on() {
    let trace = run(ROOT, &Overrides { seed: Some(2), ..Overrides::default() });
    let summary = trace.summary();
    let faults: BTreeMap<&str, u64> = summary.faults.iter().collect();
    let below = column(&trace, "p").iter().filter(|p| **p < 0.0).count();
    assert!(summary.faults.count() > 0, "{below} {faults:?}");
    assert!(faults.keys().all(|reason| reason.contains("not be finite")), "{faults:?}");
    assert!(summary.text().contains("of 501 samples: the new state would not be finite"), "{}", summary.text());
}

#[test]
fn a_sample_that_arrives_after_the_run_is_refused() {
    let late = |delay: &str| {
        let known =
            format!("observer: {{sensors: {{q: 0.1}}, start: {{v: 1}}, disturbance: {{v: 0}}, delay: {delay}}}");
        with(SPRING, "observer: {gain: 50, filter: 5}", &known)
    };
    let found = resolve(&late("{q: 10}"), &Overrides::default()).expect_err("a run of 10 s");
    let hit =
        found.iter().find(|d| d.code == Code::NumberOutOfRange && d.message.contains("does not arrive within 10"));
    assert!(hit.is_some_and(|d| d.help.is_some()), "{found:#?}");
    // The sensor of the run is as late as the observer is told.
    let [ideal, delayed] = [SPRING.to_owned(), late("{q: 0.05}")].map(|text| column(&sampled(&text, 1), "q"));
    assert_eq!(delayed[100].to_bits(), ideal[95].to_bits());
}

#[test]
fn impossible_sensors_are_refused() {
    for (more, code, message) in [
        ("bias: {v: 1}", Code::UnknownEntry, "`v` under `bias` is not an output of y"),
        ("bias: 1", Code::WrongShape, "expected a map from names to numbers"),
        ("quantisation: {v: 1}", Code::UnknownEntry, "`v` under `quantisation`"),
        ("quantisation: {q: -1}", Code::NumberOutOfRange, "the step of a quantisation must not be negative"),
        ("delay: {v: 1}", Code::UnknownEntry, "`v` under `delay`"),
        ("delay: -1", Code::NumberOutOfRange, "a delay must not be negative"),
        ("delay: [1]", Code::WrongShape, "expected a number, or a map from names to numbers"),
        ("delay: 1e7", Code::SimulationUnsupported, "a delay of 1e7 s is too long"),
        ("jitter: 0.5", Code::NumberOutOfRange, "`jitter` must be 0 or more, and below 0.5"),
        ("jitter: {q: 0.1}", Code::WrongShape, "expected a number"),
        ("dropped: 1", Code::NumberOutOfRange, "`dropped` must be 0 or more, and below 1"),
        ("dropped: -0.1", Code::NumberOutOfRange, "`dropped`"),
        ("jiter: 0.1", Code::UnknownKey, "unknown key `jiter`"),
    ] {
        let found = resolve(&spring(more), &Overrides::default()).expect_err(more);
        let hit = found.iter().find(|d| d.code == code && d.message.contains(message));
        assert!(hit.is_some_and(|d| d.help.is_some()), "{message}: {found:#?}");
    }
}
