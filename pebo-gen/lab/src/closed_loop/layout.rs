//! The table with all values of an instant.
//!
//! Every formula of a run reads its symbols from this table, so that the values of one formula are where the next one
//! looks for them.

use std::ops::Range;

use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::model::{Baseline, Entry, Simulation};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Span};

use crate::observe::design::{Design, program};

/// The position of time.
pub(crate) const TIME: usize = 0;

/// The positions of the values: time; x, y and the baselines' states, which are integrated; inputs; estimates; the
/// baselines' estimates; signals and courses; samples of imperfect sensors; signs in the rates.
#[derive(Debug)]
pub(crate) struct Layout {
    /// The symbols in the order of the table; behind those of the ranges, signs in the rates.
    pub(crate) symbols: Vec<Symbol>,
    /// x, y and the baselines' states combined.
    pub(crate) state: Range<usize>,
    pub(crate) x: Range<usize>,
    /// The true outputs.
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
}

impl Layout {
    /// The table for this plant and simulation, with the states that this observer recovers.
    pub(crate) fn new(plant: &Plant, simulation: &Simulation, design: &Design) -> Self {
        let arena = &plant.arena;
        let mut symbols = vec![time(arena)];
        let mut add = |group: Vec<Symbol>| {
            let start = symbols.len();
            symbols.extend(group);
            start..symbols.len()
        };
        let baselines = || simulation.baselines.iter();
        let x = add(plant.x.iter().map(|state| state.symbol).collect());
        let y = add(plant.y.iter().map(|output| output.symbol).collect());
        let own = add(baselines()
            .filter_map(|b| Some((&b.name.value, b.value.equations()?)))
            .flat_map(|(name, b)| b.state.iter().map(|entry| baseline_state(arena, name, &entry.name.value)))
            .collect());
        let u = add(plant.u.clone());
        let recovered = || design.recovered.iter().map(|state| arena.name(*state));
        let hat = add(recovered().map(|state| estimate(arena, &state)).collect());
        let predicted = recovered().filter(|_| design.predicts());
        let standard_errors = add(predicted.map(|state| standard_error(arena, &state)).collect());
        let baseline_hats =
            add(baselines().flat_map(|b| baseline_estimates(plant, b)).map(|(_, estimate)| estimate).collect());
        let signals = simulation.signals.iter().map(|signal| arena.symbol(&signal.name.value));
        let courses = simulation.plant.iter().map(|entry| course(arena, &entry.name.value));
        let signals = add(signals.chain(courses).collect());
        let imperfect = plant.y.iter().filter(|_| simulation.is_imperfect());
        let last_samples = add(imperfect.map(|output| last_sample(arena, &arena.name(output.symbol))).collect());
        let measured_time = plant.time.map(|_| u.end - 1);
        Self {
            symbols,
            state: x.start..own.end,
            x,
            y,
            u,
            measured_time,
            hat,
            standard_errors,
            baseline_estimates: baseline_hats,
            signals,
            last_samples,
        }
    }

    /// The inputs without the time.
    pub(crate) fn commanded(&self) -> Range<usize> {
        self.u.start..self.measured_time.unwrap_or(self.u.end)
    }

    /// A program from the table to the values of these expressions; `span` is where they are from.
    pub(crate) fn program(&self, arena: &Arena, outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
        program(arena, &self.symbols, outputs, span)
    }

    /// The names of the values at these positions.
    pub(crate) fn names(&self, arena: &Arena, range: &Range<usize>) -> Vec<String> {
        self.symbols[range.clone()].iter().map(|symbol| arena.name(*symbol)).collect()
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
