//! Faults of rows, and the treatment of the others.

use std::ops::ControlFlow;

use super::truth::simulated;
use super::{CART, Failure, Log, faults, refusal, replay, resolve, without_most};
use crate::recording::log::LONGEST;

#[test]
fn faults_are_counted_by_kind_and_do_not_end_the_run() {
    let recording = "\
# a comment
t,q,f,note
0,0,0,starts
0.1,,0,an empty cell
0.2,nan,0,
0.3,0,,no input
# another comment
0.4,0,inf,none either
0.3,0,0,backwards
0.3,0,0,
,0,0,no time
0.5,0,0,
0.9,0,0,three rows are missing
1.0,0,0,
";
    let expected = [
        "empty cells of `q`: 1, first in line 4",
        "cells of `q` that are NaN or infinite: 1, first in line 5",
        "empty cells of `f`: 1, first in line 6",
        "rows without a value of `f`: the value before was held: 2, first in line 6",
        "cells of `f` that are NaN or infinite: 1, first in line 8",
        "rows skipped whose time is not between those of their neighbours: 2, first in line 9",
        "empty cells of `t`: 1, first in line 11",
        "rows skipped that have no time: 1, first in line 11",
        "gaps, where the time steps by more than one and a half periods: 1, first in line 13",
    ];
    assert_eq!(faults(recording), expected);
    let (replayed, estimates) = replay(CART, recording).expect("a replay");
    assert_eq!((replayed.rows, replayed.summary.faults.count(), replayed.summary.end), (11, 2, 1.0));
    let rows: Vec<&str> = estimates.lines().collect();
    // A row for each that has a time of its own, with empty cells where the sample was refused.
    assert_eq!(&rows[..4], ["t,p_hat", "0,0", "0.1,", "0.2,"]);
    assert_eq!(rows.len(), 1 + 8);
}

#[test]
fn after_a_long_gap_the_observer_begins_anew() {
    let row = |k: u32| format!("{},{},1\n", f64::from(k) / 64.0, (f64::from(k) / 64.0).powi(2) / 2.0);
    let recording = |start: u32| {
        let rows: String = (0..100).chain(start..start + 200).map(row).collect();
        format!("t,q,f\n{rows}")
    };
    let impatient = CART.replace("filter: 5", "filter: 5, gap: 1");
    let (replayed, estimates) = replay(&impatient, &recording(1000)).expect("a replay");
    assert_eq!(replayed.summary.restarts, 1);
    assert!(replayed.text().contains("begun anew: once"), "{}", replayed.text());
    // From the row behind the gap on it is as if nothing had been before.
    let alone: String = (1000..1200).map(row).collect();
    let (_, fresh) = replay(&impatient, &format!("t,q,f\n{alone}")).expect("a replay");
    let last = |text: &str, count: usize| {
        let lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines[lines.len() - count..].to_vec()
    };
    assert_eq!(last(&estimates, 200), last(&fresh, 200));
    let (replayed, _) = replay(&impatient, &recording(120)).expect("a replay");
    assert_eq!(replayed.summary.restarts, 0);
}

#[test]
fn a_refused_sample_leaves_its_time_and_input_to_the_next() {
    let last = |rows: Vec<(f64, Option<f64>, f64)>| {
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let rows: Vec<String> = rows.into_iter().map(|(t, q, f)| format!("{t},{},{f}\n", cell(q))).collect();
        let (_, estimates) = replay(CART, &format!("t,q,f\n{}", rows.concat())).expect("a replay");
        let row = estimates.lines().last().expect("a row");
        row.split(',').nth(1).expect("an estimate").parse::<f64>().expect("a number")
    };
    let t = |k: u32| f64::from(k) / 64.0;
    let q = |k: u32| t(k).powi(3) / 6.0 + t(k);
    let is_hole = |k: u32| k % 32 > 20;
    let holed = (0..=512).map(|k| (t(k), Some(q(k)).filter(|_| !is_hole(k)), t(k) + 0.5 / 64.0)).collect();
    // One row for the twelve intervals, with the mean of their inputs.
    let whole = (0..=512).filter(|k| !is_hole(*k));
    let coarse = whole.map(|k| (t(k), Some(q(k)), t(k) + if k % 32 == 20 { 6.0 } else { 0.5 } / 64.0)).collect();
    let (holed, coarse) = (last(holed), last(coarse));
    // To the rounding of a mean: sixteen times some units of the last place of numbers below 64.
    assert!((holed - coarse).abs() < 1e-12, "{holed} {coarse}");
    // And near the truth, t^2/2 + 1: a filter of bandwidth a takes the rate of an output to be constant over a step,
    // which costs a f dt^2/12 of the momentum.
    assert!((holed - 33.0).abs() < 5.0 * 8.0 * (12.0_f64 / 64.0).powi(2) / 12.0, "{holed}");
}

