//! Regressions in functions of theta, dynamic or under the derivative, and what theta is known up to.

use std::collections::BTreeMap;

use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::analysis::left_inverse::is_whole_turns;
use crate::analysis::regression::implicit;
use crate::analysis::regression::separation::{self, Recovered, Separated};
use crate::cas::domain::Domain;
use crate::cas::tidy::shortest;
use crate::cas::zero::decide;
use crate::cas::{Expr, Symbol};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};

/// A regression in functions of theta, if theta can be recovered from them: a dynamic one with a row for each
/// output, an implicit one with so many rows of primitives before these.
pub(super) fn over_parameterised(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    (rows, held): (Vec<usize>, usize),
    separated: Separated,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    // The fewer functions, if they are enough.
    let joined = separation::join_dependent(plant, domain, &separated).ok().and_then(|joined| {
        let recovered = separation::recover(plant, domain, &joined.eta)?;
        Some((joined, recovered))
    });
    let (separated, recovered) = if let Some(both) = joined {
        both
    } else {
        let recovered = separation::recover(plant, domain, &separated.eta)?;
        (separated, recovered)
    };
    if let Some(refusal) = turned_away(plant, domain, left_inverse, &separated.eta, &recovered, found) {
        return Some(refusal);
    }
    // With sides of a primitive first, these are the first half of the rows.
    let short = |row: &Vec<Expr>| row.iter().map(|e| shortest(&plant.arena, domain, *e)).collect::<Vec<Expr>>();
    let (mut phi_0, mut phi_1) = (short(&separated.known), separated.factors.iter().map(short).collect::<Vec<_>>());
    let primitive_0: Vec<Expr> = phi_0.drain(..held).collect();
    let primitive_1: Vec<Vec<Expr>> = phi_1.drain(..held).collect();
    let result = Regression {
        kind: if held == 0 { RegressionKind::Dynamic } else { RegressionKind::Implicit },
        rows,
        phi_0,
        phi_1,
        primitive_0,
        primitive_1,
        eta_symbols: plant.eta(separated.eta.len()),
        alternative: None,
        eta: separated.eta,
        theta: recovered.theta,
    };
    Some(Claim { verdict: Verdict::Proved, result: Some(result) })
}

/// A regression with the unknowns under the derivative, where the rates have that form.
pub(super) fn under_derivative(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: &LeftInverse,
    outputs: &[usize],
    rates: &[Expr],
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let (mut primitives, mut rights) = (Vec::new(), Vec::new());
    for (output, rate) in outputs.iter().zip(rates) {
        let sides = implicit::sides(plant, domain, &cascade.h, (*output, *rate)).ok()??;
        primitives.push(sides.primitive);
        rights.push(sides.rate);
    }
    let separated = separation::separate(plant, domain, &[primitives, rights].concat()).ok()??;
    over_parameterised(plant, domain, left_inverse, (outputs.to_vec(), outputs.len()), separated, found)
}

/// The refusal, where theta is determined only up to whole turns and a state is lost by that: one that does
/// not move by a constant, or an angle that moves by a part of its period. Else at most a warning.
pub(super) fn turned_away(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    eta: &[Expr],
    recovered: &Recovered,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let arena = &plant.arena;
    let turn = arena.mul(arena.number(2), arena.pi());
    let mut ambiguous = false;
    for &index in &recovered.turning {
        let turned = |expr: Expr, symbol: Symbol| {
            let moved = BTreeMap::from([(symbol, arena.add(arena.of_symbol(symbol), turn))]);
            shortest(arena, domain, arena.sub(arena.substitute(expr, &moved), expr))
        };
        for &(state, formula) in &left_inverse.x {
            let shift = turned(formula, plant.z[index]);
            let kept = match plant.period(state) {
                Some(period) => is_whole_turns(arena, domain, arena.div(arena.mul(shift, turn), period)),
                None => arena.symbols_of(&[shift]).iter().all(|s| plant.parameters.iter().any(|p| p.symbol == *s)),
            };
            if kept {
                // What a turn moves is an angle; one that was declared as such needs no warning.
                ambiguous |= plant.period(state).is_none() && !arena.is_zero(shift);
                continue;
            }
            // Whether the outputs themselves are blind to the turn, or only the formula for theta.
            let blind = eta.iter().all(|e| decide(arena, turned(*e, plant.theta[index]), domain).is_zero());
            found.push(lost_by_turns(plant, index, state, shift));
            let verdict = if blind { Verdict::Refuted } else { Verdict::Undecided };
            return Some(Claim { verdict, result: None });
        }
    }
    found.extend(ambiguous.then(|| up_to_turns(plant)));
    None
}

/// What a turn of an unknown does to a state.
fn lost_by_turns(plant: &Plant, index: usize, state: Symbol, shift: Expr) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let diagnostic = Diagnostic::error(
        Code::UnknownUpToTurns,
        plant.phi[index].span,
        format!("{name} is not determined: theta{} is known only up to whole turns", index + 1),
    )
    .label(format!("a whole turn of this component changes {name} by `{}`", arena.print(shift)))
    .note("the outputs depend on this component only through its sine and cosine");
    match plant.period(state) {
        Some(period) => diagnostic.help(format!(
            "declare a period under `angles` that divides this change, instead of `{}`, or measure another output",
            arena.print(period)
        )),
        None => diagnostic
            .help("choose a phi in which the other states do not need this component, or measure another output"),
    }
}

/// What to know where theta enters through sine and cosine alone.
fn up_to_turns(plant: &Plant) -> Diagnostic {
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    Diagnostic::warning(Code::UnknownUpToTurns, span, "theta is determined only up to whole turns")
        .label("the outputs depend on this transform only through its sine and cosine")
        .help("if the recovered state is an angle, declare it under `angles`")
}
