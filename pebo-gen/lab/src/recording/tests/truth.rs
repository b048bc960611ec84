//! Replays of a simulation's own table.

use std::ops::ControlFlow;

use super::{CART, Failure, Log, replay, resolve};
use crate::{Overrides, Scenario, Trace};
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::Source;

const CUK: &str = include_str!("../../../../../models/cuk.yaml");
const MOTOR: &str = include_str!("../../../../../models/motor.yaml");
const BATTERY: &str = include_str!("../../../../../models/battery.yaml");
const DRIVE: &str = include_str!("../../../../../models/two_mass_drive.yaml");

/// A run of the model's own scenario with every sample in the table.
pub(super) fn simulated(text: &str, (duration, step): (f64, f64)) -> Trace {
    let model = Model::parse(&Source::new("model", text).expect("a short text")).expect("a model");
    let plant = Plant::resolve(&model).expect("a plant");
    let derivation = pebo_design::analysis::Derivation::derive(&plant);
    let overrides = Overrides { duration: Some(duration), step: Some(step), every: Some(step), ..Overrides::default() };
    let scenario = Scenario::resolve(&model, &plant, &derivation, &overrides).expect("a scenario");
    scenario.run().expect("a run to its end")
}

fn columns(csv: &str) -> Vec<(String, Vec<f64>)> {
    let mut lines = csv.lines();
    let names = lines.next().expect("a header").split(',');
    let mut columns: Vec<(String, Vec<f64>)> = names.map(|name| (name.to_owned(), Vec::new())).collect();
    for line in lines {
        for (column, cell) in columns.iter_mut().zip(line.split(',')) {
            column.1.push(cell.parse().expect("a number"));
        }
    }
    columns
}

/// The largest difference of an estimate or error, relative to the largest value.
fn apart(trace: &Trace, csv: &str) -> f64 {
    let mut worst = 0.0_f64;
    for (name, values) in columns(csv) {
        let expected = trace.column(&name).expect("a column of the simulation");
        assert_eq!(values.len(), expected.len());
        let scale = expected.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let apart = values.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        worst = worst.max(apart / scale.max(f64::MIN_POSITIVE));
    }
    worst
}

/// A mass that a force pushes back and forth whose course over time is known.
const SHAKEN: &str = "
model: shaken
x: [v]
y: [q]
f_x: {v: 3*sin(2*t) - q}
f_y: {q: v}
phi: [v]
observer: {sensors: {q: 0.001}, start: {v: 5}}
simulation: {duration: 10, step: 0.01, initial: {v: 2, q: 1}}
";

const RUNS: [(&str, &str, (f64, f64)); 5] = [
    ("cuk", CUK, (0.05, 1e-5)),
    ("motor", MOTOR, (0.1, 1e-5)),
    ("battery", BATTERY, (2000.0, 1.0)),
    ("drive", DRIVE, (1.0, 1e-3)),
    ("shaken", SHAKEN, (10.0, 0.01)),
];

#[test]
fn a_recording_on_which_nothing_settles_says_why() {
    let advice = |model: &str, recording: &str| {
        let mut log = Log::open("log.csv", recording.as_bytes()).expect("a header");
        let replay = resolve(model, &mut log).expect("the columns have a meaning");
        let replayed = replay.run(&mut log, None, &mut |_, _| ControlFlow::Continue(())).expect("a replay");
        replay.advise(&replayed).pop().map(|found| (found.notes.concat(), found.help.unwrap_or_default()))
    };
    // Moved at 1 m/s; the sensor of the momentum shows 10 % more.
    let rows = |momentum: f64| {
        let row = |k: u32| format!("{0},{0},0,{momentum}\n", f64::from(k) / 64.0);
        format!("t,q,f,p\n{}", (0..2000).map(row).collect::<String>())
    };
    assert_eq!(advice(CART, &rows(1.0)), None);
    let (note, help) = advice(CART, &rows(1.1)).expect("it is off");
    assert!(note.contains("the error of `p` hardly falls any more") && help.contains("the bench"), "{note} {help}");
    let (note, help) = advice(&CART.replace("gain: 50", "gain: 0.05"), &rows(1.0)).expect("it is slow");
    assert!(note.contains("still falls") && help.contains("raise `gain`, or record longer"), "{note} {help}");
    // Without that sensor there is no error to be seen, and nothing to be said.
    assert_eq!(advice(CART, &rows(1.0).replace(",p\n", "\n").replace(",0,1\n", ",0\n")), None);
}

