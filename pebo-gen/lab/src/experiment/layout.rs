//! The table with all values of an instant.
//!
//! Every formula of an experiment reads its symbols from this table, so that the values of one formula are where the next
//! one looks for them.

use std::ops::Range;

use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::model::{Baseline, Entry};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Span};

use crate::observe::design::{Design, program};
use crate::summary::Estimate;

/// The position of time.
pub(crate) const TIME: usize = 0;

/// The positions of the values: time; states that are known, outputs and the baselines' states; inputs; estimates and
/// their standard errors; the baselines' estimates; what else a source has; the errors of estimates.
#[derive(Debug)]
pub(crate) struct Layout {
    /// The symbols in the order of the table; behind those of the ranges, signs in the rates.
    pub(crate) symbols: Vec<Symbol>,
    /// x, y and the baselines' states combined, which a simulation integrates.
    pub(crate) state: Range<usize>,
    /// The states that are simulated, or were measured.
    pub(crate) x: Range<usize>,
    /// The outputs; in a simulation the true ones.
    pub(crate) y: Range<usize>,
    pub(crate) u: Range<usize>,
    /// The time as observers measure it, which then is the last of the inputs.
    pub(crate) measured_time: Option<usize>,
    /// The observer's estimates.
    pub(crate) hat: Range<usize>,
    /// Their standard errors, where they are predicted.
    pub(crate) standard_errors: Range<usize>,
    /// The baselines' estimates, one baseline after the other.
    pub(crate) baseline_estimates: Range<usize>,
    /// Signals, then the courses of true parameters and states.
    pub(crate) signals: Range<usize>,
    /// The last sample of each output that arrived; empty where sensors are perfect.
    pub(crate) last_samples: Range<usize>,
    /// The residuals of outputs.
    pub(crate) residuals: Range<usize>,
    /// The errors of the estimates whose states are known.
    pub(crate) errors: Range<usize>,
    /// The observer's estimates, then those of each baseline.
    pub(crate) estimates: Vec<PlacedEstimate>,
    /// The baselines, with the positions of their estimates.
    pub(crate) baselines: Vec<(String, Range<usize>)>,
}

/// An estimate with its positions in the table.
#[derive(Debug)]
pub(crate) struct PlacedEstimate {
    pub(crate) estimate: Estimate,
    pub(crate) hat: usize,
    /// The state, if it is known, and the error then.
    pub(crate) truth: Option<usize>,
    pub(crate) error: Option<usize>,
}

/// The symbols of a source beside outputs, inputs and estimates.
#[derive(Debug, Default)]
pub(crate) struct SourceSymbols {
    /// The states that are known.
    pub(crate) x: Vec<Symbol>,
    /// The states of baselines.
    pub(crate) baselines: Vec<Symbol>,
    pub(crate) signals: Vec<Symbol>,
    pub(crate) last_samples: Vec<Symbol>,
    pub(crate) residuals: Vec<Symbol>,
}

impl Layout {
    /// The table for this plant and source, with the states that this observer recovers and these baselines estimate.
    pub(crate) fn new(
        plant: &Plant,
        design: &Design,
        baselines: &[(String, Vec<String>)],
        source: SourceSymbols,
    ) -> Self {
        let arena = &plant.arena;
        let mut symbols = vec![time(arena)];
        let mut add = |group: Vec<Symbol>| {
            let start = symbols.len();
            symbols.extend(group);
            start..symbols.len()
        };
        let x = add(source.x);
        let y = add(plant.y.iter().map(|output| output.symbol).collect());
        let state = x.start..add(source.baselines).end;
        let u = add(plant.u.clone());
        let recovered: Vec<String> = design.recovered.iter().map(|state| arena.name(*state)).collect();
        let hat = add(recovered.iter().map(|state| estimate(arena, state)).collect());
        let predicted = recovered.iter().filter(|_| design.predicts());
        let standard_errors = add(predicted.map(|state| standard_error(arena, state)).collect());
        let of_baselines: Vec<(&String, &String)> =
            baselines.iter().flat_map(|(name, states)| states.iter().map(move |state| (name, state))).collect();
        let written = of_baselines.iter().map(|(name, state)| baseline_estimate(arena, name, state));
        let baseline_estimates = add(written.collect());
        let [signals, last_samples, residuals] = [source.signals, source.last_samples, source.residuals].map(add);
        let of_observer = recovered.iter().map(|state| (None, state));
        let all = of_observer.chain(of_baselines.iter().map(|(name, state)| (Some((*name).clone()), *state)));
        let (first_error, mut placed) = (symbols.len(), Vec::new());
        for ((baseline, state), hat) in all.zip(hat.clone().chain(baseline_estimates.clone())) {
            let truth = symbols[..first_error].iter().position(|known| *known == arena.symbol(state));
            let error = truth.map(|_| symbols.len());
            let unit = plant.units.get(&arena.symbol(state)).cloned();
            let estimate = Estimate { baseline, state: state.clone(), unit };
            symbols.extend(error.map(|_| arena.generated(&format!("error({})", estimate.name()))));
            placed.push(PlacedEstimate { estimate, hat, truth, error });
        }
        let mut end = baseline_estimates.start;
        let place = |(name, states): &(String, Vec<String>)| {
            let start = end;
            end += states.len();
            (name.clone(), start..end)
        };
        let measured_time = plant.time.map(|_| u.end - 1);
        let errors = first_error..symbols.len();
        Self {
            symbols,
            state,
            x,
            y,
            u,
            measured_time,
            hat,
            standard_errors,
            baseline_estimates,
            signals,
            last_samples,
            residuals,
            errors,
            estimates: placed,
            baselines: baselines.iter().map(place).collect(),
        }
    }

