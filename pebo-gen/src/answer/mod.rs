//! The whole answer on a model in one call, as a value that serialises.
//!
//! ```text
//! Source, Request -> derive -> report, emit, run -> Answer
//! ```
//!
//! In: a source, and requests beside the verdict. Out: the verdict for programs and for people, every diagnostic with
//! its spans in bytes, and the requested results. Holds after: if a requested result is missing, a diagnostic says why.
//! The command line is this call between reading and writing files; a page or an editor makes the same call. Front ends
//! that need tokens alone call its parts, [`derive_within`] and [`Derived::admitted`](crate::Derived::admitted).

mod filled;
mod framed;
mod page;
#[cfg(feature = "simulate")]
mod replay;
mod request;
#[cfg(feature = "simulate")]
mod run;
mod solve;
mod standing;
mod typeset;

pub use crate::page::Section;
#[cfg(feature = "simulate")]
pub use replay::{Tape, fitted, replay};
#[cfg(feature = "simulate")]
pub use request::RunRequest;
pub use request::{Request, Stage};
#[cfg(feature = "simulate")]
pub use run::{FinalError, Run};
pub use solve::{Solution, solve};
pub use standing::Standing;
pub use typeset::TypesetFormulas;

use std::path::Path;

use serde::Serialize;

use request::Explanation;

#[cfg(feature = "simulate")]
use crate::c_face::{CProject, Samples};
use crate::certificate::certificate;
use crate::derived::{Derived, derive_within};
use crate::emit::Emitted;
#[cfg(feature = "simulate")]
use crate::emit::Scalar;
use crate::report::{self, Report};
use pebo_design::analysis::Outcome;
#[cfg(feature = "simulate")]
use pebo_design::source::Code;
use pebo_design::source::{Diagnostic, Source};
#[cfg(feature = "simulate")]
use pebo_lab::recording::Replayed;

/// The whole answer on a model. Fields are only ever added.
///
/// It serialises, for a page or an editor:
///
/// ```
/// use pebo_gen::source::Source;
/// use pebo_gen::{Request, answer};
///
/// let text = "model: m\nx: [p]\ny: [q]\nf_x: {p: s}\nf_y: {q: p}\n";
/// let answer = answer(&Source::new("m.yaml", text).expect("a short text"), &Request::new());
/// let value = serde_json::to_value(answer).expect("it serialises");
/// assert_eq!(value["standing"], "malformed");
/// let place = &value["diagnostics"][0]["primary"]["span"];
/// assert_eq!(&text[place["start"].as_u64().unwrap() as usize..place["end"].as_u64().unwrap() as usize], "s");
/// ```
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The outcome of the call.
    pub standing: Standing,
    /// The object of `check --format json`.
    pub report: Report,
    /// The verdict in a few lines for people; empty without a plant.
    pub summary: String,
    /// The diagnostics, those of the report first, with spans in bytes.
    pub diagnostics: Vec<Diagnostic>,
    /// The observer as Rust, if it was requested and everything is proved.
    pub emitted: Option<Emitted>,
    /// The crate with a C face around that observer, if it was requested and the settings of the observer are complete.
    #[cfg(feature = "simulate")]
    pub c_project: Option<CProject>,
    /// The derivation as `MathML`, if it was requested.
    pub mathml: Option<TypesetFormulas>,
    /// A Python script that proves the claims again with `SymPy`, if it was requested and everything is proved.
    pub certificate: Option<String>,
    /// A page of HTML that explains the proof, if it was requested and there is a plant, accepted or not.
    pub page: Option<String>,
    /// The sections of that page about the derivation, if they were requested and there is a plant.
    pub sections: Option<Vec<Section>>,
    /// The run of the closed loop, if it was requested and everything is proved.
    #[cfg(feature = "simulate")]
    pub run: Option<Run>,
    /// The replay of recorded data, if the call was for one and everything is proved.
    #[cfg(feature = "simulate")]
    pub replay: Option<Replayed>,
}

/// Checks a model, and does the requested tasks.
///
/// ```
/// use pebo_gen::emit::Scalar;
/// use pebo_gen::source::Source;
/// use pebo_gen::{Request, Standing, answer};
///
/// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\nphi: [p]\n";
/// let source = Source::new("m.yaml", text).expect("a short text");
/// let answer = answer(&source, &Request::new().emit(Scalar::F32));
/// assert_eq!(answer.standing, Standing::Accepted);
/// assert!(answer.report.line().starts_with(r#"{"schema":1,"model":"m","verdict":"accepted""#));
/// assert!(answer.emitted.expect("it is accepted").text.contains("pub struct M"));
/// ```
pub fn answer(source: &Source, request: &Request) -> Answer {
    let derived = match derive_within(source, request.budget()) {
        Ok(derived) => derived,
        Err(diagnostics) => {
            return Answer::of_unread(&stem(source, request), diagnostics, source);
        }
    };
    Answer::on(&derived, source, request)
}

