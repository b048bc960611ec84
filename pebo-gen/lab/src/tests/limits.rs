//! Limits of samples, and gaps between them.

use crate::{Certainty, Overrides};

use super::{SPRING, resolve, run, with};

/// The spring from its equilibrium, so that its first sample is within limits; q is sin(2 t).
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
    assert!(matches!(refused[..], [(reason, 266..=279)] if reason.starts_with("`q` is out of range")), "{refused:?}");
    assert_eq!((summary.restarts, summary.dropped), (0, 0));
    // A gap of 0.45 s, a seventh of the period, is bridged by a straight line: the estimate errs by some percent of 2
    // m/s.
    assert!(summary.estimates[0].score.rms < 0.1, "{}", summary.text());
    // No number of them ends the run, also at its start.
    let low = run(&spring(", limits: {q: [-2, -0.1]}", "").replace("step: 0.01", "step: 1e-3"), &Overrides::default());
    let summary = low.summary();
    assert!(summary.faults.count() > 5000, "{}", summary.text());
    // The first of all samples is one too.
    assert!(summary.text().contains(" of 10001 samples: `q` is out of range"), "{}", summary.text());
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

/// A mass on which an unknown constant force acts, with its speed measured.
const FORCE: &str = "
model: force
x: [F]
y: [v]
u: [a]
f_x: {F: 0}
f_y: {v: F + a}
phi: [F]
observer: {sensors: {v: 0.01}, start: {F: 10}, disturbance: {F: 0.1}}
simulation: {duration: 10, step: 0.01, initial: {F: 3, v: 0}, control: {a: -v}, noise: {v: 0.01}}
";

#[test]
fn certainty_is_reported_beside_the_wanted_one() {
    let line = |wanted: &str| {
        let text = with(FORCE, "disturbance: {F: 0.1}", &format!("disturbance: {{F: 0.1}}, wanted: {{F: {wanted}}}"));
        let text = run(&text, &Overrides::default()).summary().text();
        text.lines().find(|line| line.starts_with("certainty: ")).map(str::to_owned)
    };
    // The covariance for this sensor and drift: P = q sqrt(r dt) of the pair (v, F) is about 0.04^2.
    assert!(line("0.2").is_some_and(|line| line.starts_with("certainty: as wanted from t = 0.")), "{:?}", line("0.2"));
    assert!(line("1e-3").is_some_and(|line| line.contains("not yet, `F` is known to 0.0")), "{:?}", line("1e-3"));
    assert_eq!(run(FORCE, &Overrides::default()).summary().certainty, None);
}

#[test]
fn certainty_is_lost_while_no_sample_is_taken() {
    // v goes to 3 - 5 up to 5 s, and to 3 + 5 then: its sensor ends at 6.
    let text = with(FORCE, "disturbance: {F: 0.1}", "disturbance: {F: 0.1}, wanted: {F: 0.05}, limits: {v: [-10, 6]}");
    let text = with(&text, "a: -v", "a: -v + 5*tanh(100*(t - 5))");
    let summary = run(&text, &Overrides::default()).summary().clone();
    // v > 6 after 5 + log(5) s; F was known to 0.04, and drifts to 0.07 within 0.4 s.
    let Some(Certainty::Lost { since, weakest }) = &summary.certainty else { panic!("{}", summary.text()) };
    assert!(weakest == "F" && (6.6..7.5).contains(since), "{}", summary.text());
}

#[test]
fn bounds_that_exclude_the_truth_are_reported_and_leave_the_standard_error() {
    let text = with(FORCE, "disturbance: {F: 0.1}", "disturbance: {F: 0.1}, within: {lower: 5, upper: 6}");
    let scenario = resolve(&text, &Overrides::default()).unwrap();
    let trace = scenario.run().unwrap();
    let (summary, free) = (trace.summary(), run(FORCE, &Overrides::default()));
    let advice = scenario.advise(summary).pop().unwrap();
    assert!(advice.notes[0].contains("`F` itself is beyond the bounds of `within`"), "{advice:?}");
    assert!(summary.estimates[0].outside && !free.summary().estimates[0].outside);
    // An estimate that is moved to a bound is known no better: over the last tenth, as it never settles.
    let last = |trace: &crate::Trace| trace.summary().estimates[0].expected.unwrap();
    assert!((last(&trace) / last(&free) - 1.0).abs() < 0.2, "{} {}", last(&trace), last(&free));
}

#[test]
fn a_state_that_moves_is_followed_by_a_disturbance() {
    let text = with(FORCE, "initial: {F: 3, v: 0}", "initial: {v: 0}, plant: {F: 3*sin(2*pi*t)}");
    let text = with(&text, "{v: 0.01}", "{v: 0.001}");
    let text = with(&text, "disturbance: {F: 0.1}", "disturbance: {F: 0.001}");
    let scenario = resolve(&text, &Overrides::default()).unwrap();
    let trace = scenario.run().unwrap();
    let help = scenario.advise(trace.summary()).pop().unwrap().help.unwrap();
    assert!(help.contains("raise `disturbance` of `F`") && !help.contains("parameter"), "{help}");
    // And so it is: of 2.1 rms a twentieth is lag, behind (3/(0.001^2*0.01)^(1/2))^(1/2) rad/s, and an eighth noise.
    let rms = |text: &str| run(text, &Overrides::default()).summary().estimates[0].score.rms;
    let mended = with(&text, "disturbance: {F: 0.001}", "disturbance: {F: 3}");
    assert!(rms(&mended) < 0.3 * rms(&text), "{} {}", rms(&mended), rms(&text));
}

