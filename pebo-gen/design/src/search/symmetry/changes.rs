//! Finds states that may change their signs, or two by two their places, together.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::domain::zero::{is_zero, refute};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Domain, Expr, Symbol};

use super::super::problem::Problem;
use super::found::{Symmetry, SymmetryKind};
use super::preserved::{Formulas, MOST_STATES};

/// The hidden symbols that change, each with its other value.
type Change = BTreeMap<Symbol, Expr>;

/// The change of the fewest states under which rates change as their states do, what is shown is the same, and the
/// assumptions hold as before; of signs if there is one.
pub(super) fn change(problem: &Problem<'_>, formulas: &Formulas) -> Option<Symmetry> {
    let hidden: Vec<Symbol> = formulas.states.iter().chain(&problem.plant.w).copied().collect();
    if hidden.len() > MOST_STATES {
        return None;
    }
    [SymmetryKind::Signs, SymmetryKind::Exchange].into_iter().find_map(|kind| {
        let mut changes = Changes { problem, formulas, kind, found: Vec::new() };
        changes.extend(&hidden, &Change::new());
        changes.smallest()
    })
}

/// The changes of one kind that preserve the formulas.
struct Changes<'a, 'p> {
    problem: &'a Problem<'p>,
    formulas: &'a Formulas,
    kind: SymmetryKind,
    found: Vec<Change>,
}

impl Changes<'_, '_> {
    /// Extends a change to the open symbols, as far as the formulas in decided symbols alone permit it.
    fn extend(&mut self, open: &[Symbol], change: &Change) {
        let Some((next, rest)) = open.split_first() else {
            self.found.push(change.clone());
            return;
        };
        let arena = self.problem.arena;
        let value = |symbol: Symbol| arena.of_symbol(symbol);
        self.go_on(&[*next], rest, change);
        if self.kind == SymmetryKind::Signs {
            let mut opposite = change.clone();
            opposite.insert(*next, arena.neg(value(*next)));
            return self.go_on(&[*next], rest, &opposite);
        }
        let is_state = |symbol: &Symbol| self.formulas.states.contains(symbol);
        let partners: Vec<Symbol> = rest.iter().copied().filter(|other| is_state(other) == is_state(next)).collect();
        for other in partners {
            let mut exchanged = change.clone();
            exchanged.extend([(*next, value(other)), (other, value(*next))]);
            let rest: Vec<Symbol> = rest.iter().copied().filter(|symbol| *symbol != other).collect();
            self.go_on(&[*next, other], &rest, &exchanged);
        }
    }

    /// Extends a change if it preserves the formulas that the symbols decided last have left without open ones.
    fn go_on(&mut self, last: &[Symbol], open: &[Symbol], change: &Change) {
        let (arena, formulas) = (self.problem.arena, self.formulas);
        let set = |symbols: &[Symbol]| symbols.iter().copied().collect::<BTreeSet<Symbol>>();
        let (last, open_set) = (set(last), set(open));
        let is_due = |involved: &[Expr]| {
            let any = |symbols: &BTreeSet<Symbol>| involved.iter().any(|expr| arena.depends_on(*expr, symbols));
            !any(&open_set) && any(&last)
        };
        let is_same = |formula: Expr, expected: Expr| {
            let image = arena.substitute(formula, change);
            is_zero(arena, arena.sub(image, expected), &self.problem.domain)
        };
        let keeps_rate = |(state, rate): (&Symbol, &Expr)| {
            let own = arena.of_symbol(*state);
            let other = change.get(state).copied().unwrap_or(own);
            let of_other = match arena.as_symbol(other) {
                Some(other) => formulas.rate(other).unwrap_or(*rate),
                None => arena.neg(*rate),
            };
            !is_due(&[own, other, *rate, of_other]) || is_same(*rate, of_other)
        };
        let shows_same = |shown: &Expr| !is_due(&[*shown]) || is_same(*shown, *shown);
        let permitted = self.problem.goes_on()
            && formulas.states.iter().zip(&formulas.rates).all(keeps_rate)
            && formulas.shown.iter().all(shows_same);
        if permitted {
            self.extend(open, change);
        }
    }

    /// The change of the fewest symbols that leaves no state of the domain outside it.
    fn smallest(self) -> Option<Symmetry> {
        let (problem, arena) = (self.problem, self.problem.arena);
        let states = |change: &Change| -> Vec<(Symbol, Expr)> {
            let states = self.formulas.states.iter();
            states.filter_map(|state| Some((*state, *change.get(state)?))).collect()
        };
        let domain = of_values(problem, self.formulas);
        let kept = self.found.iter().filter(|change| !states(change).is_empty() && keeps(problem, &domain, change));
        let change = kept.min_by_key(|change| (change.len(), states(change).len()))?;
        // A state that is zero is its opposite, and equal ones are exchanged for themselves.
        let moves = |(state, other): &(Symbol, Expr)| {
            refute(arena, arena.sub(*other, arena.of_symbol(*state)), &problem.domain).is_some()
        };
        let moving: Vec<(Symbol, Expr)> = states(change).into_iter().filter(moves).collect();
        let with_signals = problem.plant.w.iter().any(|signal| change.contains_key(signal));
        (!moving.is_empty()).then_some(Symmetry { kind: self.kind, states: moving, with_signals })
    }
}

/// The domain, with the conditions under which the formulas have values among its facts.
fn of_values(problem: &Problem<'_>, formulas: &Formulas) -> Domain {
    let mut domain = problem.domain.clone();
    let conditions = problem.arena.domain_conditions(&formulas.all(), Regularity::Differentiable);
    for (part, relation) in conditions {
        domain.facts.assume(part, relation);
    }
    domain
}

/// Tests whether the changed states are in the domain where the states are.
fn keeps(problem: &Problem<'_>, domain: &Domain, change: &Change) -> bool {
    let holds = |(fact, relation)| {
        let image = problem.arena.substitute(fact, change);
        image == fact || domain.grants(problem.arena, (image, relation))
    };
    domain.facts.iter().all(holds)
}
