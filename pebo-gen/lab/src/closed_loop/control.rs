//! The control law, and the source of its estimates.

use pebo_cas::Expr;
use pebo_design::model::Simulation;
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest};

use super::scope::{Estimates, Names, Sight, View};
use crate::experiment::layout::{baseline_estimates, time};
use crate::overrides::Overrides;

/// The source of the control law's estimates.
pub(crate) fn feedback(names: &Names, overrides: &Overrides, problems: &mut Diagnostics) -> Option<String> {
    let simulation = names.simulation;
    let written = simulation.feedback.as_ref();
    let name = overrides.feedback.as_deref().or(written.map(|feedback| feedback.value.as_str()));
    let name = name.unwrap_or(Simulation::OBSERVER);
    let choices = simulation.feedbacks();
    if choices.contains(&name) {
        return Some(name.to_owned());
    }
    let diagnostic = match written {
        Some(written) if overrides.feedback.is_none() => Diagnostic::error(
            Code::WrongChoice,
            written.span,
            format!("`{name}` is not an observer of this simulation"),
        ),
        _ => Diagnostic::error(
            Code::WrongChoice,
            Span::NOWHERE,
            format!("`{name}`, which the call names for feedback, is not an observer of this simulation"),
        ),
    };
    problems.push(match nearest(name, choices.iter().copied()) {
        Some(near) => diagnostic.suggest(Some(near)),
        None => diagnostic.help(format!("choose one of {}", listed(choices))),
    });
    None
}

/// The values of `hat(x)` in the control law.
fn visible_estimates(names: &Names, feedback: &str, hats: &Estimates) -> Estimates {
    let arena = &names.plant.arena;
    match feedback {
        Simulation::OBSERVER => hats.clone(),
        Simulation::TRUTH => names.plant.x.iter().map(|x| (arena.name(x.symbol), arena.of_symbol(x.symbol))).collect(),
        name => {
            let baseline = names.simulation.baselines.iter().find(|entry| entry.name.value == name);
            let estimates = baseline.into_iter().flat_map(|entry| baseline_estimates(names.plant, entry));
            estimates.map(|(x, estimate)| (x, arena.of_symbol(estimate))).collect()
        }
    }
}

/// The inputs in outputs, estimates and signals; the time, if it is the last input, is the true one.
pub(crate) fn law(names: &Names, feedback: &str, hats: &Estimates, problems: &mut Diagnostics) -> Vec<Expr> {
    let scope =
        names.scope(&View { sight: Sight::Outputs, hats: visible_estimates(names, feedback, hats), ..View::default() });
    let (plant, arena) = (names.plant, &names.plant.arena);
    let wanted: Vec<_> = plant.commanded().collect();
    let mut inputs = names.entries(&scope, &wanted, ("control", &names.simulation.control), problems);
    inputs.extend(plant.time.map(|_| arena.of_symbol(time(arena))));
    inputs
}
