//! What came of a replay.

use serde::Serialize;

use crate::score::Score;
use crate::summary::{Summary, short};

use super::fault::FaultCount;

/// What came of a replay.
#[derive(Clone, Debug, Serialize)]
pub struct Replayed {
    /// The rows that were read.
    pub rows: u64,
    /// When the first of them was recorded, in seconds.
    pub start: f64,
    /// The errors of estimates whose states were measured, what the data were good for, and the samples that the observer
    /// refused.
    pub summary: Summary,
    /// What the model with the estimates does not explain of the outputs.
    pub residuals: Vec<OutputResidual>,
    /// What was wrong with rows, by kind, in the order in which each occurred first.
    pub faults: Vec<FaultCount>,
    /// The figure as SVG.
    #[serde(skip)]
    pub figure: String,
}

/// How far an output is from what the model says of it with the estimates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputResidual {
    /// The output.
    pub output: String,
    /// Its unit, if the model has one for it.
    pub unit: Option<String>,
    /// How large the residual is in the last tenth of the recording.
    pub score: Score,
}

impl Replayed {
    /// For people: a table of errors, and a line for each output, and for each kind of fault.
    pub fn text(&self) -> String {
        let Self { rows, start, summary, residuals, faults, .. } = self;
        let mut text = format!("{rows} rows from t = {start} s to {} s\n", summary.end);
        text.push_str(&summary.text());
        let residual = |OutputResidual { output, unit, score }: &OutputResidual| {
            let unit = unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
            let [rms, worst, since] = [score.rms, score.worst, score.since].map(short);
            format!("residual of {output}: {rms}{unit} rms, {worst}{unit} at worst from t = {since} s on\n")
        };
        text.extend(residuals.iter().map(residual));
        text.extend(faults.iter().map(|fault| format!("{fault}\n")));
        text
    }
}
