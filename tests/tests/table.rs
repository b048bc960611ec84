//! The table of models/README.md, from the tool's verdict on each model.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use pebo_gen::analysis::Excitation;
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};

const HEAD: &str = "\
# Models

Plants of the paper (Ortega, Bobtsov, Pyrkin, Aranovskiy 2015) and others, each checked, emitted, compiled and simulated
by the tests. This table is written by the tool: `UPDATE_TABLE=1 cargo test -p tests --test table`.

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
    let written = plant.class.as_ref().map_or_else(String::new, |class| format!(", {}", class.name()));
    let class = format!("{}{written}", derivation.class.name());
    let regression = derivation.regression.result.as_ref().map_or_else(String::new, |regression| {
        format!("{}, {}", regression.kind.word(), regression.parameterisation(plant))
    });
    let excitation = derivation.identifiability.result.as_ref().map_or_else(String::new, |identifiability| {
        let kind = match identifiability.kind {
            Excitation::Excitation => "over time",
            kind => kind.word(),
        };
        let singular: Vec<String> = identifiability.singular_where.iter().map(|c| format!("`{c}`")).collect();
        if singular.is_empty() { kind.to_owned() } else { format!("{kind}, except where {}", singular.join(", ")) }
    });
    let verdict = derivation.outcome.word();
    // The reference behind the year.
    let reference = plant.reference.as_deref().unwrap_or("-");
    let paper = reference.strip_prefix("Ortega et al. 2015, ").unwrap_or(reference);
    format!(
        "| [{name}]({name}.yaml) | {paper} | {} | {class} | {regression} | {excitation} | {verdict} |",
        phi.join(", "),
        name = plant.name
    )
}

/// The heading behind the table: figures of runs, which `cargo run --release -p tests --example models` prints.
const FIGURES: &str = "\n## Settling";

#[test]
fn the_table_agrees_with_the_tool() {
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
    let shown = std::fs::read_to_string(&file).expect("models/README.md");
    let figures = &shown[shown.find(FIGURES).unwrap_or(shown.len())..];
    table.push_str(figures);
    if std::env::var_os("UPDATE_TABLE").is_some() {
        std::fs::write(&file, &table).expect("the table can be written");
        return;
    }
    assert!(shown == table, "models/README.md is stale: UPDATE_TABLE=1 cargo test -p tests --test table\n{table}");
}