#[test]
fn time_in_a_plant_is_an_input_as_one_that_is_declared() {
    // A force that hardly drifts is known to less than a hundredth.
    let text = with(FORCE, "disturbance: {F: 0.1}", "disturbance: {F: 0.001}");
    let text = with(&text, "v: F + a", "v: F + a + sin(t)");
    let trace = run(&text, &Overrides::default());
    assert!(trace.summary().unsettled().is_empty(), "{}", trace.summary().text());
    let declared = with(&with(&text, "sin(t)", "sin(time)"), "u: [a]", "u: [a, time]");
    let declared = with(&declared, "control: {a: -v}", "control: {a: -v, time: t + 0.01/2}");
    let other = run(&declared, &Overrides::default());
    let [found, expected] = [&trace, &other].map(|trace| trace.column("F_hat").unwrap());
    // The plant with the declared input has its steps, each of which is off by less than dt^3 s^-2/24 m/s; the noise is
    // one.
    let apart = found.iter().zip(&expected).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-4, "{apart}");
}

#[test]
fn a_run_that_leaves_the_assumed_domain_says_where() {
    let text = "
model: dom
x: [a]
y: [s]
assume: [s > 0, a >= 0]
f_x: {a: 0}
f_y: {s: -a}
phi: [a]
simulation: {duration: 2, step: 0.01, initial: {a: 1, s: 1}}
";
    let trace = run(text, &Overrides::default());
    let found: Vec<_> = trace.summary().outside.iter().map(|left| (left.assumption.as_str(), left.samples)).collect();
    // From 1 s on; whether s is 0 there or a rounding error is the integrator's.
    assert!(matches!(found[..], [("s > 0", 100..=101)]), "{found:?}");
    assert!((trace.summary().outside[0].since - 1.0).abs() < 0.015);
    assert!(trace.summary().text().contains("outside the domain: `s > 0`"), "{}", trace.summary().text());
    // A state that rests at the border of `>=` is not outside.
    let still = run(&with(text, "initial: {a: 1, s: 1}", "initial: {a: 0, s: 1}"), &Overrides::default());
    assert!(still.summary().outside.is_empty(), "{:?}", still.summary().outside);
}

#[test]
fn advice_follows_from_innovation_and_expected_error() {
    let advice = |numbers: &str, more: &str| {
        let (plant, simulation) =
            (SPRING.split("observer:").next().unwrap(), SPRING.split("simulation:").nth(1).unwrap());
        let text = format!(
            "{plant}observer: {{{numbers}}}\nsimulation:{}",
            simulation.replace("q: 1}", &format!("q: 1}}{more}"))
        );
        let scenario = resolve(&text, &Overrides::default()).unwrap();
        let trace = scenario.run().unwrap();
        let said: Vec<String> = scenario
            .advise(trace.summary())
            .into_iter()
            .map(|found| {
                format!("{}: {} | {}", found.code.name(), found.notes.join("; "), found.help.unwrap_or_default())
            })
            .collect();
        (said, trace.summary().clone())
    };
    let numbers = "sensors: {q: 0.1}, start: {v: 1}, disturbance: {v: 0.1}";
    // As noisy as the observer was told: only better sensors help.
    let (said, summary) = advice(numbers, ", noise: {q: 0.1}");
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("the observer expects") && said[0].contains("a better sensor"), "{said:?}");
    assert!(said[0].contains("choose a lower `disturbance`"), "{said:?}");
    assert!(summary.contradiction.is_none() && summary.estimates[0].expected.is_some());
    // One that is assumed is as low as samples show already.
    let (said, _) = advice("sensors: {q: 1}, start: {v: 1}", ", noise: {q: 1}");
    assert!(said[0].contains("simulate longer") && !said[0].contains("lower `disturbance`"), "{said:?}");
    // A hundred times as noisy: the numbers are wrong, and nothing is expected.
    let (said, summary) = advice(&numbers.replace("q: 0.1", "q: 0.001"), ", noise: {q: 0.1}");
    assert!(said[0].starts_with("numbers-contradicted:") && said[0].contains("raise `sensors`"), "{said:?}");
    assert!(said[1].contains("mend the numbers of the observer first"), "{said:?}");
    assert!(summary.text().starts_with("innovations: ") && summary.estimates[0].expected.is_none());
    // Ten times less noisy than told.
    let (said, _) = advice(numbers, ", noise: {q: 0.01}");
    assert!(said[0].contains("lower `sensors`"), "{said:?}");
    // Another spring: the plant does more than the model says.
    let (said, _) =
        advice("sensors: {q: 0.001}, start: {v: 1}, disturbance: {v: 0}", ", noise: {q: 0.001}, plant: {k: 5}");
    assert!(said[0].contains("the simulation has `plant`") && said[0].contains("raise `disturbance`"), "{said:?}");
    assert!(said[1].contains("measure the parameter that differs"), "{said:?}");
    // Samples without noise contradict nothing.
    let (said, summary) = advice("sensors: {q: 0.1}, start: {v: 1}, disturbance: {v: 0}", "");
    assert!(said.is_empty() && summary.contradiction.is_none(), "{said:?}");
}

#[test]
fn a_run_where_a_condition_of_the_verdict_fails_says_so() {
    let text = "
model: gain
x: [a]
y: [s]
u: [v]
f_x: {a: 0}
g_y: {s: a*v}
phi: [1/a]
simulation: {duration: 2, step: 0.01, initial: {a: 0}, control: {v: 1}}
";
    let trace = run(text, &Overrides::default());
    let said = trace.summary().text();
    let line = "outside the conditions: `a != 0` does not hold from t = 0 s on, in 201 of 201 samples";
    assert!(said.contains(line), "{said}");
    let elsewhere = run(&with(text, "initial: {a: 0}", "initial: {a: 1}"), &Overrides::default());
    assert!(elsewhere.summary().outside.is_empty(), "{:?}", elsewhere.summary().outside);
}
