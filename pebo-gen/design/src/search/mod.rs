//! Transforms that make a plant's state observation an estimation of constants: the search for phi.
//!
//! ```text
//! Plant, class -> candidates -> claims, proved by `analysis` -> Search
//! ```
//!
//! In: a plant; its own transform, if any, is ignored. Out: the transforms that were found, in order of merit, each
//! with its derivation, and the attempts. Holds after: *found* is said only of a transform whose claims are all proved.
//! Everything before that proof only directs the search: values modulo a prime, null spaces, rules for integrals.
//!
//! It is linear: the rate of `phi = sum of c_k b_k` is linear in the `c_k`, and in dphi, however nonlinear the plant is
//! (Ortega, Bobtsov, Pyrkin, Aranovskiy 2015, eq. 3). Attempts go from simple forms to large ones; the first whose
//! outputs are affine in z ends the search.

mod bounds;
mod integral;
mod problem;

mod ansatz;
mod at_estimate;
mod attempts;
mod candidate;
mod choice;
mod closure;
mod completion;
mod continuous;
mod declaration;
mod found;
mod frame;
mod functions;
mod known;
mod lifted;
mod partial;
mod sample;
mod symmetry;
#[cfg(all(test, feature = "yaml"))]
mod tests;
pub mod words;

use crate::analysis::{AtEstimate, Class, Derivation, Outcome, Verdict};
use crate::plant::{Plant, TransformOrigin};

use attempts::attempted;
pub use bounds::{Bound, BoundClass, Evidence};
use bounds::{LARGEST_ORDER, affine_rates};
pub use candidate::Candidate;
pub use declaration::Declaration;
pub use found::{Attempt, Form, Search, SearchVerdict, Start};
pub use frame::{Block, blocks};
use problem::Problem;
pub use symmetry::{Symmetry, SymmetryKind};
pub use words::settles;

/// Searches for a transform of the plant, of one class of cascade or of any.
///
/// ```
/// use pebo_design::model::Model;
/// use pebo_design::plant::Plant;
/// use pebo_design::search::{SearchVerdict, solve};
/// use pebo_design::source::Source;
///
/// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\n";
/// let model = Model::parse(&Source::new("m.yaml", text).expect("a short text")).expect("a model");
/// let search = solve(&Plant::resolve(&model).expect("a plant"), None);
/// assert_eq!(search.verdict, SearchVerdict::Found);
/// assert_eq!(search.candidates[0].formulas(), ["p"]);
/// ```
#[must_use]
pub fn solve(plant: &Plant, class: Option<Class>) -> Search {
    // Transforms are found without a regression at the estimate, with which any of them would do.
    let exact = Plant { local_regression: None, monotone_regression: false, ..plant.clone() };
    let problem = Problem::of(&exact);
    // The states themselves are tried first where a regression to first order is asked for.
    let near = plant.local_regression.and_then(|_| at_estimate::found(&problem, AtEstimate::Local, &[]));
    let near = near.filter(Candidate::is_full);
    if let Some(near) = near.filter(|near| class.is_none_or(|class| near.derivation.class == class)) {
        return Search::of(near);
    }
    let mut attempts = attempted(&problem, class);
    let (mut candidates, tried) = (std::mem::take(&mut attempts.candidates), std::mem::take(&mut attempts.tried));
    let is_found = |candidates: &[Candidate]| candidates.first().is_some_and(Candidate::is_full);
    if plant.local_regression.is_some() {
        let local = at_estimate::found(&problem, AtEstimate::Local, &candidates);
        candidates.retain(|candidate| local.as_ref().is_none_or(|local| local.formulas() != candidate.formulas()));
        candidates.splice(0..0, local);
    }
    if !is_found(&candidates) && plant.monotone_regression {
        let is_of_class = |found: &Candidate| class.is_none_or(|class| class == found.derivation.class);
        candidates.splice(0..0, at_estimate::monotone(&problem, &candidates).filter(is_of_class));
    }
    if !is_found(&candidates) {
        let known = || known::from_known_start(&problem, class, &accepted);
        candidates.splice(0..0, plant.arena.budget().share(FOR_PRODUCTS, known));
    }
    let found = is_found(&candidates);
    let plain = candidates.iter().any(|c| c.is_full() && c.derivation.class == Class::Pebo);
    let (affine, bound) = if plain || class == Some(Class::Gpebo) {
        (None, None)
    } else {
        let affine = attempts.affine.take().or_else(|| bounds::largest::affine(&problem, 0));
        (affine, attempts.bound.take().or_else(|| bounds::largest::smooth_to(&problem, LARGEST_ORDER, 0)))
    };
    let affine = affine.filter(|affine| affine.rank < affine.states);
    let bound = match bound {
        Some(smooth) if smooth.rank < smooth.states => Some(smooth),
        smooth => affine.clone().or(smooth),
    };
    let smooth = bound.as_ref().is_some_and(|bound| bound.class == BoundClass::Smooth && bound.excludes());
    let generalised = if found || !smooth || class.is_some() {
        None
    } else {
        attempts.generalised.take().or_else(|| affine_rates(&problem, 0)).filter(|bound| bound.rank < bound.states)
    };
    let excluded = smooth
        && (class == Some(Class::Pebo)
            || (generalised.as_ref().is_some_and(Bound::excludes) && problem.suggests_affine_transforms()));
    // A transform may fail at single points, which are then listed: two points that were drawn are not both of them.
    let again = || {
        let smooth = bounds::largest::smooth(&problem, bounds::largest::affine(&problem, 1).as_ref(), 1)
            .filter(Bound::excludes)
            .or_else(|| bounds::largest::smooth_to(&problem, LARGEST_ORDER, 1));
        let generalised = || affine_rates(&problem, 1);
        smooth.is_some_and(|bound| bound.excludes())
            && (class.is_some() || generalised().is_some_and(|bound| bound.excludes()))
    };
    // What outputs do not show, a known start may.
    let is_start_unknown = plant.known.is_empty();
    let excluded = excluded && is_start_unknown && again();
    let symmetry = || plant.arena.budget().share(FOR_SYMMETRY, || symmetry::symmetry(&problem)).ok().flatten();
    let symmetry = if found || !is_start_unknown { None } else { symmetry() };
    let is_asked = plant.local_regression.is_some();
    let admitted = (plant.monotone_regression, is_asked);
    let mut declared = || declared(&problem, &mut candidates, class, symmetry.as_ref(), admitted);
    let declared = if found { Vec::new() } else { declared() };
    // A plant that lacks only a sign or an order is as yet undecided: with its declaration there is an observer.
    let decides = |(_, declaration): &(Candidate, Declaration)| declaration.is_of_domain();
    let is_unobservable = symmetry.as_ref().is_some_and(|symmetry| match symmetry.kind {
        SymmetryKind::Direction => true,
        // Without time, no declaration may have been tried.
        SymmetryKind::Signs | SymmetryKind::Exchange => {
            !plant.arena.budget().is_exhausted() && !declared.iter().any(decides)
        }
    });
    let verdict = match (found, excluded || is_unobservable) {
        (true, _) => SearchVerdict::Found,
        (false, true) => SearchVerdict::None,
        (false, false) => SearchVerdict::Undecided,
    };
    Search { verdict, candidates, symmetry, is_unobservable, declared, bound, affine, generalised, tried }
}

