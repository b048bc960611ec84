//! The motion that unknowns need to be identifiable where one instant does not suffice, and the trajectories on which
//! they are hidden.
//!
//! In: a regression whose rows are of full rank over time on almost every trajectory. Out: the same with all inputs
//! constant, and at rest; and simple trajectories on which they are not: inputs that are constant, that are equal, or
//! at a value at which an entry vanishes.
//!
//! The problem is the same as for all trajectories: the rank of the rows with their derivatives. A point proves full
//! rank; otherwise exact algebra gives the directions that no derivative observes. Undecided trajectories are not
//! reported; that there are no others is reported only if each of them provably ends at once.

mod problem;

mod coinciding;
mod losses;
#[cfg(test)]
mod tests;
mod words;

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{Blind, Cascade, Motion, Place, Regression};
use crate::plant::Plant;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Relation, Symbol};

use losses::{MOST_OF_DETERMINANT, is_listed};
use problem::{MOST_PARTS, Question, Restriction, Shown};

pub(super) use problem::seen;

/// Inputs up to which trajectories are tried one by one.
const MOST_INPUTS: usize = 6;

/// For longer rows, the share of the budget for the conditions on parameters.
const FOR_PARAMETERS: u64 = 8;

/// Values of inputs that are tried.
const MOST_VALUES: usize = 8;

/// The necessary motion, and combinations of the parameters whose zeros lower the rank.
pub(super) fn of(plant: &Plant, domain: &Domain, cascade: &Cascade, regression: &Regression) -> (Motion, Vec<Expr>) {
    let arena = &plant.arena;
    let question = Question { plant, domain, cascade, regression, unknowns: regression.eta.len() };
    let inputs: BTreeSet<Symbol> = plant.commanded().collect();
    let held = question.shown(&Restriction { held: inputs.clone(), ..Restriction::default() });
    let by_itself = held.as_ref().ok().map(|shown| shown.hidden.is_empty()).or(inputs.is_empty().then_some(true));
    // Where all signals are constant, so is z, and with it the input of a plain extension.
    let outputs = plant.y.iter().map(|output| output.symbol);
    let extension = plant.chi.iter().copied().filter(|_| cascade.lambda.is_none());
    let still: BTreeSet<Symbol> = inputs.iter().copied().chain(outputs).chain(extension).collect();
    let balanced = Restriction { held: still.clone(), equal: at_rest(plant, domain, cascade) };
    let rest =
        question.shown(&balanced).or_else(|_| question.shown(&Restriction { held: still, ..Restriction::default() }));
    let at_rest = by_itself == Some(true) && rest.as_ref().is_ok_and(|shown| shown.hidden.is_empty());
    let symbols = if regression.is_linear(plant) { &plant.z } else { &regression.eta_symbols };
    let mut blind = Vec::new();
    let mut note = |place: Place, shown: &Result<Shown, Obstacle>| {
        let hidden = shown.as_ref().map_or(&[][..], |shown| shown.hidden.as_slice());
        if !hidden.is_empty() {
            blind.push(Blind { place, seen: seen(arena, symbols, hidden), hidden: hidden.to_vec() });
        }
    };
    match by_itself {
        Some(true) => note(Place::Rest, &rest),
        Some(false) | None => note(Place::Constant(plant.commanded().collect()), &held),
    }
    let free;
    let shown = if let Some(shown) = [&rest, &held].into_iter().flatten().find(|shown| shown.hidden.is_empty()) {
        Some(shown)
    } else {
        free = question.shown(&Restriction::default());
        free.as_ref().ok()
    };
    let special = shown.and_then(|shown| {
        let few = arena.postorder(&shown.stack.concat()).len() <= MOST_OF_DETERMINANT;
        let worked_out = || question.constants(&shown.stack).ok();
        if few { worked_out() } else { arena.budget().share(FOR_PARAMETERS, worked_out) }
    });
    let coincide = || shown.is_some_and(|shown| question.may_coincide(&shown.stack));
    let (constants, all) = special.unwrap_or_default();
    let parameters = all && !coincide();
    let kept = shown.filter(|_| by_itself != Some(true)).map(|shown| question.kept(&shown.stack));
    let unshown = |zero| Blind { place: Place::Unshown(zero), seen: Vec::new(), hidden: Vec::new() };
    let kept: Vec<Blind> = kept.into_iter().flatten().map(unshown).collect();
    let parts = held.as_ref().map_or(usize::MAX, |shown| arena.postorder(&shown.stack.concat()).len());
    let mut everywhere = false;
    if parts <= MOST_PARTS && inputs.len() <= MOST_INPUTS {
        let stack = held.as_ref().map_or(&[][..], |shown| shown.stack.as_slice());
        let mut tried: Vec<(Symbol, Expr)> = Vec::new();
        for (place, restriction) in question.candidates(by_itself == Some(true), stack) {
            if let Place::Value(input, value) = &place {
                tried.push((*input, *value));
            }
            let shown = question.shown(&restriction);
            let is_seen = shown.as_ref().is_ok_and(|shown| shown.hidden.is_empty());
            // Inputs that identify unknowns by their variation do not do so as constants.
            if let (true, Some(true), Place::Value(input, value)) = (is_seen, by_itself, &place) {
                note(Place::Steady(*input, *value), &question.steady(*input, *value));
            }
            note(place, &shown);
        }
        if by_itself == Some(true) {
            for input in inputs.iter().filter(|input| !tried.contains(&(**input, arena.zero()))) {
                let alone = inputs.len() == 1;
                let place = if alone { Place::Value } else { Place::Steady };
                note(place(*input, arena.zero()), &question.steady(*input, arena.zero()));
            }
            for (parameter, value) in question.coincidences(stack, &constants) {
                note(Place::Steady(parameter, value), &question.steady(parameter, value));
            }
            let (doubtful, all) = question.doubtful(&blind, symbols, stack);
            blind.extend(doubtful);
            everywhere = all;
        }
    }
    if by_itself != Some(true) {
        let zeros = question.columns().unwrap_or_default().into_iter();
        let others: Vec<Blind> = zeros.filter(|zero| !is_listed(arena, &blind, *zero)).map(unshown).collect();
        blind.extend(others);
    }
    blind.extend(kept);
    if let Some(shown) = rest.as_ref().ok().filter(|_| at_rest) {
        let known: Vec<Expr> = blind.iter().filter_map(|other| unshown_zero(&other.place)).collect();
        let (doubtful, all) = question.doubtful_at_rest(&shown.stack);
        let others = doubtful.into_iter().filter(|zero| !known.contains(zero));
        blind.extend(others.map(|zero| Blind {
            place: Place::UnshownAtRest(zero),
            seen: Vec::new(),
            hidden: Vec::new(),
        }));
        everywhere &= all;
    }
    (Motion { by_itself, at_rest, blind, everywhere, parameters }, constants)
}

