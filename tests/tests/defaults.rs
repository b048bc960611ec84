//! Without a number from their author observers converge; `cargo run --release -p tests --example defaults` shows all.

#[path = "../bench/defaults/plants.rs"]
mod plants;

use pebo_gen::derive;
use pebo_gen::simulate::{Overrides, Summary};
use pebo_gen::source::Source;

fn run(text: &str, seed: u64) -> Summary {
    let derived = derive(&Source::new("model", text).unwrap()).unwrap();
    let scenario = derived.scenario(&Overrides { seed: Some(seed), ..Overrides::default() }).unwrap();
    scenario.run().unwrap().summary().clone()
}

/// Of each kind of observer, cascade and regression at least one; those that take few samples.
const QUICK: &[&str] = &[
    "models/battery",
    "models/bicycle",
    "models/boost_resistive",
    "models/reactor",
    "plants/battery",
    "plants/bearing_only",
    "plants/boost_resistive",
    "plants/dc_motor_load",
    "plants/wind_turbine",
];

#[test]
fn observers_converge_without_a_number() {
    let cases = plants::cases(QUICK).unwrap();
    assert_eq!(cases.len(), QUICK.len());
    for case in cases {
        // Until something sets in that lasts, of which no output tells: an offset of the input's sensor, a side wind.
        let text = case.text.replace("duration: 7200\n", "duration: 3600\n").replace("duration: 10\n", "duration: 5\n");
        let summary = run(&text, 1);
        assert!(summary.known.is_some(), "{}", case.name);
        let unsettled: Vec<String> = summary.unsettled().iter().map(|rated| rated.estimate.name()).collect();
        assert!(unsettled.is_empty(), "{}: {unsettled:?}\n{}", case.name, summary.text());
    }
}

#[test]
fn a_target_that_changes_its_course_is_followed_under_noise() {
    // Half way the bearing begins to contradict a constant velocity; without noise the range takes longer than the run.
    let case = plants::cases(&["models/bearing_only"]).unwrap().remove(0);
    let noisy = case.text.replace("  duration: 2400\n", "  duration: 2400\n  noise: {beta: 1.4e-3}\n");
    assert_ne!(noisy, case.text);
    let summary = run(&noisy, 1);
    let unsettled: Vec<String> =
        summary.unsettled().iter().map(|rated| rated.estimate.name()).filter(|name| !name.starts_with("ekf")).collect();
    assert!(unsettled.is_empty(), "{unsettled:?}\n{}", summary.text());
}

#[test]
fn the_noise_of_a_bearing_does_not_pull_a_target_near() {
    // The filter of the same numbers is an extended Kalman filter, which linearises the bearing where it expects it.
    let case = plants::cases(&["models/bearing_only"]).unwrap().remove(0);
    let known = "observer: {sensors: {beta: 1e-3}, start: {rx: 3000, ry: 3000, vx: 5, vy: 5}, disturbance: {vx: 0.02, vy: 0.02}}";
    let noisy = case.text.replace("  duration: 2400\n", "  duration: 2400\n  noise: {beta: 1e-3}\n");
    let summary = run(&format!("{noisy}\n{known}\n"), 1);
    for state in ["rx", "ry"] {
        let rms =
            |name: String| summary.estimates.iter().find(|rated| rated.estimate.name() == name).unwrap().score.rms;
        let (own, filter) = (rms(state.to_owned()), rms(format!("ekf.{state}")));
        // As good but for chance: the error of a range is correlated over half a turn of the ship, of which the run has
        // eight. With the noise in the factor it is two to five times as large.
        assert!(own < 1.4 * filter, "{own} {filter}\n{}", summary.text());
    }
}

/// An output multiplies an unknown: the free enzyme is that of a sum which stands still, less what the sensors show.
const ENZYME: &str = "
model: enzyme
parameters: {k1: 1, km: 0.5, k2: 0.3, E0: 1}
x: [C]
y: [S, P]
u: [v]
f_x: {C: k1*(E0 - C)*S - (km + k2)*C}
f_y: {S: -k1*(E0 - C)*S + km*C + v, P: k2*C}
phi: [S + P + C]
assume: [C > 0, S > 0, P > 0]
observer: {sensors: {S: 0.0155, P: 0.0345}, start: {C: 3}, disturbance: {C: 0}}
simulation:
  duration: 30
  step: 0.01
  initial: {C: 0.1, S: 2, P: 0.1}
  control: {v: 0.2}
  noise: {S: 0.0155, P: 0.0345}
  baselines: {ekf: {start: {C: 3}}}