/// The declarations that a plant without an accepted transform lacks, or else a sensor, and what can be had without it. A
/// transform that proves, to first order, that nothing recovers the states comes first among the candidates then.
fn declared(
    problem: &Problem<'_>,
    candidates: &mut Vec<Candidate>,
    class: Option<Class>,
    symmetry: Option<&Symmetry>,
    (admits_monotone, local_is_asked): (bool, bool),
) -> Vec<(Candidate, Declaration)> {
    let is_open = !candidates.iter().any(Candidate::hides_states);
    let helpful = || if is_open { declaration::helpful(problem, candidates, symmetry, class, &accepted) } else { None };
    let helpful = declaration::without_unseen(problem, class, &accepted).or_else(helpful);
    let monotone = || match (is_open, admits_monotone) {
        (true, true) => declaration::with_monotone_rates(problem),
        (true, false) if !local_is_asked => {
            at_estimate::monotone(problem, candidates).map(|found| (found, Declaration::Monotone))
        }
        _ => None,
    };
    let helpful = helpful.or_else(monotone);
    if let Some(helpful) = helpful {
        return vec![helpful];
    }
    // Where two states have the same outputs, a local regression would find either.
    let is_local_of_use = !local_is_asked && symmetry.is_none();
    let local = || at_estimate::found(problem, AtEstimate::Local, candidates);
    match if is_local_of_use && is_open { local() } else { None } {
        Some(local) if local.is_full() => return vec![(local, Declaration::Local)],
        local => candidates.splice(0..0, local).for_each(drop),
    }
    let measured = partial::measured(problem, class, &accepted);
    measured.into_iter().chain(partial::partial(problem, candidates, class, &accepted)).collect()
}

/// The author's transform with functions of its components, where it has a generalised cascade and a left inverse but
/// the outputs are not affine in it; none where that is not accepted.
#[must_use]
pub fn lifted(plant: &Plant, derivation: &Derivation) -> Option<Candidate> {
    if plant.origin != TransformOrigin::Given || derivation.regression.verdict == Verdict::Proved {
        return None;
    }
    let problem = Problem::of(plant);
    plant.arena.budget().share(FOR_PRODUCTS, || lifted::lifted(&problem, plant, derivation))
}

/// The best transform of a plant, if one is accepted that recovers all states.
fn accepted(plant: &Plant, class: Option<Class>) -> Option<Candidate> {
    let problem = Problem::of(plant);
    let candidates = attempted(&problem, class).candidates;
    candidates.into_iter().next().filter(Candidate::is_full)
}

/// A symmetry of a plant whose local observer is accepted: its estimate goes to the nearer of states with the same
/// outputs.
#[must_use]
pub fn symmetry_beside(plant: &Plant, derivation: &Derivation) -> Option<Symmetry> {
    if derivation.outcome != Outcome::Accepted || derivation.at_estimate() != Some(AtEstimate::Local) {
        return None;
    }
    plant.arena.budget().share(FOR_SYMMETRY, || symmetry::symmetry(&Problem::of(plant))).ok().flatten()
}

/// The share of the remaining budget for products of the components of the plant's own transform.
const FOR_PRODUCTS: u64 = 2;

/// The share of the remaining budget for the reason why there is none.
const FOR_SYMMETRY: u64 = 8;
