//! One call gives the whole answer: the output of the command line and of the build script, as a value.
#![cfg(all(feature = "cli", feature = "simulate"))]

use std::cell::Cell;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::rc::Rc;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::Scalar;
use pebo_gen::simulate::Overrides;
use pebo_gen::source::{Code, Source};
use pebo_gen::{Answer, Builder, Request, RunRequest, Stage, Standing, answer};
use serde_json::Value;

const CUK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/cuk.yaml");

const REFUTED: &str = "model: m\nx: [a]\ny: [b]\nu: [c]\nf_x: {a: c - a^2}\nf_y: {b: a}\nphi: [a]\n";

fn source(path: &str) -> Source {
    Source::new(path, std::fs::read_to_string(path).expect("a model file")).expect("a text")
}

fn answered(text: &str, request: &Request) -> Answer {
    answer(&Source::new("folder/plant.yaml", text).expect("a text"), request)
}

fn program(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pebo-gen"))
        .args(arguments)
        .env("NO_COLOR", "1")
        .output()
        .expect("the program runs")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("a text")
}

/// A short run of the converter.
fn short() -> RunRequest {
    let overrides = Overrides { step: Some(1e-4), every: Some(0.25), ..Overrides::default() };
    RunRequest { overrides, trace: true, figure: true, ..RunRequest::default() }
}

#[test]
fn the_command_line_and_the_builder_agree_with_the_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["cuk", "motor_flux", "pendulum"] {
        let path = PathBuf::from(CUK).with_file_name(format!("{name}.yaml")).display().to_string();
        let answer = answer(&source(&path), &Request::new().emit(Scalar::F32));
        let emitted = answer.emitted.expect("accepted");
        let check = program(&["check", &path, "--format", "json"]);
        assert_eq!(text(&check.stdout), answer.report.line() + "\n");
        assert_eq!(text(&program(&["check", &path]).stdout), answer.summary);
        let generate = program(&[&path, "--scalar", "f32"]);
        assert_eq!((text(&generate.stdout), text(&generate.stderr)), (emitted.text.as_str(), answer.summary.as_str()));
        let builder = Builder::new().out_dir(folder.path()).emit_rerun_if_changed(false).scalar(Scalar::F32);
        let built = builder.compile(&[&path]).expect("accepted");
        assert_eq!(std::fs::read_to_string(&built[0].path).expect("a file"), emitted.text);
        assert_eq!(built[0].type_name, emitted.type_name);
    }
}

#[test]
fn a_run_has_its_final_errors_and_the_requested_results() {
    let answer = answer(&source(CUK), &Request::new().run(short()));
    assert_eq!(answer.standing, Standing::Accepted);
    let run = answer.run.expect("a run");
    let states: Vec<&str> = run.errors.iter().map(|error| error.state.as_str()).collect();
    assert_eq!((states, run.end), (vec!["i1", "i3"], 1.0));
    assert!(run.errors.iter().all(|error| error.start.abs() > 0.1 && error.end.abs() < 0.01), "{:?}", run.errors);
    let csv = std::env::temp_dir().join(format!("pebo-answer-{}.csv", std::process::id()));
    let path = csv.display().to_string();
    let output = program(&["simulate", CUK, "--step", "1e-4", "--every", "0.25", "--csv", &path]);
    let written = std::fs::read_to_string(&csv).expect("a table");
    std::fs::remove_file(&csv).expect("it was written");
    assert_eq!(written, run.trace.as_ref().expect("requested").csv());
    assert_eq!(text(&output.stdout), run.summary.text());
    assert!(run.figure.expect("requested").starts_with("<svg"));
}

