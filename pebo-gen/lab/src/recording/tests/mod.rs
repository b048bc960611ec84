//! Replays of tables in text.

mod columns;
mod fit;
mod rows;
mod truth;

use std::ops::ControlFlow;

use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::source::{Diagnostic, Source};

use super::{Failure, Log, Replay, Replayed};

/// A cart of one kilogram that a force moves; its position is measured.
const CART: &str = "
model: cart
parameters: {m: 1, offset: 0.5, spare: 3}
x: [p]
y: [q]
u: [f]
assume: [m > 0]
f_x: {p: f}
f_y: {q: p/m}
phi: [p]
observer: {gain: 50, filter: 5}
";

/// The replay of a model for this header.
fn resolve(text: &str, log: &mut Log) -> Result<Replay, Vec<Diagnostic>> {
    let source = Source::new("test", text).expect("a short text");
    let model = Model::parse(&source)?;
    let plant = Plant::resolve(&model)?;
    let derivation = Derivation::derive(&plant);
    Replay::resolve(&model, &plant, &derivation, log)
}

/// The result, and the estimates.
fn replay(model: &str, recording: &str) -> Result<(Replayed, String), Failure> {
    let mut log = Log::open("log.csv", recording.as_bytes()).map_err(Failure::Unreadable)?;
    let replay = resolve(model, &mut log).expect("the columns have a meaning");
    let mut estimates = Vec::new();
    let replayed = replay.run(&mut log, Some(&mut estimates), &mut |_, _| ControlFlow::Continue(()))?;
    Ok((replayed, String::from_utf8(estimates).expect("a text")))
}

/// The faults of a recording of the cart.
fn faults(recording: &str) -> Vec<String> {
    let (replayed, _) = replay(CART, recording).expect("a replay");
    replayed.faults.iter().map(ToString::to_string).collect()
}

/// The complaint about a recording of the cart that cannot be read.
fn refusal(recording: &str) -> String {
    let failure = replay(CART, recording).expect_err("it cannot be read");
    let mut log = Log::open("log.csv", "t,q,f\n".as_bytes()).expect("a header");
    let diagnostic = resolve(CART, &mut log).expect("the cart").explain(&failure, "log.csv");
    format!("{}: {} | {}", diagnostic.code.name(), diagnostic.message, diagnostic.help.unwrap_or_default())
}

/// The table without most cells of a column: each tenth remains.
fn without_most(csv: &str, name: &str) -> String {
    let (header, rows) = csv.split_once('\n').expect("a header");
    let place = header.split(',').position(|column| column == name).expect("a column");
    let row = |(number, row): (usize, &str)| {
        let mut cells: Vec<&str> = row.split(',').collect();
        if number % 10 != 0 {
            cells[place] = "";
        }
        cells.join(",")
    };
    std::iter::once(header.to_owned()).chain(rows.lines().enumerate().map(row)).collect::<Vec<_>>().join("\n")
}
