//! The search problem: a plant without its transform, and the kinds of its signals.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Domain, Expr, Node, Relation, Symbol};

/// A plant whose transform is looked for.
#[derive(Debug)]
pub(super) struct Problem<'a> {
    pub(super) plant: &'a Plant,
    pub(super) arena: &'a Arena,
    /// The domain of the model: where its own formulas have values.
    pub(super) domain: Domain,
    pub(super) rates: BTreeMap<Symbol, Expr>,
    /// The unmeasured states that are looked for.
    pub(super) x: Vec<Symbol>,
    /// The outputs that a transform may hold: those with a rate.
    pub(super) y: Vec<Symbol>,
    /// The states and unmeasured signals: no rate of a transform may depend on them.
    pub(super) hidden: BTreeSet<Symbol>,
    /// All that is no constant.
    pub(super) signals: BTreeSet<Symbol>,
}

impl<'a> Problem<'a> {
    pub(super) fn of(plant: &'a Plant) -> Self {
        Self::knowing(plant, &BTreeMap::new())
    }

    /// The problems for the other states where outputs determine some by their value, alone or with states that remain
    /// unmeasured. An output that is a function of several states determines one of them; which, differs between the
    /// problems.
    pub(super) fn with_measured_states(plant: &'a Plant) -> Vec<Self> {
        let states: BTreeSet<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let values = plant.y.iter().filter_map(|output| output.value.as_ref());
        let count = |value: Expr| plant.arena.symbols_of(&[value]).intersection(&states).count();
        let turns = values.map(|value| count(value.expr)).max().unwrap_or(0);
        let mut known: Vec<BTreeMap<Symbol, Expr>> = Vec::new();
        for turn in 0..turns {
            let measured = measured(plant, turn);
            if !measured.is_empty() && measured.len() < plant.x.len() && !known.contains(&measured) {
                known.push(measured);
            }
        }
        known.iter().map(|measured| Self::knowing(plant, measured)).collect()
    }

    /// The problem where some states are functions of outputs and of the other states.
    fn knowing(plant: &'a Plant, measured: &BTreeMap<Symbol, Expr>) -> Self {
        let states = plant.x.iter().map(|state| state.symbol);
        let x: Vec<Symbol> = states.filter(|state| !measured.contains_key(state)).collect();
        let moving = plant.y.iter().filter(|output| output.rate.is_some());
        let mut hidden = plant.hidden();
        hidden.retain(|symbol| !measured.contains_key(symbol));
        let outputs = plant.y.iter().map(|output| output.symbol);
        let signals = plant.hidden().into_iter().chain(outputs).chain(plant.u.iter().copied()).collect();
        let rates = plant.rates().into_iter().map(|(symbol, rate)| (symbol, plant.arena.substitute(rate, measured)));
        Self {
            plant,
            arena: &plant.arena,
            domain: plant.domain(),
            rates: rates.collect(),
            y: moving.map(|output| output.symbol).collect(),
            x,
            hidden,
            signals,
        }
    }

    /// The rate of a function of states and outputs.
    pub(super) fn rate(&self, expr: Expr) -> Expr {
        self.arena.directional(expr, &self.rates)
    }

    /// The rates of the outputs that a transform may hold.
    pub(super) fn output_rates(&self) -> Vec<Expr> {
        self.y.iter().filter_map(|symbol| self.rates.get(symbol).copied()).collect()
    }

    /// The states as a set.
    pub(super) fn states(&self) -> BTreeSet<Symbol> {
        self.x.iter().copied().collect()
    }

    /// Tests whether a function has values and derivatives on the whole domain, except perhaps at the zeros of some
    /// formulas, which the proof of the claims then lists.
    pub(super) fn exists(&self, expr: Expr) -> bool {
        let conditions = self.arena.domain_conditions(&[expr], Regularity::Differentiable);
        conditions.into_iter().all(|(part, relation)| match relation {
            Relation::NonZero => !self.arena.is_zero(part),
            Relation::NonNegative => self.domain.implies(self.arena, part, relation),
            // A nonnegative expression is positive except at its zeros.
            Relation::Positive => {
                !self.arena.is_zero(part) && self.domain.implies(self.arena, part, Relation::NonNegative)
            }
        })
    }

