//! The ambiguity of theta where functions of it are identified: up to turns, which may be harmless, a warning, or lose a
//! state.

use std::collections::BTreeMap;

use super::premises::Premises;
use super::recovery::ThetaRecovery;
use crate::analysis::design::Verdict;
use crate::analysis::left_inverse::checking::is_whole_turns;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::{Expr, Relation, Symbol};

/// The states that move by a constant where theta moves by the step that leaves it ambiguous: the outputs do not
/// distinguish them from angles, which is a warning.
///
/// # Errors
/// The verdict on a regression that loses a state: one that does not move by a constant, or an angle that moves by a
/// fraction of its period.
pub(super) fn steps(
    premises: &Premises<'_>,
    eta: &[Expr],
    recovered: &ThetaRecovery,
    found: &mut Vec<Diagnostic>,
) -> Result<Vec<(Symbol, Expr)>, Verdict> {
    let (arena, plant, domain) = (premises.arena(), premises.plant, premises.domain);
    let mut steps = Vec::new();
    for &(index, step) in &recovered.turning {
        let turned = |expr: Expr, symbol: Symbol, step: Expr| {
            let moved = BTreeMap::from([(symbol, arena.add(arena.of_symbol(symbol), step))]);
            premises.shortest(arena.sub(arena.substitute(expr, &moved), expr))
        };
        for &(state, formula) in premises.left_inverse.iter().flat_map(|inverse| &inverse.x) {
            let shift = turned(formula, plant.z[index], step);
            let kept = match plant.period(state) {
                Some(period) => is_whole_turns(arena, domain, arena.div(arena.mul(shift, arena.turn()), period)),
                None => premises.vanishes(shift),
            };
            if kept {
                continue;
            }
            // The outputs themselves are blind to the step, or only the formula for theta is; and the domain holds the
            // states on both sides of it, or not.
            let constant = arena.symbols_of(&[shift]).is_subset(&premises.constants());
            let blind = eta.iter().all(|e| premises.vanishes(turned(*e, plant.theta[index], step)));
            let bounded = domain.facts.iter().any(|(fact, _)| arena.symbols_of(&[fact]).contains(&state));
            if blind && !bounded && constant && plant.period(state).is_none() {
                // The state may well be an angle: the outputs do not distinguish it from one. A period is positive.
                let opposite = arena.neg(shift);
                let shift = if domain.implies(arena, opposite, Relation::Positive) { opposite } else { shift };
                found.push(up_to_steps(plant, index, (state, shift)));
                steps.push((state, shift));
                continue;
            }
            let is_restricted = bounded && constant;
            found.push(lost_by_turns(plant, (index, step), (state, shift), (blind, is_restricted)));
            return Err(if blind && !bounded { Verdict::Refuted } else { Verdict::Undecided });
        }
    }
    Ok(steps)
}

/// The effect of a step of an unknown on a state.
fn lost_by_turns(
    plant: &Plant,
    (index, step): (usize, Expr),
    (state, shift): (Symbol, Expr),
    (blind, is_restricted): (bool, bool),
) -> Diagnostic {
    let arena = &plant.arena;
    let (name, number) = (arena.name(state), index + 1);
    let (step, moved) = (arena.print(step), arena.print(shift));
    let title = if is_restricted {
        format!("{name} is not determined: multiples of {step} in theta{number} are left to the assumptions")
    } else {
        format!("{name} is not determined: theta{number} is known only up to multiples of {step}")
    };
    let diagnostic = Diagnostic::error(Code::UnknownUpToTurns, plant.phi[index].span, title)
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
        None if is_restricted => diagnostic.help(format!(
            "declare the period, `angles: {{{name}: {moved}}}`: {name} is then recovered up to it, to be placed \
             within its bounds"
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
