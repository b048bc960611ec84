//! What has to move for unknowns to be seen that one moment does not show, and on which motions they stay hidden.
//!
//! In: a regression whose rows are of full rank over time on almost every motion. Out: whether they are with all
//! inputs constant, and at rest; and motions, simple enough to be met with, on which they are not: inputs that are
//! constant, that are equal, or at a value at which an entry vanishes.
//!
//! On each of them the same question is asked as of all motions: the rank of the rows with their derivatives. Full, it was
//! seen at a point; less, exact algebra gives the directions that no derivative shows. What could not be decided is not
//! said, nor is it said that there are no others.

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::field::{Field, Obstacle};
use crate::cas::poly::Poly;
use crate::cas::tidy::shortest;
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;

use crate::analysis::design::{Blind, Cascade, Motion, Place, Regression};
use crate::cas::parts::Side;
use crate::cas::rank::{null_vectors, rank_seen};

use super::flow::{Flow, effective, without_psi};
use crate::analysis::identifiability::singular::Volume;

/// Parts of the rows with their derivatives, and inputs, up to which motions are tried one by one.
const MOST_PARTS: usize = 600;
const MOST_INPUTS: usize = 6;

/// Values of inputs that are tried.
const MOST_VALUES: usize = 8;

/// Parts of the rows up to which their determinant is worked out.
const MOST_OF_DETERMINANT: usize = 150;

/// Beyond that, the part of the budget that the conditions on parameters may take.
const FOR_PARAMETERS: u64 = 8;

/// A question about motions of a plant.
struct Question<'a> {
    plant: &'a Plant,
    domain: &'a Domain,
    cascade: &'a Cascade,
    regression: &'a Regression,
    unknowns: usize,
}

/// What is asked of a motion at all times.
#[derive(Default)]
struct Restriction {
    /// Signals that do not move.
    held: BTreeSet<Symbol>,
    /// Inputs as functions of others.
    equal: BTreeMap<Symbol, Expr>,
}

/// What the rows with their derivatives show on a motion.
struct Shown {
    /// Rows that show as much as all derivatives do.
    stack: Vec<Vec<Expr>>,
    /// Directions that they do not show.
    hidden: Vec<Vec<Expr>>,
}

/// What has to move, and combinations of the parameters that must not vanish for the rank to be full.
pub(super) fn of(plant: &Plant, domain: &Domain, cascade: &Cascade, regression: &Regression) -> (Motion, Vec<Expr>) {
    let arena = &plant.arena;
    let question = Question { plant, domain, cascade, regression, unknowns: regression.eta.len() };
    let inputs: BTreeSet<Symbol> = plant.u.iter().copied().collect();
    let held = question.shown(&Restriction { held: inputs.clone(), ..Restriction::default() });
    let by_itself = held.as_ref().ok().map(|shown| shown.hidden.is_empty()).or(inputs.is_empty().then_some(true));
    // Where all signals rest, so does z, and with it what a plain extension integrates.
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
        Some(false) | None => note(Place::Constant(plant.u.clone()), &held),
    }
    let free;
    let shown = match [&rest, &held].into_iter().flatten().find(|shown| shown.hidden.is_empty()) {
        Some(shown) => Some(shown),
        None => {
            free = question.shown(&Restriction::default());
            free.as_ref().ok()
        }
    };
    let special = shown.and_then(|shown| {
        let few = arena.postorder(&shown.stack.concat()).len() <= MOST_OF_DETERMINANT;
        let worked_out = || question.constants(&shown.stack).ok();
        if few { worked_out() } else { arena.budget().share(FOR_PARAMETERS, worked_out) }
    });
    let (constants, parameters) = (special.clone().unwrap_or_default(), special.is_some());
    let parts = held.as_ref().map_or(usize::MAX, |shown| arena.postorder(&shown.stack.concat()).len());
    let mut everywhere = false;
    if parts <= MOST_PARTS && plant.u.len() <= MOST_INPUTS {
        let stack = held.as_ref().map_or(&[][..], |shown| shown.stack.as_slice());
        for (place, restriction) in question.candidates(by_itself == Some(true), stack) {
            let shown = question.shown(&restriction);
            let is_seen = shown.as_ref().is_ok_and(|shown| shown.hidden.is_empty());
            // What the other inputs show by their variation they do not show as constants.
            if let (true, Some(true), Place::Value(input, value)) = (is_seen, by_itself, &place) {
                note(Place::Steady(*input, *value), &question.steady(*input, *value));
            }
            note(place, &shown);
        }
        if by_itself == Some(true) {
            for (parameter, value) in question.coincidences(stack, &constants) {
                note(Place::Steady(parameter, value), &question.steady(parameter, value));
            }
            let (doubtful, all) = question.doubtful(&blind, symbols, stack);
            blind.extend(doubtful);
            everywhere = all;
        }
    }
    if let Some(shown) = rest.as_ref().ok().filter(|_| at_rest) {
        let known: Vec<Expr> = blind.iter().filter_map(|other| unshown_zero(&other.place)).collect();
        let (doubtful, all) = question.doubtful_at_rest(&shown.stack);
        let others = doubtful.into_iter().filter(|zero| !known.contains(zero));
        blind.extend(others.map(|zero| Blind { place: Place::Unshown(zero), seen: Vec::new(), hidden: Vec::new() }));
        everywhere &= all;
    }
    (Motion { by_itself, at_rest, blind, everywhere, parameters }, constants)
}

