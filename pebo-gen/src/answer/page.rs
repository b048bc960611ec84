//! The content of a page: the verdict, the code for `f64`, and the closed loop if the model describes one.

use crate::derived::Derived;
use crate::emit::{Emitted, Scalar};
use crate::page::{self, Section, Subject};
use pebo_design::analysis::Outcome;
use pebo_design::source::{Diagnostic, Source};

use super::request::Request;
#[cfg(feature = "simulate")]
use super::request::RunRequest;
#[cfg(feature = "simulate")]
use super::run::{self, Run};
use super::standing::Standing;

/// The reason that a part of the page is missing.
type Refusal = (Standing, Vec<Diagnostic>);

/// Writes the page, with the known diagnostics, and the code if it was requested.
pub(super) fn page(
    derived: &Derived,
    source: &Source,
    request: &Request,
    (known, emitted): (&[Diagnostic], Option<&Emitted>),
) -> (String, Option<Refusal>) {
    let mut refusal = None;
    let emitted = match emitted.filter(|_| request.scalar == Some(Scalar::F64)) {
        Some(emitted) => Some(emitted.clone()),
        None if derived.derivation.outcome == Outcome::Accepted && request.scalar != Some(Scalar::F64) => {
            let admitted = derived.admitted(Scalar::F64);
            admitted.map_err(|found| refusal = Some((Standing::of_emission(&found), found))).ok()
        }
        None => None,
    };
    #[cfg(feature = "simulate")]
    let run = emitted.as_ref().and_then(|_| described(derived, request)).map(|run| {
        run.map(|(run, _)| run).map_err(|(standing, found)| {
            let note = |found: Diagnostic| found.note("the page is written without the figure of the closed loop");
            refusal = Some((standing, found.into_iter().map(note).collect()));
        })
    });
    let diagnostics: Vec<Diagnostic> =
        known.iter().chain(refusal.iter().flat_map(|(_, found)| found)).cloned().collect();
    let page = page::page(&Subject {
        source,
        plant: &derived.plant,
        derivation: &derived.derivation,
        diagnostics: &diagnostics,
        emitted: emitted.as_ref(),
        #[cfg(feature = "simulate")]
        run: run.as_ref().map_or(page::Run::Not, |run| {
            run.as_ref().ok().and_then(of_run).map_or(page::Run::Failed, page::Run::Done)
        }),
    });
    (page, refusal)
}

/// The sections of the page about the derivation, with the known diagnostics and code.
pub(super) fn sections(
    derived: &Derived,
    source: &Source,
    (diagnostics, emitted): (&[Diagnostic], Option<&Emitted>),
) -> Vec<Section> {
    page::sections(&Subject {
        source,
        plant: &derived.plant,
        derivation: &derived.derivation,
        diagnostics,
        emitted,
        #[cfg(feature = "simulate")]
        run: page::Run::Not,
    })
}

/// Runs the closed loop that the model describes, if it describes one.
#[cfg(feature = "simulate")]
fn described(derived: &Derived, request: &Request) -> Option<Result<(Run, Vec<Diagnostic>), Refusal>> {
    derived.model.simulation.as_ref()?;
    Some(run::run(derived, request, &RunRequest { figure: true, ..RunRequest::default() }))
}

/// The rows of a run on the page: the table without empty columns.
#[cfg(feature = "simulate")]
fn of_run(run: &Run) -> Option<page::Loop<'_>> {
    let rows = run.summary.rows();
    let filled = |column: usize| rows.iter().any(|row| !row[column].is_empty());
    let shown = |row: &[String; 7]| (0..row.len()).filter(|i| filled(*i)).map(|i| row[i].clone()).collect();
    let errors = rows.iter().map(shown).collect();
    let lines = run.summary.lines().iter().map(|line| line.trim_start().to_owned()).collect();
    Some(page::Loop { figure: run.figure.as_deref()?, end: run.end, errors, lines })
}