#[test]
fn many_runs_are_summarised_by_their_quantiles() {
    let noisy =
        std::fs::read_to_string(CUK).expect("a model").replace("  step: 1e-5", "  step: 1e-4\n  noise: {v2: 0.1}");
    let runs = |runs: u64| {
        let overrides = Overrides { seed: Some(5), duration: Some(0.2), ..Overrides::default() };
        let request = RunRequest { overrides, figure: true, runs: Some(runs), ..RunRequest::default() };
        answered(&noisy, &Request::new().run(request)).run.expect("a run")
    };
    let (few, one) = (runs(7), runs(1));
    let [few_ensemble, one_ensemble] = [&few, &one].map(|run| run.ensemble.as_ref().expect("requested"));
    assert_eq!((few_ensemble.seed, few_ensemble.runs, few_ensemble.stopped, one_ensemble.runs), (5, 7, 0, 1));
    for (spread, alone) in few_ensemble.estimates.iter().zip(&one_ensemble.estimates) {
        let (rms, score) = (spread.rms, few.summary.estimates.iter().find(|rated| rated.estimate == spread.estimate));
        assert!(rms.median > Some(0.0) && rms.ninety > rms.median, "{spread:?}");
        // One run is all of its quantiles; the first of many is that one.
        assert_eq!((alone.rms.median, alone.rms.ninety), (score.map(|rated| rated.score.rms), alone.rms.median));
    }
    assert_eq!(few_ensemble, runs(7).ensemble.as_ref().expect("requested"));
    assert!(
        few.figure
            .as_ref()
            .is_some_and(|svg| svg.contains("fill-opacity") && svg.contains("(median and 10 to 90 % of 7 runs)"))
    );
    assert!(few.trace.is_none());
    let json = serde_json::to_value(few_ensemble).expect("it serialises");
    assert!(json["estimates"][0]["settled"]["median"].is_number(), "{json}");
}

/// A plant that is accepted, with something behind it.
fn with(section: &str) -> Source {
    let plant = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\nphi: [p]\n";
    Source::new("m.yaml", format!("{plant}{section}\n")).expect("a short text")
}

#[test]
fn a_list_of_wrong_length_under_observer_is_refused_before_code_is_written() {
    let source = with("observer: {estimator: gradient, gain: [1, 2, 3], filter: 10}");
    let refused = answer(&source, &Request::new().emit(Scalar::F64));
    assert_eq!((refused.standing, refused.diagnostics[0].code), (Standing::Malformed, Code::WrongShape));
    assert!(refused.emitted.is_none());
    assert_eq!(answer(&source, &Request::new()).standing, Standing::Accepted, "the claims do not depend on it");
}

#[test]
fn an_input_under_signals_is_sent_to_the_control_law() {
    let source = with("simulation: {duration: 1, step: 1e-3, initial: {p: 1}, signals: {v: 1}}");
    let refused = answer(&source, &Request::new());
    assert_eq!((refused.standing, refused.diagnostics.len()), (Standing::Malformed, 1));
    assert!(refused.diagnostics[0].help.as_deref().is_some_and(|help| help.contains("`control: {v: v_t}`")));
}

