//! Where the plant rests under a constant input (Ortega et al. 2015, Section 2.5 and remark R5).
//!
//! In: a plant with a proved cascade. Out: states, and inputs where the states leave equations, in those that
//! stay free, with the proof that every rate vanishes there, and with it `h`.
//!
//! The equations are taken one at a time, each for a symbol that is linear in it, which is then replaced
//! in all others; where none is linear, inverse functions may help. Division by what vanishes somewhere can
//! lose operating points, never add one: what comes out is checked by the zero test within the assumed domain.

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::domain::Domain;
use crate::cas::enclosure::Point;
use crate::cas::facts::Relation;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::zero::{Answer, decide};
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;

use super::design::{Cascade, Derivation, Verdict};
use super::solve::{Equation, solve};
use super::tidy::shortest;

/// What is known of where a plant rests.
#[derive(Clone, Debug)]
pub enum Equilibrium {
    /// It rests there: proved.
    At(OperatingPoint),
    /// It rests nowhere, as this state or output never does: proved.
    Nowhere(Symbol),
    /// Neither was shown, for this reason.
    Undecided(String),
}

/// Values at which every rate vanishes.
#[derive(Clone, Debug)]
pub struct OperatingPoint {
    /// Symbols that are determined, in those that are free.
    pub values: Vec<(Symbol, Expr)>,
    /// Whether z' vanishes there too: `h`, of the generalised cascade `Lambda z + h`.
    pub still: bool,
    /// The rank of `[f; h_i]` at almost every point, the same for all i; none where it was not shown. At
    /// the operating point it is 0 if z' vanishes.
    pub rank: Option<usize>,
}

impl Equilibrium {
    /// Looks for the operating points of a plant; none without a proved cascade.
    pub fn of(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved)?;
        Some(found(plant, cascade).unwrap_or_else(|obstacle| Self::Undecided(obstacle.to_string())))
    }
}

fn found(plant: &Plant, cascade: &Cascade) -> Result<Equilibrium, Obstacle> {
    let arena = &plant.arena;
    let domain = plant.domain();
    if let Some(output) = plant.y.iter().find(|output| output.rate.is_none()) {
        return Ok(Equilibrium::Undecided(format!("give the rate of `{}`", arena.name(output.symbol))));
    }
    let rates = plant.rates();
    if let Some((symbol, _)) = rates.iter().find(|(_, rate)| domain.shows(arena, **rate, Relation::NonZero)) {
        return Ok(Equilibrium::Nowhere(*symbol));
    }
    let mut search = Search { plant, domain: &domain, values: BTreeMap::new() };
    if let Some(left) = search.run(rates.values().copied().collect())? {
        let reason = format!("no rule solves `{}` = 0", arena.print(left));
        return Ok(Equilibrium::Undecided(reason));
    }
    let values = search.values;
    let Some(there) = restricted(arena, &domain, &values) else {
        return Ok(Equilibrium::Undecided("no operating point was found within the assumptions".to_owned()));
    };
    let vanishes = |expr: Expr| decide(arena, arena.substitute(expr, &values), &there).is_zero();
    if let Some((symbol, _)) = rates.iter().find(|(_, rate)| !vanishes(**rate)) {
        return Ok(Equilibrium::Undecided(format!("the rate of `{}` was not shown to vanish", arena.name(*symbol))));
    }
    let still = flow(plant, cascade).into_iter().all(vanishes);
    let order = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol));
    let order = order.chain(plant.u.iter().copied()).chain(plant.w.iter().copied());
    let values = order.filter_map(|s| Some((s, shortest(arena, &there, *values.get(&s)?)))).collect();
    Ok(Equilibrium::At(OperatingPoint { values, still, rank: rank(arena, &domain, rates.values()) }))
}

/// z' as the cascade has it: `h`, or `Lambda phi + h`.
fn flow(plant: &Plant, cascade: &Cascade) -> Vec<Expr> {
    let arena = &plant.arena;
    let Some(lambda) = &cascade.lambda else { return cascade.h.clone() };
    let phi = plant.transform();
    let moved = lambda.iter().map(|row| crate::plant::matrix::dot(arena, row, &phi));
    moved.zip(&cascade.h).map(|(moved, h)| arena.add(moved, *h)).collect()
}

/// The rank of the column `[f; h_i]` at almost every point. Of a column it is 1 where an entry is not zero; as
/// `h_i` is a combination of the rates, those decide.
fn rank<'a>(arena: &Arena, domain: &Domain, mut rates: impl Iterator<Item = &'a Expr> + Clone) -> Option<usize> {
    let answers = || rates.clone().map(|rate| decide(arena, *rate, domain));
    if answers().any(|answer| matches!(answer, Answer::NonZero(_))) {
        return Some(1);
    }
    rates.all(|rate| decide(arena, *rate, domain).is_zero()).then_some(0)
}

