//! The observer of a model over recorded data, in one call.
//!
//! In: a source, a budget, and a recording. Out: the answer on the model, and the result of the replay; or the
//! diagnostics of a refused model, of missing columns, or of a malformed row.

use std::io::{Read, Write};
use std::ops::ControlFlow;

use crate::derived::{Derived, derive_within};
use pebo_design::analysis::Outcome;
use pebo_design::source::{Diagnostic, Source};
use pebo_lab::recording::{Failure, FittedNumbers, Log, Replayed, Unreadable};

use super::request::{Request, Stage};
use super::standing::Standing;
use super::{Answer, stem};

/// A recording, and the sink of the estimates.
pub struct Tape<'a> {
    /// The recording's name in messages.
    pub name: &'a str,
    /// The recording as CSV; read row by row.
    pub recording: &'a mut dyn Read,
    /// Takes the estimates as CSV, row by row; they are of use only if there is a replay in the answer.
    pub estimates: Option<&'a mut dyn Write>,
}

/// Checks a model, and runs its observer over a recording if everything is proved; other requests are ignored here.
///
/// ```
/// use pebo_gen::source::Source;
/// use pebo_gen::{Request, Standing, Tape, replay};
///
/// let text = "model: m\nx: [p]\ny: [q]\nf_x: {p: -p}\nf_y: {q: p}\nphi: [p]\nobserver: {gain: 1, filter: 1}\n";
/// let source = Source::new("m.yaml", text).expect("a short text");
/// let mut recording = "t,q\n0,0\n0.1,0.095\n0.2,0.181\n".as_bytes();
/// let mut estimates = Vec::new();
/// let tape = Tape { name: "log.csv", recording: &mut recording, estimates: Some(&mut estimates) };
/// let answer = replay(&source, &Request::new(), tape);
/// assert_eq!(answer.standing, Standing::Accepted);
/// assert_eq!(answer.replay.expect("a replay").rows, 3);
/// assert!(estimates.starts_with(b"t,p_hat\n0,0\n0.1,"));
/// ```
pub fn replay(source: &Source, request: &Request, tape: Tape<'_>) -> Answer {
    let derived = match derive_within(source, request.budget()) {
        Ok(derived) => derived,
        Err(diagnostics) => return Answer::of_unread(&stem(source, request), diagnostics, source),
    };
    Answer::replayed_on(&derived, source, request, tape)
}

/// Finds the standard deviations of sensors and disturbances with which a model's observer makes the first rows of a
/// recording most likely: name and text of the recording, with its header. None where not everything is proved; `watch`
/// gets the number of replays so far, and may end the search with what it has.
///
/// # Errors
/// The diagnostics of missing columns, of a malformed row, or of an observer of written gains.
pub fn fitted(
    source: &Source,
    request: &Request,
    (recording, sought): ((&str, &[u8]), &[String]),
    watch: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<Option<FittedNumbers>, Vec<Diagnostic>> {
    match derive_within(source, request.budget()) {
        Ok(derived) if derived.derivation.outcome == Outcome::Accepted => {
            derived.fitted(recording, sought, watch).map(Some)
        }
        _ => Ok(None),
    }
}

impl Answer {
    /// The same for a model that was derived before, from this source: nothing is derived again.
    pub fn replayed_on(derived: &Derived, source: &Source, request: &Request, tape: Tape<'_>) -> Self {
        let mut answer = Self::of(derived, source);
        if derived.derivation.outcome == Outcome::Accepted {
            match run(derived, request, tape) {
                Ok((replayed, advice)) => {
                    answer.replay = Some(replayed);
                    answer.diagnostics.extend(advice);
                }
                Err((standing, found)) => answer.refuse(standing, found),
            }
        }
        answer
    }
}

/// Runs the observer; flaws of the call, the model or the recording are the caller's mistakes. Gives the replay with
/// diagnostics if it did not converge.
fn run(
    derived: &Derived,
    request: &Request,
    tape: Tape<'_>,
) -> Result<(Replayed, Vec<Diagnostic>), (Standing, Vec<Diagnostic>)> {
    let unreadable = |found: Unreadable| (Standing::Malformed, vec![found.explain(tape.name)]);
    let mut log = Log::open(tape.name, tape.recording).map_err(unreadable)?;
    let replay = derived.replay(&mut log).map_err(|found| (Standing::Malformed, found))?;
    let mut watch = |rows, bytes| match &request.watch {
        Some(watch) => watch(Stage::Replay { rows, bytes }),
        None => ControlFlow::Continue(()),
    };
    let replayed = replay.run(&mut log, tape.estimates, &mut watch).map_err(|failure| {
        let standing = match failure {
            Failure::Unreadable(_) | Failure::Unwritten(_) | Failure::Silent { rows: 0, .. } => Standing::Malformed,
            _ => Standing::Refused,
        };
        (standing, vec![replay.explain(&failure, tape.name)])
    })?;
    let advice = replay.advise(&replayed);
    Ok((replayed, advice))
}
