//! The questions of a page.

use pebo_gen::emit::Scalar;
use pebo_gen::model::Estimator;
use pebo_gen::simulate::Overrides;
use serde::Deserialize;

/// A question. The answer to each is one JSON object.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "what", rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum Question {
    /// The verdict with its diagnostics, the derivation in sections, and the settings of its simulation.
    Check {
        /// The model file.
        text: String,
        /// As of the commands.
        limit: Option<f64>,
    },
    /// The observer as Rust.
    Emit {
        /// The model file.
        text: String,
        /// As of the commands.
        limit: Option<f64>,
        /// `f32` or `f64`.
        scalar: Number,
    },
    /// The closed loop.
    Simulate {
        /// The model file.
        text: String,
        /// As of the commands.
        limit: Option<f64>,
        /// Settings that override the file, each `NAME=VALUE` as of `--set`.
        #[serde(default)]
        set: Vec<String>,
        /// Options of the run.
        #[serde(default)]
        how: RunOptions,
        /// The table of all signals is wanted.
        #[serde(default)]
        csv: bool,
    },
    /// The transforms of the plant.
    Solve {
        /// The model file.
        text: String,
        /// As of the commands.
        limit: Option<f64>,
    },
    /// The observer over recorded data.
    Replay {
        /// The model file.
        text: String,
        /// As of the commands.
        limit: Option<f64>,
        /// The recording's name in messages.
        name: String,
        /// The recording as CSV.
        csv: String,
    },
    /// The story of every diagnostic by its code, as `pebo-gen explain` tells it.
    Stories,
    /// The JSON schema of a model file.
    Schema,
    /// The version of the generator.
    Version,
}

/// The type of numbers in emitted code.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Number {
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl From<Number> for Scalar {
    fn from(number: Number) -> Self {
        match number {
            Number::F32 => Self::F32,
            Number::F64 => Self::F64,
        }
    }
}

/// Options of a run.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct RunOptions {
    seed: Option<u64>,
    initial_error: Option<f64>,
    estimator: Option<Estimator>,
}

impl From<RunOptions> for Overrides {
    fn from(how: RunOptions) -> Self {
        Self { seed: how.seed, initial_error: how.initial_error, estimator: how.estimator, ..Self::default() }
    }
}
