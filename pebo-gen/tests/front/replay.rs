//! `pebo-gen replay`, of recordings in files and on standard input, and of the one that is shipped.
#![cfg(all(feature = "cli", feature = "simulate", unix))]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const MODEL: &str = include_str!("../../../models/recordings/motor_bench.yaml");
const RECORDING: &str = include_str!("../../../models/recordings/motor_bench.csv");

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")
}

/// A cart that a force moves; its position is measured.
const CART: &str =
    "model: cart\nx: [p]\ny: [q]\nu: [u]\nf_x: {p: u}\nf_y: {q: p}\nphi: [p]\nobserver: {gain: 1, filter: 10}\n";

/// A folder with the models, in which the manual's commands can be run.
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::os::unix::fs::symlink(models(), folder.path().join("models")).expect("a link");
    std::fs::write(folder.path().join("cart.yaml"), CART).expect("a model");
    folder
}

fn run(command: &str, folder: &Path) -> Output {
    let programs = Path::new(env!("CARGO_BIN_EXE_pebo-gen")).parent().expect("a folder").display();
    let path = format!("{programs}:{}", std::env::var("PATH").unwrap_or_default());
    Command::new("sh").args(["-c", command]).current_dir(folder).env("PATH", path).output().expect("a shell")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("a text")
}

#[test]
fn the_shipped_recording_is_replayed() {
    let folder = bench();
    let files = "models/recordings/motor_bench.yaml --data models/recordings/motor_bench.csv";
    let output = run(&format!("pebo-gen replay {files} -o estimates.csv --plot motor.svg"), folder.path());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let estimates = std::fs::read_to_string(folder.path().join("estimates.csv")).expect("the estimates");
    // A header and a row for each; the recording has a comment besides.
    assert_eq!(estimates.lines().count() + 1, RECORDING.lines().count());
    assert!(estimates.starts_with("t,i_hat,i_error,T_L_hat\n"), "{estimates:.40}");
    assert!(std::fs::read_to_string(folder.path().join("motor.svg")).expect("the figure").starts_with("<svg"));
}

#[test]
fn the_shipped_recording_is_the_output_of_its_command() {
    let lines = MODEL.lines().skip_while(|line| !line.contains("pebo-gen simulate"));
    let command: String = lines.take(2).map(|line| line.trim_start_matches('#')).collect();
    let command = command.split(" > ").next().expect("a command");
    let output = run(command, bench().path());
    assert!(text(&output.stdout) == RECORDING, "make models/recordings/motor_bench.csv again");
}

#[test]
fn standard_input_and_output_serve() {
    let folder = bench();
    let command = "pebo-gen replay cart.yaml --data - -o - < log.csv";
    std::fs::write(folder.path().join("log.csv"), "t,q,u\n0,0,1\n0.01,0,1\n").expect("a file");
    let output = run(command, folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).lines().count(), 3);
    // A reader that goes away is no error.
    let output = run(&format!("{command} | head -n 1"), folder.path());
    assert_eq!(text(&output.stdout).lines().count(), 1);
    assert!(!text(&output.stderr).contains("error"), "{}", text(&output.stderr));
    let both = run("pebo-gen replay - --data -", folder.path());
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn a_failure_leaves_no_file_and_has_its_position() {
    let folder = bench();
    let table = [
        ("t,q,u\n0,0,0\n1,x,0\n", 2, "log.csv, line 3, column 2: `x` in the column `q` is not a number"),
        ("t,q\n0,0\n", 2, "error[recording-incomplete]: log.csv does not say `u`"),
        ("", 2, "log.csv has no names of columns"),
        ("t,q,u\n0,,0\n", 1, "the observer took no sample of the 1 rows of log.csv"),
    ];
    for (recording, status, expected) in table {
        std::fs::write(folder.path().join("log.csv"), recording).expect("a file");
        let output = run("pebo-gen replay cart.yaml --data log.csv -o out.csv --plot out.svg", folder.path());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{said}");
        assert!(said.contains(expected), "{said}");
        let left: Vec<_> =
            std::fs::read_dir(folder.path()).expect("the folder").flatten().map(|e| e.file_name()).collect();
        assert_eq!(left.len(), 3, "{left:?}");
    }
    let missing = run("pebo-gen replay cart.yaml --data none.csv", folder.path());
    assert!(text(&missing.stderr).contains("cannot read none.csv: no such file or directory"));
    // A folder can be opened, but not read.
    let folder_read = run("pebo-gen replay cart.yaml --data models", folder.path());
    assert!(text(&folder_read.stderr).contains("error[cannot-read]"), "{}", text(&folder_read.stderr));
}

