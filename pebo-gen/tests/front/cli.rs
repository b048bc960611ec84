//! The command line: exit status, streams, files whole or not at all, and hostile input.
#![cfg(all(feature = "cli", feature = "simulate"))]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

pub(super) const CUK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/cuk.yaml");

/// A longer call is a hang, on a machine however busy.
const HANG: Duration = Duration::from_secs(120);

/// A folder that goes with the test.
pub(super) struct Folder(tempfile::TempDir);

impl Folder {
    pub(super) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(super) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file");
        path.display().to_string()
    }
}

pub(super) fn run(arguments: &[&str]) -> Output {
    let started = Instant::now();
    let output = Command::new(env!("CARGO_BIN_EXE_pebo-gen"))
        .args(arguments)
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .output()
        .expect("the program runs");
    assert!(started.elapsed() < HANG, "{arguments:?} took {:?}", started.elapsed());
    output
}

pub(super) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A small model with one line replaced.
pub(super) fn model(key: &str, line: &str) -> String {
    let base = [
        ("model", "model: m"),
        ("parameters", "parameters: {a: 2}"),
        ("x", "x: [x1]"),
        ("y", "y: [y1]"),
        ("u", "u: [u1]"),
        ("f_x", "f_x: {x1: u1}"),
        ("f_y", "f_y: {y1: a*x1}"),
        ("phi", "phi: [x1]"),
    ];
    base.iter().map(|(k, l)| if *k == key { line } else { *l }).collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn emits_to_standard_output_and_the_verdict_to_standard_error() {
    let output = run(&[CUK]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("pub struct Cuk"));
    assert!(text(&output.stderr).starts_with("cuk: accepted"));
}

#[test]
fn output_is_the_same_every_time() {
    assert_eq!(run(&[CUK]).stdout, run(&[CUK]).stdout);
    assert_eq!(run(&["check", CUK, "--format", "json"]).stdout, run(&["check", CUK, "--format", "json"]).stdout);
}

#[test]
fn several_models_are_written_into_a_folder() {
    let folder = Folder::new();
    let small = folder.file("m.yaml", model("model", "model: small"));
    let out = folder.0.path().display().to_string();
    assert_eq!(run(&[CUK, &small, "-o", &out]).status.code(), Some(0));
    assert!(folder.path("cuk.rs").exists() && folder.path("small.rs").exists());
    let output = run(&[CUK, &small]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("help: make it, and name it with `-o FOLDER`"));
}

#[test]
fn describes_itself() {
    for (arguments, part) in [
        (&["--help"][..], "Examples:"),
        (&["--version"], env!("CARGO_PKG_VERSION")),
        (&["completions", "bash"], "complete -F"),
        (&["completions", "fish"], "complete -c pebo-gen"),
        (&["man"], ".TH pebo-gen"),
        (&["schema"], "The verdict on one model"),
        (&["schema", "check"], "The verdict on one model"),
        (&["schema", "model"], "A model file of pebo-gen"),
    ] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains(part), "{arguments:?}: {}", text(&output.stdout));
    }
}

#[test]
fn a_certificate_goes_to_a_file_and_the_verdict_to_standard_error() {
    let folder = Folder::new();
    let script = folder.path("cuk.py").display().to_string();
    let output = run(&["certificate", CUK, "-o", &script]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && text(&output.stderr).starts_with("cuk: accepted"));
    assert!(std::fs::read_to_string(&script).unwrap().starts_with("#!/usr/bin/env python3\n"));
    let wrong = folder.file("m.yaml", model("phi", "phi: [x1, x1^2]"));
    let output = run(&["certificate", &wrong]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty());
}

#[test]
fn a_page_goes_to_a_file_and_a_refused_model_has_one_too() {
    let folder = Folder::new();
    let page = folder.path("cuk.html").display().to_string();
    let output = run(&["report", CUK, "-o", &page]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty() && text(&output.stderr).starts_with("cuk: accepted"));
    assert!(std::fs::read_to_string(&page).unwrap().starts_with("<!DOCTYPE html>\n"));
    let wrong = folder.file("m.yaml", model("phi", "phi: [x1, x1^2]"));
    let output = run(&["report", &wrong]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("id=\"diagnostics\""));
    let malformed = folder.file("n.yaml", "model: n\n");
    let output = run(&["report", &malformed, "-o", &folder.path("n.html").display().to_string()]);
    assert_eq!((output.status.code(), folder.path("n.html").exists()), (Some(2), false));
}

