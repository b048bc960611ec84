//! The equations that hold on a domain, with the steps that solve them for some of their symbols.
//!
//! There are two readers. The normal form takes *exact* steps: their divisors vanish nowhere, so they lose no solution.
//! An equation that no such step solves is *open*: it holds, but nothing is concluded from it. Points are completed by
//! any steps: a point at which a divisor vanishes is not taken.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::solution::{Solution, Step};
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Symbol};

/// Equations, and the symbols they are solved for.
#[derive(Clone, Debug, Default)]
pub struct Manifold {
    pub(super) equations: Vec<Expr>,
    /// The first group must not occur in results: an equation that holds one of it is solved exactly for no other. The
    /// last are constants: they are solved for to find points, never in the normal form.
    pub(super) groups: Vec<BTreeSet<Symbol>>,
    pub(super) exact: Solution,
    /// The plans that were made, by their equations: points of one domain are looked for many times. Copies share them.
    pub(super) plans: Plans,
}

/// Plans by their equations and the symbols that bounds confine; none where there is no plan.
pub(super) type Plans = Rc<RefCell<BTreeMap<(Vec<Expr>, BTreeSet<Symbol>), Option<Rc<Solution>>>>>;

impl Manifold {
    /// True if there is no equation.
    pub fn is_empty(&self) -> bool {
        self.equations.is_empty()
    }

    /// The equations: expressions that are zero.
    pub fn equations(&self) -> &[Expr] {
        &self.equations
    }

    /// The values of the symbols that the equations determine, as functions of others; none if an equation is left, or
    /// has several roots.
    pub fn values(&self) -> Option<BTreeMap<Symbol, Expr>> {
        let is_single = self.exact.open.is_empty() && self.exact.steps.iter().all(|step| step.root.is_none());
        is_single.then(|| self.determined())
    }

    /// The values of those symbols that have a single one.
    pub fn determined(&self) -> BTreeMap<Symbol, Expr> {
        let single = self.exact.steps.iter().filter(|step| step.root.is_none());
        single.map(|step| (step.symbol, step.middle)).collect()
    }

    /// The symbols that must not occur in results.
    pub(super) fn hidden(&self) -> &BTreeSet<Symbol> {
        static NONE: BTreeSet<Symbol> = BTreeSet::new();
        self.groups.first().unwrap_or(&NONE)
    }

    /// The values of symbols that may occur in results, where an equation is a number times one of them and a formula
    /// without it.
    pub(super) fn given_values(&self, arena: &Arena) -> BTreeMap<Symbol, Expr> {
        let mut values = BTreeMap::new();
        for equation in &self.equations {
            let Node::Sum(sum) = arena.node(*equation) else { continue };
            let value = sum.terms.iter().find_map(|(term, slope)| {
                let symbol = arena.as_symbol(*term).filter(|symbol| !self.hidden().contains(symbol))?;
                let value = arena.sub(*term, arena.scale(*equation, &slope.recip()?));
                let is_apart = !arena.symbols_of(&[value]).contains(&symbol);
                (is_apart && arena.depends_on(value, self.hidden())).then_some((symbol, value))
            });
            // Of a symbol that has two values, either is one.
            values.extend(value.filter(|(symbol, _)| !values.contains_key(symbol)));
        }
        values
    }

    /// An equation that no exact step solves, so that the normal form does not use it.
    pub fn open(&self) -> Option<Expr> {
        self.exact.open.first().copied()
    }

    /// All equations that no exact step solves.
    pub(crate) fn open_equations(&self) -> &[Expr] {
        &self.exact.open
    }

    /// Expressions that vanish together where the equations hold: those of the exact steps, and the open equations.
    pub fn reduced(&self, arena: &Arena) -> Vec<Expr> {
        self.exact.steps.iter().map(|step| step.equation(arena)).chain(self.exact.open.iter().copied()).collect()
    }

    /// Those of [`Self::reduced`] that do not determine a symbol as a function of others.
    pub(crate) fn unsolved(&self, arena: &Arena) -> Vec<Expr> {
        let roots = self.exact.steps.iter().filter(|step| step.root.is_some()).map(|step| step.equation(arena));
        roots.chain(self.exact.open.iter().copied()).collect()
    }

    /// The exact steps.
    pub(crate) fn steps(&self) -> &[Step] {
        &self.exact.steps
    }
}