/// The table holds every sample to the last bit. What differs is the time between two rows: the difference of two
/// instants that are rounded to 2^-53 of themselves, and so off by some t/dt times that of the step, where the
/// simulation has the step itself. Over 10^4 steps that is 10^-12 of each step; what the observer makes of it, ten
/// times that.
#[test]
fn the_estimates_are_those_of_the_simulation_to_the_rounding_of_its_times() -> Result<(), Failure> {
    for (name, model, run) in RUNS {
        let trace = simulated(model, run);
        let (replayed, estimates) = replay(model, &trace.csv())?;
        let apart = apart(&trace, &estimates);
        assert!(apart < 1e-11, "{name}: {apart}");
        assert_eq!((replayed.faults.len(), replayed.summary.faults.count()), (0, 0), "{name}");
    }
    Ok(())
}

/// With the step in place of the instants nothing is rounded differently.
#[test]
fn with_the_step_of_the_simulation_they_are_the_same_to_the_last_bit() -> Result<(), Failure> {
    for (name, model, run) in RUNS {
        let trace = simulated(model, run);
        let (_, estimates) = replay(&format!("{model}\nrecording: {{step: {:e}}}\n", run.1), &trace.csv())?;
        for (column, values) in columns(&estimates) {
            assert_eq!(Some(values), trace.column(&column), "{name}: {column}");
        }
    }
    Ok(())
}

#[test]
fn baselines_run_beside_the_observer() -> Result<(), Failure> {
    // With the same samples and numbers they are those of the simulation.
    let filters = "kalman: {start: {v: 5}, sensors: {q: 0.001}}, luenberger: {poles: [-3, -4]}";
    let model = SHAKEN.replace("q: 1}}", &format!("q: 1}}, baselines: {{{filters}}}}}"));
    let trace = simulated(&model, (10.0, 0.01));
    let (replayed, csv) = replay(&format!("{model}recording: {{step: 0.01}}\n"), &trace.csv())?;
    assert!(csv.starts_with("t,v_hat,v_error,kalman.v_hat,luenberger.v_hat,v_std\n"), "{}", &csv[..60]);
    assert!(apart(&trace, &csv) < 1e-12, "{}", apart(&trace, &csv));
    let names: Vec<String> = replayed.summary.estimates.iter().map(|scored| scored.estimate.name()).collect();
    assert_eq!(names, ["v", "kalman.v", "luenberger.v"]);
    assert!(replayed.figure.contains("(kalman)"));
    // Without a start of its own a filter has that of the observer, also an assumed one; one with equations is named.
    let own = "own: {state: {a: 5*(q - a)}, estimate: {v: a}}, kalman: {sensors: {q: 0.001}}";
    let other = SHAKEN.replace("q: 1}}", &format!("q: 1}}, baselines: {{{own}}}}}"));
    let (replayed, _) = replay(&format!("{other}recording: {{step: 0.01}}\n"), &trace.csv())?;
    assert!(replayed.text().contains("not run: the baseline `own`"), "{}", replayed.text());
    assert_eq!(replayed.summary.estimates.len(), 2);
    let silent = other.replace("observer: {sensors: {q: 0.001}, start: {v: 5}}\n", "");
    assert!(!silent.contains("observer:"), "{silent}");
    let (replayed, _) = replay(&format!("{silent}recording: {{step: 0.01}}\n"), &trace.csv())?;
    assert_eq!(replayed.summary.estimates.len(), 2, "{}", replayed.text());
    Ok(())
}

