//! Numbers that are fitted to a simulation's own table.

use std::ops::ControlFlow;

use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

use super::truth::{GROWTH, simulated};
use super::{replay, without_most};
use crate::recording::{FittedNumbers, fit};

/// The numbers of a model that fit a recording.
fn numbers(model: &str, csv: &str) -> Result<FittedNumbers, Vec<Diagnostic>> {
    with(model, csv, &[])
}

/// The same with parameters and delays that are sought besides.
fn with(model: &str, csv: &str, sought: &[&str]) -> Result<FittedNumbers, Vec<Diagnostic>> {
    let sought: Vec<String> = sought.iter().map(|name| (*name).to_owned()).collect();
    let source = Source::new("test", model).expect("a short text");
    let model = Model::parse(&source)?;
    let plant = Plant::resolve(&model)?;
    let derivation = Derivation::derive(&plant);
    let rows = ("log.csv", csv.as_bytes());
    fit((&model, &plant, &derivation), rows, &sought, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn fitted_numbers_are_those_of_the_simulation() {
    let simulation = "simulation: {duration: 10, step: 0.01, initial: {START}, noise: {q: 0.01}, signals: {s: {0: 0.2, \
                      3: 0.5, 6: 0.2, 9: 0.5, 12: 0.2, 15: 0.5}}, control: {f: s}";
    let fitted = |model: &str, plant: &str| {
        let simulation = simulation.replace("START", if plant.is_empty() { "a: -0.3, q: 1" } else { "q: 1" });
        let csv = simulated(&format!("{GROWTH}{simulation}{plant}}}\n"), (10.0, 0.01)).csv();
        (numbers(model, &csv).expect("numbers"), csv)
    };
    // Nothing but the sensor scatters.
    let (found, csv) = fitted(GROWTH, "");
    assert!((found.sensors[0].1 / 0.01 - 1.0).abs() < 0.1 && found.gain >= 0.0, "{found:?}");
    assert_eq!(found.disturbance, [("a".to_owned(), 0.0)]);
    // The section that is printed is one that a replay takes.
    let (replayed, _) = replay(&format!("{GROWTH}{}", found.section()), &csv).expect("a replay");
    assert!(replayed.summary.contradiction.is_none(), "{}", replayed.text());
    assert!(replayed.summary.estimates[0].expected.is_some_and(|expected| expected < 0.01), "{}", replayed.text());
    // A pace that moves, by its rms rate of some 0.04 per second over times of a second, wanders.
    let (found, _) = fitted(GROWTH, ", plant: {a: -0.3 + 0.05*sin(t)}");
    let wanders = found.disturbance.iter().find(|(name, _)| name == "a").expect("it is sought").1;
    assert!((0.005..0.2).contains(&wanders) && found.gain > 10.0, "{found:?}");
    // What the author wrote as 0 stays 0, and so does the start.
    let told = format!("{GROWTH}observer: {{start: {{a: 1}}, disturbance: {{a: 0}}}}\n");
    let (found, _) = fitted(&told, ", plant: {a: -0.3 + 0.05*sin(t)}");
    assert!(found.disturbance.contains(&("a".to_owned(), 0.0)), "{found:?}");
    assert_eq!(found.start, [("a".to_owned(), 1.0)]);
    let (found, _) = fitted(&told.replace(", disturbance: {a: 0}", ""), ", plant: {a: -0.3 + 0.05*sin(t)}");
    assert!(found.disturbance.iter().any(|(name, value)| name == "a" && *value > 0.005), "{found:?}");
    // Gains are no numbers.
    let gains = format!("{GROWTH}observer: {{gain: 1, filter: 1}}\n");
    assert!(numbers(&gains, &csv).is_err_and(|found| found[0].message.contains("written gains")));
}

/// A drive with a load that nobody measures, and a speed that is.
const DRIVE: &str = "model: drive\nparameters: {J: 0.02, K: 0.5, d: 0.1}\nx: [T]\ny: [w]\nu: [i]\nunits: {T: N m}\n\
                     f_x: {T: 0}\nf_y: {w: (K*i - d*w - T)/J}\nphi: [T]\n\
                     observer: {start: {T: 1}, disturbance: {T: 0}}\n";

#[test]
fn parameters_and_delays_are_found_where_they_are_sought() {
    let scenario = "simulation: {duration: 3, step: 0.01, initial: {T: 0.3, w: 0}, noise: {w: 0.05}, delay: {w: 0.07}, \
                    control: {i: 1 + sin(2*t) + 0.5*sin(7*t)}}\n";
    let csv = simulated(&format!("{DRIVE}{scenario}"), (3.0, 0.01)).csv();
    // Who does not know it takes the inertia for a half more than it is, and the sensor for one on time.
    let wrong = DRIVE.replace("J: 0.02", "J: 0.03");
    let found = with(&wrong, &csv, &["J", "w"]).unwrap();
    let [(name, inertia)] = found.parameters.as_slice() else { panic!("{found:?}") };
    assert!(name == "J" && (inertia / 0.02 - 1.0).abs() < 0.02, "{found:?}");
    assert_eq!(found.delay.len(), 1, "{found:?}");
    assert!(found.delay[0].0 == "w" && (found.delay[0].1 - 0.07).abs() < 1e-9, "{found:?}");
    assert!((found.sensors[0].1 / 0.05 - 1.0).abs() < 0.15, "{found:?}");
    assert!(found.section().contains("delay: {w: 0.07"), "{}", found.section());
    assert!(found.section().contains("parameters:\n  J: 2.0"), "{}", found.section());
    // Of a sensor on time, none is found.
    let csv = simulated(&format!("{DRIVE}{}", scenario.replace("delay: {w: 0.07}, ", "")), (3.0, 0.01)).csv();
    assert_eq!(with(DRIVE, &csv, &["w"]).unwrap().delay, []);
    for (sought, message) in [("M", "`M` is neither a parameter nor an output"), ("T", "`T` is neither")] {
        let problems = with(DRIVE, &csv, &[sought]).unwrap_err();
        assert!(problems[0].message.contains(message) && problems[0].help.is_some(), "{problems:?}");
    }
}

/// A motor with an unknown load, whose current comes ten times as seldom as its speed.
const MOTOR: &str = "model: motor\nparameters: {J: 0.02, K: 0.5, R: 1, L: 0.1}\nx: [T]\ny: [w, i]\nu: [v]\n\
                     f_x: {T: 0}\nf_y: {w: (K*i - T)/J, i: (v - R*i - K*w)/L}\nphi: [T]\n";

/// The table of a run of the motor without most of its currents; of some rows without one the speed is off by so much.
fn seldom(outlier: f64) -> String {
    let scenario = "simulation: {duration: 4, step: 0.005, initial: {w: 0, i: 0}, noise: {w: 0.05, i: 0.02}, \
                    plant: {T: 0.3 + 0.1*sin(2*t)}, control: {v: 3 + sin(2*t) + 0.5*sin(7*t)}}\n";
    let csv = without_most(&simulated(&format!("{MOTOR}{scenario}"), (4.0, 0.005)).csv(), "i");
    let (header, rows) = csv.split_once('\n').expect("a header");
    let speed = header.split(',').position(|column| column == "w").expect("a column");
    let row = |(number, row): (usize, &str)| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        if number % 200 == 105 {
            cells[speed] = (cells[speed].parse::<f64>().expect("a number") + outlier).to_string();
        }
        cells.join(",")
    };
    std::iter::once(header.to_owned()).chain(rows.lines().enumerate().map(row)).collect::<Vec<_>>().join("\n")
}

#[test]
fn rows_that_lack_an_output_count_by_the_others() {
    let told = "observer: {start: {T: 1}, disturbance: {T: 0.1, w: 0, i: 0}}\n";
    let found = numbers(&format!("{MOTOR}{told}"), &seldom(0.0)).expect("numbers");
    // Of 800 samples of the speed and 80 of the current the deviation is known to 2.5 and 8 %: three to four of these.
    for (sensor, (deviation, most)) in found.sensors.iter().zip([(0.05, 0.1), (0.02, 0.25)]) {
        assert!((sensor.1 / deviation - 1.0).abs() < most, "{found:?}");
    }
    let gated = "observer: {sensors: {w: 0.05, i: 0.02}, start: {T: 1}, disturbance: {T: 0.15}, gate: 25}\n";
    let [clean, outliers] = [0.0, 5.0].map(|outlier| {
        let (replayed, _) = replay(&format!("{MOTOR}{gated}"), &seldom(outlier)).expect("a replay");
        (replayed.text(), replayed.summary.contradiction, replayed.summary.estimates[0].score.worst)
    });
    let (text, contradiction, worst) = outliers;
    assert!(text.contains("refused: 4 of 801 samples: the sample is an outlier"), "{text}");
    assert!(contradiction.is_none() && text.contains("expected\n"), "{text}");
    // Refused are the outliers themselves: a good sample in the place of one moves the estimate by far more.
    assert!(worst < 1.2 * clean.2, "{worst} {} {text}", clean.2);
}
