//! Baselines given by equations: one ODE combined with the plant.

use pebo_cas::Expr;
use pebo_design::model::{Entry, Equations, Formula};
use pebo_design::plant::lower;
use pebo_design::source::Diagnostics;

use crate::closed_loop::scope::{Estimates, Names, Sight, View};

/// The equations of a baseline, resolved.
#[derive(Debug, Default)]
pub(super) struct ResolvedEquations {
    /// The rates of its states.
    pub(super) rates: Vec<Expr>,
    /// Its states at the start, in outputs.
    pub(super) start: Vec<Expr>,
    /// Its estimates, in its states, outputs and inputs.
    pub(super) estimates: Estimates,
}

/// Resolves a baseline of this name.
pub(super) fn resolve(
    names: &Names,
    (name, baseline): (&str, &Equations),
    problems: &mut Diagnostics,
) -> ResolvedEquations {
    let arena = &names.plant.arena;
    let view = View { sight: Sight::Inputs, own: Some((name, baseline)), ..View::default() };

    let scope = names.scope(&view);
    let estimates: Estimates = (baseline.estimate.iter())
        .filter_map(|e| Some((e.name.value.clone(), problems.keep(lower(arena, &scope, &e.value))?)))
        .collect();

    let scope = names.scope(&View { hats: estimates.clone(), ..view });
    let rates = (baseline.state.iter()).filter_map(|e| problems.keep(lower(arena, &scope, &e.value))).collect();

    let scope = names.scope(&View { sight: Sight::Outputs, ..View::default() });
    let mut begin = |state: &Entry<Formula>| {
        let written = baseline.initial.iter().find(|entry| entry.name.value == state.name.value);
        written.map_or(Some(arena.zero()), |entry| problems.keep(lower(arena, &scope, &entry.value)))
    };
    let start = baseline.state.iter().filter_map(&mut begin).collect();
    ResolvedEquations { rates, start, estimates }
}