    /// Tests whether a function is non-smooth or jumps where a combination of the unmeasured states passes zero: theta
    /// would be another constant behind a jump, and no proof that omits the point reveals it.
    pub(super) fn is_non_smooth_in_states(&self, expr: Expr) -> bool {
        let hidden = |part: Expr| self.arena.depends_on(part, &self.hidden);
        self.arena.dividers(&[expr]).into_iter().any(hidden)
    }

    /// Tests whether nothing suggests components that are not affine in x: the rates are written as polynomials in
    /// hidden symbols, and no state is an unknown constant, which may multiply others.
    pub(super) fn suggests_affine_transforms(&self) -> bool {
        let is_constant = |state: &Symbol| self.rates.get(state).is_some_and(|rate| self.arena.is_zero(*rate));
        if self.x.len() > 1 && self.x.iter().any(is_constant) {
            return false;
        }
        let rates: Vec<Expr> = self.rates.values().copied().collect();
        self.arena.postorder(&rates).into_iter().all(|part| match self.arena.node(part) {
            Node::Call(..) => !self.arena.depends_on(part, &self.hidden),
            Node::Product(product) => product.factors.iter().all(|(base, exponent)| {
                (exponent.is_integer() && !exponent.is_negative()) || !self.arena.depends_on(*base, &self.hidden)
            }),
            _ => true,
        })
    }

    /// Tests whether some budget is left.
    pub(super) fn goes_on(&self) -> bool {
        !self.arena.budget().is_exhausted()
    }
}

/// States that outputs with a rate determine by their value, as functions of these and of the remaining states: `th` by
/// `m = th`, `p` or `b` by `m = p + b`, `i` by `m = k*i`. In the rates they are measured. An output determines one of its states, in the
/// first turn the first that moves, in each further turn the next.
fn measured(plant: &Plant, turn: usize) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let domain = plant.domain();
    let states: BTreeSet<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let rates = plant.rates();
    let is_constant = |state: &Symbol| rates.get(state).is_some_and(|rate| arena.is_zero(*rate));
    let values = plant.y.iter().filter(|output| output.rate.is_some());
    let mut values: Vec<(Symbol, Expr)> = values.filter_map(|y| Some((y.symbol, y.value.as_ref()?.expr))).collect();
    // A state determined by an output alone is known in the values of outputs of several states.
    values.sort_by_key(|(_, value)| arena.symbols_of(&[*value]).intersection(&states).count());
    let mut found: BTreeMap<Symbol, Expr> = BTreeMap::new();
    for (output, value) in values {
        let value = arena.substitute(value, &found);
        let symbols = arena.symbols_of(&[value]);
        let is_known = |symbol: &Symbol| {
            states.contains(symbol) || parameters.contains(symbol) || plant.y.iter().any(|y| y.symbol == *symbol)
        };
        if !symbols.iter().all(is_known) {
            continue;
        }
        let is_steep = |state: &Symbol| {
            let slope = arena.derivative(value, *state);
            let is_affine = !arena.depends_on(slope, &BTreeSet::from([*state])) && !arena.is_zero(slope);
            is_affine && domain.implies(arena, slope, Relation::NonZero)
        };
        let mut measured: Vec<Symbol> = plant.x.iter().map(|x| x.symbol).filter(|x| symbols.contains(x)).collect();
        measured.retain(is_steep);
        measured.sort_by_key(is_constant);
        let Some(state) = (!measured.is_empty()).then(|| measured[turn % measured.len()]) else { continue };
        let rest = arena.substitute(value, &BTreeMap::from([(state, arena.zero())]));
        let difference = arena.sub(arena.of_symbol(output), rest);
        let by_output = arena.div(difference, arena.derivative(value, state));
        let own = BTreeMap::from([(state, by_output)]);
        for earlier in found.values_mut() {
            *earlier = arena.substitute(*earlier, &own);
        }
        found.insert(state, by_output);
    }
    found
}
