//! The outcome of a call.

use serde::Serialize;

use pebo_design::analysis::Outcome;
use pebo_design::source::{Code, Diagnostic};

/// The outcome of a call, from best to worst: the exit status of programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Every claim is proved, and every requested result is there.
    Accepted = 0,
    /// The model was read, but a claim is refuted or undecided, or a requested result could not be made.
    Refused = 1,
    /// The input or the call is malformed.
    Malformed = 2,
}

impl Standing {
    /// The outcome for a model without a plant.
    pub(super) fn of_unread(diagnostics: &[Diagnostic]) -> Self {
        match Outcome::of_unread(diagnostics) {
            Outcome::Undecided => Self::Refused,
            Outcome::Accepted | Outcome::Rejected => Self::Malformed,
        }
    }

    /// The outcome for an accepted model that is not emitted: its code cannot be made, or its section `observer` is
    /// wrong.
    pub(super) fn of_emission(found: &[Diagnostic]) -> Self {
        let of_code = |diagnostic: &Diagnostic| matches!(diagnostic.code, Code::CannotEmit | Code::LimitReached);
        if found.iter().all(of_code) { Self::Refused } else { Self::Malformed }
    }
}

impl From<Outcome> for Standing {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Accepted => Self::Accepted,
            Outcome::Rejected | Outcome::Undecided => Self::Refused,
        }
    }
}
