//! The meaning of columns.

use super::{CART, Log, replay, resolve};

fn columns(header: &str) -> Vec<String> {
    Log::open("log.csv", header.as_bytes()).expect("a header").columns().to_vec()
}

/// Code, message, first note and help of the complaint about the section for this header.
fn said(recording: &str, header: &str) -> Vec<String> {
    let mut log = Log::open("log.csv", header.as_bytes()).expect("a header");
    let found = resolve(&format!("{CART}{recording}\n"), &mut log).expect_err("something is wrong");
    let line = |diagnostic: &pebo_design::source::Diagnostic| {
        let help = diagnostic.help.as_deref().unwrap_or_default();
        format!("{}: {} | {} | {help}", diagnostic.code.name(), diagnostic.message, diagnostic.notes.join("; "))
    };
    found.iter().map(line).collect()
}

#[test]
fn columns_are_called_by_names_of_formulas() {
    let table = [
        ("t,v2,d\n", &["t", "v2", "d"][..]),
        ("\u{feff}# made by us\n\nTime (s);Channel A [V];kalman.i1_hat\n", &["Time_s", "Channel_A_V", "kalman_i1_hat"]),
        ("\u{feff}t\t2nd\t\"a, b\"\t°C\tµ\n", &["t", "_2nd", "a_b", "C", "column_5"]),
        ("t,_x_,x_\r\n", &["t", "_x_", "x_"]),
    ];
    for (header, names) in table {
        assert_eq!(columns(header), names, "{header}");
    }
}

#[test]
fn a_file_without_names_is_refused() {
    for text in ["", "# nothing\n", "0,1,2\n3,4,5\n", "\n\n"] {
        assert!(Log::open("log.csv", text.as_bytes()).is_err(), "{text:?}");
    }
}

#[test]
fn formulas_say_what_columns_mean() {
    let rows = |scale: f64| -> String {
        let row = |k: u32| {
            let t = f64::from(k) / 100.0;
            format!("{},{},{}\n", t * 1000.0, (t.sin() + 0.5) * scale, -t.sin())
        };
        (0..300).map(row).collect()
    };
    let section = "recording: {t: ms/1000, q: ch1/256 - offset}";
    let (_, found) = replay(&format!("{CART}{section}"), &format!("ms,ch1,f\n{}", rows(256.0))).expect("a replay");
    // The same data in other units, by their own names.
    let own = "recording: {t: t/1000, q: q - 1/2}";
    let (_, expected) = replay(&format!("{CART}{own}"), &format!("t,q,f\n{}", rows(1.0))).expect("a replay");
    let last = |text: &str| -> f64 { text.lines().last().unwrap().split(',').nth(1).unwrap().parse().unwrap() };
    // To rounding: 256 (y + 1/2)/256 has the error of one or two roundings of numbers below 2.
    assert!((last(&found) - last(&expected)).abs() < 1e-10, "{} {}", last(&found), last(&expected));
    assert!((last(&found) - 2.99_f64.cos()).abs() < 0.05, "{}", last(&found));
}

#[test]
fn missing_signals_are_reported_with_the_columns() {
    let found = said("", "time,q,force\n");
    let columns = "the columns of log.csv are `time`, `q`, `force`";
    let time = "add `t`, a formula in columns, or `step`, the seconds from row to row, under `recording`";
    let force = "add `f`, a formula in columns and parameters, under `recording`";
    assert_eq!(
        found,
        [
            format!("recording-incomplete: log.csv does not say the time of its rows | {columns} | {time}"),
            format!("recording-incomplete: log.csv does not say `f` | {columns} | {force}"),
        ]
    );
}

#[test]
fn columns_that_blanks_separate_are_one() {
    let found = said("", "t q f\n");
    let one = "log.csv has one column, `t_q_f`: commas, semicolons or tabs separate columns";
    assert!(found.iter().all(|said| said.contains(one)) && !found.is_empty(), "{found:?}");
}

#[test]
fn names_that_are_no_columns_are_reported_each() {
    let found = said("recording: {t: tiem, f: force + gravity}", "time,q,force\n");
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("unknown-name: unknown name `tiem`") && found[0].ends_with("did you mean `time`?"));
    assert!(found[1].starts_with("unknown-name: unknown name `gravity`"), "{found:?}");
}

#[test]
fn names_with_two_meanings_are_reported_where_they_are_used() {
    assert!(said("recording: {f: offset}", "t,q,offset\n")[0].contains("`offset` cannot be used here"));
    assert!(said("recording: {f: a}", "t,q,a,a\n")[0].contains("`a` cannot be used here"));
    // Neither is used here.
    let mut log = Log::open("log.csv", "t,q,f,a,a,spare\n".as_bytes()).expect("a header");
    assert!(resolve(CART, &mut log).is_ok());
}

#[test]
fn the_section_is_checked_without_a_recording() {
    let table = [
        ("recording: {f2: ch1}", "unknown-entry"),
        ("recording: {t: time, step: 0.1}", "setting-conflict"),
        ("recording: {q: ch1 +}", "unexpected-token"),
        ("recording: {q: hat(p)}", "misplaced-estimate"),
        ("recording: [q]", "wrong-shape"),
        ("recording: {q: [1]}", "wrong-shape"),
    ];
    for (section, code) in table {
        let found = said(section, "t,q,f\n");
        assert!(found[0].starts_with(code), "{section}: {found:?}");
    }
    assert!(said("recording: {step: 0}", "q,f\n")[0].starts_with("number-out-of-range"));
    assert!(said("recording: {step: f}", "q,f\n")[0].starts_with("number-out-of-range"));
}