impl Question<'_> {
    /// What the rows with their derivatives show on the motions that a restriction leaves.
    fn shown(&self, restriction: &Restriction) -> Result<Shown, Obstacle> {
        let &Self { plant, domain, cascade, regression, unknowns } = self;
        let arena = &plant.arena;
        let domain = if restriction.equal.is_empty() {
            domain.clone()
        } else {
            domain.restricted(arena, &restriction.equal).ok_or(Obstacle::NoPoint)?
        };
        let mut flow = Flow::along(plant, &domain, cascade, &restriction.held, &restriction.equal)?;
        let there = |rows: &[Vec<Expr>]| -> Vec<Vec<Expr>> {
            rows.iter().map(|row| arena.substitute_all(row, &restriction.equal)).collect()
        };
        let (phi_1, primitive_1) = (there(&regression.phi_1), there(&regression.primitive_1));
        let mut latest = effective(arena, &flow, &phi_1, &primitive_1);
        let mut stack = without_psi(plant, &latest);
        let mut rank = rank_seen(arena, &domain, &stack, unknowns);
        let mut hidden = None;
        for _ in 1..unknowns {
            if rank == unknowns {
                break;
            }
            let before = stack.clone();
            latest = latest.iter().map(|row| row.iter().map(|e| flow.rate(arena, *e)).collect()).collect();
            stack.extend(without_psi(plant, &latest));
            let next = rank_seen(arena, &domain, &stack, unknowns);
            if next == rank {
                if arena.postorder(&stack.concat()).len() > MOST_PARTS {
                    return Err(Obstacle::TooLarge);
                }
                // No derivative adds to a rank that one derivative did not raise: by exact algebra, both times.
                let vectors = null_vectors(arena, &domain, &stack, unknowns)?;
                if vectors.len() == null_vectors(arena, &domain, &before, unknowns)?.len() {
                    hidden = Some(vectors);
                    break;
                }
            }
            rank = next;
            flow.advance(plant);
        }
        let hidden = match hidden {
            Some(hidden) => hidden,
            None if rank == unknowns => Vec::new(),
            // As many derivatives as there are unknowns show all that any do.
            None if arena.postorder(&stack.concat()).len() > MOST_PARTS => return Err(Obstacle::TooLarge),
            None => null_vectors(arena, &domain, &stack, unknowns)?,
        };
        if hidden.is_empty() && rank < unknowns {
            return Err(Obstacle::NoWitness);
        }
        Ok(Shown { stack, hidden })
    }

    /// What is shown where all inputs are constant, and an input or parameter has a value.
    fn steady(&self, symbol: Symbol, value: Expr) -> Result<Shown, Obstacle> {
        let held = self.plant.u.iter().copied().filter(|input| *input != symbol).collect();
        self.shown(&Restriction { held, equal: BTreeMap::from([(symbol, value)]) })
    }

    /// Values of parameters at which rows that have full rank with constant inputs lose it, but for what is a condition.
    fn coincidences(&self, stack: &[Vec<Expr>], conditions: &[Expr]) -> Vec<(Symbol, Expr)> {
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

    /// Motions that are worth a look.
    fn candidates(&self, by_itself: bool, stack: &[Vec<Expr>]) -> Vec<(Place, Restriction)> {
        let inputs = &self.plant.u;
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

    /// Where rows that have full rank with constant inputs lose it, but for what is listed: where an input is a function of
    /// others, it is asked what is seen there; the rest was not decided. And whether there is no other such motion: what a
    /// motion leaves at once is none, and what several signals make zero is not listed unless it stays so.
    fn doubtful(&self, listed: &[Blind], symbols: &[Symbol], stack: &[Vec<Expr>]) -> (Vec<Blind>, bool) {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        let volume = Volume::of(arena, domain, stack);
        let Ok(places) = volume.and_then(|volume| volume.places(plant, domain)) else { return (Vec::new(), false) };
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let known: BTreeSet<Symbol> = constants.iter().chain(&plant.u).copied().collect();
        let held = plant.u.iter().copied().collect();
        let flow = Flow::along(plant, domain, self.cascade, &held, &BTreeMap::new());
        let mut found = Vec::new();
        let mut all = places.all;
        for zero in places.zeros {
            let unshown = || Blind { place: Place::Unshown(zero), seen: Vec::new(), hidden: Vec::new() };
            let symbols_there = arena.symbols_of(&[zero]);
            if !symbols_there.is_subset(&known) {
                let alone = symbols_there.difference(&constants).count() == 1;
                let rate = flow.as_ref().ok().map(|flow| flow.rate(arena, zero));
                if rate.is_some_and(|rate| self.leaves(zero, rate)) {
                    continue;
                }
                if alone || rate.is_some_and(|rate| self.stays(zero, rate)) {
                    found.push(unshown());
                } else {
                    all = false;
                }
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
        (found, all)
    }

    /// Whether the rows are the same on all motions.
    fn is_constant(&self, stack: &[Vec<Expr>]) -> bool {
        let constants: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        self.plant.arena.symbols_of(&stack.concat()).is_subset(&constants)
    }

    /// Whether what is zero moves on at once, wherever it is.
    fn leaves(&self, zero: Expr, rate: Expr) -> bool {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        let there = |symbol: Symbol| {
            let equal = BTreeMap::from([(symbol, solved(arena, zero, symbol)?)]);
            let is_one = domain.implies(arena, arena.derivative(zero, symbol), Relation::NonZero);
            let domain = domain.restricted(arena, &equal).filter(|_| is_one)?;
            Some(domain.implies(arena, arena.substitute(rate, &equal), Relation::NonZero))
        };
        domain.implies(arena, rate, Relation::NonZero)
            || arena.symbols_of(&[zero]).into_iter().find_map(there).unwrap_or(false)
    }

    /// Whether what is zero stays so: it divides its rate.
    fn stays(&self, zero: Expr, rate: Expr) -> bool {
        let &Self { plant, domain, .. } = self;
        let divides = || -> Result<bool, Obstacle> {
            let field = Field::on(&plant.arena, domain, &[zero, rate])?;
            let (zero, rate) = (field.fraction(zero)?, field.fraction(rate)?);
            Ok(rate.numerator().div_exact(zero.numerator(), field.limit())?.is_some())
        };
        divides().unwrap_or(false)
    }

    /// What makes rows that have full rank at rest lose it, as all that is zero stays so there; and whether nothing else
    /// does.
    fn doubtful_at_rest(&self, stack: &[Vec<Expr>]) -> (Vec<Expr>, bool) {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return (Vec::new(), false);
        }
        let volume = Volume::of(arena, domain, stack);
        let Ok(places) = volume.and_then(|volume| volume.places(plant, domain)) else { return (Vec::new(), false) };
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        // What is of inputs alone is looked at on all motions.
        let of_outputs = |zero: &Expr| {
            let symbols = arena.symbols_of(&[*zero]);
            symbols.difference(&constants).any(|signal| !plant.u.contains(signal))
        };
        (places.zeros.into_iter().filter(of_outputs).collect(), places.all)
    }

    /// Values of inputs at which an entry vanishes.
    fn values(&self, stack: &[Vec<Expr>]) -> Result<Vec<(Symbol, Expr)>, Obstacle> {
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
    fn constants(&self, stack: &[Vec<Expr>]) -> Result<Vec<Expr>, Obstacle> {
        let arena = &self.plant.arena;
        let own: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        if arena.symbols_of(&stack.concat()).is_disjoint(&own) {
            return Ok(Vec::new());
        }
        let places = Volume::of(arena, self.domain, stack)?.places(self.plant, self.domain)?;
        // Not where other motions show them all the same.
        let lost = |formula: &Expr| {
            let solved = arena
                .symbols_of(&[*formula])
                .into_iter()
                .find_map(|parameter| Some((parameter, solved(arena, *formula, parameter)?)));
            let there = solved.map(|solved| Restriction { equal: BTreeMap::from([solved]), ..Restriction::default() });
            there.is_none_or(|there| self.shown(&there).map_or(true, |shown| !shown.hidden.is_empty()))
        };
        Ok(places.constants.into_iter().filter(lost).collect())
    }
}

/// What is zero where nothing was decided.
fn unshown_zero(place: &Place) -> Option<Expr> {
    match place {
        Place::Unshown(zero) => Some(*zero),
        _ => None,
    }
}

/// What the symbol is where a formula that is linear in it vanishes.
fn solved(arena: &Arena, formula: Expr, symbol: Symbol) -> Option<Expr> {
    let slope = arena.derivative(formula, symbol);
    let linear = !arena.is_zero(slope) && !arena.depends_on(slope, &BTreeSet::from([symbol]));
    let rest = arena.substitute(formula, &BTreeMap::from([(symbol, arena.zero())]));
    linear.then(|| arena.neg(arena.div(rest, slope)))
}

/// Inputs that are the only ones with which the plant rests, and the transform with it: read off the rates that hold no
/// unmeasured state, which are zero there.
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
        let solved = plant.u.iter().find_map(|input| {
            let slope = arena.derivative(rate, *input);
            let steep =
                arena.symbols_of(&[slope]).is_subset(&constants) && domain.implies(arena, slope, Relation::NonZero);
            let rest = arena.substitute(rate, &BTreeMap::from([(*input, arena.zero())]));
            steep.then(|| (*input, arena.neg(arena.div(rest, slope))))
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

/// What is seen of the unknowns where these directions are not: combinations that do not change along them. Each direction
/// has a component that is one, and zero in the others.
pub(super) fn seen(arena: &Arena, symbols: &[Symbol], hidden: &[Vec<Expr>]) -> Vec<Expr> {
    let own = |index: usize| {
        (0..symbols.len()).find(|&column| {
            let entry = |(other, vector): (usize, &Vec<Expr>)| {
                vector[column] == if other == index { arena.one() } else { arena.zero() }
            };
            hidden.iter().enumerate().all(entry)
        })
    };
    let free: Vec<Option<usize>> = (0..hidden.len()).map(own).collect();
    let combination = |column: usize| {
        let moved = hidden.iter().zip(&free).filter_map(|(vector, free)| {
            Some(arena.neg(arena.mul(vector[column], arena.of_symbol(symbols[(*free)?]))))
        });
        arena.sum(moved.chain([arena.of_symbol(symbols[column])]))
    };
    (0..symbols.len()).filter(|column| !free.contains(&Some(*column))).map(combination).collect()
}

impl Motion {
    /// Whether there are parts of the domain in which not all unknowns are seen.
    pub fn is_divided(&self) -> bool {
        self.blind.iter().any(|blind| matches!(blind.place, Place::Part(_)))
    }

    /// What has to move, in a line, and where the regression is blind, in a line each.
    pub fn lines(&self, plant: &Plant) -> Vec<String> {
        let first = match (self.by_itself, self.at_rest, self.everywhere) {
            _ if self.is_divided() => {
                "the unknowns are identified on almost every motion that does not stay where one of these holds"
            }
            (Some(true), true, true) if self.blind.is_empty() => {
                "the unknowns are identified without excitation by the inputs, even at rest"
            }
            (Some(true), true, true) => {
                "the unknowns are identified without excitation by the inputs, even at rest, but for these motions"
            }
            (Some(true), true, false) => {
                "the unknowns are identified without excitation by the inputs on almost every motion, and almost wherever \
                 the plant rests"
            }
            (Some(true), false, true) => "the unknowns are identified while the plant moves, also with constant inputs",
            (Some(true), false, false) => {
                "the unknowns are identified on almost every motion, also with constant inputs"
            }
            (Some(false), ..) => "the unknowns are identified under excitation: keep the inputs varying",
            (None, ..) => {
                "the unknowns are identified on almost every motion; it was not decided whether the inputs have to vary"
            }
        };
        let blind = self.blind.iter().map(|blind| blind.line(plant));
        let parameters = (!self.parameters && !plant.parameters.is_empty())
            .then(|| "it was not worked out for which special values of the parameters this is not so".to_owned());
        std::iter::once(first.to_owned()).chain(blind).chain(parameters).collect()
    }
}

impl Blind {
    /// The motion.
    pub fn place(&self, plant: &Plant) -> String {
        self.worded(plant).replace('`', "")
    }

    /// The motion, with formulas as code.
    fn worded(&self, plant: &Plant) -> String {
        let arena = &plant.arena;
        match &self.place {
            Place::Rest => "the plant rests".to_owned(),
            Place::Constant(inputs) if inputs.len() > 1 && inputs.len() == plant.u.len() => {
                "all inputs are constant".to_owned()
            }
            Place::Constant(inputs) => {
                let names: Vec<String> = inputs.iter().map(|input| format!("`{}`", arena.name(*input))).collect();
                format!("{} is constant", names.join(", "))
            }
            Place::Value(input, value) => format!("`{} = {}`", arena.name(*input), arena.print(*value)),
            Place::Steady(symbol, value) => {
                let others = match (plant.u.contains(symbol), plant.u.len()) {
                    (true, 0 | 1) | (false, 0) => "",
                    (true, 2) => "the other input is constant and ",
                    (true, _) => "the other inputs are constant and ",
                    (false, 1) => "the input is constant and ",
                    (false, _) => "the inputs are constant and ",
                };
                format!("{others}`{} = {}`", arena.name(*symbol), arena.print(*value))
            }
            Place::Unshown(zero) => format!("`{} = 0`", arena.print(*zero)),
            Place::Part(sides) => {
                let side = |(expr, side): &(Expr, Side)| format!("`{} {}`", arena.print(*expr), side.sign());
                sides.iter().map(side).collect::<Vec<_>>().join(" and ")
            }
        }
    }

    fn line(&self, plant: &Plant) -> String {
        let seen: Vec<String> = self.seen.iter().map(|e| format!("`{}`", plant.arena.print(*e))).collect();
        if matches!(self.place, Place::Unshown(_)) {
            return format!("while {}, it was not decided what is identified", self.worded(plant));
        }
        let seen = if seen.is_empty() { "nothing".to_owned() } else { format!("only {}", seen.join(", ")) };
        format!("while {}, {seen} is identified", self.worded(plant))
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::{Derivation, Outcome};
    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::Source;

    /// What is said of a plant's motions, and the conditions on its parameters.
    fn of(lines: &str) -> Vec<String> {
        let text = format!("model: m\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
        let result = derivation.identifiability.result.as_ref().expect("proved");
        let mut lines = result.motion.as_ref().expect("over time").lines(&plant);
        lines.extend(result.constants.iter().map(|e| format!("{} != 0", plant.arena.print(*e))));
        lines
    }

    #[test]
    fn inputs_that_are_equal_or_constant_may_hide_unknowns() {
        let phases = "parameters: [r]\nx: [a, b]\ny: [v]\nu: [d, e]\nf_x: {a: -r*a - d*v, b: -r*b - e*v}\n\
                      f_y: {v: d*a + e*b}\nphi: [a, b]\nassume: [r > 0";
        let anywhere = format!("{phases}]");
        let expected = [
            "the unknowns are identified under excitation: keep the inputs varying",
            "while all inputs are constant, only `z1 + e*z2/d` is identified",
            "while `d = e`, only `z1 + z2` is identified",
            "while `d = 0`, only `z2` is identified",
            "while `e = 0`, only `z1` is identified",
        ];
        assert_eq!(of(&anywhere), expected);
        // Assumptions exclude the rest.
        assert_eq!(of(&format!("{phases}, d > 0, e > d]")), expected[..2]);
    }

    #[test]
    fn different_time_constants_tell_unknowns_apart() {
        let cells = "parameters: [r, s]\nassume: [r > 0, s > 0]\nx: [a, b]\ny: [v]\nu: [i]\n\
                     f_x: {a: i - r*a, b: i - s*b}\nf_y: {v: a + b}\nphi: [a, b]";
        assert_eq!(
            of(cells),
            ["the unknowns are identified without excitation by the inputs, even at rest", "r - s != 0"]
        );
    }

    #[test]
    fn a_plant_that_moves_may_need_no_input() {
        let square = "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x^2}\nphi: [x]";
        let lines = of(square);
        assert_eq!(lines[0], "the unknowns are identified while the plant moves, also with constant inputs");
        assert!(lines[1].starts_with("while the plant rests, only `"), "{lines:?}");
        assert!(lines[2].starts_with("while `u = 0`, only `"), "{lines:?}");
        assert_eq!(lines.len(), 3);
        let turned = "x: [q]\ny: [s]\nu: [v]\nf_x: {q: v}\ng_y: {s: sin(q)}\nphi: [sin(q), cos(q)]\nangles: {q: 2*pi}";
        let lines = of(turned);
        assert_eq!(lines[0], "the unknowns are identified while the plant moves, also with constant inputs");
        assert_eq!(lines[1], "while the plant rests, only `z1` is identified");
        let frame = "x: [a, b]\ny: [y]\nu: [w, u]\nf_x: {a: w*b + u, b: -w*a}\nf_y: {y: a}\nphi: [a, b]";
        assert_eq!(
            of(frame),
            [
                "the unknowns are identified without excitation by the inputs, even at rest, but for these motions",
                "while `w = 0`, only `z1` is identified"
            ]
        );
    }

    #[test]
    fn what_constant_inputs_hide_at_a_value_of_one_or_of_a_parameter_is_listed() {
        let wind = "x: [a, k]\ny: [p, q]\nu: [v, r]\nassume: [v > 0]\nf_x: {a: 0, k: 0}\n\
                    f_y: {p: k*v*cos(q) + a, q: r}\nphi: [a, k]";
        let lines = of(wind);
        assert_eq!(lines[0], "the unknowns are identified while the plant moves, also with constant inputs");
        assert_eq!(lines[2], "while the other input is constant and `r = 0`, only `z1 + v*z2*cos(q)` is identified");
        let sum = "parameters: [k, m]\nassume: [k > 0, m > 0, v > 0, w > 0]\nx: [a, b]\ny: [r]\nu: [v, w]\n\
                   f_x: {a: -k*a, b: -m*b}\nf_y: {r: v*a + w*b}\nphi: [a, b]";
        let lines = of(sum);
        assert!(lines[0].ends_with("even at rest, but for these motions"), "{lines:?}");
        assert!(lines[1].starts_with("while the inputs are constant and `k = m`, only"), "{lines:?}");
        // q = v stays, while r moves.
        let pursuit = "x: [p, s]\ny: [r, q]\nu: [v]\nf_x: {p: -v*p, s: -q*s}\nf_y: {r: p + s, q: q - v}\nphi: [p, s]";
        let lines = of(pursuit);
        assert!(lines.iter().any(|line| line.contains("q - v = 0") || line.contains("v - q = 0")), "{lines:?}");
    }

    #[test]
    fn inputs_at_which_rows_with_their_derivatives_lose_rank_are_listed() {
        let but = "the unknowns are identified without excitation by the inputs, even at rest, but for these motions";
        let cells = |rates: &str| format!("parameters: {{k: 2}}\nx: [a, b]\ny: [r]\nu: [v, w]\n{rates}\nphi: [a, b]");
        let told = |rates: &str| of(&cells(&format!("{rates}\nf_y: {{r: a + b}}")));
        assert_eq!(told("f_x: {a: v*a, b: w*b}"), [but, "while `v = w`, only `z1 + z2` is identified"]);
        assert_eq!(told("f_x: {a: -k*v*a, b: -k*b}"), [but, "while `v = 1`, only `z1 + z2` is identified"]);
        assert_eq!(
            told("f_x: {a: -(1 + v^2)*a, b: -(2 + v)*b}"),
            [but, "while `v*(v - 1) - 1 = 0`, it was not decided what is identified"]
        );
        let turned = "x: [a, b]\ny: [q, r]\nu: [v]\nf_x: {a: q*a, b: -q*b}\nf_y: {q: v, r: a + b}\nphi: [a, b]";
        assert_eq!(of(turned), [but, "while `q = 0`, it was not decided what is identified"]);
    }

    /// A heat exchanger with an unknown area: without a difference of temperatures it transfers nothing, for ever at rest.
    #[test]
    fn what_several_signals_hide_at_rest_is_listed() {
        let exchanger = "x: [T, k]\ny: [S]\nu: [v, w]\nassume: [k > 0]\nf_x: {T: v - T - k*(T - S), k: 0}\n\
                         f_y: {S: w - S + k*(T - S)}\nphi: [k, k*(T + S)]";
        let lines = of(exchanger);
        assert!(lines[0].ends_with("almost wherever the plant rests"), "{lines:?}");
        assert!(lines[1].ends_with("= 0`, it was not decided what is identified"), "{lines:?}");
        assert_eq!(lines.len(), 2, "{lines:?}");
    }

    /// No motion is passed over in silence: what is said of all motions was seen to hold on all.
    #[test]
    fn motions_that_several_signals_keep_to_are_listed_or_not_spoken_of() {
        let almost = "the unknowns are identified on almost every motion, also with constant inputs";
        // A limit cycle, on which q^2 + w^2 stays 1.
        let cycle = "x: [p, s]\ny: [q, w, r]\nf_x: {p: 0, s: 0}\nphi: [p, s]\n\
                     f_y: {q: w + q*(1 - q^2 - w^2), w: -q + w*(1 - q^2 - w^2), r: p + s*(q^2 + w^2)}";
        let lines = of(cycle);
        assert!(lines.iter().any(|line| line.starts_with("while `") && line.contains("= 0`, it was not")), "{lines:?}");
        // Two axes, of which one may hold still.
        let axes = "x: [a, g, b, k]\ny: [q, v, r, w]\nu: [m, n]\nf_x: {a: 0, g: 0, b: 0, k: 0}\n\
                    f_y: {q: v, v: m - a*v - g*cos(q), r: w, w: n - b*w - k*cos(r)}\nphi: [a, g, b, k]";
        assert_eq!(of(axes)[0], almost);
    }

    /// Competing species at the concentration at which both grow alike.
    #[test]
    fn outputs_at_which_the_plant_rests_unseen_are_listed() {
        let species = "x: [p, s]\ny: [q, r]\nu: [v]\nf_x: {p: -q*p, s: -s}\nf_y: {q: v - q, r: p + q*s}\nphi: [p, s]";
        let lines = of(species);
        assert!(lines.len() > 1 && lines[1..].iter().any(|line| line.contains("q")), "{lines:?}");
    }
}
