//! The table of models/README.md, from what the tool says of each model.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use pebo_gen::analysis::{Class, Excitation, Outcome, RegressionKind};
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};

const HEAD: &str = "\
# Models

Plants of the paper (Ortega, Bobtsov, Pyrkin, Aranovskiy 2015), each checked, emitted, compiled and simulated by the
tests. This table is written by the tool: `UPDATE_TABLE=1 cargo test -p tests --test table`.

| model | paper | phi | class | regression | excitation | verdict |
|---|---|---|---|---|---|---|
";

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")
}

fn row(derived: &Derived) -> String {
    let Derived { plant, derivation, .. } = derived;
    let arena = &plant.arena;
    let phi: Vec<String> = plant.phi.iter().map(|f| format!("`{}`", arena.print(f.expr))).collect();
    let class = match (derivation.class, &plant.class) {
        (Class::Pebo, None) => "pebo".to_owned(),
        (Class::Pebo, Some(class)) => format!("pebo, {}", class.name()),
        (Class::Gpebo, None) => "gpebo".to_owned(),
        (Class::Gpebo, Some(class)) => format!("gpebo, {}", class.name()),
    };
    let regression = derivation.regression.result.as_ref().map_or_else(String::new, |regression| {
        let kind = match regression.kind {
            RegressionKind::Dynamic => "dynamic",
            RegressionKind::Static => "static",
            RegressionKind::Implicit => "implicit",
        };
        let parameterisation = if regression.is_linear(plant) { "linear" } else { "over-parameterised" };
        format!("{kind}, {parameterisation}")
    });
    let excitation = derivation.identifiability.result.as_ref().map_or_else(String::new, |identifiability| {
        let kind = match identifiability.kind {
            Excitation::Instant => "instant",
            Excitation::Excitation => "over time",
            Excitation::Never => "never",
        };
        let singular: Vec<String> = identifiability.singular_where.iter().map(|c| format!("`{c}`")).collect();
        if singular.is_empty() { kind.to_owned() } else { format!("{kind}, except where {}", singular.join(", ")) }
    });
    let verdict = match derivation.outcome {
        Outcome::Accepted => "accepted",
        Outcome::Rejected => "rejected",
        Outcome::Undecided => "undecided",
    };
    // Of the reference, what comes after the year.
    let reference = plant.reference.as_deref().unwrap_or("-");
    let paper = reference.strip_prefix("Ortega et al. 2015, ").unwrap_or(reference);
    format!(
        "| [{name}]({name}.yaml) | {paper} | {} | {class} | {regression} | {excitation} | {verdict} |",
        phi.join(", "),
        name = plant.name
    )
}

#[test]
fn the_table_is_what_the_tool_says() {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder()).expect("the models").flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "yaml"));
    paths.sort();
    let mut table = HEAD.to_owned();
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a model");
        let derived = derive(&Source::new("model", text).expect("a text")).expect("a model");
        writeln!(table, "{}", row(&derived)).expect("a string");
    }
    let file = folder().join("README.md");
    if std::env::var_os("UPDATE_TABLE").is_some() {
        std::fs::write(&file, &table).expect("the table can be written");
    }
    let shown = std::fs::read_to_string(&file).expect("models/README.md");
    assert!(shown == table, "models/README.md is stale: UPDATE_TABLE=1 cargo test -p tests --test table\n{table}");
}
