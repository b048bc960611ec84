//! The summands of a rate, each with its own span for a refusal to point at.

use std::collections::BTreeMap;

use crate::model::Model;
use crate::model::formula::{self, Operator, Term};
use crate::source::Span;
use pebo_cas::{Arena, Expr, Symbol};

use super::formula::lower;
use super::parts::Formula;
use super::scope::Scope;

/// A formula of more summands is pointed at as a whole.
const MOST_TERMS: usize = 64;

/// The summands of every rate that the author wrote.
pub(super) fn of_rates(arena: &Arena, scope: &Scope, model: &Model) -> BTreeMap<Symbol, Vec<Formula>> {
    let rates = model.f_x.iter().chain(&model.f_y);
    rates.map(|rate| (arena.symbol(&rate.name.value), of(arena, scope, &rate.value))).collect()
}

/// The summands of a formula as written: `(a - b)/c` has `a/c` at the span of `a`, and `-b/c` at that of `b`.
///
/// None if the formula has no meaning; otherwise they add up to it.
fn of(arena: &Arena, scope: &Scope, formula: &formula::Formula) -> Vec<Formula> {
    let mut terms = Vec::new();
    let complete = split(arena, scope, formula, arena.one(), &mut terms);
    match complete {
        Some(()) if terms.len() <= MOST_TERMS => terms,
        Some(()) => lower(arena, scope, formula).map(|expr| at(expr, formula.span)).into_iter().collect(),
        None => Vec::new(),
    }
}

/// Adds the summands of `factor * formula`; nothing if a subformula has no meaning.
fn split(
    arena: &Arena,
    scope: &Scope,
    formula: &formula::Formula,
    factor: Expr,
    terms: &mut Vec<Formula>,
) -> Option<()> {
    if terms.len() <= MOST_TERMS {
        match &formula.term {
            Term::Negative(inner) => return split(arena, scope, inner, arena.neg(factor), terms),
            Term::Binary(operator @ (Operator::Add | Operator::Subtract), left, right) => {
                split(arena, scope, left, factor, terms)?;
                let sign = if *operator == Operator::Add { factor } else { arena.neg(factor) };
                return split(arena, scope, right, sign, terms);
            }
            Term::Binary(Operator::Divide, left, right) if is_sum(left) => {
                let divisor = lower(arena, scope, right).ok().filter(|divisor| !arena.is_zero(*divisor))?;
                return split(arena, scope, left, arena.div(factor, divisor), terms);
            }
            Term::Binary(Operator::Multiply, left, right) if is_sum(left) => {
                let multiple = arena.mul(factor, lower(arena, scope, right).ok()?);
                return split(arena, scope, left, multiple, terms);
            }
            Term::Binary(Operator::Multiply, left, right) if is_sum(right) => {
                let multiple = arena.mul(factor, lower(arena, scope, left).ok()?);
                return split(arena, scope, right, multiple, terms);
            }
            _ => {}
        }
    }
    terms.push(at(arena.mul(factor, lower(arena, scope, formula).ok()?), formula.span));
    Some(())
}

fn is_sum(formula: &formula::Formula) -> bool {
    match &formula.term {
        Term::Binary(Operator::Add | Operator::Subtract, ..) => true,
        Term::Binary(Operator::Multiply, left, right) => is_sum(left) || is_sum(right),
        Term::Binary(Operator::Divide, inner, _) | Term::Negative(inner) => is_sum(inner),
        _ => false,
    }
}

fn at(expr: Expr, span: Span) -> Formula {
    Formula { expr, span }
}
