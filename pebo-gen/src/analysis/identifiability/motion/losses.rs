//! Where rows that have full rank with constant inputs, or at rest, lose it: at values of inputs, at values of parameters, and
//! where a formula of several signals stays zero. It is read off the determinant of the rows, and off their entries.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{Blind, Place};
use crate::analysis::identifiability::flow::Flow;
use crate::analysis::identifiability::singular::Volume;
use crate::cas::facts::Relation;
use crate::cas::field::{Field, Obstacle};
use crate::cas::poly::Poly;
use crate::cas::zero::decide;
use crate::cas::{Arena, Expr, Symbol};

use super::question::{Question, Restriction, seen};

/// Parts of the rows up to which their determinant is worked out.
pub(super) const MOST_OF_DETERMINANT: usize = 150;

impl Question<'_> {
    /// Values of parameters at which rows that have full rank with constant inputs lose it, but for what is a condition.
    pub(super) fn coincidences(&self, stack: &[Vec<Expr>], conditions: &[Expr]) -> Vec<(Symbol, Expr)> {
        let arena = &self.plant.arena;
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return Vec::new();
        }
        let volume = Volume::of(arena, self.domain, stack);
        let places = volume.and_then(|volume| volume.places(self.plant, self.domain)).unwrap_or_default();
        let open = places.constants.into_iter().filter(|formula| !conditions.contains(formula));
        let value = |formula: Expr| {
            let mut parameters = arena.symbols_of(&[formula]).into_iter();
            parameters.find_map(|parameter| Some((parameter, solved(arena, formula, parameter)?)))
        };
        open.filter_map(value).collect()
    }

    /// Where rows that have full rank with constant inputs lose it, but for what is listed: where an input is a function of
    /// others, it is asked what is seen there; the rest was not decided, but for what does not stay zero.
    pub(super) fn doubtful(&self, listed: &[Blind], symbols: &[Symbol], stack: &[Vec<Expr>]) -> Vec<Blind> {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        let volume = Volume::of(arena, domain, stack);
        let places = volume.and_then(|volume| volume.places(plant, domain)).unwrap_or_default();
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let known: BTreeSet<Symbol> = constants.iter().chain(&plant.u).copied().collect();
        let mut found = Vec::new();
        for zero in places.zeros {
            let unshown = || Blind { place: Place::Unshown(zero), seen: Vec::new(), hidden: Vec::new() };
            let symbols_there = arena.symbols_of(&[zero]);
            if !symbols_there.is_subset(&known) {
                let held = plant.u.iter().copied().collect();
                let rate = Flow::along(plant, domain, self.cascade, &held, &BTreeMap::new())
                    .map(|flow| flow.rate(arena, zero));
                let stays = match rate {
                    // What several signals make zero is passed in a moment, unless its rate vanishes there with it.
                    Ok(rate) if symbols_there.difference(&constants).count() > 1 => {
                        symbols_there.iter().any(|symbol| {
                            let there = solved(arena, zero, *symbol).map(|value| BTreeMap::from([(*symbol, value)]));
                            there.is_some_and(|there| decide(arena, arena.substitute(rate, &there), domain).is_zero())
                        })
                    }
                    Ok(rate) => !domain.implies(arena, rate, Relation::NonZero),
                    Err(_) => symbols_there.difference(&constants).count() == 1,
                };
                found.extend(stays.then(unshown));
                continue;
            }
            let Some((input, value)) = plant.u.iter().find_map(|input| Some((*input, solved(arena, zero, *input)?)))
            else {
                found.push(unshown());
                continue;
            };
            let is_listed = |other: &Blind| match &other.place {
                Place::Value(one, at) => arena.is_zero(arena.substitute(zero, &BTreeMap::from([(*one, *at)]))),
                _ => false,
            };
            if listed.iter().any(is_listed) {
                continue;
            }
            let equal = BTreeMap::from([(input, value)]);
            match self.shown(&Restriction { equal, ..Restriction::default() }) {
                Ok(shown) if shown.hidden.is_empty() => {}
                Ok(shown) => found.push(Blind {
                    place: Place::Value(input, value),
                    seen: seen(arena, symbols, &shown.hidden),
                    hidden: shown.hidden,
                }),
                // Where the domain holds no such motion, there is nothing to say.
                Err(Obstacle::NoPoint) => {}
                Err(_) => found.push(unshown()),
            }
        }
        found
    }

    /// What makes rows that have full rank at rest lose it: what several signals make zero stays so there.
    pub(super) fn doubtful_at_rest(&self, stack: &[Vec<Expr>]) -> Vec<Expr> {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return Vec::new();
        }
        let volume = Volume::of(arena, domain, stack);
        let places = volume.and_then(|volume| volume.places(plant, domain)).unwrap_or_default();
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        // What is of inputs alone is looked at on all motions.
        let of_several = |zero: &Expr| {
            let signals: BTreeSet<Symbol> = arena.symbols_of(&[*zero]).difference(&constants).copied().collect();
            signals.len() > 1 && signals.iter().any(|signal| !plant.u.contains(signal))
        };
        places.zeros.into_iter().filter(of_several).collect()
    }

    /// Values of inputs at which an entry vanishes.
    pub(super) fn values(&self, stack: &[Vec<Expr>]) -> Result<Vec<(Symbol, Expr)>, Obstacle> {
        let arena = &self.plant.arena;
        let constants: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        let entries: Vec<Expr> = stack.concat();
        let field = Field::over(arena, &self.domain.facts, &entries)?;
        let mut found = Vec::new();
        for entry in entries {
            for (factor, _) in field.fraction(entry)?.numerator().factored(field.limit())?.factors {
                for &variable in factor.variables().iter().filter(|v| factor.degree(**v) == 1) {
                    let Some(input) = arena.as_symbol(field.kernel(variable)) else { continue };
                    let coefficients = factor.coefficients_in(variable);
                    let (slope, rest) = match coefficients.as_slice() {
                        [(_, slope), (_, rest)] => (slope.clone(), rest.clone()),
                        [(_, slope)] => (slope.clone(), Poly::zero()),
                        _ => continue,
                    };
                    let value = field.show(&field.quotient(&-&rest, &slope)?);
                    let plain = arena.symbols_of(&[value]).is_subset(&constants);
                    if plain && self.plant.u.contains(&input) && !found.contains(&(input, value)) {
                        found.push((input, value));
                    }
                }
            }
        }
        Ok(found)
    }

    /// Combinations of the parameters at which rows that have full rank on some motions lose it on all.
    pub(super) fn constants(&self, stack: &[Vec<Expr>]) -> Vec<Expr> {
        let arena = &self.plant.arena;
        let volume = Volume::of(arena, self.domain, stack);
        let places = volume.and_then(|volume| volume.places(self.plant, self.domain)).unwrap_or_default();
        // Not where other motions show them all the same.
        let lost = |formula: &Expr| {
            let solved = arena
                .symbols_of(&[*formula])
                .into_iter()
                .find_map(|parameter| Some((parameter, solved(arena, *formula, parameter)?)));
            let there = solved.map(|solved| Restriction { equal: BTreeMap::from([solved]), ..Restriction::default() });
            there.is_none_or(|there| self.shown(&there).map_or(true, |shown| !shown.hidden.is_empty()))
        };
        places.constants.into_iter().filter(lost).collect()
    }
}

/// What the symbol is where a formula that is linear in it vanishes.
fn solved(arena: &Arena, formula: Expr, symbol: Symbol) -> Option<Expr> {
    let slope = arena.derivative(formula, symbol);
    let linear = !arena.is_zero(slope) && !arena.depends_on(slope, &BTreeSet::from([symbol]));
    let rest = arena.substitute(formula, &BTreeMap::from([(symbol, arena.zero())]));
    linear.then(|| arena.neg(arena.div(rest, slope)))
}