impl Question<'_> {
    /// Candidate trajectories.
    fn candidates(&self, by_itself: bool, stack: &[Vec<Expr>]) -> Vec<(Place, Restriction)> {
        let inputs: Vec<Symbol> = self.plant.commanded().collect();
        let arena = &self.plant.arena;
        let mut found = Vec::new();
        if !by_itself && inputs.len() > 1 {
            for (index, &one) in inputs.iter().enumerate() {
                let held = BTreeSet::from([one]);
                found.push((Place::Constant(vec![one]), Restriction { held, ..Restriction::default() }));
                for &other in &inputs[index + 1..] {
                    let equal = BTreeMap::from([(other, arena.of_symbol(one))]);
                    found.push((
                        Place::Value(one, arena.of_symbol(other)),
                        Restriction { equal, ..Restriction::default() },
                    ));
                }
            }
        }
        for (input, value) in self.values(stack).unwrap_or_default().into_iter().take(MOST_VALUES) {
            let equal = BTreeMap::from([(input, value)]);
            found.push((Place::Value(input, value), Restriction { equal, ..Restriction::default() }));
        }
        found
    }
}

/// The expression of an undecided zero.
fn unshown_zero(place: &Place) -> Option<Expr> {
    match place {
        Place::Unshown(zero) => Some(*zero),
        _ => None,
    }
}

/// The only values of the inputs at which the plant is at equilibrium, and the transform at them: read off the rates
/// without an unmeasured state, which are zero there.
fn at_rest(plant: &Plant, domain: &Domain, cascade: &Cascade) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let hidden = plant.hidden();
    let moves = cascade.h.iter().filter(|_| cascade.lambda.is_none()).copied();
    let mut equal: BTreeMap<Symbol, Expr> = BTreeMap::new();
    for rate in moves.chain(plant.rates().into_values()) {
        let rate = arena.substitute(rate, &equal);
        if arena.depends_on(rate, &hidden) {
            continue;
        }
        let solved = plant.commanded().find_map(|input| {
            let slope = arena.derivative(rate, input);
            let steep =
                arena.symbols_of(&[slope]).is_subset(&constants) && domain.implies(arena, slope, Relation::NonZero);
            let rest = arena.substitute(rate, &BTreeMap::from([(input, arena.zero())]));
            steep.then(|| (input, arena.neg(arena.div(rest, slope))))
        });
        let Some((input, value)) = solved else { continue };
        let value = BTreeMap::from([(input, shortest(arena, domain, value))]);
        for other in equal.values_mut() {
            *other = arena.substitute(*other, &value);
        }
        equal.extend(value);
    }
    equal
}