#[test]
fn an_interrupted_run_leaves_no_file() {
    let folder = bench();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pebo-gen"));
    command.args(["replay", "cart.yaml", "--data", "-", "-o", "out.csv"]).current_dir(folder.path());
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the program runs");
    let mut rows = child.stdin.take().expect("a pipe");
    // More than the pipe and all buffers hold, so that most of it has been taken when the last of it is written.
    rows.write_all(b"t,q,u\n").expect("it reads");
    for row in 0..100_000 {
        writeln!(rows, "{row},0,0").expect("it reads");
    }
    assert!(child.try_wait().expect("a process").is_none());
    child.kill().expect("it is there");
    child.wait().expect("it ends");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 2);
}

#[test]
fn a_limit_stops_it() {
    let folder = bench();
    let rows: Vec<String> = (0..400_000).map(|row| format!("{},0,0\n", f64::from(row) / 100.0)).collect();
    std::fs::write(folder.path().join("log.csv"), format!("t,q,u\n{}", rows.concat())).expect("a file");
    let output = run("pebo-gen replay cart.yaml --data log.csv --limit 0.05 -o out.csv", folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("error[limit-reached]"), "{}", text(&output.stderr));
    assert!(!folder.path().join("out.csv").exists());
}

#[test]
fn numbers_are_fitted_to_a_recording() {
    let folder = bench();
    let model = "model: lag\nx: [a]\ny: [q]\nf_x: {a: 0}\nf_y: {q: a - q}\nphi: [a]\n\
                 simulation: {duration: 3, step: 0.01, initial: {a: 1, q: 0}, noise: {q: 0.05}}\n";
    std::fs::write(folder.path().join("lag.yaml"), model).expect("a file");
    let output = run("pebo-gen simulate lag.yaml --csv log.csv --every 0.01", folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let output = run("pebo-gen replay lag.yaml --data log.csv --fit -o file.csv", folder.path());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    let section = said.split("observer:\n").nth(1).expect("a section");
    let sensor = section.split("sensors: {q: ").nth(1).and_then(|rest| rest.split('}').next()).expect("a number");
    // 300 samples tell a standard deviation to 4 %.
    assert!((sensor.parse::<f64>().expect("a number") / 0.05 - 1.0).abs() < 0.15, "{said}");
    assert!(section.contains("disturbance: {a: 0}"), "{said}");
    // The file with the section runs as the call did, and so does the recording on standard input.
    std::fs::write(folder.path().join("told.yaml"), format!("{model}observer:\n{section}")).expect("a file");
    run("pebo-gen replay told.yaml --data log.csv -o told.csv", folder.path());
    run("pebo-gen replay lag.yaml --data - --fit -o piped.csv < log.csv", folder.path());
    let [file, told, piped] =
        ["file", "told", "piped"].map(|name| std::fs::read_to_string(folder.path().join(format!("{name}.csv"))));
    let (file, told, piped) = (file.expect("a table"), told.expect("a table"), piped.expect("a table"));
    assert!(file == told && file == piped && file.lines().count() == 302, "{file:.80}\n{told:.80}\n{piped:.80}");
    let output = run("pebo-gen replay - --data log.csv --fit < lag.yaml", folder.path());
    assert!(text(&output.stderr).contains("read twice") && output.status.code() == Some(2));
    let output = run("pebo-gen replay cart.yaml --data log.csv --fit --set model=cart", folder.path());
    assert!(text(&output.stderr).contains("written gains"), "{}", text(&output.stderr));
}
