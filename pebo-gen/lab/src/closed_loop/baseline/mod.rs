//! Baseline observers, with which the model's own is compared.
//!
//! In: the entries of the model file. Out: for one given by equations, rates, starts and estimates as expressions of
//! the layout's symbols; for one given by name, a [`NamedBaseline`] that takes the samples of the model's own observer.
//! Either uses what an observer may: outputs, inputs, signals, its own states.
//!
//! ```text
//! equations -> expressions                 kalman, ekf, luenberger -> linearised plant -> gain -> estimate
//! ```

mod equations;
mod gain;
mod linearised;
mod sampled;

use pebo_cas::Expr;
use pebo_design::model::{Baseline, Entry};
use pebo_design::source::Diagnostics;

use super::scope::{Estimates, Names};
use crate::experiment::layout::baseline_estimates;
use equations::ResolvedEquations;

pub(crate) use sampled::{Follower, NamedBaseline, StartError};

/// A baseline, resolved.
#[derive(Debug)]
pub(crate) struct ResolvedBaseline {
    /// Its name.
    pub(crate) name: String,
    /// The rates of its states, if it has equations.
    pub(crate) rates: Vec<Expr>,
    /// Its states at the start, in outputs.
    pub(crate) start: Vec<Expr>,
    /// Its estimates, in its states, outputs and inputs; for one by name, the symbols that it writes.
    pub(crate) estimates: Estimates,
    /// The observer that writes them, if it has no equations.
    pub(crate) sampled: Option<NamedBaseline>,
}

impl ResolvedBaseline {
    /// Resolves a baseline; mistakes are reported.
    pub(crate) fn resolve(names: &Names, entry: &Entry<Baseline>, problems: &mut Diagnostics) -> Option<Self> {
        let name = entry.name.value.as_str();
        let (ResolvedEquations { rates, start, estimates }, sampled) = match &entry.value {
            Baseline::Equations(written) => (equations::resolve(names, (name, written), problems), None),
            Baseline::Kalman(_) | Baseline::Extended(_) | Baseline::Luenberger(_) => {
                let estimates = baseline_estimates(names.plant, entry).into_iter();
                let estimates = estimates.map(|(state, symbol)| (state, names.plant.arena.of_symbol(symbol))).collect();
                (
                    ResolvedEquations { estimates, ..ResolvedEquations::default() },
                    Some(NamedBaseline::resolve(names, entry, StartError::Known, problems)?),
                )
            }
        };
        Some(Self { name: name.to_owned(), rates, start, estimates, sampled })
    }
}
