//! The JSON object of `solve --format json`, and the same for people.

use indexmap::IndexMap;
use serde::Serialize;

use super::printed;
use pebo_cas::Arena;
use pebo_design::plant::Plant;
use pebo_design::search::words::declared;
use pebo_design::search::{Bound, Candidate, Search};
use pebo_design::source::{Diagnostic, LocatedDiagnostic, Source};

/// The object of one search, which [`SOLVE_SCHEMA`](super::SOLVE_SCHEMA) describes.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct SearchReport {
    schema: u32,
    /// The model's name, or the stem of its file.
    pub model: String,
    /// `found`, `none` or `undecided`.
    pub verdict: &'static str,
    candidates: Vec<CandidateReport>,
    /// The transform that would be accepted with a declaration, if none is accepted as it is.
    assumed: Option<AssumedReport>,
    /// A change of the states that no output shows.
    symmetry: Option<SymmetryReport>,
    bound: Option<BoundReport>,
    /// The bound for transforms affine in x, if it is small.
    bound_affine: Option<BoundReport>,
    /// The bound for transforms affine in x with a generalised cascade.
    bound_generalised: Option<BoundReport>,
    /// Transforms that the bounds of a verdict `none` do not exclude.
    not_excluded: Option<&'static str>,
    tried: Vec<String>,
    diagnostics: Vec<LocatedDiagnostic>,
}

/// A declaration, and the transform that would be accepted with it.
#[derive(Clone, Debug, Serialize)]
struct AssumedReport {
    /// The signs of states or their order, if it is these.
    assume: Vec<String>,
    /// The lines of the model file.
    declare: String,
    phi: Vec<String>,
}

/// The states that move along a direction, with their speeds; or that change their signs or places, with their other values.
#[derive(Clone, Debug, Serialize)]
struct SymmetryReport {
    /// `direction`, `signs` or `exchange`.
    kind: &'static str,
    states: Vec<String>,
    direction: Vec<String>,
}

/// The largest rank of dphi/dx at a point, among transforms of a class with a plain cascade.
#[derive(Clone, Debug, Serialize)]
struct BoundReport {
    states: usize,
    rank: usize,
    class: &'static str,
    proved: bool,
    /// The number of independent transforms of the class up to functions of y, if that is decided.
    transforms: Option<usize>,
    point: IndexMap<String, String>,
    certificate: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
struct CandidateReport {
    class: &'static str,
    phi: Vec<String>,
    h: Vec<String>,
    lambda: Option<Vec<Vec<String>>>,
    verdict: &'static str,
    /// The parameterisation, and the kind of the regression if it is not dynamic.
    regression: Option<&'static str>,
    kind: Option<&'static str>,
    identifiability: Option<&'static str>,
    left_inverse: IndexMap<String, String>,
    /// Conditions that are not assumed.
    conditions: Vec<String>,
}

impl SearchReport {
    /// The object of a search.
    pub fn of(plant: &Plant, search: &Search) -> Self {
        Self {
            schema: 1,
            model: plant.name.clone(),
            verdict: search.verdict.word(),
            candidates: search.candidates.iter().map(candidate).collect(),
            assumed: search.declared.first().map(|(candidate, declaration)| AssumedReport {
                assume: declaration.assumed(&plant.arena),
                declare: declaration.lines(&candidate.plant).replace('`', ""),
                phi: candidate.formulas(),
            }),
            symmetry: search.symmetry.as_ref().map(|symmetry| SymmetryReport {
                kind: symmetry.kind.word(),
                states: symmetry.states.iter().map(|(state, _)| plant.arena.name(*state)).collect(),
                direction: symmetry.entries(&plant.arena),
            }),
            bound: search.bound.as_ref().map(|found| bound(&plant.arena, found)),
            bound_affine: search.affine.as_ref().map(|found| bound(&plant.arena, found)),
            bound_generalised: search.generalised.as_ref().map(|found| bound(&plant.arena, found)),
            not_excluded: search.open(),
            tried: search.tried.iter().map(pebo_design::search::Attempt::sentence).collect(),
            diagnostics: Vec::new(),
        }
    }

    /// The object of a model without a plant.
    pub fn of_unread(name: &str, diagnostics: &[Diagnostic], source: &Source) -> Self {
        Self {
            schema: 1,
            model: name.to_owned(),
            verdict: pebo_design::search::SearchVerdict::Undecided.word(),
            candidates: Vec::new(),
            assumed: None,
            symmetry: None,
            bound: None,
            bound_affine: None,
            bound_generalised: None,
            not_excluded: None,
            tried: Vec::new(),
            diagnostics: diagnostics.iter().map(|d| LocatedDiagnostic::new(d, source)).collect(),
        }
    }

    /// The object as a line, without the line's end.
    pub fn line(&self) -> String {
        // Strings, numbers and maps with string keys always serialise.
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn bound(arena: &Arena, bound: &Bound) -> BoundReport {
    BoundReport {
        states: bound.states,
        rank: bound.rank,
        class: bound.class.word(),
        proved: bound.proved,
        transforms: bound.transforms(),
        point: bound.point.iter().map(|(s, e)| (arena.name(*s), arena.print(*e))).collect(),
        certificate: bound.certificate(arena),
    }
}

fn candidate(candidate: &Candidate) -> CandidateReport {
    let Candidate { plant, derivation, .. } = candidate;
    let arena = &plant.arena;
    let cascade = derivation.cascade.result.as_ref();
    let regression = derivation.regression.result.as_ref();
    let inverse = derivation.left_inverse.result.iter().flat_map(|inverse| &inverse.x);
    CandidateReport {
        class: derivation.class.name(),
        phi: candidate.formulas(),
        h: cascade.map(|c| printed(arena, &c.h)).unwrap_or_default(),
        lambda: cascade.and_then(|c| Some(c.lambda.as_ref()?.iter().map(|row| printed(arena, row)).collect())),
        verdict: derivation.outcome.word(),
        regression: regression.map(|r| r.parameterisation(plant)),
        kind: regression.map(|r| r.kind.word()),
        identifiability: derivation.identifiability.result.as_ref().map(|r| r.kind.word()),
        left_inverse: inverse.map(|(state, e)| (arena.name(*state), arena.print(*e))).collect(),
        conditions: super::conditions(arena, &derivation.conditions),
    }
}

/// A few lines for people: the verdict, then each candidate with its proofs.
pub fn search_summary(plant: &Plant, search: &Search) -> String {
    let mut text = format!("{}: {}\n", plant.name, search.verdict.word());
    for candidate in &search.candidates {
        text.extend([super::text::summary(&candidate.plant, &candidate.derivation).as_str()]);
    }
    text.extend(search.declared.iter().map(|found| format!("  {}\n", declared(found))));
    text.extend(search.symmetry.iter().map(|found| format!("  symmetry: {}\n", found.sentence(&plant.arena))));
    for bound in search.bounds() {
        text.extend([format!("  bound: {}\n", bound.sentence(&plant.arena))]);
        text.extend(bound.certificate(&plant.arena).iter().map(|line| format!("  certificate: {line}\n")));
    }
    if let Some(open) = search.open() {
        text.extend([format!("  not excluded: {open}\n")]);
    }
    for tried in &search.tried {
        text.extend([format!("  tried: {}\n", tried.sentence())]);
    }
    text
}
