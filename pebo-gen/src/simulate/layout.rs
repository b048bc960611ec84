//! One table for all values of an instant.
//!
//! Every formula of a run reads its symbols from this table, so that what one formula computes is
//! where the next one looks for it.

use std::ops::Range;

use crate::cas::{Arena, Expr, Symbol};
use crate::model::Simulation;
use crate::plant::Plant;
use crate::program::{Program, lower};
use crate::source::{Code, Diagnostic, Span};

/// The position of time.
pub(super) const TIME: usize = 0;

/// Which value stands where: time; x, y and the baselines' states, which are integrated; inputs;
/// estimates; the baselines' estimates; signals.
#[derive(Debug)]
pub(super) struct Layout {
    /// The symbols in the order of the table.
    pub(super) symbols: Vec<Symbol>,
    /// x, y and the baselines' states together.
    pub(super) state: Range<usize>,
    pub(super) x: Range<usize>,
    pub(super) y: Range<usize>,
    pub(super) u: Range<usize>,
    /// The observer's estimates.
    pub(super) hat: Range<usize>,
    /// The baselines' estimates, one baseline after the other.
    pub(super) rivals: Range<usize>,
    pub(super) signals: Range<usize>,
}

impl Layout {
    /// The table for this plant and simulation, with these states recovered by the observer.
    pub(super) fn new(plant: &Plant, simulation: &Simulation, recovered: &[Symbol]) -> Self {
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
            .flat_map(|b| b.value.state.iter().map(|entry| rival_state(arena, &b.name.value, &entry.name.value)))
            .collect());
        let u = add(plant.u.clone());
        let hat = add(recovered.iter().map(|state| estimate(arena, &arena.name(*state))).collect());
        let rivals = add(baselines()
            .flat_map(|b| b.value.estimate.iter().map(|e| rival_estimate(arena, &b.name.value, &e.name.value)))
            .collect());
        let signals = add(simulation.signals.iter().map(|signal| arena.symbol(&signal.name.value)).collect());
        Self { symbols, state: x.start..own.end, x, y, u, hat, rivals, signals }
    }

    /// A program from the table to the values of these expressions; `span` is where they are from.
    pub(super) fn program(&self, arena: &Arena, outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
        program(arena, &self.symbols, outputs, span)
    }

    /// The names of the values at these positions.
    pub(super) fn names(&self, arena: &Arena, range: &Range<usize>) -> Vec<String> {
        self.symbols[range.clone()].iter().map(|symbol| arena.name(*symbol)).collect()
    }
}

/// A program; a symbol without a value is a diagnostic at `span`.
pub(super) fn program(arena: &Arena, inputs: &[Symbol], outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
    lower(arena, inputs, outputs).map_err(|undeclared| {
        let message = format!("`{}` has no value in the simulation", arena.name(undeclared.0));
        Diagnostic::error(Code::SimulationIncomplete, span, message).help("give its values over time under `signals`")
    })
}

/// Time. No declared name is `t` where there is a simulation.
pub(super) fn time(arena: &Arena) -> Symbol {
    arena.generated("t")
}

/// The observer's estimate of a state.
pub(super) fn estimate(arena: &Arena, state: &str) -> Symbol {
    arena.generated(&format!("hat({state})"))
}

/// A state of a baseline.
pub(super) fn rival_state(arena: &Arena, baseline: &str, state: &str) -> Symbol {
    arena.generated(&format!("{baseline}.{state}"))
}

/// A baseline's estimate of a state.
pub(super) fn rival_estimate(arena: &Arena, baseline: &str, state: &str) -> Symbol {
    arena.generated(&format!("{baseline}.hat({state})"))
}
