//! The transforms of a plant in one call.
//!
//! In: a source, and the wanted class of cascade. Out: the result of the search for programs and for people, and the
//! model with the best transform written into it.

use std::path::Path;

use serde::Serialize;

use crate::report::{SearchReport, search_summary};
use pebo_design::analysis::Class;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::search::{self, SearchVerdict};
use pebo_design::source::{Diagnostic, Source};

use super::filled::filled;
use super::request::Request;
use super::standing::Standing;

/// The answer on the transforms of a plant. Fields are only ever added.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Solution {
    /// The outcome of the call: accepted if a transform was found.
    pub standing: Standing,
    /// The object of `solve --format json`.
    pub report: SearchReport,
    /// The same in a few lines for people; empty without a plant.
    pub summary: String,
    /// The diagnostics, with spans in bytes.
    pub diagnostics: Vec<Diagnostic>,
    /// The text of the model with the best transform for its own, if one was found.
    pub filled: Option<String>,
    /// The text of the model with each candidate for its transform, in their order, where the file has words for it.
    pub texts: Vec<Option<String>>,
}

/// Searches for transforms of a model's plant, whether or not the model has one; of one class of cascade, of the one
/// that the model names, or of any.
///
/// ```
/// use pebo_gen::source::Source;
/// use pebo_gen::{Request, Standing, solve};
///
/// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\n";
/// let solution = solve(&Source::new("m.yaml", text).expect("a short text"), None, &Request::new());
/// assert_eq!(solution.standing, Standing::Accepted);
/// assert!(solution.report.line().starts_with(r#"{"schema":1,"model":"m","verdict":"found""#));
/// assert_eq!(solution.filled.expect("it was found"), format!("{text}phi: [p]\n"));
/// ```
pub fn solve(source: &Source, class: Option<Class>, request: &Request) -> Solution {
    let read = Model::parse(source).and_then(|model| Ok((Plant::resolve_within(&model, request.budget())?, model)));
    let (plant, model) = match read {
        Ok(read) => read,
        Err(diagnostics) => {
            let stem = || Path::new(source.name()).file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let name = request.name.clone().or_else(stem).unwrap_or_default();
            return Solution::of_unread(&name, diagnostics, source);
        }
    };
    let search = search::solve(&plant, class.or(plant.cascade_class));
    let best = search.candidates.first().filter(|_| search.verdict == SearchVerdict::Found);
    let texts: Vec<Option<String>> =
        search.candidates.iter().map(|candidate| filled(source, &model, candidate)).collect();
    Solution {
        standing: if best.is_some() { Standing::Accepted } else { Standing::Refused },
        report: SearchReport::of(&plant, &search),
        summary: search_summary(&plant, &search),
        diagnostics: Vec::new(),
        filled: best.and_then(|_| texts.first().cloned().flatten()),
        texts,
    }
}

impl Solution {
    /// The answer on a model without a plant, perhaps because there is no text of it; its diagnostics refer to
    /// `source`.
    pub fn of_unread(name: &str, diagnostics: Vec<Diagnostic>, source: &Source) -> Self {
        Self {
            standing: Standing::of_unread(&diagnostics),
            report: SearchReport::of_unread(name, &diagnostics, source),
            summary: String::new(),
            diagnostics,
            filled: None,
            texts: Vec::new(),
        }
    }
}