/// A quantity that grows at an unknown pace, as its square.
pub(super) const GROWTH: &str = "
model: growth
x: [a]
y: [q]
u: [f]
assume: [q > 0]
f_x: {a: 0}
f_y: {q: a*q^2 + f}
phi: [a]
";

#[test]
fn the_first_rows_say_what_no_one_wrote() -> Result<(), Failure> {
    // Neither numbers nor a simulation: the slopes depend on where the plant is, which the rows show.
    let simulation = "simulation: {duration: 20, step: 0.01, initial: {a: -0.3, q: 1}, noise: {q: 0.01}, \
                      control: {f: {0: 0.2, 3: 0.5, 6: 0.2, 9: 0.5, 12: 0.2, 15: 0.5}}}\n";
    let simulation = simulation.replace("control: {f: {", "signals: {s: {").replace("}}}", "}}, control: {f: s}}");
    let trace = simulated(&format!("{GROWTH}{simulation}"), (20.0, 0.01));
    let (replayed, csv) = replay(GROWTH, &trace.csv())?;
    let text = replayed.text();
    let known = replayed.summary.known.as_ref().expect("known numbers");
    let sensors = &known.numbers[0];
    assert!(sensors.recorded && !sensors.assumed && text.contains("(as the first rows show)"), "{text}");
    // Of 256 samples the median of differences is known to some tenth.
    assert!((sensors.values[0].value / 0.01 - 1.0).abs() < 0.25, "{text}");
    assert!(replayed.summary.surprise.is_some_and(|square| (0.6..1.6).contains(&square)), "{text}");
    // The table has the true state: it is compared.
    assert!(csv.starts_with("t,a_hat,a_error,a_std\n") && replayed.summary.unsettled().is_empty(), "{text}");
    let score = &replayed.summary.estimates[0];
    assert!(score.score.rms < 3.0 * score.expected.expect("it is predicted"), "{text}");
    // What an author writes counts more.
    let told = format!("{GROWTH}observer: {{sensors: {{q: 0.02}}, start: {{a: 1}}}}\n");
    let (replayed, _) = replay(&told, &trace.csv())?;
    assert!(replayed.text().contains("  sensors: q 0.0200\n"), "{}", replayed.text());
    Ok(())
}

/// A body that a force moves, whose friction is not known of.
const BODY: &str = "
model: body
parameters: {m: 2}
x: [v]
y: [q]
u: [f]
assume: [m > 0]
f_x: {v: f/m}
f_y: {q: v}
phi: [v]
simulation: {step: 0.01, initial: {v: 0.01, q: 0}}
";

#[test]
fn innovations_of_which_some_are_far_too_large_are_not_as_expected() {
    let row = |k: u32| format!("{0},{0},0,1.5\n", f64::from(k) / 64.0);
    let rows: String = (0..300).map(row).collect();
    let rows = format!("t,q,f,v\n{rows}");
    let mut log = Log::open("log.csv", rows.as_bytes()).expect("a header");
    let replay = resolve(BODY, &mut log).expect("the columns have a meaning");
    let mut replayed = replay.run(&mut log, None, &mut |_, _| ControlFlow::Continue(())).expect("a replay");
    let mut notes = |surprise: f64| {
        (replayed.summary.contradiction, replayed.summary.surprise) = (None, Some(surprise));
        let said = replay.advise(&replayed).pop().expect("the speed is off");
        format!("{} {}", said.notes.concat(), said.help.expect("a help"))
    };
    assert!(notes(1.2).contains("the innovations are as expected"), "{}", notes(1.2));
    let (some, all) = (notes(14.0), "the innovations are as expected");
    assert!(some.contains("but some so large that their normalised square is 14.0") && !some.contains(all), "{some}");
    assert!(some.contains("`gate: 25`") && !notes(1.2).contains("gate"), "{some}");
}

/// A body that coasts, its position with an error of one millimetre; at some rows it is off by so much.
fn with_outliers(outlier: f64) -> String {
    let noise = |k: u32| (f64::from(k) * 1.7).sin() + (f64::from(k * k) * 0.61).cos();
    let row = |k: u32| {
        let q = f64::from(k) / 64.0 + 1e-3 * noise(k) + if k % 50 == 49 { outlier } else { 0.0 };
        format!("{},{q},0\n", f64::from(k) / 64.0)
    };
    (0..400).map(row).collect()
}

