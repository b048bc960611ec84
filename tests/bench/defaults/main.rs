//! Observers without a number from their author: for each plant, the time in which its estimates settle to 1 % of the
//! state's largest absolute value, or the reason that they do not.
//!
//! Run with `cargo run --release -p tests --example defaults`; names as `models/cuk` pick out plants.

mod plants;

use pebo_gen::derive;
use pebo_gen::simulate::Overrides;
use pebo_gen::source::{Diagnostic, Source};

/// The row of a plant: its observer, and the result.
fn row(text: &str) -> Result<String, Vec<Diagnostic>> {
    let derived = derive(&Source::new("model", text).map_err(|found| vec![found])?)?;
    let scenario = derived.scenario(&Overrides::default())?;
    let trace = scenario.run().map_err(|failure| vec![scenario.explain(&failure)])?;
    let summary = trace.summary();
    let own: Vec<_> = summary.estimates.iter().filter(|rated| rated.estimate.baseline.is_none()).collect();
    let observer = summary.known.as_ref().map_or("gains", |known| known.observer.as_str());
    let settled = own.iter().map(|rated| {
        let at = rated.score.settled.map_or_else(|| "no".to_owned(), |t| format!("{t:.3e} s"));
        format!("{} {at}", rated.estimate.state)
    });
    let settled = settled.collect::<Vec<_>>().join(", ");
    let reason = scenario.advise(summary).pop().map(|diagnostic| diagnostic.notes.join("; "));
    let verdict = reason.map_or_else(|| "converged".to_owned(), |reason| format!("not converged: {reason}"));
    Ok(format!("{observer} | {settled} | {verdict}"))
}

fn main() -> std::io::Result<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let wanted: Vec<&str> = wanted.iter().map(String::as_str).collect();
    println!("| plant | observer | settled to 1 % | verdict |\n|---|---|---|---|");
    for case in plants::cases(&wanted)? {
        let row = row(&case.text).unwrap_or_else(|found| {
            let messages: Vec<&str> = found.iter().map(|diagnostic| &*diagnostic.message).collect();
            format!("- | - | not run: {}", messages.join("; "))
        });
        println!("| {} | {row} |", case.name);
    }
    Ok(())
}