";

#[test]
fn what_multiplies_an_unknown_is_filtered_too() {
    let summary = run(ENZYME, 1);
    // As fast and as good as an extended Kalman filter of the same numbers: it differs by how each goes from sample to
    // sample. With samples in the rates as they are the error takes eighty times as long to settle, and is ten times as
    // large then.
    let settled: Vec<f64> = summary.estimates.iter().map(|rated| rated.score.settled.unwrap()).collect();
    assert!(settled[0] < 1.1 * settled[1], "{}", summary.text());
    let [own, filter] = [0, 1].map(|place: usize| summary.estimates[place].score.rms);
    assert!(own < 1.1 * filter, "{}", summary.text());
}

/// A converter whose parts die out at different rates, with numbers that leave nothing to disturb them.
const SEPIC: &str = "
model: sepic
parameters: {L1: 150e-6, L2: 100e-6, C1: 47e-6, C2: 100e-6, R: 5, E: 12}
x: [i1, i2]
y: [v1, v2]
u: [d]
assume: [0 < d < 1]
f_x: {i1: (E - (1 - d)*(v1 + v2))/L1, i2: (d*v1 - (1 - d)*v2)/L2}
f_y: {v1: ((1 - d)*i1 - d*i2)/C1, v2: ((1 - d)*(i1 + i2) - v2/R)/C2}
phi: [i1, i2]
observer: {sensors: {v1: 0.07, v2: 0.09}, start: {i1: 1, i2: 0.5}, disturbance: {i1: 0, i2: 0}}
simulation:
  duration: 0.15
  step: 5e-6
  initial: {i1: 1, i2: 0.5, v1: 10, v2: 8}
  control: {d: 0.4}
  noise: {v1: 0.07, v2: 0.09}
";

#[test]
fn parts_that_die_out_at_different_rates_leave_the_others_their_digits() {
    let summary = run(SEPIC, 1);
    // Otherwise the gain is rounding after 40 ms, and the error of the currents 1e4 A.
    let surprise = summary.surprise.unwrap();
    assert!((surprise - 1.0).abs() < 0.1, "{}", summary.text());
    assert!(summary.estimates.iter().all(|rated| rated.score.last.abs() < 1e-3), "{}", summary.text());
}

#[test]
fn without_a_sample_the_observer_goes_on_as_a_kalman_filter_does() {
    // Half of the samples are lost while the input moves.
    let lossy = CUK
        .replace("noise:", "dropped: 0.5\n  noise:")
        .replace("control: {d: 0.5}", "control: {d: 0.5 + 0.2*sin(2e4*t)}");
    let lossy = format!("{lossy}  baselines: {{kalman: {{start: {{i1: 2, i3: 2}}, disturbance: {{i1: 0, i3: 0}}}}}}\n");
    let summary = run(&lossy, 1);
    assert!(summary.dropped > 50, "{}", summary.text());
    let (own, filter) = summary.estimates.split_at(2);
    for (own, filter) in own.iter().zip(filter) {
        // The same filter, in other coordinates: what is left is how rates run between samples.
        let (own, filter) = (own.score.rms, filter.score.rms);
        assert!((own / filter - 1.0).abs() < 0.1, "{own} {filter} {}", summary.text());
    }
}

#[test]
fn a_late_sample_counts_for_the_time_that_it_is_of() {
    // Ten samples of an oscillation of the duty cycle are 64: a filter that is not told sees another phase.
    let moving = CUK.replace("control: {d: 0.5}", "control: {d: 0.5 + 0.2*sin(1e4*t)}").replace("2e-3", "1e-2");
    let kalman = "  baselines: {kalman: {start: {i1: 2, i3: 2}, disturbance: {i1: 0, i3: 0}}}\n";
    let late = moving.replace("observer: {", "observer: {delay: {v4: 1e-4}, ");
    let [on_time, late, untold] = [
        run(&format!("{moving}{kalman}"), 1),
        run(&format!("{late}{kalman}"), 1),
        run(&format!("{moving}  delay: {{v4: 1e-4}}\n"), 1),
    ];
    for state in 0..2 {
        let rms = |summary: &Summary, estimate: usize| summary.estimates[estimate].score.rms;
        let [on_time, told, untold, kalman] =
            [rms(&on_time, state), rms(&late, state), rms(&untold, state), rms(&late, state + 2)];
        // Two noises of a thousand samples: their errors differ by some tenths, and ten samples fewer are told.
        assert!(told < 1.5 * on_time, "{state}: {told} {on_time} {}", late.text());
        assert!(untold > 3.0 * told && kalman > 3.0 * told, "{state}: {told} {untold} {kalman}");
    }
    // Of each sixteenth of a thousand samples, some sixty of two rows: a mean of 125 squares scatters by 0.13.
    let surprise = late.surprise.unwrap();
    assert!((surprise - 1.0).abs() < 0.2, "{}", late.text());
}

