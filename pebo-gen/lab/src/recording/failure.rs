//! The reasons why a replay stops early.

use pebo_runtime::Fault;

use pebo_design::source::{Code, Diagnostic, Span};

use super::fault::FaultCount;
use super::log::{Malformed, Unreadable};
use super::scene::Replay;

/// The reason for which a replay gives nothing.
#[derive(Debug)]
pub enum Failure {
    /// The recording could not be read, or not further.
    Unreadable(Unreadable),
    /// The estimates could not be written.
    Unwritten(std::io::Error),
    /// The observer could not be made with its settings.
    Refused(Fault),
    /// The observer accepted no sample.
    Silent {
        /// The number of rows.
        rows: u64,
        /// The faults of the rows.
        faults: Vec<FaultCount>,
        /// The reasons for which the observer refused them.
        refused: Vec<String>,
    },
    /// The caller ended the run.
    Stopped {
        /// The line that had been read.
        line: u64,
    },
}

impl Replay {
    /// A failure of a run as a diagnostic; `name` is that of the recording.
    pub fn explain(&self, failure: &Failure, name: &str) -> Diagnostic {
        match failure {
            Failure::Unreadable(unreadable) => unreadable.explain(name),
            Failure::Unwritten(error) => {
                Diagnostic::error(Code::CannotWrite, Span::NOWHERE, format!("cannot write the estimates: {error}"))
                    .help("check that there is room for a table as long as the recording")
            }
            Failure::Refused(fault) => {
                let message = format!("the observer cannot be made: {fault}");
                Diagnostic::error(Code::SimulationFailed, self.experiment.span, message)
                    .help("check the gains and bounds under `observer`")
            }
            Failure::Silent { rows: 0, .. } => {
                Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, format!("{name} has no rows"))
                    .help("give a recording with a row for each sample, below the header")
            }
            Failure::Silent { rows, faults, refused } => {
                let message = format!("the observer took no sample of the {rows} rows of {name}");
                let silent = Diagnostic::error(Code::SimulationFailed, self.experiment.span, message)
                    .help("check the formulas under `recording` and the units of the columns");
                let reasons = refused.iter().cloned().chain(faults.iter().map(ToString::to_string));
                reasons.fold(silent, Diagnostic::note)
            }
            Failure::Stopped { line } => {
                let message = format!("the replay reached its limit at line {line} of {name}");
                Diagnostic::error(Code::LimitReached, self.experiment.span, message)
                    .help("allow more time, as `--limit 600`, or leave it out")
            }
        }
    }
}

impl Unreadable {
    /// As a diagnostic; `name` is that of the recording.
    pub fn explain(&self, name: &str) -> Diagnostic {
        match self {
            Self::Refused(error) => {
                Diagnostic::error(Code::CannotRead, Span::NOWHERE, format!("cannot read {name}: {error}"))
                    .help("check the path and the permissions")
            }
            Self::Nameless => {
                Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, format!("{name} has no names of columns"))
                    .help("write them in the first line, as `t,v2,d`")
            }
            Self::Malformed(malformed) => {
                let place = match malformed.column {
                    Some(column) => format!("{name}, line {}, column {column}", malformed.line),
                    None => format!("{name}, line {}", malformed.line),
                };
                let Malformed { what, .. } = malformed;
                Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, format!("{place}: {what}"))
                    .help(malformed.help())
            }
        }
    }
}
