//! Functions of x whose rates are affine in themselves: an immersion into a plant that is linear in z.
//!
//! In: formulas, those of the outputs' rates or the states. Out: the functions of x that they consist of, with those that the
//! rates of these consist of, and so on until nothing is added; none if that does not end soon. Coefficients are functions
//! of y and u, so that the cascade is a generalised one, and what the functions were taken from is affine in them.

use std::collections::BTreeSet;

use crate::cas::field::{Field, Obstacle};
use crate::cas::rational::Rational;
use crate::cas::{Expr, Symbol};

use super::question::Question;
use super::sample::is_affine_in;

/// More functions than this make no observer that anybody would run.
const MOST: usize = 12;

/// Nor do functions of more parts: rates of rates that do not close grow with every step.
const MOST_PARTS: usize = 3_000;

/// The closure of the functions of x in these formulas; none if it is larger than that, or the rates leave what it can say.
pub(super) fn closure(question: &Question<'_>, start: &[Expr]) -> Result<Option<Vec<Expr>>, Obstacle> {
    let mut found: Vec<Expr> = Vec::new();
    let mut open: Vec<Expr> = start.to_vec();
    while let Some(formula) = open.pop() {
        let Some(functions) = functions_of(question, formula)? else { return Ok(None) };
        for function in functions {
            if found.contains(&function) {
                continue;
            }
            if found.len() == MOST
                || is_long(question, function)
                || question.bends_in_states(function)
                || question.arena.depends_on(function, &question.plant.w.iter().copied().collect())
            {
                return Ok(None);
            }
            found.push(function);
            open.push(question.rate(function));
        }
    }
    found.sort_by_key(|e| (question.arena.print(*e).len(), *e));
    Ok(Some(found))
}

/// The outputs' rates that hold states and no input, and their rates, and so on until those are affine in what is there; none
/// if they hold an input before, or it is more than that.
pub(super) fn of_rows(question: &Question<'_>) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = question.arena;
    let others: BTreeSet<Symbol> = question.plant.u.iter().chain(&question.plant.w).copied().collect();
    let is_of_states = |row: &Expr| {
        arena.depends_on(*row, &question.states())
            && !arena.depends_on(*row, &others)
            && !question.bends_in_states(*row)
    };
    let mut found: Vec<Expr> = question.output_rates().into_iter().filter(is_of_states).collect();
    let mut next = 0;
    while next < found.len() {
        let rate = question.rate(found[next]);
        next += 1;
        if is_long(question, rate) {
            return Ok(None);
        }
        if is_affine_in(question, &[rate], &found)? {
            continue;
        }
        if found.len() == MOST || !is_of_states(&rate) {
            return Ok(None);
        }
        found.push(rate);
    }
    Ok((!found.is_empty()).then_some(found))
}

fn is_long(question: &Question<'_>, function: Expr) -> bool {
    question.arena.postorder(&[function]).len() > MOST_PARTS
}

/// The functions of x of which a formula is a combination with coefficients that are free of x; none where they are not
/// seen, as x stands in a denominator that is a sum.
fn functions_of(question: &Question<'_>, formula: Expr) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = question.arena;
    let field = Field::over(arena, &question.domain.facts, &[formula])?;
    let fraction = field.fraction(formula)?;
    let hidden: Vec<u32> = field.kernels_of(&question.hidden).into_iter().collect();
    let power = |powers: &[(u32, u32)], sign: i64| {
        let factors = powers
            .iter()
            .map(|(kernel, exponent)| (field.kernel(*kernel), Rational::from(sign * i64::from(*exponent))));
        arena.multiply(&Rational::ONE, factors)
    };
    let below = fraction.denominator().collect(&hidden);
    let [(divisor, _)] = below.as_slice() else { return Ok(None) };
    let divisor = power(divisor.powers(), -1);
    let mut found = Vec::new();
    for (monomial, _) in fraction.numerator().collect(&hidden) {
        let function = arena.mul(power(monomial.powers(), 1), divisor);
        // Functions of x and y together may be coefficients times one another: only those of x alone are told apart.
        let symbols = arena.symbols_of(&[function]);
        if symbols.iter().any(|s| question.signals.contains(s) && !question.hidden.contains(s)) {
            return Ok(None);
        }
        if !symbols.is_disjoint(&question.hidden) {
            found.push(function);
        }
    }
    Ok(Some(found))
}