/// Case I of the Cuk converter at a duty cycle that changes, with sensors of known noise.
const CUK: &str = "
model: cuk
parameters: {L1: 10e-3, C2: 22e-6, L3: 10e-3, C4: 22.9e-6, G: 0.0447, E: 12}
x: [i1, i3]
y: [v2, v4]
u: [d]
assume: [0 < d < 1]
f_x: {i1: (E - (1 - d)*v2)/L1, i3: -(d*v2 + v4)/L3}
f_y: {v2: ((1 - d)*i1 + d*i3)/C2, v4: (i3 - G*v4)/C4}
observer: {sensors: {v2: 0.1, v4: 0.05}, start: {i1: 2, i3: 2}, disturbance: {i1: 0, i3: 0}}
simulation:
  duration: 2e-3
  step: 1e-5
  initial: {i1: 0.5, i3: -1, v2: 10, v4: -12}
  noise: {v2: 0.1, v4: 0.05}
  control: {d: 0.5}
";

/// A plant whose cascade is free of its output.
const LAG: &str = "
model: lag
x: [a, b]
y: [q]
u: [v]
f_x: {a: v - a, b: 0}
f_y: {q: a + b}
phi: [a, b]
observer: {sensors: {q: 1}, start: {a: 3, b: 3}, disturbance: {a: 0, b: 0}}
simulation: {duration: 10, step: 0.05, initial: {a: 1, b: 1, q: 0}, noise: {q: 1}, control: {v: sin(t)}}
";

/// Of a model's first states, and of its innovation: the root mean square that is seen in so many runs, over what is
/// expected.
fn measured_over_expected(text: &str, runs: u32) -> [f64; 3] {
    let (mut seen, mut expected, mut surprise) = ([0.0; 2], [0.0; 2], 0.0);
    let derived = derive(&Source::new("model", text).unwrap()).unwrap();
    for seed in 0..runs {
        let overrides = Overrides { seed: Some(seed.into()), ..Overrides::default() };
        let trace = derived.scenario(&overrides).unwrap().run().unwrap();
        let summary = trace.summary();
        for (state, rated) in summary.estimates.iter().enumerate() {
            seen[state] += rated.score.rms.powi(2);
            expected[state] += rated.expected.unwrap().powi(2);
        }
        surprise += summary.surprise.unwrap() / f64::from(runs);
    }
    [(seen[0] / expected[0]).sqrt(), (seen[1] / expected[1]).sqrt(), surprise]
}

#[test]
fn expected_errors_are_the_measured_ones() {
    let found = measured_over_expected(LAG, 400);
    println!("{found:?}");
    // An error of the last tenth of a run is one number: 400 of them tell a deviation to 1/sqrt(800) = 3.5 %: four of that.
    // 400 runs with 12 innovations of one row: known to sqrt(2/4800) = 2 %.
    // `a` dies out, and what was wrong of it at the start is the same in each run.
    assert!(found[1..].iter().all(|ratio| (ratio - 1.0).abs() < 0.14), "{found:?}");
    // Of these the measured outputs drive the cascade: the noise of a sample is in the regression and in the extension.
    // Noise that keeps the estimates from settling, so that errors are of the last tenth of a run; an error of it is one
    // number, as above: 200 runs tell a deviation to 5 %, and four of that are allowed. With `every`, what stands in for a
    // missing output is what is expected of it.
    let noisy = CUK.replace("{v2: 0.1, v4: 0.05}", "{v2: 4, v4: 2}");
    for text in [
        noisy.clone(),
        noisy.replace("noise:", "every: {v4: 5}\n  noise:"),
        noisy.replace("noise:", "dropped: 0.2\n  noise:"),
    ] {
        let found = measured_over_expected(&text, 200);
        println!("{found:?}");
        assert!(found[..2].iter().all(|ratio| (ratio - 1.0).abs() < 0.2), "{found:?}");
        // 200 runs with 12 innovations of two rows, where none is missing: known to sqrt(2/4800) = 2 %.
        assert!((found[2] - 1.0).abs() < 0.1, "{found:?}");
    }
}