#[test]
fn long_lines_are_cut_to_the_terminal() {
    let folder = Folder::new();
    let long = folder.file("m.yaml", model("phi", &format!("phi: [x1{}, y2]", " + 0*y1".repeat(60))));
    let widest = |columns: &str| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_pebo-gen")).args(["check", &long]).env("COLUMNS", columns).output();
        let said = text(&output.expect("the program runs").stderr);
        said.lines().filter(|line| line.contains('|')).map(|line| line.chars().count()).max().unwrap_or(0)
    };
    let (narrow, wide) = (widest("60"), widest("1000"));
    assert!(narrow <= 80 && wide > 300, "{narrow} and {wide}");
}

#[test]
fn a_refused_model_exits_with_1_and_writes_nothing() {
    let folder = Folder::new();
    let refused = folder.file("m.yaml", model("f_x", "f_x: {x1: u1 - x1*x1}"));
    let target = folder.path("out.rs");
    let output = run(&[&refused, "-o", &target.display().to_string()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(!target.exists());
    assert!(output.stdout.is_empty());
    assert!(text(&output.stderr).contains("error[cascade-refuted]"));
}

#[test]
fn a_failed_write_leaves_the_old_file() {
    let folder = Folder::new();
    let target = folder.path("no-such-folder").join("out.rs");
    let output = run(&[CUK, "-o", &target.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("error[cannot-write]"), "{}", text(&output.stderr));
}

/// A device is not replaced: as root, a file could take the path of `/dev/null`.
#[cfg(unix)]
#[test]
fn pipes_and_links_are_written_to_where_they_stand() {
    use std::os::unix::fs::FileTypeExt as _;

    let folder = Folder::new();
    let pipe = folder.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().expect("cat");
    let arguments = ["simulate", CUK, "--step", "1e-4", "--csv"];
    let to = |place: &Path| run(&[&arguments[..], &[&place.display().to_string()]].concat());
    let output = to(&pipe);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(std::fs::metadata(&pipe).expect("the pipe").file_type().is_fifo(), "a file stands in its place");
    let piped = reader.wait_with_output().expect("what was written").stdout;
    assert!(text(&piped).starts_with("t,"), "{}", text(&piped));

    let (file, link) = (folder.path("file.csv"), folder.path("link.csv"));
    std::fs::write(&file, "old").expect("a file");
    std::os::unix::fs::symlink(&file, &link).expect("a link");
    assert!(to(&link).status.success());
    assert!(std::fs::symlink_metadata(&link).expect("the link").is_symlink());
    assert_eq!(std::fs::read(&file).expect("the file"), piped);
}

/// A full disk, for whatever is written to standard output.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_in_a_diagnostic() {
    for arguments in [
        &[CUK][..],
        &["check", CUK],
        &["check", CUK, "--format", "json"],
        &["simulate", CUK, "--step", "1e-4", "--csv", "-"],
        &["explain", "cannot-read"],
        &["completions", "bash"],
        &["man"],
        &["schema"],
        &["--help"],
        &["--version"],
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full").expect("a device that is full");
        let output = Command::new(env!("CARGO_BIN_EXE_pebo-gen")).args(arguments).stdout(full).output();
        let output = output.expect("the program runs");
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains("error[cannot-write]") && said.contains("help:"), "{arguments:?}: {said}");
        assert!(said.contains("no space left on device"), "{arguments:?}: {said}");
    }
}

/// A setting of the call is refused as the call's: no line of the model file is at fault.
#[test]
fn settings_of_the_call_are_refused_without_the_file() {
    for (arguments, code, message, help) in [
        (&["--step", "0"][..], "number-out-of-range", "`step` of the call is 0", "above zero"),
        (&["--step", "-1"], "number-out-of-range", "`step` of the call is -1", "above zero"),
        (&["--every", "-1"], "number-out-of-range", "`every` of the call is -1", "above zero"),
        (&["--every", "NaN"], "number-out-of-range", "`every` of the call is NaN", "above zero"),
        (&["--step", "2"], "number-out-of-range", "longer than the duration of 1 s", "a shorter `step`"),
        (&["--step", "1e-30"], "simulation-too-long", "`step` of the call, 1e-30 s", "a longer step"),
        (&["--step", "1e-8", "--every", "1e-8"], "simulation-too-long", "rows", "a larger `--every`"),
        (&["--feedback", "trueth"], "wrong-choice", "the call", "did you mean `truth`?"),
    ] {
        let output = run(&[&["simulate", CUK], arguments].concat());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        for part in [&format!("error[{code}]"), message, help] {
            assert!(said.contains(part), "{arguments:?}: no {part} in {said}");
        }
        assert!(!said.contains("cuk.yaml"), "{arguments:?}: {said}");
    }
}

#[test]
fn a_setting_of_a_call_is_as_one_in_the_file() {
    let folder = Folder::new();
    let model = folder.file("spring.yaml", spring("").replace("-4*q", "-k*q") + "parameters: {k: 1}\n");
    let set = run(&["simulate", &model, "--csv", "-", "--set", "k=4", "--set", "simulation.initial={v: 0.5, q: 1}"]);
    let written = folder.file("stiff.yaml", spring("").replace("-4*q", "-k*q") + "parameters: {k: 4}\n");
    let written = run(&["simulate", &written, "--csv", "-"]);
    assert_eq!(set.status.code(), Some(0), "{}", text(&set.stderr));
    assert!(set.stdout == written.stdout && !set.stdout.is_empty());
    // A parameter that becomes 0 is another plant: it is proved anew.
    let said = text(&run(&["simulate", &model, "--set", "k=0", "--set", "observer.gain=0.1"]).stderr);
    assert!(said.contains("still falls"), "{said}");
    for (setting, status, code, place) in [
        ("k", 2, "wrong-shape", "--> the call:1:7"),
        ("simulation.nois.q=1", 2, "unknown-key", "--> the call:1:18"),
        ("f_y.q=1", 1, "never-identifiable", "spring.yaml"),
    ] {
        let output = run(&["simulate", &model, "--csv", "-", "--set", setting]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{setting}: {said}");
        assert!(said.contains(&format!("error[{code}]")) && said.contains(place), "{setting}: {said}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn a_figure_in_another_format_is_refused_before_anything_runs() {
    let folder = Folder::new();
    let path = folder.path("figure.png").display().to_string();
    let output = run(&["simulate", "no such model.yaml", "--plot", &path]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("error[figure-format]") && said.contains("asks for a figure as png"), "{said}");
    assert!(said.contains("figure.svg") && !said.contains("no such model"), "{said}");
    assert!(!folder.path("figure.png").exists());
}

/// A spring with an observer, and this in its simulation.
fn spring(more: &str) -> String {
    format!(
        "model: spring\nx: [v]\ny: [q]\nf_x: {{v: -4*q}}\nf_y: {{q: v}}\nphi: [v]\nunits: {{v: m/s}}\n\
         observer: {{gain: 50, filter: 5}}\n\
         simulation: {{duration: 10, step: 0.01, initial: {{v: 0.5, q: 1}}{more}}}\n"
    )
}

#[test]
fn a_run_is_summed_up() {
    let folder = Folder::new();
    let long =
        spring(", noise: {q: 1e-4}, dropped: 0.1, baselines: {kalman: {}}").replace("duration: 10", "duration: 20");
    let model = folder.file("spring.yaml", long);
    let output = run(&["simulate", &model, "--seed", "3"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[0].starts_with("error of") && lines[0].contains("settled to 1 %"), "{said}");
    assert!(lines[1].starts_with("v in m/s") && lines[2].starts_with("kalman.v in m/s"), "{said}");
    for part in ["excitation: enough from t = ", "dropped: ", " of 2001 samples"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains("not-converged"), "{said}");
    // The same seed is the same run, another one is another.
    assert_eq!(said, text(&run(&["simulate", &model, "--seed", "3"]).stdout));
    assert_ne!(said, text(&run(&["simulate", &model, "--seed", "4"]).stdout));
    // Where the table goes to standard output, the summary does not stand in it.
    let output = run(&["simulate", &model, "--seed", "3", "--csv", "-"]);
    assert!(text(&output.stderr) == said && text(&output.stdout).starts_with("t,v,q"), "{}", text(&output.stdout));
}

#[test]
fn a_run_that_did_not_converge_says_why() {
    let folder = Folder::new();
    for (more, gain, note, help) in [
        ("", "gain: 0.1", "still falls", "raise `gain`, or simulate longer"),
        (", plant: {k: 5}", "gain: 50", "with `plant` in the simulation", "measure the parameter"),
    ] {
        let text_of = spring(more).replace("gain: 50", gain).replace("-4*q", "-k*q") + "parameters: {k: 4}\n";
        let output = run(&["simulate", &folder.file("spring.yaml", text_of)]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains("warning[not-converged]") && said.contains(note) && said.contains(help), "{said}");
    }
}

#[test]
fn many_runs_have_a_table_a_figure_and_quantiles() {
    let folder = Folder::new();
    let model = folder.file("spring.yaml", spring(", noise: {q: 1e-3}, baselines: {kalman: {}}"));
    let [plot, csv] = ["band.svg", "band.csv"].map(|name| folder.path(name).display().to_string());
    let output = run(&["simulate", &model, "--runs", "5", "--plot", &plot, "--csv", &csv]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("rms then, median") && said.contains("runs: 5 with the seeds 1 to 5"), "{said}");
    let table = std::fs::read_to_string(&csv).expect("a table");
    let header = "t,v_error_10,v_error_50,v_error_90,kalman.v_error_10,kalman.v_error_50,kalman.v_error_90";
    assert_eq!(table.lines().next(), Some(header));
    assert_eq!(table.lines().count(), 401);
    for line in table.lines().skip(1) {
        let values: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        assert!(values[1] <= values[2] && values[2] <= values[3] && values[4] <= values[5], "{line}");
    }
    assert!(std::fs::read_to_string(&plot).expect("a figure").contains("fill-opacity"));
    for wrong in ["0", "-1", "1e9", "x"] {
        assert_eq!(run(&["simulate", &model, "--runs", wrong]).status.code(), Some(2), "{wrong}");
    }
}

/// A file is written beside its path and moved there when it is whole: an ended run leaves nothing.
#[test]
fn an_interrupted_run_leaves_no_file() {
    let folder = Folder::new();
    let [plot, csv] = ["f.svg", "f.csv"].map(|name| folder.path(name).display().to_string());
    let arguments = ["simulate", CUK, "--step", "1e-8", "--plot", &plot, "--csv", &csv];
    let mut command = Command::new(env!("CARGO_BIN_EXE_pebo-gen"));
    let mut child = command.args(arguments).stderr(Stdio::null()).spawn().expect("the program runs");
    std::thread::sleep(Duration::from_millis(500));
    // A hundred million samples take a minute and more.
    assert!(child.try_wait().expect("a process").is_none());
    child.kill().expect("it is there");
    child.wait().expect("it ends");
    assert_eq!(std::fs::read_dir(folder.path("")).expect("a folder").count(), 0);
}

#[test]
fn colour_is_for_terminals() {
    let folder = Folder::new();
    let refused = folder.file("m.yaml", model("f_x", "f_x: {x1: u1 - x1*x1}"));
    let escapes = |variable: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_pebo-gen")).args(["check", &refused]).env(variable, "1").output();
        text(&output.expect("the program runs").stderr).contains('\u{1b}')
    };
    // Here the stream is a pipe.
    assert!(!escapes("UNRELATED") && !escapes("NO_COLOR"));
    assert!(escapes("CLICOLOR_FORCE"));
}

#[test]
fn several_models_in_one_call_end_with_the_worst_status() {
    let folder = Folder::new();
    let refused = folder.file("m.yaml", model("f_x", "f_x: {x1: u1 - x1*x1}"));
    let output = run(&["check", CUK, &refused, "--format", "json"]);
    assert_eq!(output.status.code(), Some(1));
    let lines = text(&output.stdout);
    let verdicts: Vec<&str> =
        lines.lines().filter_map(|l| l.split("\"verdict\":\"").nth(1)?.split('"').next()).collect();
    assert_eq!(verdicts, ["accepted", "rejected"]);
}

#[test]
fn json_has_the_drift_and_the_equilibrium() {
    let printed = text(&run(&["check", CUK, "--format", "json"]).stdout);
    for part in [
        r#""drift":["chi1","chi2"]"#,
        r#""operating_point":{"verdict":"proved","values":{"i1":"G*E*d^2/(1 - d)^2","i3":"-G*E*d/(1 - d)","#,
        r#""still":true,"rank":[1,0],"reason":null}"#,
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
}

#[test]
fn json_has_an_object_for_a_malformed_model_too() {
    let folder = Folder::new();
    let malformed = folder.file("m.yaml", "model: [");
    let output = run(&["check", &malformed, "--format", "json"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stdout).starts_with("{\"schema\":1,\"model\":\"m\",\"verdict\":\"rejected\""));
}

#[test]
fn explains_every_code() {
    let output = run(&["explain", "cascade-refuted"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains("Claim C1"));
    let output = run(&["explain", "cascade-refused"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("did you mean `cascade-refuted`?"));
}

/// Mistakes and attacks: the text, the code, and the words that the message must have.
#[test]
fn hostile_input_ends_in_a_diagnostic() {
    let folder = Folder::new();
    let deep = format!("phi: [{}x1{}]", "(".repeat(10_000), ")".repeat(10_000));
    let bomb = "a: &a [1,1,1,1,1,1,1,1]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b]\nmodel: *c\n";
    let table: Vec<(&str, Vec<u8>, &str, &str)> = vec![
        ("unknown key", model("u", "u: [u1]\nphi_lefd: {x1: z1}").into(), "unknown-key", "phi_left"),
        ("duplicate key", model("u", "u: [u1]\nx: [x1]").into(), "duplicate-key", "x"),
        ("unknown name", model("f_y", "f_y: {y1: a*x2}").into(), "unknown-name", "did you mean `x1`?"),
        ("huge power", model("f_y", "f_y: {y1: x1^1000000000}").into(), "exponent-too-large", "64"),
        ("huge number", model("parameters", "parameters: {a: 1e999999999}").into(), "number-too-large", "308"),
        ("huge number in a formula", model("f_y", "f_y: {y1: 1e999999999*x1}").into(), "number-too-large", "308"),
        ("parentheses", model("phi", &deep).into(), "formula-too-deep", ""),
        ("alias bomb", bomb.into(), "yaml-feature", ""),
        ("empty", Vec::new(), "empty-file", ""),
        ("binary", vec![0, 159, 146, 150, 255], "not-text", "UTF-8"),
        ("ten megabytes", vec![b'a'; 10 << 20], "file-too-large", ""),
        ("division by zero", model("f_y", "f_y: {y1: x1/(a - a)}").into(), "division-by-zero", "zero"),
        ("reserved", model("x", "x: [z1]").into(), "reserved-name", "z1"),
        ("missing rate", model("x", "x: [x1, x2]").into(), "missing-entry", "x2"),
        ("empty map", model("f_x", "f_x: {}").into(), "empty-list", "f_x"),
        ("control characters", b"model: m\x00\x01\n".to_vec(), "yaml-syntax", ""),
        ("no yaml", b"{{{{{{".to_vec(), "yaml-syntax", ""),
    ];
    for (what, content, code, named) in table {
        let path = folder.file("m.yaml", content);
        let output = run(&["check", &path]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{what}: {message}");
        assert!(message.contains(&format!("error[{code}]")), "{what}: {message}");
        assert!(message.contains(named), "{what} does not name {named}: {message}");
        assert!(message.contains("help: "), "{what} has no help: {message}");
        assert!(!message.contains("panicked"), "{what}: {message}");
    }
    let output = run(&["check", &folder.path("none.yaml").display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("error[cannot-read]"));
}

/// The library's tests have the models that take long (`limit.rs`): here is the program's behaviour.
#[test]
fn a_derivation_that_takes_too_long_is_undecided_and_names_the_phase() {
    let folder = Folder::new();
    let tangents = (0..18).fold("q".to_owned(), |inner, _| format!("tan({inner} + u1)"));
    let content = "model: m\nx: [p]\ny: [q]\nu: [u1]\nf_y: {q: p}\nphi: [p]\n".to_owned()
        + &format!("f_x: {{p: \"u1*{tangents}\"}}\n");
    let path = folder.file("m.yaml", content);
    for command in [["check", &path, "--limit", "0.1"], ["simulate", &path, "--limit", "0.1"]] {
        let output = run(&command);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{command:?}: {message}");
        assert!(message.contains("error[limit-reached]"), "{command:?}: {message}");
        assert!(message.contains("reached in the cascade"), "{command:?}: {message}");
    }
    assert_eq!(run(&[&path, "--limit", "0.1"]).status.code(), Some(1));
}

/// Options of every command stand where their writer put them.
#[test]
fn a_limit_may_stand_before_the_command() {
    let json = run(&["--limit", "20", "check", CUK, "--format", "json"]);
    assert_eq!(json.status.code(), Some(0), "{}", text(&json.stderr));
    assert_eq!(json.stdout, run(&["check", CUK, "--format", "json", "--limit", "20"]).stdout);
    assert_eq!(run(&["--limit=20", CUK]).stdout, run(&[CUK]).stdout);
    let short = run(&["--limit", "1e-6", "check", CUK]);
    assert_eq!(short.status.code(), Some(1), "{}", text(&short.stderr));
    // An option of one command is refused before another.
    for option in [["--output", "file.rs"], ["--scalar", "f32"]] {
        let output = run(&[option[0], option[1], "check", CUK]);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        assert!(text(&output.stderr).contains(&format!("`{}` belongs to `pebo-gen MODEL`", option[0])));
    }
    // Behind a model, a command's name is a file's.
    let output = run(&[CUK, "check"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("several models need a folder"), "{}", text(&output.stderr));
}

#[test]
fn a_misspelt_command_is_no_model() {
    for arguments in [&["simulat", CUK][..], &["solv"][..]] {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2));
        let said = text(&output.stderr);
        let command = if arguments.len() == 2 { "did you mean `simulate`?" } else { "did you mean `solve`?" };
        assert!(said.contains(command) && !said.contains("folder"), "{said}");
    }
}

#[test]
fn a_limit_is_a_positive_number_of_seconds() {
    for limit in ["0", "-1", "NaN", "ten", ""] {
        let output = run(&["check", CUK, &format!("--limit={limit}")]);
        assert_eq!(output.status.code(), Some(2), "{limit}: {}", text(&output.stderr));
    }
    for limit in ["inf", "1e300", "1000"] {
        let output = run(&["check", CUK, "--limit", limit]);
        assert_eq!(output.status.code(), Some(0), "{limit}: {}", text(&output.stderr));
    }
}

/// Shared parts are printed wherever they are used: a formula that would fill the memory is not printed in full.
#[test]
fn a_formula_that_no_page_holds_is_not_printed_in_full() {
    let folder = Folder::new();
    let level = |i: usize| format!("  a{i}: \"sin(a{0})*a{0} + 1\"\n", i - 1);
    let chain: String = (1..60).map(level).collect();
    let content = format!(
        "model: m\nx: [p]\ny: [q]\nu: [v]\ndefine:\n  a0: q\n{chain}f_x: {{p: v*a59}}\nf_y: {{q: p + q}}\nphi: [p]\n"
    );
    let output = run(&["check", &folder.file("m.yaml", content)]);
    assert!(output.status.code().is_some_and(|code| code < 2), "{}", text(&output.stderr));
    assert!(output.stdout.len() + output.stderr.len() < 1_000_000, "{} bytes", output.stdout.len());
}

/// Names that other tools stumble over are just names.
#[test]
fn difficult_names_are_accepted() {
    let folder = Folder::new();
    for (what, content) in [
        (
            "a parameter named like a function",
            "model: m\nparameters: {sin: 2}\nx: [x1]\ny: [y1]\nf_x: {x1: sin(sin*y1)}\nf_y: {y1: sin*x1}\nphi: [x1]\n",
        ),
        ("a state named E", "model: m\nx: [E]\ny: [I]\nf_x: {E: I^2}\nf_y: {I: E + I}\nphi: [E]\n"),
        (
            "a Rust keyword",
            "model: type\nparameters: {fn: 2}\nx: [match]\ny: [self]\nu: [gen]\nf_x: {match: gen}\nf_y: {self: fn*match}\nphi: [match]\n",
        ),
        (
            "names that differ in case",
            "model: m\nparameters: {l: 2, L: 3}\nx: [x]\ny: [X]\nf_x: {x: X/l}\nf_y: {X: L*x}\nphi: [x]\n",
        ),
    ] {
        let path = folder.file("m.yaml", content);
        let output = run(&[&path]);
        assert_eq!(output.status.code(), Some(0), "{what}: {}", text(&output.stderr));
    }
}
