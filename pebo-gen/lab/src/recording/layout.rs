//! The table with all values of a row.

use std::ops::Range;

use crate::closed_loop::layout::estimate;
use crate::observe::design::program;
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Span};

/// The positions of the values: measured states, outputs, inputs of the row, estimates.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) symbols: Vec<Symbol>,
    pub(super) x: Range<usize>,
    pub(super) y: Range<usize>,
    pub(super) u: Range<usize>,
    /// The time as the observer measures it, which then is the last of the inputs.
    pub(super) measured_time: Option<usize>,
    pub(super) hat: Range<usize>,
    /// The states that the observer recovers, with the symbols of their estimates.
    pub(super) estimated: Vec<(Symbol, Symbol)>,
}

impl Layout {
    /// The table of a plant whose states at these positions were measured, and whose states `recovered` are estimated.
    pub(super) fn new(plant: &Plant, measured: &[usize], recovered: &[Symbol]) -> Self {
        let arena = &plant.arena;
        let estimated: Vec<_> = recovered.iter().map(|state| (*state, estimate(arena, &arena.name(*state)))).collect();
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
        Self { symbols, x, y, u, measured_time, hat, estimated }
    }

    /// The number of values.
    pub(super) fn len(&self) -> usize {
        self.symbols.len()
    }

    /// The position of a state that was measured.
    pub(super) fn of_state(&self, state: Symbol) -> Option<usize> {
        self.x.clone().find(|place| self.symbols[*place] == state)
    }

    /// A program from the table to the values of these expressions.
    pub(super) fn program(&self, arena: &Arena, outputs: &[Expr], span: Span) -> Result<Program, Diagnostic> {
        program(arena, &self.symbols, outputs, span)
    }
}