#[test]
fn outliers_are_refused_and_outputs_may_come_at_other_rates() {
    let text = CUK.replace("noise:", "every: {v4: 5}\n  noise:");
    let summary = run(&text, 3);
    assert_eq!((summary.parted, summary.faults.count()), (160, 0), "{}", summary.text());
    assert!(summary.estimates.iter().all(|rated| rated.score.last.abs() < 0.1), "{}", summary.text());
    // A gate of the expected square itself refuses about as many samples as chi-squared of two rows exceeds 2: e^-1.
    let gated = CUK.replace("observer: {", "observer: {gate: 2, ");
    let summary = run(&gated, 3);
    let outliers: u64 = summary.faults.iter().filter(|(reason, _)| reason.contains("outlier")).map(|(_, n)| n).sum();
    assert!((40..120).contains(&outliers), "{}", summary.text());
    assert!(summary.estimates.iter().all(|rated| rated.score.last.abs() < 0.2), "{}", summary.text());
}

#[test]
fn advice_names_the_numbers_that_there_are() {
    // Too short to settle, and noisier than told: there is no gain, filter or covariance to choose.
    for (text, wanted) in [
        (LAG.replace("duration: 10", "duration: 1"), "simulate longer"),
        (LAG.replace("noise: {q: 1}", "noise: {q: 9}"), "raise `sensors`"),
    ] {
        let derived = derive(&Source::new("model", text.as_str()).unwrap()).unwrap();
        let scenario = derived.scenario(&Overrides::default()).unwrap();
        let advice = scenario.advise(scenario.run().unwrap().summary());
        let help: Vec<_> = advice.into_iter().filter_map(|diagnostic| diagnostic.help).collect();
        assert!(help.concat().contains(wanted), "{help:?}");
        assert!(!["gain", "filter", "covariance"].iter().any(|key| help.concat().contains(key)), "{help:?}");
    }
}

/// An LCL filter that swings at 1.8 and 2 kHz, sampled at 20 kHz: between samples outputs are no straight lines.
const FILTER: &str = "
model: filter
parameters: {L1: 2e-3, C: 10e-6, L2: 1e-3, w: 314}
x: [vca, vcb, i2a, i2b, ga, gb]
y: [i1a, i1b]
u: [va, vb]
f_x: {vca: (i1a - i2a)/C, vcb: (i1b - i2b)/C, i2a: (vca - ga)/L2, i2b: (vcb - gb)/L2, ga: -w*gb, gb: w*ga}
f_y: {i1a: (va - vca)/L1, i1b: (vb - vcb)/L1}
simulation:
  duration: 0.1
  step: 5e-5
  initial: {vca: 0, vcb: 0, i2a: 0, i2b: 0, ga: 325, gb: 0, i1a: 0, i1b: 0}
  control: {va: 320*cos(314*t), vb: 320*sin(314*t)}
  noise: {i1a: 0.05, i1b: 0.05}
  baselines: {kalman: {start: {vca: 10, vcb: 10, i2a: 10, i2b: 10, ga: 400, gb: 400}}}
";

#[test]
fn outputs_that_swing_between_samples_are_followed_without_a_number() {
    let summary = run(FILTER, 1);
    let (own, kalman) = summary.estimates.split_at(6);
    for (own, kalman) in own.iter().zip(kalman) {
        assert!(own.score.settled.is_some(), "{}", summary.text());
        // The filter that is told the noise and the start. Of one run either root mean square is known to some tenth.
        assert!(own.score.rms < 1.5 * kalman.score.rms, "{}", summary.text());
    }
    // Of 2000 samples each sixteenth is judged, in two rows: known to a tenth.
    assert!(summary.surprise.is_some_and(|square| (0.7..1.4).contains(&square)), "{}", summary.text());
}

