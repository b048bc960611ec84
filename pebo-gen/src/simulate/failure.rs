//! Why a run could not go on: a fact, and its wording.

use std::fmt;

use pebo_runtime::Fault;

/// The reason for which a run stopped before its end.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// A value is infinite or NaN.
    NotFinite {
        /// Its name.
        name: String,
        /// When, in seconds.
        at: f64,
    },
    /// The integrator came to a stand: its steps became too short or too many.
    Stuck {
        /// When, in seconds.
        at: f64,
        /// The steps that it has taken from one sample to the next.
        steps: u64,
    },
    /// The observer refused a sample.
    Refused {
        /// When, in seconds.
        at: f64,
        /// Why.
        fault: Fault,
    },
    /// The caller ended the run.
    Stopped {
        /// When, in seconds of the run.
        at: f64,
    },
}

impl Failure {
    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotFinite { .. } => {
                "the loop is unstable or a formula left its domain: check the signs, the start and the control law, or \
                 run it with `feedback: truth`"
            }
            Self::Stuck { .. } => {
                "the plant or a baseline is unstable, left the domain of its formulas, or is too stiff for an explicit \
                 method"
            }
            Self::Refused { .. } => "check the gains, the domain of the observer's formulas, and the step",
            Self::Stopped { .. } => {
                "allow more time, as `--limit 60`, choose a longer step, or simulate a shorter time"
            }
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { name, at } => write!(f, "`{name}` is not a finite number at t = {at} s"),
            Self::Stuck { at, steps } => {
                write!(f, "the integration made no progress at t = {at} s in {steps} steps")
            }
            Self::Refused { at, fault } => write!(f, "the observer refused the sample at t = {at} s: {fault}"),
            Self::Stopped { at } => write!(f, "the run reached its limit at t = {at} s"),
        }
    }
}

impl std::error::Error for Failure {}
