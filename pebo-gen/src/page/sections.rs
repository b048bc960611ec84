//! The sections of the page about the derivation, each by itself, for a front end with its own order; with the spans of
//! the file that each refers to.

use serde::Serialize;

use pebo_design::analysis::RegressionKind;
use pebo_design::plant::{Formula, Plant, TransformOrigin};
use pebo_design::source::Span;

use super::formula::Setter;
use super::html::Html;
use super::subject::Subject;
use super::{cascade, code, identifiability, left_inverse, plant, regression, transform, usage};

/// A section of the page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Section {
    /// Its subject, as `cascade`.
    pub id: &'static str,
    /// The verdict, if it is about a claim.
    pub verdict: Option<&'static str>,
    /// Elements of `section` with their headings, well-formed as XML too.
    pub html: String,
    /// The author's formulas for it.
    pub places: Vec<Span>,
}

impl Section {
    /// The style sheet of the page that it is a section of.
    pub const STYLE: &str = super::STYLE;
}

/// The sections in the order of the page: plant, transform, the four claims, conditions with remarks, and the code if
/// there is any.
pub(crate) fn sections(subject: &Subject<'_>) -> Vec<Section> {
    let (plant, derivation) = (subject.plant, subject.derivation);
    let setter = Setter::new(&plant.arena);
    let section = |id, verdict, places: Vec<Span>, write: &dyn Fn(&mut Html)| {
        let mut html = Html::default();
        write(&mut html);
        Section { id, verdict, html: html.finish(), places }
    };
    // The author wrote nothing of a transform that the search found.
    let transform = match plant.origin {
        TransformOrigin::Found => Vec::new(),
        TransformOrigin::Lifted { written } => spans(&plant.phi[..written]),
        TransformOrigin::Given | TransformOrigin::Class => spans(&plant.phi),
    };
    let regressed = regressed(subject);
    let moved: Vec<Span> = transform.iter().copied().chain(rates(plant)).collect();
    let inverse: Vec<Span> = transform.iter().copied().chain(given_inverse(plant)).collect();
    let assumed = plant.assumptions.iter().map(|assumption| assumption.span).collect();
    let mut sections = vec![
        section("plant", None, rates(plant).collect(), &|html| plant::section(html, &setter, subject)),
        section("transform", None, transform.clone(), &|html| transform::section(html, &setter, subject)),
        section("cascade", Some(derivation.cascade.verdict.word()), moved, &|html| {
            cascade::section(html, &setter, subject);
        }),
        section("left-inverse", Some(derivation.left_inverse.verdict.word()), inverse, &|html| {
            left_inverse::section(html, &setter, subject);
        }),
        section("regression", Some(derivation.regression.verdict.word()), regressed.clone(), &|html| {
            regression::section(html, &setter, subject);
        }),
        section("identifiability", Some(derivation.identifiability.verdict.word()), regressed, &|html| {
            identifiability::section(html, &setter, subject);
        }),
        section("conditions", None, assumed, &|html| usage::sections(html, &setter, subject)),
    ];
    if subject.emitted.is_some() {
        sections.push(section("code", None, Vec::new(), &|html| code::section(html, subject)));
    }
    for section in &mut sections {
        section.places.retain(|place| *place != Span::NOWHERE && !place.is_empty());
        section.places.sort();
        section.places.dedup();
    }
    sections
}

fn spans(formulas: &[Formula]) -> Vec<Span> {
    formulas.iter().map(|formula| formula.span).collect()
}

/// The rates that enter the rate of the transform: those of the states, and those of the outputs in it.
fn rates(plant: &Plant) -> impl Iterator<Item = Span> {
    let held = plant.arena.symbols_of(&plant.transform());
    let outputs = plant.y.iter().filter(move |output| held.contains(&output.symbol));
    let outputs = outputs.filter_map(|output| Some(output.rate?.span));
    plant.x.iter().map(|state| state.rate.span).chain(outputs)
}

fn given_inverse(plant: &Plant) -> impl Iterator<Item = Span> {
    plant.phi_left.iter().flatten().map(|(_, formula)| formula.span)
}

/// The formulas behind the regression: rates of outputs, or relations between signals.
fn regressed(subject: &Subject<'_>) -> Vec<Span> {
    let plant = subject.plant;
    let rates = |rows: Vec<usize>| -> Vec<Span> {
        rows.into_iter().filter_map(|row| Some(plant.y.get(row)?.rate?.span)).collect()
    };
    match &subject.derivation.regression.result {
        Some(regression) if regression.kind == RegressionKind::Dynamic => rates(regression.rows()),
        Some(_) if !plant.identities.is_empty() => spans(&plant.identities),
        Some(_) => spans(&plant.phi),
        None => rates((0..plant.y.len()).collect()),
    }
}
