//! Baseline observers: the ones that the model's own is compared with.
//!
//! In: equations of the model file. Out: rates, starts and estimates as expressions of the layout's
//! symbols. A baseline sees what an observer sees: outputs, inputs, signals, its own states.

use crate::cas::Expr;
use crate::model::{Baseline, Entry, Formula};
use crate::plant::lower;
use crate::source::Diagnostics;

use super::scope::{Estimates, Names, Sight, View};

/// A baseline, resolved.
#[derive(Debug)]
pub(super) struct Rival {
    /// Its name.
    pub(super) name: String,
    /// The rates of its states.
    pub(super) rates: Vec<Expr>,
    /// Its states at the start, in outputs.
    pub(super) start: Vec<Expr>,
    /// Its estimates, in its states, outputs and inputs.
    pub(super) estimates: Estimates,
}

impl Rival {
    /// Resolves a baseline.
    pub(super) fn resolve(names: &Names, entry: &Entry<Baseline>, problems: &mut Diagnostics) -> Self {
        let arena = &names.plant.arena;
        let baseline = &entry.value;
        let seen = View { sight: Sight::Inputs, own: Some(entry), ..View::default() };

        let scope = names.scope(&seen);
        let estimates: Estimates = (baseline.estimate.iter())
            .filter_map(|e| Some((e.name.value.clone(), problems.keep(lower(arena, &scope, &e.value))?)))
            .collect();

        let scope = names.scope(&View { hats: estimates.clone(), ..seen });
        let rates = (baseline.state.iter()).filter_map(|e| problems.keep(lower(arena, &scope, &e.value))).collect();

        let scope = names.scope(&View { sight: Sight::Outputs, ..View::default() });
        let mut begin = |state: &Entry<Formula>| {
            let written = baseline.initial.iter().find(|entry| entry.name.value == state.name.value);
            written.map_or(Some(arena.zero()), |entry| problems.keep(lower(arena, &scope, &entry.value)))
        };
        let start = baseline.state.iter().filter_map(&mut begin).collect();
        Self { name: entry.name.value.clone(), rates, start, estimates }
    }
}
