//! Settling of the shipped models whose plant steps, beside the baselines of their files: prints the table of
//! models/README.md.
//!
//! Run with `cargo run --release -p tests --example models`.
//!
//! The error of a state is relative to the largest absolute value of the state in the run. Settled: the time from which
//! no error reaches 1 % any more, before the step that the plant makes half way, and from that step on. Noise: the same
//! run with white noise in each output, of 0.1 % of the output's largest absolute value; the largest root mean square
//! of an error in the last quarter.

use std::path::Path;

use pebo_gen::derive;
use pebo_gen::simulate::{Overrides, Trace};
use pebo_gen::source::{Diagnostic, Source};

/// Within this an estimate has settled.
const SETTLED: f64 = 0.01;

/// The noise of a sensor, as a share of the largest output.
const NOISE: f64 = 1e-3;

/// The line before the keys of the simulation.
const SECTION: &str = "\nsimulation:\n";

fn run(text: &str) -> Result<Trace, Vec<Diagnostic>> {
    let derived = derive(&Source::new("model", text).map_err(|found| vec![found])?)?;
    // Every sample.
    let scenario = derived.scenario(&Overrides { every: Some(f64::MIN_POSITIVE), ..Overrides::default() })?;
    scenario.run().map_err(|failure| vec![scenario.explain(&failure)])
}

/// A model that was run without noise and with it.
struct Runs {
    states: Vec<String>,
    observers: Vec<String>,
    quiet: Trace,
    noisy: Trace,
}

impl Runs {
    fn of(text: &str) -> Result<Self, Vec<Diagnostic>> {
        let model = pebo_gen::model::Model::parse(&Source::new("model", text).map_err(|found| vec![found])?)?;
        let names = |list: &[pebo_gen::model::Spanned<String>]| -> Vec<String> {
            list.iter().map(|name| name.value.clone()).collect()
        };
        let baselines = model.simulation.iter().flat_map(|simulation| &simulation.baselines);
        let observers = std::iter::once(String::new()).chain(baselines.map(|entry| entry.name.value.clone()));
        let quiet = run(text)?;
        let noise = names(&model.y).into_iter().map(|y| format!("{y}: {:e}", NOISE * largest(&quiet, &y)));
        let noise = format!("{SECTION}  noise: {{{}}}\n", noise.collect::<Vec<_>>().join(", "));
        let noisy = run(&text.replacen(SECTION, &noise, 1))?;
        Ok(Self { states: names(&model.x), observers: observers.collect(), quiet, noisy })
    }

    /// The largest share of an error, row by row.
    fn shares(&self, trace: &Trace, observer: &str) -> Vec<f64> {
        let mut shares = vec![0.0_f64; trace.rows().count()];
        for state in &self.states {
            let (scale, truth) = (largest(&self.quiet, state), column(trace, state));
            let prefix = if observer.is_empty() { String::new() } else { format!("{observer}.") };
            for ((share, truth), hat) in
                shares.iter_mut().zip(truth).zip(column(trace, &format!("{prefix}{state}_hat")))
            {
                *share = share.max((hat - truth).abs() / scale);
            }
        }
        shares
    }

    fn row(&self, observer: &str) -> String {
        let (time, shares) = (column(&self.quiet, "t"), self.shares(&self.quiet, observer));
        let half = time.last().copied().unwrap_or_default() / 2.0;
        let step = time.iter().position(|t| *t >= half).unwrap_or_default();
        let settled = |from: usize, to: usize| match (from..to).rev().find(|row| shares[*row] >= SETTLED) {
            None => "at once".to_owned(),
            Some(last) if last + 1 == to => "never".to_owned(),
            Some(last) => seconds(time[last + 1] - time[from]),
        };
        let noisy = self.shares(&self.noisy, observer);
        let quarter = &noisy[step + (noisy.len() - step) / 2..];
        let count = u32::try_from(quarter.len()).map_or(f64::NAN, f64::from);
        let square = quarter.iter().map(|share| share * share).sum::<f64>() / count;
        format!("{} | {} | {:.2} %", settled(0, step), settled(step, time.len()), 100.0 * square.sqrt())
    }
}

fn column(trace: &Trace, name: &str) -> Vec<f64> {
    trace.column(name).unwrap_or_default()
}

fn largest(trace: &Trace, name: &str) -> f64 {
    column(trace, name).into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Three digits with a unit.
fn seconds(seconds: f64) -> String {
    let (number, unit) = if seconds < 1.0 { (seconds * 1e3, "ms") } else { (seconds, "s") };
    let digits = if number < 10.0 { 2 } else { usize::from(number < 100.0) };
    format!("{number:.digits$} {unit}")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let mut paths: Vec<_> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../models"))?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.retain(|path| path.extension().is_some_and(|e| e == "yaml"));
    paths.sort();
    println!("| model | observer | settled after the start | after the step | 0.1 % noise |\n|---|---|---|---|---|");
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path)?;
        let is_wanted = wanted.is_empty() || wanted.contains(&name);
        if !text.contains("\n  plant:") || !is_wanted {
            continue;
        }
        match Runs::of(&text) {
            Ok(runs) => {
                for observer in &runs.observers {
                    let shown = if observer.is_empty() { "pebo-gen" } else { observer };
                    println!("| {name} | {shown} | {} |", runs.row(observer));
                }
            }
            Err(found) => {
                for diagnostic in found {
                    println!("| {name} | {}: {:?} |", diagnostic.message, diagnostic.help);
                }
            }
        }
    }
    Ok(())
}
