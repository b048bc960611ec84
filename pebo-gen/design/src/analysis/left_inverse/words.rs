//! The diagnostics of a left inverse that is refuted, undecided or not found.

use std::collections::BTreeMap;

use crate::analysis::design::Witness;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::checking::{at_phi, check, unlike_after};
use super::solving;

pub(super) fn refuted(plant: &Plant, domain: &Domain, state: Symbol, span: Span, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let mut diagnostic = Diagnostic::error(Code::LeftInverseRefuted, span, format!("phi_left does not recover {name}"))
        .label(format!("at z = phi(x, y) this formula is not equal to {name}"))
        .note(witness.sentence(arena));
    if let Some(period) = plant.period(state) {
        let printed = arena.print(period);
        if unlike_after(plant, domain, state, period).is_some() {
            return diagnostic
                .note(format!(
                    "this is how a rate of the plant differs between {name} + {printed} and {name}: {printed} is no period of \
                     {name}, and to know {name} up to multiples of it is not to know {name}"
                ))
                .help(format!("declare a period of {name} under `angles` with which all rates repeat"));
        }
        diagnostic =
            diagnostic.note(format!("this is not zero, so the two differ by more than whole periods of {printed}"));
    }
    let mend = solving::formulas(plant, domain).ok().and_then(|all| {
        let (_, formula) = all.into_iter().find(|(own, _)| own.symbol == state)?;
        check(plant, domain, state, formula).1.is_zero().then_some(formula)
    });
    match mend {
        Some(formula) => diagnostic.help(format!("use `{name}: {}`", arena.print(formula))),
        None => diagnostic.help("leave phi_left out to have it derived, or state the domain under `assume`"),
    }
}

pub(super) fn not_injective(plant: &Plant, state: Symbol, formula: Expr, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let other = arena.print(arena.substitute(formula, &transform));
    Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), format!("phi does not determine {name}"))
        .label(format!("the states {name} and {other} give the same z"))
        .note(format!("they differ: {}", witness.sentence(arena)))
        .help(format!("state the sign of {name} under `assume`, or choose a phi that is one-to-one in {name}"))
}

pub(super) fn not_one_to_one(plant: &Plant, state: Symbol, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), format!("phi does not determine {name}"))
            .label(format!("two values of {name} give the same z"));
    if let Some(compared) = &witness.compared {
        let what = format!("`{}`", arena.print(compared.expr));
        diagnostic = diagnostic.note(compared.sentence(arena, &what));
        if compared.points.len() > 2 {
            diagnostic = diagnostic
                .note("it is continuous between the last two, so somewhere there it has the first value once more");
        }
    }
    diagnostic.help(format!("bound {name} under `assume`, or choose a phi that is one-to-one in {name}"))
}

pub(super) fn degenerate(plant: &Plant, direction: &[Expr]) -> Diagnostic {
    let arena = &plant.arena;
    let entries: Vec<String> = plant
        .x
        .iter()
        .zip(direction)
        .map(|(s, d)| format!("{}' = {}", arena.name(s.symbol), arena.print(*d)))
        .collect();
    Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), "phi does not determine x")
        .label(format!("z does not change along the direction {}", entries.join(", ")))
        .help("add components to phi, or give `phi_left` for the states that it determines: a partial observer")
}

pub(super) fn undecided(plant: &Plant, state: Symbol, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let name = plant.arena.name(state);
    Diagnostic::error(
        Code::LeftInverseUndecided,
        span,
        format!("it could not be decided whether phi_left recovers {name}"),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("state the signs of the quantities under roots and logarithms under `assume`")
}

pub(super) fn underivable(plant: &Plant, missing: &[Symbol], obstacle: Option<&Obstacle>) -> Diagnostic {
    let names: Vec<String> = missing.iter().map(|s| plant.arena.name(*s)).collect();
    let of = if names.is_empty() { String::new() } else { format!(" for {}", names.join(", ")) };
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseUnderivable, span, format!("no left inverse was found{of}"))
            .label("this transform could not be solved for the states");
    if let Some(obstacle) = obstacle {
        diagnostic = diagnostic.note(format!("obstacle: {obstacle}"));
    }
    diagnostic.help("give the left inverse under `phi_left`, or state the signs of states under `assume`")
}