#[test]
fn an_observer_begins_where_the_inputs_are_known() {
    let (replayed, estimates) = replay(CART, "t,q,f\n0,0,\n1,0,\n2,0,1\n3,0.5,1\n").expect("a replay");
    assert_eq!(replayed.rows, 4);
    assert!(estimates.starts_with("t,p_hat\n0,\n1,\n2,0\n3,"), "{estimates}");
}

#[test]
fn a_row_that_is_no_row_is_refused_with_line_and_column() {
    let table = [
        ("t,q,f\n0,0,0\n0.1,x,0\n", "line 3, column 2: `x` in the column `q` is not a number"),
        ("# c\nt,q,f\n\n0,0,0\n# c\n0.1,0,zero\n", "line 6, column 3: `zero` in the column `f` is not a number"),
        ("t,q,f\r\n0,0,0\r\n0.1,0\r\n", "line 3, column 3: the row has 2 cells and the header 3"),
        ("t,q,f\n0,0,0,1\n0,0,0\n", "line 2, column 4: the row has 4 cells and the header 3"),
        (
            "t,q,f\n0,\"0,5\",0\n",
            "line 2, column 2: `0,5` in the column `q` is not a number | write decimals with a point",
        ),
        ("t,q,f\n0,\u{fffd},0\n", "line 2, column 2: `\u{fffd}` in the column `q` is not a number"),
        ("t,q,f\n0,\"0,0\n1,0,0\n", "line 2: a quote is not closed"),
        ("t,q,f\n", "log.csv has no rows"),
    ];
    for (recording, expected) in table {
        let said = refusal(recording);
        assert!(said.starts_with("recording-malformed: log.csv"), "{said}");
        assert!(said.contains(expected), "{recording:?}: {said}");
    }
    // Columns that no formula reads may hold anything.
    assert_eq!(faults("t,note,q,f\n0,\"a, b\",0,0\n1,,0,0\n"), [""; 0]);
    // Nor is a cell too many one if it is empty.
    assert_eq!(faults("t,q,f\n0,0,0,\n1,0,0,\n"), [""; 0]);
}

#[test]
fn a_recording_may_break_off_within_its_last_row() {
    let dropped =
        |line: u32| vec![format!("last row dropped, as it breaks off with the file: 1, first in line {line}")];
    assert_eq!(faults("t,q,f\n0,0,0\n1,0,0\n2,0."), dropped(4));
    assert_eq!(faults("t,q,f\n0,0,0\n1,0,-"), dropped(3));
    // A whole last line needs no end.
    assert_eq!(faults("t,q,f\n0,0,0\n1,0,0"), [""; 0]);
}

#[test]
fn a_row_without_end_is_refused_and_not_held() {
    let said = refusal(&format!("t,q,f\n0,0,0\n{}", "1,".repeat(LONGEST)));
    assert!(said.contains("log.csv, line 3: the line has more than 1048576 bytes"), "{said}");
}

#[test]
fn a_recording_of_which_nothing_is_taken_says_why() {
    let said = refusal("t,q,f\n0,,0\n1,,0\n");
    assert!(said.starts_with("simulation-failed: the observer took no sample of the 2 rows of log.csv"), "{said}");
}