/// The domain of the symbols that stay free; none unless some point of it is found.
fn restricted(arena: &Arena, domain: &Domain, values: &BTreeMap<Symbol, Expr>) -> Option<Domain> {
    let mut there = Domain { fixed: domain.fixed.clone(), ..Domain::default() };
    let mut constant = Vec::new();
    for (fact, relation) in domain.facts.iter() {
        let fact = arena.substitute(fact, values);
        if relation == Relation::NonNegative && arena.is_zero(fact) {
            continue;
        }
        if arena.symbols_of(&[fact]).is_empty() {
            constant.push((fact, relation));
        } else {
            there.facts.assume(fact, relation);
        }
    }
    let holds = |(fact, relation): &(Expr, Relation)| {
        let value = arena.separated_from_zero(*fact, &BTreeMap::new());
        value.is_some_and(|value| *relation == Relation::NonZero || value.is_positive())
    };
    let mut all: Vec<Expr> = values.values().copied().collect();
    all.extend(there.facts.iter().map(|(fact, _)| fact));
    let exists = |point: &Point| values.values().all(|value| arena.exists_at(*value, point));
    (constant.iter().all(holds) && there.points(arena, &all).any(|point| exists(&point))).then_some(there)
}

/// The equations with what they have determined so far.
struct Search<'a> {
    plant: &'a Plant,
    domain: &'a Domain,
    values: BTreeMap<Symbol, Expr>,
}

/// How little a step of elimination assumes; the least is taken.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Cost {
    /// Whether the symbol's factor holds states, which may vanish.
    bends: bool,
    /// Whether the symbol is an input, which the author would rather choose.
    input: bool,
    /// Whether the factor holds inputs.
    driven: bool,
    /// Terms of factor and rest.
    terms: usize,
}

impl Search<'_> {
    /// Determines symbols until every equation holds; else one that does not.
    fn run(&mut self, mut equations: Vec<Expr>) -> Result<Option<Expr>, Obstacle> {
        let arena = &self.plant.arena;
        loop {
            equations = arena.substitute_all(&equations, &self.values);
            let field = Field::over(arena, &self.domain.facts, &equations)?;
            let mut open = Vec::new();
            for equation in &equations {
                let fraction = field.fraction(*equation)?;
                if !fraction.is_zero() {
                    open.push((field.show(&fraction), fraction));
                }
            }
            let Some((first, _)) = open.first() else { return Ok(None) };
            let next = match self.linear(&field, &open)? {
                Some(next) => Some(next),
                None => self.inverted(&open)?,
            };
            let Some((symbol, value)) = next else { return Ok(Some(*first)) };
            let replaced = BTreeMap::from([(symbol, value)]);
            for known in self.values.values_mut() {
                *known = arena.substitute(*known, &replaced);
            }
            self.values.insert(symbol, value);
            equations = open.into_iter().map(|(equation, _)| equation).collect();
        }
    }

    /// The states, then the inputs, that are not determined.
    fn unknowns(&self) -> [BTreeSet<Symbol>; 2] {
        let plant = self.plant;
        let states = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol));
        let inputs = plant.u.iter().chain(&plant.w).copied();
        [
            states.filter(|s| !self.values.contains_key(s)).collect(),
            inputs.filter(|s| !self.values.contains_key(s)).collect(),
        ]
    }

    /// A symbol that stands to the first power in an equation, in no kernel but itself.
    fn linear(&self, field: &Field<'_>, open: &[(Expr, Fraction)]) -> Result<Option<(Symbol, Expr)>, Obstacle> {
        let arena = field.arena();
        let [states, inputs] = self.unknowns();
        let mut best: Option<(Cost, Symbol, Expr)> = None;
        for (_, fraction) in open {
            let numerator = fraction.numerator();
            for symbol in states.union(&inputs) {
                let kernels = field.kernels_of(&BTreeSet::from([*symbol]));
                let mut kernels = numerator.variables().iter().filter(|kernel| kernels.contains(kernel));
                let (Some(kernel), None) = (kernels.next(), kernels.next()) else { continue };
                if numerator.degree(*kernel) != 1 || arena.as_symbol(field.kernel(*kernel)) != Some(*symbol) {
                    continue;
                }
                let mut factor = Fraction::zero();
                let mut rest = Fraction::zero();
                for (power, coefficient) in numerator.collect(&[*kernel]) {
                    *(if power.is_one() { &mut rest } else { &mut factor }) = field.of_polynomial(&coefficient)?;
                }
                let holds = |symbols: &BTreeSet<Symbol>| {
                    let kernels = field.kernels_of(symbols);
                    factor.variables().any(|kernel| kernels.contains(&kernel))
                };
                let cost = Cost {
                    bends: holds(&states),
                    input: inputs.contains(symbol),
                    driven: holds(&inputs),
                    terms: factor.numerator().term_count() + rest.numerator().term_count(),
                };
                if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                    let value = field.show(&field.div(&rest, &factor)?.opposite());
                    best = Some((cost, *symbol, value));
                }
            }
        }
        Ok(best.map(|(_, symbol, value)| (symbol, value)))
    }

    /// A state that inverse functions give.
    fn inverted(&self, open: &[(Expr, Fraction)]) -> Result<Option<(Symbol, Expr)>, Obstacle> {
        let arena = &self.plant.arena;
        let [states, _] = self.unknowns();
        let unknowns: Vec<Symbol> = states.iter().copied().collect();
        let equations: Vec<Equation> =
            open.iter().map(|(formula, _)| Equation { formula: *formula, value: arena.zero() }).collect();
        let candidates = solve(arena, self.domain, &equations, &unknowns)?;
        let free = |(symbol, values): (Symbol, Vec<Expr>)| {
            let value = values.into_iter().find(|value| !arena.depends_on(*value, &BTreeSet::from([symbol])))?;
            Some((symbol, value))
        };
        Ok(candidates.into_iter().find_map(free))
    }
}
