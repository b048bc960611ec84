//! The reasons why a run stops early, and their wording.

use std::fmt;

use pebo_runtime::Fault;

use crate::summary::short;

/// The reason for which a run stopped before its end.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// A value is infinite or NaN.
    NotFinite {
        /// Its name.
        name: String,
        /// The time, in seconds.
        at: f64,
    },
    /// A state of the plant or of a baseline runs away.
    Diverged {
        /// Its name.
        name: String,
        /// Its last absolute value.
        value: f64,
        /// The time, in seconds.
        at: f64,
    },
    /// The integrator came to a standstill: its steps became too short or too many.
    Stuck {
        /// The time, in seconds.
        at: f64,
        /// The steps that it took from one sample to the next.
        steps: u64,
    },
    /// The run would take the integrator too long.
    Slow {
        /// The time in the run at which that was known, in seconds.
        at: f64,
        /// The steps that it took until then.
        steps: u64,
        /// The fastest state there.
        fastest: String,
        /// Its time constant there, in seconds.
        constant: f64,
    },
    /// The observer refused samples until the end.
    Refused {
        /// The time of the first of them, in seconds.
        at: f64,
        /// Their number.
        samples: u64,
        /// The fault.
        fault: Fault,
    },
    /// The caller ended the run.
    Stopped {
        /// The time in the run, in seconds.
        at: f64,
    },
}

impl Failure {
    /// The help for the user.
    pub fn help(&self) -> &'static str {
        match self {
            Self::NotFinite { name, .. } if name.contains(".hat(") => {
                "a baseline left the domain of the plant's formulas: write under it where it starts, as `initial: {x: 1}`, \
                 which is 0 if left out, or how far off it may be, as `start: {x: 0.2}`"
            }
            Self::NotFinite { .. } => {
                "a formula left its domain: check the start, the control law and the signs, or run it with \
                 `feedback: truth`"
            }
            Self::Diverged { .. } => {
                "the loop is unstable: check the signs of the rates and the control law; if the run with \
                 `--feedback truth` is stable, it is the observer in the loop that makes it so"
            }
            Self::Stuck { .. } => {
                "a formula of the plant or of a baseline left its domain or jumps other than by `sign`, or something in it \
                 is much faster than the rest: leave that out, or let it be slower"
            }
            Self::Slow { .. } => {
                "leave what is so fast out of the model, in its steady state (set its rate to 0, and put what follows for it \
                 into the other formulas), or simulate a shorter time"
            }
            Self::Refused { fault: Fault::Estimate, .. } => {
                "the estimate left the domain of `phi_left`: say under `observer` how far from 0 states may be at the \
                 start, as `start: {x: 0.2}`, where ten times their size is too far; bound the states, as \
                 `within: {lower: 0}`; or let it start nearer, by `extension`"
            }
            Self::Refused { fault: Fault::Output { .. } | Fault::Input { .. }, .. } => {
                "a sample is no finite number: check `noise`, `bias` and the control law"
            }
            Self::Refused { fault: Fault::Singular, .. } => {
                "something in the model settles far within a step, and the observer follows it from sample to sample: leave such \
                 a state out of the model, in its steady state (set its rate to 0, and put what follows for it into the other \
                 formulas), or take a shorter step"
            }
            Self::Refused { .. } => {
                "the observer's equations have no finite value at this sample: check the domain of its formulas at the \
                 start and on the way, the step, and the gains if there are any"
            }
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
            Self::Diverged { name, value, at } => {
                write!(f, "`{name}` grows without end: its magnitude is {} at t = {} s", short(*value), short(*at))
            }
            Self::Stuck { at, steps } => {
                write!(f, "the integration made no progress at t = {at} s in {steps} steps")
            }
            Self::Slow { at, steps, fastest, constant } => write!(
                f,
                "the run would take minutes: {steps} steps of the integration led to t = {} s, as `{fastest}` moves with a time \
                 constant of {} s there",
                short(*at),
                short(*constant)
            ),
            Self::Refused { at, samples, fault } => write!(f, "{}: {fault}", refused(*at, *samples)),
            Self::Stopped { at } => write!(f, "the run reached its limit at t = {at} s"),
        }
    }
}

impl std::error::Error for Failure {}

/// The refused samples, in words.
pub(super) fn refused(at: f64, samples: u64) -> String {
    if samples > 1 {
        format!("the observer refused all {samples} samples from t = {at} s on")
    } else {
        format!("the observer refused the sample at t = {at} s")
    }
}
