//! Regressions in functions of theta, dynamic or under the derivative, with the ambiguity of theta.

use std::collections::BTreeMap;

use super::separation::{self, Separation, ThetaRecovery};
use crate::analysis::design::{Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::analysis::left_inverse::checking::is_whole_turns;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::zero::decide;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Domain, Expr, Relation, Symbol};

/// A regression in functions of theta, if theta can be recovered from them: a dynamic one with a row for each
/// output, an implicit one with so many rows of primitives before these; with the outputs of each row.
pub(super) fn over_parameterised(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    (sources, held): (Vec<Vec<usize>>, usize),
    separated: Separation,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let (separated, recovered) = separation::recoverable(plant, domain, separated)?;
    let steps = match steps(plant, domain, left_inverse, &separated.eta, &recovered, found) {
        Ok(steps) => steps,
        Err(verdict) => return Some(Claim { verdict, result: None }),
    };
    // With sides of a primitive first, these are the first half of the rows.
    let short = |row: &Vec<Expr>| row.iter().map(|e| shortest(&plant.arena, domain, *e)).collect::<Vec<Expr>>();
    let (mut phi_0, mut phi_1) = (short(&separated.known), separated.factors.iter().map(short).collect::<Vec<_>>());
    let primitive_0: Vec<Expr> = phi_0.drain(..held).collect();
    let primitive_1: Vec<Vec<Expr>> = phi_1.drain(..held).collect();
    let result = Regression {
        kind: if held == 0 { RegressionKind::Dynamic } else { RegressionKind::Implicit },
        sources,
        phi_0,
        phi_1,
        primitive_0,
        primitive_1,
        eta_symbols: plant.eta(separated.eta.len()),
        steps,
        alternative: None,
        unused: Vec::new(),
        eta: separated.eta,
        theta: recovered.theta,
    };
    Some(Claim { verdict: Verdict::Proved, result: Some(result) })
}

/// The states that move by a constant where theta moves by the step that leaves it ambiguous: the outputs do not
/// distinguish them from angles, which is a warning.
///
/// # Errors
/// The verdict on a regression that loses a state: one that does not move by a constant, or an angle that moves by a
/// fraction of its period.
pub(super) fn steps(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    eta: &[Expr],
    recovered: &ThetaRecovery,
    found: &mut Vec<Diagnostic>,
) -> Result<Vec<(Symbol, Expr)>, Verdict> {
    let arena = &plant.arena;
    let mut steps = Vec::new();
    for &(index, step) in &recovered.turning {
        let turned = |expr: Expr, symbol: Symbol, step: Expr| {
            let moved = BTreeMap::from([(symbol, arena.add(arena.of_symbol(symbol), step))]);
            shortest(arena, domain, arena.sub(arena.substitute(expr, &moved), expr))
        };
        for &(state, formula) in &left_inverse.x {
            let shift = turned(formula, plant.z[index], step);
            let kept = match plant.period(state) {
                Some(period) => is_whole_turns(arena, domain, arena.div(arena.mul(shift, arena.turn()), period)),
                None => decide(arena, shift, domain).is_zero(),
            };
            if kept {
                continue;
            }
            // The outputs themselves are blind to the step, or only the formula for theta is; and the domain holds the
            // states on both sides of it, or not.
            let constant = arena.symbols_of(&[shift]).iter().all(|s| plant.parameters.iter().any(|p| p.symbol == *s));
            let blind = eta.iter().all(|e| decide(arena, turned(*e, plant.theta[index], step), domain).is_zero());
            let bounded = domain.facts.iter().any(|(fact, _)| arena.symbols_of(&[fact]).contains(&state));
            if blind && !bounded && constant && plant.period(state).is_none() {
                // The state may well be an angle: the outputs do not distinguish it from one. A period is positive.
                let opposite = arena.neg(shift);
                let shift = if domain.implies(arena, opposite, Relation::Positive) { opposite } else { shift };
                found.push(up_to_steps(plant, index, (state, shift)));
                steps.push((state, shift));
                continue;
            }
            found.push(lost_by_turns(plant, (index, step), (state, shift), blind));
            let verdict = if blind && !bounded { Verdict::Refuted } else { Verdict::Undecided };
            return Err(verdict);
        }
    }
    Ok(steps)
}

/// The effect of a step of an unknown on a state.
fn lost_by_turns(
    plant: &Plant,
    (index, step): (usize, Expr),
    (state, shift): (Symbol, Expr),
    blind: bool,
) -> Diagnostic {
    let arena = &plant.arena;
    let (name, number) = (arena.name(state), index + 1);
    let (step, moved) = (arena.print(step), arena.print(shift));
    let diagnostic = Diagnostic::error(
        Code::UnknownUpToTurns,
        plant.phi[index].span,
        format!("{name} is not determined: theta{number} is known only up to multiples of {step}"),
    )
    .label(format!("where this component changes by {step}, {name} changes by `{moved}`"))
    .note(if blind {
        "the outputs depend on this component only through its sine and cosine"
    } else {
        "no formula was found that recovers theta from the unknowns of the regression but by the angle of a sine and cosine"
    });
    match plant.period(state) {
        Some(period) => diagnostic.help(format!(
            "declare a period under `angles` that divides this change, instead of `{}`, or measure another output",
            arena.print(period)
        )),
        None => diagnostic.help(
            "choose a phi in which the states do not need this component, or one whose regression is affine, or measure \
             another output",
        ),
    }
}

/// The warning for a state that is identifiable only up to a period.
fn up_to_steps(plant: &Plant, index: usize, (state, shift): (Symbol, Expr)) -> Diagnostic {
    let arena = &plant.arena;
    let (name, moved) = (arena.name(state), arena.print(shift));
    Diagnostic::warning(
        Code::UnknownUpToTurns,
        plant.phi[index].span,
        format!("{name} is determined only up to multiples of {moved}"),
    )
    .label("the outputs depend on this component only through its sine and cosine")
    .note("an estimate that starts near another multiple stays there")
    .help(format!(
        "if {name} is an angle, declare its period: `angles: {{{name}: {moved}}}`; if not, measure another output"
    ))
}