/// The value for a page or an editor: spans in bytes, labels, notes, and no more than was requested.
#[test]
fn the_answer_serialises_with_spans_labels_and_notes() {
    let answer = answered(REFUTED, &Request::new().emit(Scalar::F64));
    assert_eq!((answer.standing, answer.report.verdict), (Standing::Refused, Outcome::Rejected));
    let json: Value = serde_json::to_value(&answer).expect("it serialises");
    assert_eq!(json["standing"], "refused");
    assert_eq!(json["report"], serde_json::from_str::<Value>(&answer.report.line()).expect("a line of JSON"));
    let diagnostic = &json["diagnostics"][0];
    assert_eq!((&diagnostic["code"], &diagnostic["severity"]), (&"cascade-refuted".into(), &"error".into()));
    let place = |span: &Value| {
        let [start, end] = ["start", "end"].map(|key| usize::try_from(span[key].as_u64().expect("a byte")).unwrap());
        &REFUTED[start..end]
    };
    assert_eq!(place(&diagnostic["primary"]["span"]), "a");
    assert!(
        diagnostic["secondary"]
            .as_array()
            .is_some_and(|labels| labels.iter().any(|l| place(&l["span"]) == "-a^2" || place(&l["span"]) == "a^2")),
        "{diagnostic}"
    );
    assert!(diagnostic["notes"].as_array().is_some_and(|notes| !notes.is_empty()), "{diagnostic}");
    for key in ["emitted", "mathml", "run"] {
        assert_eq!(json[key], Value::Null, "{key}");
    }
    let json: Value = serde_json::to_value(self::answer(&source(CUK), &Request::new().emit(Scalar::F64).run(short())))
        .expect("it serialises");
    assert_eq!(json["emitted"]["type_name"], "Cuk");
    assert!(json["emitted"]["text"].as_str().is_some_and(|text| text.contains("pub struct Cuk")));
    assert_eq!(json["run"]["trace"]["columns"][0], "t");
    assert_eq!(json["run"]["errors"][0]["state"], "i1");
    let summary = &json["run"]["summary"];
    assert_eq!((&summary["estimates"][0]["state"], &summary["estimates"][0]["unit"]), (&"i1".into(), &"A".into()));
    assert!(summary["estimates"][0]["settled"].as_f64().is_some_and(|t| t > 0.0 && t < 0.5), "{summary}");
    assert_eq!(
        (&summary["excitation"]["state"], &summary["faults"]),
        (&"converged".into(), &Value::Object(serde_json::Map::default()))
    );
    assert_eq!(json["run"]["ensemble"], Value::Null);
}

#[test]
fn a_derivation_is_typeset_on_request() {
    let model = "model: m\nparameters: [L_1]\nx: [p]\ny: [q]\nu: [v]\nassume: [L_1 > 0]\nf_x: {p: v/L_1}\nf_y: {q: p*q}\nphi: [p]\n";
    assert_eq!(answered(model, &Request::new()).mathml, None);
    let mathml = answered(model, &Request::new().mathml()).mathml.expect("requested");
    assert_eq!(
        mathml.h,
        ["<math><mfrac><mrow><mi>v</mi></mrow><mrow><msub><mi>L</mi><mn>1</mn></msub></mrow></mfrac></math>"]
    );
    assert_eq!(mathml.phi_left["p"], "<math><msub><mi>z</mi><mn>1</mn></msub></math>");
    assert_eq!(
        (mathml.phi_0.len(), mathml.phi_1, mathml.lambda.len()),
        (1, vec![vec!["<math><mi>q</mi></math>".to_owned()]], 0)
    );
}

#[test]
fn the_caller_stops_a_proof_and_a_run() {
    let stopped = |request: &Request, path: &str| {
        let answer = answer(&source(path), request);
        assert_eq!(answer.standing, Standing::Refused);
        assert_eq!(answer.diagnostics.last().map(|diagnostic| diagnostic.code), Some(Code::LimitReached));
        answer
    };
    let answered = Rc::new(Cell::new(0.0));
    let seen = Rc::clone(&answered);
    let request = Request::new().run(short()).watch(move |stage| match stage {
        Stage::Run { done, samples } => {
            assert_eq!(samples, 10_000);
            seen.set(done);
            if done < 0.5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        }
        _ => ControlFlow::Continue(()),
    });
    let answer = stopped(&request, CUK);
    assert_eq!((answer.report.verdict, answer.run.is_none(), answered.get()), (Outcome::Accepted, true, 0.5));
    // Long enough that the caller's function is called.
    let tangents = (0..18).fold("q".to_owned(), |inner, _| format!("tan({inner} + v)"));
    let model = format!("model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {{p: \"v*{tangents}\"}}\nf_y: {{q: p}}\nphi: [p]\n");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("m.yaml");
    std::fs::write(&path, model).expect("a file");
    let answer = stopped(&Request::new().limit(1e9).watch(|_| ControlFlow::Break(())), &path.display().to_string());
    assert_eq!(answer.report.verdict, Outcome::Undecided);
}

