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
    /// The unmeasured states.
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
        let x: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let moving = plant.y.iter().filter(|output| output.rate.is_some());
        let hidden = plant.hidden();
        let outputs = plant.y.iter().map(|output| output.symbol);
        let signals = hidden.iter().copied().chain(outputs).chain(plant.u.iter().copied()).collect();
        Self {
            plant,
            arena: &plant.arena,
            domain: plant.domain(),
            rates: plant.rates(),
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