#[test]
fn samples_that_are_off_by_far_contradict_the_numbers_and_are_said_to_stand_out() {
    let told =
        BODY.replace("simulation:", "observer: {sensors: {q: 0.001}, start: {v: 2}, disturbance: {v: 0}}\nsimulation:");
    let run = |outlier: f64| {
        let rows = format!("t,q,f\n{}", with_outliers(outlier));
        let mut log = Log::open("log.csv", rows.as_bytes()).expect("a header");
        let replay = resolve(&told, &mut log).expect("the columns have a meaning");
        let replayed = replay.run(&mut log, None, &mut |_, _| ControlFlow::Continue(())).expect("a replay");
        let said: Vec<String> = replay
            .advise(&replayed)
            .iter()
            .map(|d| format!("{} {}", d.message, d.help.as_deref().unwrap_or("")))
            .collect();
        (replayed.summary, said)
    };
    let (clean, said) = run(0.0);
    assert!(clean.contradiction.is_none() && said.is_empty(), "{} {said:?}", clean.text());
    // One in fifty samples, so that most of them are as expected; and so far off that later ones are not either.
    for (outlier, standing_out) in [(0.03, true), (1e100, false)] {
        let (found, said) = run(outlier);
        assert!(found.contradiction.is_some_and(|factor| factor > 3.0), "{}", found.text());
        assert!(found.text().starts_with("innovations: "), "{}", found.text());
        assert_eq!(
            said.iter().any(|said| said.contains("stand out") && said.contains("`gate: 25`")),
            standing_out,
            "{said:?}"
        );
    }
}

/// The level is in the rate, so that the noise of a sample is not in its row alone.
#[test]
fn a_sample_whose_covariance_has_no_numbers_is_judged_by_its_row() {
    let tank = "model: tank\nx: [k]\ny: [h]\nu: [q]\nassume: [h > 0]\nf_x: {k: 0}\nf_y: {h: (q - k*sqrt(h))/2}\n\
                phi: [k]\n";
    let row = |k: u32| {
        let level = if k == 150 { 1e30 } else { 4.0 + 1e-2 * (f64::from(k * k) * 0.61).cos() };
        format!("{k},{level},0.04\n")
    };
    let rows = "t,h,q\n".to_owned() + &(0..300).map(row).collect::<String>();
    let (replayed, _) = replay(tank, &rows).expect("a replay");
    assert!(replayed.summary.contradiction.is_some_and(|factor| factor > 1e9), "{}", replayed.text());
}

#[test]
fn a_plant_that_is_recorded_from_rest_has_the_rates_of_its_later_rows() -> Result<(), Failure> {
    // The force of 6 begins after the first row, which has none.
    let row = |k: u32| format!("{},{}\n", (f64::from(k) * 0.7).sin(), if k == 0 { 0.0 } else { 6.0 });
    let rows = |lead: fn(u32) -> String| (0..300).map(|k| lead(k) + &row(k)).collect::<String>();
    let timed = (BODY.to_owned(), format!("t,q,f\n{}", rows(|k| format!("{},", f64::from(k) * 0.01))));
    let counted = (format!("{BODY}recording: {{step: 0.01}}\n"), format!("q,f\n{}", rows(|_| String::new())));
    for (model, recording) in [timed, counted] {
        let (replayed, _) = replay(&model, &recording)?;
        let known = replayed.summary.known.as_ref().expect("known numbers");
        let disturbance = known.numbers.iter().find(|numbers| numbers.what == "disturbance").expect("it is assumed");
        // A hundredth of 3 m/s^2 over 1000 samples, but ten times the speed of 0.01 m/s at most, per root of their 10 s.
        let most = 10.0 * 0.01 / 10.0_f64.sqrt();
        assert!((disturbance.values[0].value / most - 1.0).abs() < 0.01, "{}", replayed.text());
    }
    Ok(())
}
