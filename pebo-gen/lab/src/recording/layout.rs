//! The table with all values of a row.

use std::ops::Range;

use crate::closed_loop::layout::{baseline_estimate, estimate, standard_error};
use crate::observe::design::{Design, program};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Span};

/// The positions of the values: measured states, outputs, inputs of the row, estimates, their standard errors, estimates of
/// baselines.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) symbols: Vec<Symbol>,
    pub(super) x: Range<usize>,
    pub(super) y: Range<usize>,
    pub(super) u: Range<usize>,
    /// The time as the observer measures it, which then is the last of the inputs.
    pub(super) measured_time: Option<usize>,
    pub(super) hat: Range<usize>,
    /// The standard errors of the estimates, where they are predicted.
    pub(super) standard_errors: Range<usize>,
    /// The estimates of the baselines, one baseline after the other.
    pub(super) baselines: Range<usize>,
    /// The baseline and the state of each.
    pub(super) of_baselines: Vec<(String, Symbol)>,
    /// The states that the observer recovers, with the symbols of their estimates.
    pub(super) estimated: Vec<(Symbol, Symbol)>,
}

impl Layout {
    /// The table of a plant whose states at these positions were measured, with the estimates of this observer and of
    /// baselines, each of all states.
    pub(super) fn new(plant: &Plant, measured: &[usize], design: &Design, baselines: &[&str]) -> Self {
        let arena = &plant.arena;
        let estimated: Vec<_> =
            design.recovered.iter().map(|state| (*state, estimate(arena, &arena.name(*state)))).collect();
        let mut symbols = Vec::new();
        let mut add = |group: Vec<Symbol>| {
            let start = symbols.len();
            symbols.extend(group);
            start..symbols.len()
        };
        let x = add(measured.iter().map(|place| plant.x[*place].symbol).collect());
        let y = add(plant.y.iter().map(|output| output.symbol).collect());
        let u = add(plant.u.clone());
        let measured_time = plant.time.map(|_| u.end - 1);
        let hat = add(estimated.iter().map(|(_, hat)| *hat).collect());
        let predicted = estimated.iter().filter(|_| design.predicts());
        let standard_errors = add(predicted.map(|(state, _)| standard_error(arena, &arena.name(*state))).collect());
        let states = || plant.x.iter().map(|state| state.symbol);
        let of_baselines: Vec<(String, Symbol)> =
            baselines.iter().flat_map(|baseline| states().map(|state| ((*baseline).to_owned(), state))).collect();
        let written = of_baselines.iter().map(|(name, state)| baseline_estimate(arena, name, &arena.name(*state)));
        let baselines = add(written.collect());
        Self { symbols, x, y, u, measured_time, hat, standard_errors, baselines, of_baselines, estimated }
    }

    /// The number of values.
    pub(super) fn len(&self) -> usize {
        self.symbols.len()
    }

    /// The position of a state that was measured.
    pub(super) fn of_state(&self, state: Symbol) -> Option<usize> {
        self.x.clone().find(|place| self.symbols[*place] == state)
    }

    /// The positions of the baselines' estimates of a state.
    pub(super) fn baselines_of(&self, state: Symbol) -> impl Iterator<Item = (&str, usize)> {
        let all = self.of_baselines.iter().zip(self.baselines.clone());
        all.filter(move |((_, of), _)| *of == state).map(|((name, _), place)| (name.as_str(), place))
    }

    /// A program from the table to the values of these expressions.
    pub(super) fn program(&self, arena: &Arena, outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
        program(arena, &self.symbols, outputs, span)
    }
}
