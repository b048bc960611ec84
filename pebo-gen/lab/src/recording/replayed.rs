//! The result of a replay.

use serde::Serialize;

use crate::score::Score;
use crate::summary::{Summary, short};

use super::fault::FaultCount;

/// The result of a replay.
#[derive(Clone, Debug, Serialize)]
pub struct Replayed {
    /// The rows that were read.
    pub rows: u64,
    /// Those of the longest piece of the recording: of it are the summary and the residuals.
    pub scored: u64,
    /// The time of the first of these, in seconds; times of the summary count from there.
    pub start: f64,
    /// True if inputs stand in the outputs of their own row, else in those of the next.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub inputs_at_once: bool,
    /// The errors of estimates whose states were measured, the excitation, and the samples that the observer refused.
    pub summary: Summary,
    /// The residuals of the outputs.
    pub residuals: Vec<OutputResidual>,
    /// The baselines that are given by equations, which only a simulation integrates.
    pub left_out: Vec<String>,
    /// The faults of rows, by kind, in the order of their first occurrence.
    pub faults: Vec<FaultCount>,
    /// The figure as SVG.
    #[serde(skip)]
    pub figure: String,
}

/// The residual of an output: its difference from the model with the estimates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputResidual {
    /// The output.
    pub output: String,
    /// Its unit, if the model has one for it.
    pub unit: Option<String>,
    /// The size of the residual in the last tenth of the recording.
    pub score: Score,
}

impl Replayed {
    /// For people: a table of errors, and a line for each output, and for each kind of fault.
    pub fn text(&self) -> String {
        let Self { rows, scored, start, inputs_at_once, summary, residuals, left_out, faults, .. } = self;
        let mut text = if scored == rows { format!("{rows} rows") } else { format!("{scored} of {rows} rows,") };
        let counted = if *start == 0.0 { "" } else { ", from the first of which times count" };
        let place = format!(" from t = {start} s to {} s{counted}\n", start + summary.end);
        text.push_str(&place);
        text.push_str(&summary.text());
        if *inputs_at_once {
            text.push_str("inputs: sampled with the outputs of their row\n");
        }
        let residual = |OutputResidual { output, unit, score }: &OutputResidual| {
            let unit = unit.as_ref().map_or_else(String::new, |unit| format!(" {unit}"));
            let [rms, worst, since] = [score.rms, score.worst, score.since].map(short);
            format!("residual of {output}: {rms}{unit} rms, {worst}{unit} at worst from t = {since} s on\n")
        };
        text.extend(residuals.iter().map(residual));
        let why = "its equations are integrated with those of a plant, in a simulation alone";
        text.extend(left_out.iter().map(|baseline| format!("not run: the baseline `{baseline}`, as {why}\n")));
        text.extend(faults.iter().map(|fault| format!("{fault}\n")));
        text
    }
}
