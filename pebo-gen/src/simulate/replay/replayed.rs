//! What came of a replay.

use serde::Serialize;

use crate::simulate::score::Score;

use super::fault::FaultCount;

/// What came of a replay.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Replayed {
    /// The rows that were read.
    pub rows: u64,
    /// The samples that the observer accepted.
    pub samples: u64,
    /// When the first row was recorded, in seconds.
    pub start: f64,
    /// When the last accepted sample was recorded, in seconds.
    pub end: f64,
    /// The errors of estimates whose states were measured.
    pub errors: Vec<MeasuredError>,
    /// What the model with the estimates does not explain of the outputs.
    pub residuals: Vec<OutputResidual>,
    /// What was wrong with rows, by kind, in the order in which each occurred first.
    pub faults: Vec<FaultCount>,
    /// The figure as SVG.
    #[serde(skip)]
    pub figure: String,
}

/// How far the estimate of a state is from its measured value.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeasuredError {
    /// The state.
    pub state: String,
    /// Estimate less measured value at the first sample.
    pub start: f64,
    /// Estimate less measured value at the last sample.
    pub end: f64,
    /// How good the estimate is.
    pub score: Score,
}

/// How far an output is from what the model says of it with the estimates.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct OutputResidual {
    /// The output.
    pub output: String,
    /// How large the residual is, held against the output itself.
    pub score: Score,
}
