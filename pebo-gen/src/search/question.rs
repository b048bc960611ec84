//! What a search is about: a plant without its transform, and how its signals are told apart.

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::asks::Want;
use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr, Node, Symbol};
use crate::plant::Plant;

/// A plant whose transform is looked for.
#[derive(Debug)]
pub(super) struct Question<'a> {
    pub(super) plant: &'a Plant,
    pub(super) arena: &'a Arena,
    /// The domain of the model: where its own formulas have values.
    pub(super) domain: Domain,
    pub(super) rates: BTreeMap<Symbol, Expr>,
    /// The unmeasured states that are looked for.
    pub(super) x: Vec<Symbol>,
    /// The outputs that a transform may hold: those with a rate.
    pub(super) y: Vec<Symbol>,
    /// What no rate of a transform may depend on: the states, and unmeasured signals.
    pub(super) hidden: BTreeSet<Symbol>,
    /// All that is no constant.
    pub(super) signals: BTreeSet<Symbol>,
}

impl<'a> Question<'a> {
    pub(super) fn of(plant: &'a Plant) -> Self {
        Self::knowing(plant, &BTreeMap::new())
    }

    /// The question for the other states where outputs tell some by their value alone; none where they tell none or all.
    pub(super) fn with_told_states(plant: &'a Plant) -> Option<Self> {
        let told = told(plant);
        (!told.is_empty() && told.len() < plant.x.len()).then(|| Self::knowing(plant, &told))
    }

    /// The question where some states are functions of outputs.
    fn knowing(plant: &'a Plant, told: &BTreeMap<Symbol, Expr>) -> Self {
        let states = plant.x.iter().map(|state| state.symbol);
        let x: Vec<Symbol> = states.filter(|state| !told.contains_key(state)).collect();
        let moving = plant.y.iter().filter(|output| output.rate.is_some());
        let mut hidden = plant.hidden();
        hidden.retain(|symbol| !told.contains_key(symbol));
        let outputs = plant.y.iter().map(|output| output.symbol);
        let signals = plant.hidden().into_iter().chain(outputs).chain(plant.u.iter().copied()).collect();
        let rates = plant.rates().into_iter().map(|(symbol, rate)| (symbol, plant.arena.substitute(rate, told)));
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

    /// Whether a function has values and derivatives on the whole domain, but perhaps for the zeros of some formulas,
    /// which the proof of the claims then lists.
    pub(super) fn exists(&self, expr: Expr) -> bool {
        let asked = self.arena.asks(&[expr], Want::Slope);
        asked.into_iter().all(|(part, relation)| match relation {
            Relation::NonZero => !self.arena.is_zero(part),
            Relation::NonNegative => self.domain.implies(self.arena, part, relation),
            // What is nowhere negative is positive but for its zeros.
            Relation::Positive => {
                !self.arena.is_zero(part) && self.domain.implies(self.arena, part, Relation::NonNegative)
            }
        })
    }

    /// Whether a function bends or jumps where a combination of the unmeasured states passes zero: theta would be another
    /// behind a jump, and no proof that leaves the place out tells so.
    pub(super) fn bends_in_states(&self, expr: Expr) -> bool {
        let hidden = |part: Expr| self.arena.depends_on(part, &self.hidden);
        self.arena.dividers(&[expr]).into_iter().any(hidden)
    }

    /// Whether nothing suggests components that are not affine in x: the rates are written as polynomials in what is hidden,
    /// and no state is an unknown constant, which may multiply others.
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

    /// Whether there is something left to take.
    pub(super) fn goes_on(&self) -> bool {
        !self.arena.budget().is_exhausted()
    }
}

/// The states that outputs with a rate tell by their value alone, as functions of these: `th` by `m = th`. In the rates they
/// are measured.
fn told(plant: &Plant) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let states: BTreeSet<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let mut found = BTreeMap::new();
    for output in plant.y.iter().filter(|output| output.rate.is_some()) {
        let Some(value) = output.value else { continue };
        let symbols = arena.symbols_of(&[value.expr]);
        let others: Vec<Symbol> = symbols.difference(&constants).copied().collect();
        let [state] = others.as_slice() else { continue };
        let slope = arena.derivative(value.expr, *state);
        let is_steep = !arena.depends_on(slope, &states) && !arena.is_zero(slope);
        if !states.contains(state) || !is_steep || !plant.domain().implies(arena, slope, Relation::NonZero) {
            continue;
        }
        let rest = arena.substitute(value.expr, &BTreeMap::from([(*state, arena.zero())]));
        let state_by_output = arena.div(arena.sub(arena.of_symbol(output.symbol), rest), slope);
        found.entry(*state).or_insert(state_by_output);
    }
    found
}
