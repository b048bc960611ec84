//! The request about a model in one call.

use std::fmt;
use std::ops::ControlFlow;
use std::rc::Rc;

use crate::emit::Scalar;
use pebo_cas::Budget;
#[cfg(feature = "simulate")]
use pebo_lab::Overrides;

/// Receives the stage of a call, and says whether to go on.
type Watch = dyn Fn(Stage) -> ControlFlow<()>;

/// The tasks of a call beside checking the model, and their budget: none and the usual one, unless it says otherwise.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use pebo_gen::emit::Scalar;
/// use pebo_gen::source::Source;
/// use pebo_gen::{Request, Standing, answer};
///
/// // The code too, in single precision, with two seconds for the proofs; a caller that stops it gets no verdict.
/// let request = Request::new().emit(Scalar::F32).limit(2.0).watch(|_| ControlFlow::Continue(()));
/// let text = "model: m\nx: [p]\ny: [q]\nf_x: {p: 0}\nf_y: {q: p}\n";
/// let answer = answer(&Source::new("m.yaml", text).expect("a short text"), &request);
/// assert_eq!(answer.standing, Standing::Accepted);
/// assert!(answer.emitted.is_some());
/// ```
#[derive(Clone)]
pub struct Request {
    pub(super) name: Option<String>,
    pub(super) seconds: f64,
    pub(super) watch: Option<Rc<Watch>>,
    pub(super) scalar: Option<Scalar>,
    pub(super) mathml: bool,
    pub(super) certificate: bool,
    pub(super) explained: Explanation,
    #[cfg(feature = "simulate")]
    pub(super) c_project: bool,
    #[cfg(feature = "simulate")]
    pub(super) run: Option<RunRequest>,
}

/// The form of an explanation of the proofs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Explanation {
    Not,
    Page,
    Sections,
}

/// The stage of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stage {
    /// It proves, or checks the code that it wrote.
    Proof,
    /// It runs the closed loop.
    Run {
        /// The fraction of the run that is done, 0 to 1.
        done: f64,
        /// The samples of the whole run.
        samples: u64,
    },
    /// It runs the observer over recorded data.
    Replay {
        /// The rows that it has taken.
        rows: u64,
        /// The bytes that it has read.
        bytes: u64,
    },
}

/// The results to keep of a run of the closed loop beside the errors of its estimates.
#[cfg(feature = "simulate")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunRequest {
    /// Settings that override those of the file.
    pub overrides: Overrides,
    /// Keep the table of all signals.
    pub trace: bool,
    /// Draw the figure.
    pub figure: bool,
    /// The number of runs, if more than one: with the seed and those after it. Then there is no table of all signals,
    /// and the figure is about all runs.
    pub runs: Option<u64>,
}

impl Request {
    /// To check the model, and no more.
    pub fn new() -> Self {
        Self {
            name: None,
            seconds: Budget::SECONDS,
            watch: None,
            scalar: None,
            mathml: false,
            certificate: false,
            explained: Explanation::Not,
            #[cfg(feature = "simulate")]
            c_project: false,
            #[cfg(feature = "simulate")]
            run: None,
        }
    }

    /// The name of a model that is too malformed to say its own: the stem of the source's name, unless this is called.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The work that the proofs may take, in seconds of a machine of today: counted in steps, and not by the clock.
    #[must_use]
    pub fn limit(mut self, seconds: f64) -> Self {
        self.seconds = seconds;
        self
    }

    /// A function that decides every few milliseconds of a proof, and some hundred times in a run, whether to go on. A
    /// stopped proof is undecided and a stopped run missing, with a diagnostic.
    #[must_use]
    pub fn watch(mut self, watch: impl Fn(Stage) -> ControlFlow<()> + 'static) -> Self {
        self.watch = Some(Rc::new(watch));
        self
    }

    /// To write the observer too, if everything is proved.
    #[must_use]
    pub fn emit(mut self, scalar: Scalar) -> Self {
        self.scalar = Some(scalar);
        self
    }

    /// To typeset the derivation too.
    #[must_use]
    pub fn mathml(mut self) -> Self {
        self.mathml = true;
        self
    }

    /// To write a script that proves the claims again, if everything is proved.
    #[must_use]
    pub fn certificate(mut self) -> Self {
        self.certificate = true;
        self
    }

    /// To write a page that explains the proofs or the obstacles; with the code for `f64` and the closed loop, if the
    /// model is accepted and describes one.
    #[must_use]
    pub fn page(mut self) -> Self {
        self.explained = Explanation::Page;
        self
    }

    /// To write the sections of that page about the derivation, each by itself and with its spans in the file; the code
    /// is among them if it is requested, and nothing is run for them. A call gives these or the page.
    #[must_use]
    pub fn sections(mut self) -> Self {
        self.explained = Explanation::Sections;
        self
    }

    /// To write a crate with a C face around the observer too, if that is written.
    #[cfg(feature = "simulate")]
    #[must_use]
    pub fn c_project(mut self) -> Self {
        self.c_project = true;
        self
    }

    /// To run the closed loop too, if everything is proved.
    #[cfg(feature = "simulate")]
    #[must_use]
    pub fn run(mut self, run: RunRequest) -> Self {
        self.run = Some(run);
        self
    }

    /// The budget of the proofs, which begin now.
    pub(super) fn budget(&self) -> Budget {
        match self.watch.clone() {
            Some(watch) => Budget::with_watch(self.seconds, move || watch(Stage::Proof).is_break()),
            None => Budget::of_seconds(self.seconds),
        }
    }
}

impl Default for Request {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Debug for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Request").field("seconds", &self.seconds).field("scalar", &self.scalar).finish_non_exhaustive()
    }
}