/// A requested result that is missing has a diagnostic.
#[test]
fn missing_results_are_explained() {
    let model = "model: m\nparameters: {a: 1e300}\nx: [p]\ny: [q]\nf_x: {p: a*q}\nf_y: {q: p}\nphi: [p]\n";
    let answer = answered(model, &Request::new().emit(Scalar::F32));
    let [refused] = answer.diagnostics.as_slice() else { panic!("{:?}", answer.diagnostics) };
    assert_eq!((refused.code, answer.standing, answer.emitted.is_none()), (Code::CannotEmit, Standing::Refused, true));
    assert_eq!(&model[refused.primary.span.range()], "m");
    assert!(answered(model, &Request::new().emit(Scalar::F64)).emitted.is_some());
    let no_loop = answered(model, &Request::new().run(RunRequest::default()));
    assert_eq!((no_loop.standing, no_loop.run.is_none()), (Standing::Malformed, true));
    assert_eq!(no_loop.diagnostics[0].code, Code::SimulationMissing);
}

#[test]
fn a_model_that_is_no_model_is_called_as_its_file() {
    let named = |request: &Request| answered("model: [", request);
    assert_eq!(
        (named(&Request::new()).report.model, named(&Request::new()).standing),
        ("plant".to_owned(), Standing::Malformed)
    );
    assert_eq!(named(&Request::new().named("-")).report.model, "-");
    let output = program(&["check", "--format", "json", &Path::new("no").join("file.yaml").display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stdout).starts_with(r#"{"schema":1,"model":"file","verdict":"rejected""#));
}

#[test]
fn settings_of_a_loop_keep_the_derivation() {
    let text = include_str!("../../../models/cuk.yaml");
    let read = |settings: &[&str]| {
        Source::new("cuk.yaml", text).and_then(|source| source.set(settings)).expect("small settings")
    };
    let derived = pebo_gen::derive(&read(&[])).expect("a model");
    let model = |settings: &[&str]| pebo_gen::model::Model::parse(&read(settings)).expect("settings that can be");
    for (settings, holds) in [
        (&["simulation.noise.v2=0.1", "simulation.plant.L1=1.1*L1", "observer.filter=2"][..], true),
        (&[], true),
        (&["L1=2e-3"], false),
        (&["assume=[0 < d < 1]"], false),
    ] {
        assert_eq!(derived.holds_of(&model(settings)), holds, "{settings:?}");
    }
    // A run with another section is that of a file with the section.
    let settings = ["simulation.noise.v2=0.1", "simulation.duration=1e-3", "simulation.plant.L1=1.1*L1"];
    let anew = pebo_gen::derive(&read(&settings)).expect("a model");
    let mut again = pebo_gen::derive(&read(&[])).expect("a model");
    again.model = model(&settings);
    let [anew, again] = [anew, again]
        .map(|derived| derived.scenario(&Overrides::default()).expect("a loop").run().expect("it runs").csv());
    assert_eq!(anew, again);
}

#[test]
fn the_answer_says_that_time_is_an_input() {
    let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v + sin(t) - q}\nf_y: {q: p}\nphi: [p]\n";
    let found = answered(text, &Request::new().emit(Scalar::F32));
    assert_eq!(found.standing, Standing::Accepted);
    let report = serde_json::to_value(&found.report).expect("it serialises");
    assert_eq!(report["time"], "t");
    assert!(found.summary.contains("\n  time                      `t` is not declared: "), "{}", found.summary);
    let code = &found.emitted.expect("it was requested").text;
    assert!(
        code.contains("    /// `t` in s.\n    pub t: f32,\n}") && code.contains("//! The input `t` is the time in s,"),
        "{code}"
    );
    let declared = answered(&text.replace("sin(t)", "sin(w)").replace("[v]", "[v, w]"), &Request::new());
    assert!(serde_json::to_value(&declared.report).expect("it serialises")["time"].is_null());
    assert!(!declared.summary.contains("  time  "));
}