    /// The outputs as their sensors show them.
    pub(crate) fn measured(&self) -> Range<usize> {
        if self.last_samples.is_empty() { self.y.clone() } else { self.last_samples.clone() }
    }

    /// The positions of a baseline's estimates.
    pub(crate) fn of_baseline(&self, name: &str) -> Range<usize> {
        let found = self.baselines.iter().find(|(known, _)| known == name);
        found.map(|(_, places)| places.clone()).unwrap_or_default()
    }

    /// A program from the table to the values of these expressions; `span` is where they are from.
    pub(crate) fn program(&self, arena: &Arena, outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
        program(arena, &self.symbols, outputs, span)
    }
}

/// The true time; the time that observers measure is an input. No declared name is `t` where there is a simulation.
pub(crate) fn time(arena: &Arena) -> Symbol {
    arena.generated("t")
}

/// The true value of a parameter or of a constant state, where it has a course.
pub(crate) fn course(arena: &Arena, name: &str) -> Symbol {
    arena.generated(&format!("plant({name})"))
}

/// The last sample of an output that arrived.
pub(crate) fn last_sample(arena: &Arena, output: &str) -> Symbol {
    arena.generated(&format!("shown({output})"))
}

/// The observer's estimate of a state.
pub(crate) fn estimate(arena: &Arena, state: &str) -> Symbol {
    arena.generated(&format!("hat({state})"))
}

/// The observer's estimates, by the state's name.
pub(crate) fn estimates(arena: &Arena, design: &Design) -> Vec<(String, Expr)> {
    let recovered = design.recovered.iter().map(|state| arena.name(*state));
    recovered.map(|state| (state.clone(), arena.of_symbol(estimate(arena, &state)))).collect()
}

/// The standard error of that estimate.
pub(crate) fn standard_error(arena: &Arena, state: &str) -> Symbol {
    arena.generated(&format!("std({state})"))
}

/// A state of a baseline.
pub(crate) fn baseline_state(arena: &Arena, baseline: &str, state: &str) -> Symbol {
    arena.generated(&format!("{baseline}.{state}"))
}

/// The states that a baseline estimates, with its estimates.
pub(crate) fn baseline_estimates(plant: &Plant, baseline: &Entry<Baseline>) -> Vec<(String, Symbol)> {
    let arena = &plant.arena;
    let states: Vec<String> = match baseline.value.equations() {
        Some(equations) => equations.estimate.iter().map(|entry| entry.name.value.clone()).collect(),
        None => plant.x.iter().map(|state| arena.name(state.symbol)).collect(),
    };
    let estimate = |state: String| {
        let symbol = baseline_estimate(arena, &baseline.name.value, &state);
        (state, symbol)
    };
    states.into_iter().map(estimate).collect()
}

/// A baseline's estimate of a state.
pub(crate) fn baseline_estimate(arena: &Arena, baseline: &str, state: &str) -> Symbol {
    arena.generated(&format!("{baseline}.hat({state})"))
}

/// The residual of an output.
pub(crate) fn residual(arena: &Arena, output: &str) -> Symbol {
    arena.generated(&format!("residual({output})"))
}