/// A cylinder whose rates are divided by unknown volumes: the first sample is a pressure, not a pressure times a volume.
const CYLINDER: &str = "
model: cylinder
parameters: {be: 1e3, V1: 0.2, V2: 0.3, A1: 0.5, A2: 0.4, m: 20, b: 5}
x: [s, v, F]
y: [p1, p2]
u: [Q1, Q2]
assume: [V1 + A1*s > 0, V2 - A2*s > 0]
f_x: {s: v, v: (A1*p1 - A2*p2 - b*v - F)/m, F: 0}
f_y: {p1: be*(Q1 - A1*v)/(V1 + A1*s), p2: be*(Q2 + A2*v)/(V2 - A2*s)}
observer: {sensors: {p1: 0.005, p2: 0.005}, start: {s: 0.1, v: 0.1, F: 5}}
simulation:
  duration: 4
  step: 0.002
  initial: {s: 0.1, v: 0, F: 3, p1: 20, p2: 15}
  control: {Q1: 0.02*sin(2*t), Q2: -0.016*sin(2*t)}
  noise: {p1: 0.005, p2: 0.005}
";

#[test]
fn an_unknown_beside_an_output_under_the_derivative_is_not_taken_for_zero_at_the_start() {
    let summary = run(CYLINDER, 1);
    for own in &summary.estimates {
        assert!(own.score.settled.is_some(), "{}", summary.text());
    }
    // As above.
    assert!(summary.surprise.is_some_and(|square| (0.7..1.4).contains(&square)), "{}", summary.text());
}

/// The speed of the wind from that of the rotor: v and v^2 are components of phi, which depend on one another.
const TURBINE: &str = "
model: wind_rotor
parameters: {J: 4e7, a: 2.4e4, b: 6e4, c: 8e5}
x: [v]
y: [omega]
u: [Tg]
assume: [v > 0, omega > 0]
f_x: {v: 0}
f_y: {omega: (a*v^2 + b*v*omega - c*omega^2 - Tg)/J}
simulation:
  duration: 200
  step: 0.1
  initial: {v: 8, omega: 1}
  control: {Tg: 1.5e6 + 0.5e6*sin(0.1*t)}
  noise: {omega: 0.002}
";

#[test]
fn the_error_of_the_nearest_state_is_expected_of_it() {
    let summary = run(TURBINE, 1);
    let rated = &summary.estimates[0];
    let ratio = rated.expected.unwrap() / rated.score.rms;
    // It is about twice the error, as the drift that is still assumed counts too. Of v alone, beside a square that is known
    // better, some four hundred times the error is expected.
    assert!((0.2..5.0).contains(&ratio), "{}", summary.text());
}

/// A tank that empties: its level comes within the noise of the sensor of 0, where the root in its rate ends.
const TANK: &str = "
model: tank
x: [c]
y: [h]
u: [q]
assume: [h > 0]
f_x: {c: 0}
f_y: {h: q - c*sqrt(h)}
observer: {sensors: {h: 0.01}, start: {c: 1}, wanted: {c: 1e-6}}
simulation:
  duration: 60
  step: 0.02
  initial: {c: 0.5, h: 0.5}
  control: {q: 0.06 + 0.03*sin(t)}
  noise: {h: 0.01}
";

#[test]
fn an_error_beside_the_edge_of_a_root_is_not_expected_to_be_zero() {
    let summary = run(TANK, 1);
    // A sample with a hundredth of noise every 20 ms does not tell c to a millionth.
    let text = summary.text();
    assert!(matches!(summary.certainty, Some(pebo_gen::simulate::Certainty::NotYet { .. })), "{text}");
}

/// The distance to a beacon of a vehicle whose log has an unknown scale k: while the estimate of k^2 is negative there is
/// no state.
const LOG: &str = "
model: log
x: [px, py, k]
y: [r]
u: [v, psi]
assume: [r > 0, k > 0]
f_x: {px: k*v*cos(psi), py: k*v*sin(psi), k: 0}
g_y: {r: sqrt(px^2 + py^2)}
simulation:
  duration: 300
  step: 0.5
  initial: {px: 80, py: -40, k: 1.05}
  control: {v: 1.5, psi: sin(0.03*t) + 0.005*t}
  noise: {r: 0.3}
";

#[test]
fn an_estimate_that_leaves_its_domain_comes_back() {
    let summary = run(LOG, 1);
    assert!(summary.stateless > 0 && summary.unsettled().is_empty(), "{}", summary.text());
}
