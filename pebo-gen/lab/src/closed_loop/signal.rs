//! Signals in time: piecewise formulas.

use pebo_cas::Arena;
use pebo_design::model::{Entry, Piece};
use pebo_design::plant::{Scope, lower};
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics};

use crate::experiment::layout::time;
use crate::observe::design::program;

/// A signal.
#[derive(Debug)]
pub(crate) struct Signal {
    /// Start times, ascending from 0 or before, with programs from time to the value.
    pieces: Vec<(f64, Program)>,
}

impl Signal {
    /// Resolves a signal in a scope of time and parameters.
    pub(crate) fn resolve(arena: &Arena, scope: &Scope, entry: &Entry<Vec<Piece>>, problems: &mut Diagnostics) -> Self {
        if let Some(first) = entry.value.first().filter(|first| first.from.value.to_f64() > 0.0) {
            let message = format!("`{}` has no value before {} s", entry.name.value, first.from.value.text());
            problems.push(
                Diagnostic::error(Code::SimulationIncomplete, first.from.span, message)
                    .help("let its first piece start at 0"),
            );
        }
        let pieces = entry.value.iter().filter_map(|piece| {
            let lowered = lower(arena, scope, &piece.formula)
                .and_then(|expr| program(arena, &[time(arena)], &[expr], piece.formula.span));
            Some((piece.from.value.to_f64(), problems.keep(lowered)?))
        });
        Self { pieces: pieces.collect() }
    }

    /// The times at which the signal passes from one formula to the next.
    pub(crate) fn jumps(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().skip(1).map(|(from, _)| *from)
    }

    /// A cursor at the signal's start.
    pub(crate) fn course(&self) -> SignalCursor {
        SignalCursor {
            pieces: self.pieces.iter().map(|(from, program)| (*from, Interpreter::new(program))).collect(),
            active: 0,
        }
    }
}

/// A signal with its present formula.
#[derive(Debug)]
pub(crate) struct SignalCursor {
    pieces: Vec<(f64, Interpreter)>,
    active: usize,
}

impl SignalCursor {
    /// Selects the formula at `t`, which must not decrease.
    pub(crate) fn select(&mut self, t: f64) {
        while self.pieces.get(self.active + 1).is_some_and(|(from, _)| *from <= t) {
            self.active += 1;
        }
    }

    /// The value of the selected formula at `t`.
    pub(crate) fn value(&mut self, t: f64) -> f64 {
        let mut value = [f64::NAN];
        if let Some((_, formula)) = self.pieces.get_mut(self.active) {
            formula.run(&[t], &mut value);
        }
        value[0]
    }
}