/// The name of a model that is too malformed to say its own.
fn stem(source: &Source, request: &Request) -> String {
    let stem = || Path::new(source.name()).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    request.name.clone().or_else(stem).unwrap_or_default()
}

impl Answer {
    /// The same for a model that was derived before, from this source: nothing is derived again. The call draws from
    /// the budget of the derivation.
    ///
    /// ```
    /// use pebo_gen::source::Source;
    /// use pebo_gen::{Answer, Request, Standing, derive};
    ///
    /// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\nphi: [p]\n";
    /// let source = Source::new("m.yaml", text).expect("a short text");
    /// let derived = derive(&source).expect("it is a model");
    /// let answer = Answer::on(&derived, &source, &Request::new().sections());
    /// assert_eq!(answer.standing, Standing::Accepted);
    /// let sections = answer.sections.expect("they were asked for");
    /// let cascade = sections.iter().find(|section| section.id == "cascade").expect("there are four claims");
    /// assert_eq!(cascade.verdict, Some("proved"));
    /// assert!(cascade.places.iter().any(|place| source.slice(*place) == "v - sin(q)"));
    /// ```
    pub fn on(derived: &Derived, source: &Source, request: &Request) -> Self {
        let mut answer = Self::of(derived, source);
        answer.mathml = request.mathml.then(|| TypesetFormulas::of(derived));
        if derived.derivation.outcome == Outcome::Accepted {
            answer.add(derived, request);
        }
        let known = (answer.diagnostics.as_slice(), answer.emitted.as_ref());
        match request.explained {
            Explanation::Not => {}
            Explanation::Page => {
                let (page, refusal) = page::page(derived, source, request, known);
                answer.page = Some(page);
                if let Some((standing, found)) = refusal {
                    answer.refuse(standing, found);
                }
            }
            Explanation::Sections => answer.sections = Some(page::sections(derived, source, known)),
        }
        answer
    }

    /// Adds the requested results of an accepted model.
    fn add(&mut self, derived: &Derived, request: &Request) {
        if request.certificate {
            self.certificate = certificate(&derived.model, &derived.plant, &derived.derivation);
        }
        if let Some(scalar) = request.scalar {
            match derived.admitted(scalar) {
                Ok(emitted) => {
                    self.diagnostics.extend(derived.cautions(&emitted, scalar));
                    #[cfg(feature = "simulate")]
                    if request.c_project {
                        self.add_c_project(derived, &emitted, scalar);
                    }
                    self.emitted = Some(emitted);
                }
                Err(found) => self.refuse(Standing::of_emission(&found), found),
            }
        }
        #[cfg(feature = "simulate")]
        if let Some(wanted) = &request.run {
            match run::run(derived, request, wanted) {
                Ok((run, advice)) => {
                    self.run = Some(run);
                    self.diagnostics.extend(advice);
                }
                Err((standing, found)) => self.refuse(standing, found),
            }
        }
    }

    /// Adds the crate with a C face.
    #[cfg(feature = "simulate")]
    fn add_c_project(&mut self, derived: &Derived, emitted: &Emitted, scalar: Scalar) {
        let Derived { plant, derivation, model, .. } = derived;
        self.c_project = CProject::of(plant, derivation, (emitted, scalar), &Samples::of(derived));
        if self.c_project.is_none() {
            let message =
                format!("`{}` has no observer to put behind a C face: its settings are incomplete", plant.name);
            let incomplete = Diagnostic::error(Code::CannotEmit, model.name.span, message)
                .help("add a section `observer`, or a section `simulation` that settings can be worked out from");
            self.refuse(Standing::Refused, vec![incomplete]);
        }
    }

    /// The verdict alone.
    fn of(derived: &Derived, source: &Source) -> Self {
        let Derived { plant, derivation, .. } = derived;
        let diagnostics = derived.advised();
        let report = Report::of(plant, derivation, &diagnostics, source);
        Self::saying(derivation.outcome.into(), report, report::summary(plant, derivation), diagnostics)
    }

    /// The answer on a model without a plant, perhaps because there is no text of it; its diagnostics refer to
    /// `source`.
    pub fn of_unread(name: &str, diagnostics: Vec<Diagnostic>, source: &Source) -> Self {
        let report = Report::of_unread(name, &diagnostics, source);
        Self::saying(Standing::of_unread(&diagnostics), report, String::new(), diagnostics)
    }

    /// An answer without requested results.
    fn saying(standing: Standing, report: Report, summary: String, diagnostics: Vec<Diagnostic>) -> Self {
        Self {
            standing,
            report,
            summary,
            diagnostics,
            emitted: None,
            #[cfg(feature = "simulate")]
            c_project: None,
            mathml: None,
            certificate: None,
            page: None,
            sections: None,
            #[cfg(feature = "simulate")]
            run: None,
            #[cfg(feature = "simulate")]
            replay: None,
        }
    }

    /// Records that a requested result is missing.
    fn refuse(&mut self, standing: Standing, found: Vec<Diagnostic>) {
        self.standing = self.standing.max(standing);
        self.diagnostics.extend(found);
    }
}
