//! Plants with verified answers: the verdict of each is that of its answer.

use std::path::Path;

use pebo_gen::analysis::{Class, Derivation, Excitation, Outcome, RegressionKind};
use pebo_gen::plant::Plant;
use pebo_gen::source::{Code, Source};

/// The derivation agrees with the answer's verdict.
fn agrees(verdict: &str, implicit: bool, plant: &Plant, derivation: &Derivation) -> bool {
    let accepted = derivation.outcome == Outcome::Accepted;
    let regression = derivation.regression.result.as_ref();
    let linear = regression.is_some_and(|r| r.is_linear(plant));
    let kind = derivation.identifiability.result.as_ref().map(|i| i.kind);
    let pebo = derivation.class == Class::Pebo;
    let refused_for =
        |code: Code| derivation.outcome == Outcome::Rejected && derivation.diagnostics.iter().any(|d| d.code == code);
    match verdict {
        "ACCEPT" | "ACCEPT_LOCAL" => accepted && pebo && linear,
        "ACCEPT_PE" => accepted && kind == Some(Excitation::Excitation),
        "ACCEPT_OVERPARAM" => accepted && !linear,
        "ACCEPT_GPEBO" => accepted && !pebo,
        "REJECT_PDE" => refused_for(Code::CascadeRefuted),
        "REJECT_LEFTINV" => refused_for(Code::LeftInverseRefuted),
        // Some answers say that there is no dynamic regression but an implicit one.
        "REJECT_NONLINEAR" if implicit => accepted && regression.is_some_and(|r| r.kind == RegressionKind::Implicit),
        "REJECT_NONLINEAR" => refused_for(Code::RegressionNonlinear),
        "REJECT_UNIDENT" => refused_for(Code::NeverIdentifiable),
        other => panic!("no such verdict: {other}"),
    }
}

#[test]
fn verified_answers() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let entries = std::fs::read_dir(&folder).expect("the verified cases");
    let mut wrong = Vec::new();
    let mut paths: Vec<_> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "yaml"));
    paths.sort();
    for path in &paths {
        let text = std::fs::read_to_string(path).expect("a case");
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        let verdict = text.lines().find_map(|l| l.strip_prefix("#   verdict: ")).expect("an answer").trim_matches('"');
        let implicit = text.lines().any(|line| line.starts_with('#') && line.contains("implicit regression"));
        // The refusal concerns plain observers: a rate affine in x has a generalised one.
        let asked = if verdict == "REJECT_PDE" { "class: pebo\n" } else { "" };
        match pebo_gen::derive(&Source::new(&name, format!("{text}{asked}")).expect("a text")) {
            Ok(derived) if agrees(verdict, implicit, &derived.plant, &derived.derivation) => {}
            Ok(derived) => wrong.push(format!("{name}: {verdict}, derived {:?}", derived.derivation.outcome)),
            Err(diagnostics) => wrong.push(format!("{name}: {}", diagnostics[0].message)),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    println!("{} cases agree with their answers", paths.len());
}
