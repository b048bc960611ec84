//! What samples may be, and how long the observer waits for one.

use crate::simulate::Overrides;

use super::{SPRING, run, with};

/// The spring from rest's place, so that its first sample is within limits; q is sin(2 t).
fn spring(observer: &str, simulation: &str) -> String {
    let moving = with(SPRING, "initial: {v: 0, q: 1}", &format!("initial: {{v: 2, q: 0}}{simulation}"));
    with(&moving, "filter: 5", &format!("filter: 5{observer}"))
}

#[test]
fn a_sample_off_its_range_is_refused_and_bridged() {
    let trace = run(&spring(", limits: {q: [-0.9, 0.9]}", ""), &Overrides::default());
    let summary = trace.summary();
    let refused: Vec<(&str, u64)> = summary.faults.iter().collect();
    // |sin| > 0.9 on 0.902 rad of each half turn: six of them in 20 rad, 45.1 samples each, and 1.5 at the end; a sample to
    // either side of each of the 13 crossings.
    assert!(matches!(refused[..], [(reason, 266..=279)] if reason.contains("output sample 0")), "{refused:?}");
    assert_eq!((summary.restarts, summary.dropped), (0, 0));
    // A gap of 0.45 s, a seventh of the period, is bridged by a straight line: the estimate errs by some percent of 2 m/s.
    assert!(summary.estimates[0].score.rms < 0.1, "{}", summary.text());
    // No number of them ends the run, also at its start.
    let low = run(&spring(", limits: {q: [-2, -0.1]}", "").replace("step: 0.01", "step: 1e-3"), &Overrides::default());
    assert!(low.summary().faults.count() > 5000, "{}", low.summary().text());
    // Limits that nothing reaches change nothing.
    let wide = run(&spring(", limits: {q: [-2, 2]}, gap: 1", ""), &Overrides::default());
    assert_eq!(wide.csv(), run(&spring("", ""), &Overrides::default()).csv());
}

#[test]
fn after_a_long_gap_the_observer_begins_anew() {
    // Two samples in a row are lost about every 25th time: the next comes after 30 ms.
    let text = spring(", gap: 0.025", ", dropped: 0.2");
    let summary = run(&text, &Overrides::default()).summary().clone();
    assert!((15..70).contains(&summary.restarts), "{}", summary.text());
    assert!(summary.text().contains("begun anew: "), "{}", summary.text());
    assert_eq!(summary.faults.count(), 0);
    let patient = run(&spring(", gap: 1", ", dropped: 0.2"), &Overrides::default());
    assert_eq!(patient.summary().restarts, 0);
    assert_eq!(patient.csv(), run(&spring("", ", dropped: 0.2"), &Overrides::default()).csv());
}

#[test]
fn limits_leave_missing_outputs_to_the_observer() {
    let text = "
model: m
x: [p]
y: [q, r]
f_x: {p: 0}
f_y: {q: p, r: p}
phi: [p]
observer: {sensors: {q: 0.01, r: 0.01}, limits: {q: [1, 50], r: [1, 50]}}
simulation: {duration: 5, step: 0.01, initial: {p: 1, q: 2, r: 2}, every: {r: 10}}
";
    let summary = run(text, &Overrides::default()).summary().clone();
    assert_eq!((summary.parted, summary.faults.count(), summary.restarts), (450, 0, 0), "{}", summary.text());
}
