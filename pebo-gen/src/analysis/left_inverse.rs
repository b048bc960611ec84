//! Claim 2, the left inverse: x from z = phi(x, y) and y.
//!
//! In: the plant. Out: `phi_left` with `phi_left(phi(x, y), y) = x` proved for each state that it
//! recovers, modulo the period for declared angles; the author's formula where there is one, else one
//! that solves the transform (Ortega et al. 2015, Assumption 1 (i), with n_x components).

use std::collections::BTreeMap;

use crate::cas::domain::Domain;
use crate::cas::field::Obstacle;
use crate::cas::zero::{Answer, decide};
use crate::cas::{Expr, Function, Symbol};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};

use super::design::{Claim, LeftInverse, Origin, Verdict, Witness};
use super::solve::{Equation, solve};
use super::tidy::shortest;

/// Proves or refutes the left inverse.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Claim<LeftInverse> {
    let (candidates, origin) = match &plant.phi_left {
        Some(given) => (given.iter().map(|(s, f)| (*s, f.expr, f.span)).collect::<Vec<_>>(), Origin::Given),
        None => match derived(plant, domain) {
            Ok(candidates) => (candidates, Origin::Derived),
            Err(obstacle) => {
                found.push(underivable(plant, &[], Some(&obstacle)));
                return Claim { verdict: Verdict::Undecided, result: None };
            }
        },
    };
    let mut result = LeftInverse { x: Vec::new(), modulo: Vec::new(), origin, witness: None };
    let mut verdict = Verdict::Proved;
    for (state, formula, span) in candidates {
        let (tested, answer) = check(plant, domain, state, formula);
        match answer {
            Answer::Zero => {
                result.x.push((state, formula));
                result.modulo.extend(plant.period(state).map(|period| (state, period)));
            }
            Answer::NonZero(point) if origin == Origin::Given => {
                let witness = Witness::of(tested, &point);
                found.push(refuted(plant, domain, state, span, &witness));
                result.x.push((state, formula));
                result.witness.get_or_insert(witness);
                verdict = Verdict::Refuted;
            }
            // A derived candidate that fails was a wrong branch, which says nothing about the claim.
            Answer::NonZero(_) => {}
            Answer::Open(obstacle) if origin == Origin::Given => {
                found.push(undecided(plant, state, span, &obstacle));
                result.x.push((state, formula));
                if verdict == Verdict::Proved {
                    verdict = Verdict::Undecided;
                }
            }
            Answer::Open(_) => {}
        }
    }
    let recovered: Vec<Symbol> = result.x.iter().map(|(s, _)| *s).collect();
    let missing: Vec<Symbol> = plant.x.iter().map(|s| s.symbol).filter(|s| !recovered.contains(s)).collect();
    if origin == Origin::Derived && !missing.is_empty() {
        found.push(underivable(plant, &missing, None));
        verdict = Verdict::Undecided;
    }
    Claim { verdict, result: Some(result) }
}

/// Solves the transform for the states.
fn derived(plant: &Plant, domain: &Domain) -> Result<Vec<(Symbol, Expr, Span)>, Obstacle> {
    let arena = &plant.arena;
    let equations: Vec<Equation> = plant
        .phi
        .iter()
        .zip(&plant.z)
        .map(|(phi, z)| Equation { formula: phi.expr, value: arena.of_symbol(*z) })
        .collect();
    let states: Vec<Symbol> = plant.x.iter().map(|s| s.symbol).collect();
    let solved = solve(arena, domain, &equations, &states)?;
    Ok(plant
        .x
        .iter()
        .filter_map(|state| {
            let formula = shortest(arena, domain, *solved.get(&state.symbol)?);
            Some((state.symbol, formula, state.rate.span))
        })
        .collect())
}

/// What must vanish, for an angle up to periods: `phi_left(phi(x, y), y) - x`.
fn residual(plant: &Plant, state: Symbol, formula: Expr) -> Expr {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    arena.sub(arena.substitute(formula, &transform), arena.of_symbol(state))
}

/// Decides whether a formula gives the state back; returns what was tested for zero as well.
fn check(plant: &Plant, domain: &Domain, state: Symbol, formula: Expr) -> (Expr, Answer) {
    let arena = &plant.arena;
    let difference = residual(plant, state, formula);
    let plain = decide(arena, difference, domain);
    let Some(period) = plant.period(state) else { return (difference, plain) };
    if plain.is_zero() {
        return (difference, plain);
    }
    // A whole number of periods: the difference as an angle d has sin d = 0 and cos d = 1.
    let turn = arena.div(arena.mul(arena.number(2), arena.pi()), period);
    let angle = arena.mul(difference, turn);
    let sin = arena.call(Function::Sin, &[angle]);
    let answer = decide(arena, sin, domain);
    if !answer.is_zero() {
        return (sin, answer);
    }
    let cos = arena.sub(arena.call(Function::Cos, &[angle]), arena.one());
    (cos, decide(arena, cos, domain))
}

fn refuted(plant: &Plant, domain: &Domain, state: Symbol, span: Span, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let mut diagnostic = Diagnostic::error(
        Code::LeftInverseRefuted,
        span,
        format!("phi_left does not give back {name}"),
    )
    .label(format!("with z = phi(x, y) this is not {name}"))
    .note(witness.sentence(arena));
    if let Some(period) = plant.period(state) {
        diagnostic = diagnostic.note(format!("that is not zero, so it fails also up to whole periods of {}", arena.print(period)));
    }
    let mend = derived(plant, domain).ok().and_then(|all| {
        let (_, formula, _) = all.into_iter().find(|(s, ..)| *s == state)?;
        check(plant, domain, state, formula).1.is_zero().then_some(formula)
    });
    match mend {
        Some(formula) => diagnostic.help(format!("use `{name}: {}`", arena.print(formula))),
        None => diagnostic.help("leave phi_left out to have it derived, or state the domain under `assume`"),
    }
}

fn undecided(plant: &Plant, state: Symbol, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let name = plant.arena.name(state);
    Diagnostic::error(
        Code::LeftInverseUndecided,
        span,
        format!("it could not be decided whether phi_left gives back {name}"),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("state the signs of the quantities under roots and logarithms under `assume`")
}

fn underivable(plant: &Plant, missing: &[Symbol], obstacle: Option<&Obstacle>) -> Diagnostic {
    let names: Vec<String> = missing.iter().map(|s| plant.arena.name(*s)).collect();
    let of = if names.is_empty() { String::new() } else { format!(" for {}", names.join(", ")) };
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseUnderivable, span, format!("no left inverse was found{of}"))
            .label("this transform could not be solved for the states");
    if let Some(obstacle) = obstacle {
        diagnostic = diagnostic.note(format!("obstacle: {obstacle}"));
    }
    diagnostic.help("give it under `phi_left`, or state signs of states under `assume`")
}
