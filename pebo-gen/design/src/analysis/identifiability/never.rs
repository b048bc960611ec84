//! Refuses unknowns that no input and no trajectory identifies.
//!
//! In: directions of the unknowns that are unobservable in every derivative of the regression. Out: the diagnostic, with
//! the combinations of the states that the outputs show, where these directions move the states by constants.

use std::collections::BTreeSet;

use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::linear::rank::null_vectors;
use pebo_cas::{Domain, Expr, Symbol};

use crate::analysis::design::{LeftInverse, Regression};
use crate::analysis::left_inverse::checking::at_phi;
use crate::analysis::pencil;
use crate::plant::{Class, Plant};
use crate::source::{Code, Diagnostic, Span, listed};

/// The refusal of unknowns of which these directions are unobservable in every row.
pub(super) fn never(
    plant: &Plant,
    domain: &Domain,
    directions: &[Vec<Expr>],
    regression: &Regression,
    left_inverse: Option<&LeftInverse>,
) -> Diagnostic {
    let arena = &plant.arena;
    let direction = &directions[0];
    let entries: Vec<String> = direction.iter().map(|e| arena.print(*e)).collect();
    let linear = regression.is_linear(plant);
    let unknown = if linear { "theta" } else { "eta" };
    let moving = regression.eta.iter().zip(direction).filter(|(_, d)| linear && !arena.is_zero(**d));
    let component = |e: Expr| plant.theta.iter().position(|theta| arena.as_symbol(e) == Some(*theta));
    let moving: Vec<Span> = moving.filter_map(|(e, _)| Some(plant.phi.get(component(*e)?)?.span)).collect();
    let (first, others) = moving.split_first().map_or((at_phi(plant), &[][..]), |(first, rest)| (*first, rest));
    let diagnostic =
        Diagnostic::error(Code::NeverIdentifiable, first, format!("no input and no trajectory identifies {unknown}"));
    // Components that were found have no spans of their own.
    let others = others.iter().filter(|other| **other != first);
    let diagnostic =
        others.fold(diagnostic, |diagnostic, other| diagnostic.also(*other, "together with this component"));
    let mut diagnostic =
        diagnostic.label(format!("the outputs do not change when {unknown} moves along ({})", entries.join(", ")));
    if linear && let Some(left_inverse) = left_inverse {
        let harmless = left_inverse.x.iter().all(|(_, formula)| {
            let slope = plant.z.iter().zip(direction).map(|(z, d)| arena.mul(arena.derivative(*formula, *z), *d));
            is_zero(arena, arena.sum(slope), domain)
        });
        diagnostic = diagnostic.note(if harmless {
            "the states do not change along this direction: phi_left cancels it, so x is recoverable although theta is not"
        } else {
            "the states change along this direction, so x cannot be recovered either"
        });
        if harmless {
            return diagnostic.help("drop the redundant components of phi");
        }
        let shown = observable_states(plant, domain, directions, left_inverse);
        diagnostic = shown.into_iter().fold(diagnostic, Diagnostic::note);
    }
    let blind = match &plant.class {
        Some(Class::Linear(linear)) => pencil::unobservable_states(plant, domain, linear).ok().flatten(),
        _ => None,
    };
    match blind {
        Some(blind) => diagnostic
            .note(blind)
            .note("the cascade exists, but theta needs an observable plant (Proposition 2, claims C2 and C3)")
            .help("measure another output"),
        None => diagnostic.help("measure another output"),
    }
}

/// The sentence on what the outputs show of the states that move along these directions: combinations of them where they
/// move by constants, else combinations of components of phi where these do; none where neither do.
fn observable_states(
    plant: &Plant,
    domain: &Domain,
    directions: &[Vec<Expr>],
    left_inverse: &LeftInverse,
) -> Option<String> {
    let arena = &plant.arena;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let are_constant =
        |rows: &[Vec<Expr>]| rows.iter().flatten().all(|expr| arena.symbols_of(&[*expr]).is_subset(&constants));
    let moved = |formula: Expr, direction: &[Expr]| {
        let slopes = plant.z.iter().zip(direction).map(|(z, d)| arena.mul(arena.derivative(formula, *z), *d));
        shortest(arena, domain, arena.sum(slopes))
    };
    let rows: Vec<Vec<Expr>> = directions
        .iter()
        .map(|direction| left_inverse.x.iter().map(|(_, formula)| moved(*formula, direction)).collect())
        .collect();
    let columns: Vec<usize> =
        (0..left_inverse.x.len()).filter(|column| rows.iter().any(|row| !arena.is_zero(row[*column]))).collect();
    let states: Vec<Symbol> = columns.iter().map(|column| left_inverse.x[*column].0).collect();
    let rows: Vec<Vec<Expr>> = rows.iter().map(|row| columns.iter().map(|column| row[*column]).collect()).collect();
    let (rows, functions) = if are_constant(&rows) {
        (rows, states.iter().map(|state| arena.of_symbol(*state)).collect())
    } else {
        (directions.to_vec(), plant.transform())
    };
    if !are_constant(&rows) {
        return None;
    }
    let shown = null_vectors(arena, domain, &rows, functions.len()).ok()?;
    let combined = |factors: &Vec<Expr>| shortest(arena, domain, arena.dot(factors, &functions));
    // Of the other states a component of phi may be a function alone.
    let of_these = |shown: &Expr| arena.symbols_of(&[*shown]).iter().any(|symbol| states.contains(symbol));
    let shown: Vec<String> = shown.iter().map(combined).filter(of_these).map(|shown| arena.print(shown)).collect();
    let names: Vec<String> = states.iter().map(|state| arena.name(*state)).collect();
    let names = listed(names.iter().map(String::as_str));
    Some(if shown.is_empty() {
        format!("the outputs show nothing of {names}")
    } else {
        format!("of {names} the outputs show only {}", listed(shown.iter().map(String::as_str)))
    })
}