#[test]
fn a_caller_may_end_it() {
    let rows: Vec<String> = (0..5000).map(|k| format!("{k},0,0\n")).collect();
    let text = format!("t,q,f\n{}", rows.concat());
    let mut log = Log::open("log.csv", text.as_bytes()).expect("a header");
    let replay = resolve(CART, &mut log).expect("the cart");
    let mut seen = Vec::new();
    let failure = replay.run(&mut log, None, &mut |rows, _| {
        seen.push(rows);
        if rows > 2000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(failure, Err(Failure::Stopped { line: 2049 })), "{failure:?}");
    assert_eq!(seen, [1024, 2048]);
}

/// A compass reads an angle within a turn; the replay is that of the angle itself.
#[test]
fn an_output_that_is_an_angle_goes_on_over_its_turns() {
    use std::f64::consts::TAU;

    let compass = "model: m\nx: [b]\ny: [q]\nu: [f]\nangles: {q: 2*pi}\nf_x: {b: 0}\nf_y: {q: f - b}\nphi: [b]\n\
                   observer: {gain: 1, filter: 5}\n";
    let recording = |read: &dyn Fn(f64) -> f64| {
        let rows = (0..400).map(|k| format!("{},{},1\n", f64::from(k) / 16.0, read(2.0 + 0.75 * f64::from(k) / 16.0)));
        format!("t,q,f\n{}", rows.collect::<String>())
    };
    let last = |model: &str, read: &dyn Fn(f64) -> f64| -> f64 {
        let (_, estimates) = replay(model, &recording(read)).expect("a replay");
        estimates.lines().last().and_then(|row| row.split(',').nth(1)?.parse().ok()).expect("an estimate")
    };
    let within_a_turn = |angle: f64| angle - TAU * (angle / TAU).round();
    let (whole, wrapped) = (last(compass, &|angle| angle), last(compass, &within_a_turn));
    // Three turns are counted with the rounding of their number.
    assert!((whole - 0.25).abs() < 1e-3 && (wrapped - whole).abs() < 1e-12, "{whole} {wrapped}");
    let ignored = last(&compass.replace("angles: {q: 2*pi}\n", ""), &within_a_turn);
    assert!((ignored - whole).abs() > 0.01, "{ignored} {whole}");
}

/// Rows of the cart from rest under a force of 1 N, at these times.
fn pushed(times: impl IntoIterator<Item = f64>, start: f64) -> String {
    let rows: Vec<String> = times.into_iter().map(|t| format!("{t},{},1\n", (t - start).powi(2) / 2.0)).collect();
    rows.concat()
}

fn times(start: f64, count: u32) -> Vec<f64> {
    (0..count).map(|k| start + f64::from(k) / 64.0).collect()
}

#[test]
fn a_clock_that_begins_again_or_jumps_begins_a_piece() {
    // It begins again, and later jumps by a day.
    let pieces = [(0.0, 100), (0.0, 200), (86400.0, 50)];
    let rows: Vec<String> = pieces.iter().map(|(start, count)| pushed(times(*start, *count), *start)).collect();
    let (replayed, estimates) = replay(CART, &format!("t,q,f\n{}", rows.concat())).expect("a replay");
    let words = "new pieces, where the clock begins again or jumps and the observer with it: 2, first in line 102";
    assert_eq!(replayed.faults.iter().map(ToString::to_string).collect::<Vec<_>>(), [words]);
    // Each piece is as if it stood alone, and the summary is that of the longest.
    let alone: Vec<_> = rows.iter().map(|rows| replay(CART, &format!("t,q,f\n{rows}")).expect("a replay")).collect();
    let without_header = |text: &str| text.split_once('\n').expect("a header").1.to_owned();
    let joined: String = alone.iter().map(|(_, estimates)| without_header(estimates)).collect();
    assert_eq!(without_header(&estimates), joined);
    assert_eq!((replayed.rows, replayed.scored, replayed.start), (350, 200, 0.0));
    assert_eq!(replayed.summary, alone[1].0.summary);
    assert!(replayed.text().starts_with("200 of 350 rows, from t = 0 s to 3.109375 s\n"), "{}", replayed.text());
    // Two rows are no piece: they are out of place.
    let early: String = times(0.0, 100).iter().map(|t| pushed([*t], 0.0)).collect();
    let (alone, _) = replay(CART, &format!("t,q,f\n{early}")).expect("a replay");
    let (astray, _) = replay(CART, &format!("t,q,f\n{early}{}", pushed([0.1, 0.2], 0.0))).expect("a replay");
    assert_eq!(astray.summary, alone.summary);
    let misplaced = "rows skipped whose time is not between those of their neighbours: 2, first in line 102";
    assert_eq!(astray.faults.iter().map(ToString::to_string).collect::<Vec<_>>(), [misplaced]);
}

#[test]
fn times_count_from_the_first_row() {
    let late = pushed(times(1e6, 300), 1e6);
    let (replayed, estimates) = replay(CART, &format!("t,q,f\n{late}")).expect("a replay");
    let (early, _) = replay(CART, &format!("t,q,f\n{}", pushed(times(0.0, 300), 0.0))).expect("a replay");
    assert_eq!(replayed.summary, early.summary);
    let head = "300 rows from t = 1000000 s to 1000004.671875 s, from the first of which times count\n";
    assert!(replayed.text().starts_with(head), "{}", replayed.text());
    // The table has the times of the log.
    assert!(estimates.lines().nth(1).is_some_and(|row| row.starts_with("1000000,")), "{estimates}");
}

#[test]
fn numbers_times_and_units_are_read_as_loggers_write_them() {
    let plain = "t,q,f\n0,0,1\n0.5,0.125,1\n1,0.5,1\n1.25,0.78125,1\n";
    let (_, expected) = replay(CART, plain).expect("a replay");
    for recording in [
        // Decimal commas; a row of units, with a 1 for none.
        "t;q;f\n0;0;1\n0,5;0,125;1\n1;0,5;1,0\n1,25;0,78125;1\n",
        "t,q,f\n[s],m,N\n0,0,1\n0.5,0.125,1\n1,0.5,1\n1.25,0.78125,1\n",
        "t\tq\tf\ns\t1\tN\n0\t0\t1\n0.5\t0.125\t1\n1\t0.5\t1\n1.25\t0.78125\t1\n",
        // Dates and times of day.
        "t,q,f\n2026-11-27T23:59:59Z,0,1\n2026-11-27T23:59:59.5Z,0.125,1\n2026-11-28T00:00:00Z,0.5,1\n\
         2026-11-28T00:00:00.250Z,0.78125,1\n",
        "t;q;f\n10:00:00;0;1\n10:00:00,5;0,125;1\n10:00:01;0,5;1\n10:00:01,25;0,78125;1\n",
    ] {
        let (replayed, found) = replay(CART, recording).expect("a replay");
        assert_eq!((found, replayed.faults.len()), (expected.clone(), 0), "{recording}");
    }
    // A comma that separates columns is no decimal comma; only the first row can be one of units.
    let said = refusal("t,q,f\n0,\"0,5\",1\n");
    assert!(
        said.contains("`0,5` in the column `q` is not a number") && said.contains("decimals with a point"),
        "{said}"
    );
    assert!(refusal("t,q,f\ns,m,N\ns,m,N\n").contains("line 3, column 1"));
}

#[test]
fn rows_that_show_no_start_are_reported() {
    // Without gains and without a simulation the rows say where the plant starts.
    let silent = CART.replace("observer: {gain: 50, filter: 5}\n", "");
    for (recording, expected) in [
        ("t,q,f\n", "log.csv has no rows"),
        ("t,q,f\n0,,0\n0.1,nan,0\n", "none of the first 2 rows of log.csv has a value of `q`"),
        ("t,q,f\n0,1,0\n", "log.csv has one row"),
        ("t,q,f\n2,0,0\n1,0,0\n0,0,0\n", "the time of log.csv does not increase in its first 3 rows"),
        (
            "t,q,f\n[ms],m,N\n0,0,0\n1,0,0\n",
            "the times of log.csv are in ms, as its row of units says, and not in seconds",
        ),
        ("t,q,q,f\n0,0,0,0\n1,0,0,0\n", "log.csv has several columns `q`"),
        ("t,q,f\n0,0,ERR\n0.1,0,0\n", "log.csv, line 2, column 3: `ERR` in the column `f` is not a number"),
        (
            "t,q,f\n27.11.2026 10:00,0,0\n28.11.2026 10:00,0,0\n",
            "log.csv, line 2, column 1: `27.11.2026 10:00` in the column `t` is not a number",
        ),
    ] {
        let mut log = Log::open("log.csv", recording.as_bytes()).expect("a header");
        let found = resolve(&silent, &mut log).expect_err("nothing is shown");
        assert_eq!(found.iter().map(|found| found.message.to_string()).collect::<Vec<_>>(), [expected]);
    }
}

#[test]
fn outputs_given_by_value_may_be_missing_too() {
    // A car with a speed at each row, and a position at every tenth, or a speed with an offset.
    let car = "model: car\nx: [v, b]\ny: [p, s]\nu: [a]\nf_x: {v: a - b, b: 0}\nphi: [v, b]\n";
    for (outputs, initial) in [("f_y: {p: v}\ng_y: {s: v}\n", ", p: 0"), ("g_y: {p: v + b, s: v}\n", "")] {
        let scenario = format!(
            "simulation: {{duration: 20, step: 0.02, initial: {{v: 0, b: 0.1{initial}}}, noise: {{p: 0.5, s: 0.1}}, \
             control: {{a: 0.5*sin(t)}}}}\n"
        );
        let csv = simulated(&format!("{car}{outputs}{scenario}"), (20.0, 0.02)).csv();
        let (replayed, _) = replay(&format!("{car}{outputs}"), &without_most(&csv, "p")).expect("a replay");
        let text = replayed.text();
        assert!(text.contains("in part: 900 of 1001 samples lack an output") && !text.contains("refused"), "{text}");
        // What the seldom sensor scatters by is known to a third from its first 32 samples.
        let sensor = &replayed.summary.known.as_ref().expect("numbers").numbers[0].values[0];
        assert!((sensor.value / 0.5 - 1.0).abs() < 1.0 / 3.0, "{text}");
        for scored in &replayed.summary.estimates {
            assert!(scored.score.rms < 3.0 * scored.expected.expect("an error"), "{text}");
        }
    }
}

#[test]
fn an_output_with_an_input_in_it_is_compared_with_the_input_of_its_own_row() {
    let cell = "model: cell\nparameters: {Q: 7200, R: 0.05}\nx: [s]\ny: [V]\nu: [I]\nf_x: {s: -I/Q}\n\
                g_y: {V: 3 + s - R*I}\nphi: [s]\nobserver: {sensors: {V: 1e-4}, start: {s: 1}, disturbance: {s: 0}}\n";
    // At rest for longer than the first rows that are asked.
    let current = |k: u32| if k > 300 && k % 60 < 30 { 2.0 } else { 0.0 };
    let table = |lag: u32| {
        let mut charge = 0.8;
        let row = |k: u32| {
            // Held from row to row, as a controller does; the voltage just before or just after it changes.
            charge -= current(k - 1) / 7200.0;
            let noise = 1e-4 * (f64::from(k * k) * 1.3).sin();
            format!("{k},{},{},{charge}\n", 3.0 + charge - 0.05 * current(k - lag) + noise, current(k))
        };
        "t,V,I,s\n".to_owned() + &(1..700).map(row).collect::<String>()
    };
    for lag in [0, 1] {
        let (replayed, _) = replay(cell, &table(lag)).expect("a replay");
        let text = replayed.text();
        assert_eq!(replayed.inputs_at_once, lag == 0, "{text}");
        assert_eq!(text.contains("inputs: sampled with the outputs of their row\n"), lag == 0, "{text}");
        let scored = &replayed.summary.estimates[0];
        assert!(scored.score.rms < 3.0 * scored.expected.expect("an error"), "{text}");
    }
    // It begins where both are known.
    let (replayed, estimates) = replay(cell, &table(0).replacen(",0,0.8\n", ",,0.8\n", 1)).expect("a replay");
    assert!(replayed.inputs_at_once && estimates.lines().nth(1) == Some("1,,,"), "{estimates}");
}
