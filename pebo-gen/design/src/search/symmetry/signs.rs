//! Finds states that may change their signs together.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::domain::zero::{is_zero, refute};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Domain, Expr, Symbol};

use super::super::problem::Problem;
use super::found::{Symmetry, SymmetryKind};
use super::preserved::{Formulas, MOST_STATES};

/// The change of the fewest states under which rates change as their states do, what is shown is the same, and the
/// assumptions hold as before.
pub(super) fn change(problem: &Problem<'_>, formulas: &Formulas) -> Option<Symmetry> {
    let hidden: Vec<Symbol> = formulas.states.iter().chain(&problem.plant.w).copied().collect();
    if hidden.len() > MOST_STATES {
        return None;
    }
    let mut found: Vec<Vec<Symbol>> = Vec::new();
    extend(problem, formulas, &hidden, &mut Vec::new(), &mut found);
    let of_states = |changed: &Vec<Symbol>| changed.iter().filter(|s| formulas.states.contains(s)).count();
    let domain = of_values(problem, formulas);
    found.retain(|changed| of_states(changed) > 0 && keeps(problem, &domain, changed));
    let changed = found.into_iter().min_by_key(|changed| (changed.len(), of_states(changed)))?;
    let arena = problem.arena;
    let states = formulas.states.iter().filter(|state| changed.contains(state));
    // A state that is zero is its opposite.
    let states = states.filter(|state| refute(arena, arena.of_symbol(**state), &problem.domain).is_some());
    let states: Vec<(Symbol, Expr)> = states.map(|state| (*state, arena.neg(arena.of_symbol(*state)))).collect();
    let with_signals = problem.plant.w.iter().any(|signal| changed.contains(signal));
    (!states.is_empty()).then_some(Symmetry { kind: SymmetryKind::Signs, states, with_signals })
}

/// Extends a choice of signs of the first hidden symbols to all, as far as the formulas in them alone permit it.
fn extend(
    problem: &Problem<'_>,
    formulas: &Formulas,
    hidden: &[Symbol],
    changed: &mut Vec<Symbol>,
    found: &mut Vec<Vec<Symbol>>,
) {
    let arena = problem.arena;
    let Some((next, rest)) = hidden.split_first() else {
        found.push(changed.clone());
        return;
    };
    let open: BTreeSet<Symbol> = rest.iter().copied().collect();
    // The formulas for which the next symbol is the last that is open.
    let is_due = |formula: Expr, own: Option<Symbol>| {
        let involves = |symbol: Symbol| own == Some(symbol) || arena.depends_on(formula, &BTreeSet::from([symbol]));
        involves(*next) && !arena.depends_on(formula, &open) && own.is_none_or(|own| !open.contains(&own))
    };
    let rates = formulas.states.iter().zip(&formulas.rates).map(|(state, rate)| (*rate, Some(*state)));
    let shown = formulas.shown.iter().map(|formula| (*formula, None));
    let due: Vec<(Expr, Option<Symbol>)> = rates.chain(shown).filter(|(formula, own)| is_due(*formula, *own)).collect();
    for changes in [false, true] {
        if changes {
            changed.push(*next);
        }
        let same = |(formula, own): &(Expr, Option<Symbol>)| {
            let image = turned(problem, *formula, changed);
            let expected = if own.is_some_and(|own| changed.contains(&own)) { arena.neg(*formula) } else { *formula };
            is_zero(arena, arena.sub(image, expected), &problem.domain)
        };
        if problem.goes_on() && due.iter().all(same) {
            extend(problem, formulas, rest, changed, found);
        }
        if changes {
            changed.pop();
        }
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
fn keeps(problem: &Problem<'_>, domain: &Domain, changed: &[Symbol]) -> bool {
    let holds = |(fact, relation)| {
        let image = turned(problem, fact, changed);
        image == fact || domain.grants(problem.arena, (image, relation))
    };
    domain.facts.iter().all(holds)
}

/// A formula of the changed states.
fn turned(problem: &Problem<'_>, formula: Expr, changed: &[Symbol]) -> Expr {
    let arena = problem.arena;
    let opposite = |symbol: &Symbol| (*symbol, arena.neg(arena.of_symbol(*symbol)));
    arena.substitute(formula, &changed.iter().map(opposite).collect::<BTreeMap<Symbol, Expr>>())
}
