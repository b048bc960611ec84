//! Times of the attribute's expansion: reading, proving, emitting; each of the models, medians in ms.
//!
//! Run with `cargo run --release -p tests --example expansion`; without `--release` it is about as fast as the
//! attribute is where a user has not optimised build scripts and macros.

use std::path::Path;
use std::time::{Duration, Instant};

use pebo_gen::derive;
use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;

/// Odd, so that the median is a measured value.
const ROUNDS: usize = 11;

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["../models", "models", "bench/models"].map(|folder| root.join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
    let mut files: Vec<_> =
        files.map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == "yaml")).collect();
    files.sort();
    let mut rows = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (mut proofs, mut emissions) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let text = std::fs::read_to_string(&file).expect("a model of the project");
            let began = Instant::now();
            let derived = derive(&Source::new(name.as_str(), text).expect("a text")).expect("a model");
            let proved = Instant::now();
            derived.emit(Scalar::F64).expect("an accepted model");
            proofs.push(proved - began);
            emissions.push(proved.elapsed());
        }
        rows.push((name, median(proofs), median(emissions)));
    }
    rows.sort_by(|a, b| (b.1 + b.2).total_cmp(&(a.1 + a.2)));
    println!("{:20} {:>14} {:>10} {:>10}", "", "read and prove", "emit", "both");
    for (name, proof, emission) in rows {
        println!("{name:20} {proof:11.1} ms {emission:7.1} ms {:7.1} ms", proof + emission);
    }
}
