//! Judges whether estimates are as certain as wanted.
//!
//! In: the standard errors that an observer predicts for its estimates, as a run goes on, and those that its author
//! wants. Out: the time since which all are as small as wanted, or the one that is not. The words are those of the
//! runtime's [`Monitor`](pebo_runtime::Monitor), which does the same for the unknowns of a regression whose gains are
//! written.

use serde::Serialize;

/// A certainty is lost once a variance is twice the wanted one, so that it does not come and go with every sample.
const LOST: f64 = std::f64::consts::SQRT_2;

/// The certainty of estimates.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub enum Certainty {
    /// Never as well as wanted.
    NotYet {
        /// The state that is known least, relative to its wanted standard error.
        weakest: String,
        /// Its standard error at the end; none where none is predicted.
        error: Option<f64>,
        /// The wanted standard error.
        wanted: f64,
    },
    /// As well as wanted.
    Converged {
        /// The time since then, in seconds.
        since: f64,
    },
    /// No longer as well as wanted.
    Lost {
        /// The time since then, in seconds.
        since: f64,
        /// The state that is known least, relative to its wanted standard error.
        weakest: String,
    },
}

/// The wanted standard error of a state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// The index of its estimate.
    pub(crate) estimate: usize,
    pub(crate) state: String,
    pub(crate) error: f64,
}

/// The certainty as time goes on.
#[derive(Debug)]
pub(crate) struct CertaintyMonitor<'a> {
    wanted: &'a [Wanted],
    known: State,
    /// The one that is known least, with its standard error.
    weakest: Option<(&'a Wanted, f64)>,
}

/// Whether data or estimates are good enough, and since when.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum State {
    #[default]
    NotYet,
    Converged(f64),
    Lost(f64),
}

impl<'a> CertaintyMonitor<'a> {
    /// The certainty before the first sample.
    pub(crate) fn new(wanted: &'a [Wanted]) -> Self {
        Self { wanted, known: State::NotYet, weakest: None }
    }

    /// Takes the standard errors of an instant, where they are known.
    pub(crate) fn look(&mut self, t: f64, errors: Option<&[f64]>) {
        let over = |(wanted, error): &(&Wanted, f64)| error / wanted.error;
        let known = self.wanted.iter().filter_map(|wanted| Some((wanted, *errors?.get(wanted.estimate)?)));
        self.weakest = known.max_by(|a, b| over(a).total_cmp(&over(b)));
        let Some(most) = self.weakest.as_ref().map(over) else { return };
        self.known = match self.known {
            State::NotYet | State::Lost(_) if most <= 1.0 => State::Converged(t),
            State::Converged(_) if most > LOST => State::Lost(t),
            unchanged => unchanged,
        };
    }

    /// The certainty now; none where nothing is wanted.
    pub(crate) fn certainty(&self) -> Option<Certainty> {
        let first = self.wanted.first()?;
        let (weakest, error) = self.weakest.map_or((first, None), |(wanted, error)| (wanted, Some(error)));
        Some(match self.known {
            State::NotYet => Certainty::NotYet { weakest: weakest.state.clone(), error, wanted: weakest.error },
            State::Converged(since) => Certainty::Converged { since },
            State::Lost(since) => Certainty::Lost { since, weakest: weakest.state.clone() },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Certainty, CertaintyMonitor, Wanted};

    #[test]
    fn certainty_comes_and_goes_with_the_standard_errors() {
        let wanted = |estimate: usize, state: &str, error| Wanted { estimate, state: state.to_owned(), error };
        let both = [wanted(1, "p", 0.1), wanted(0, "q", 2.0)];
        let mut following = CertaintyMonitor::new(&both);
        following.look(0.0, None);
        let unknown = Certainty::NotYet { weakest: "p".to_owned(), error: None, wanted: 0.1 };
        assert_eq!(following.certainty(), Some(unknown));
        // One of them is not there yet.
        following.look(1.0, Some(&[3.0, 0.09]));
        let q = Certainty::NotYet { weakest: "q".to_owned(), error: Some(3.0), wanted: 2.0 };
        assert_eq!(following.certainty(), Some(q));
        following.look(2.0, Some(&[1.9, 0.09]));
        // A little worse is not lost: the variance is 1.96 times what is wanted.
        following.look(3.0, Some(&[1.9, 0.14]));
        assert_eq!(following.certainty(), Some(Certainty::Converged { since: 2.0 }));
        following.look(4.0, Some(&[1.9, 0.15]));
        assert_eq!(following.certainty(), Some(Certainty::Lost { since: 4.0, weakest: "p".to_owned() }));
        following.look(5.0, Some(&[1.9, 0.1]));
        assert_eq!(following.certainty(), Some(Certainty::Converged { since: 5.0 }));
        assert_eq!(CertaintyMonitor::new(&[]).certainty(), None);
    }
}
