//! Switches in the rates: signs of varying levels, as of dry friction or a relay.
//!
//! In: rates with `sign(level)` in them. Out: rates in which each such sign is a symbol of its own, with levels, and
//! their slopes along the rates; and, as a run goes on, the values of these symbols.
//!
//! Method: between two changes of a sign the rates are smooth, as an integrator with adaptive steps needs. Where a
//! level reaches zero there are three cases. The level goes through; it turns away; or the rates of both sides lead
//! back to zero, and the plant slides along it, as a mass that dry friction holds. There the sign has the value between
//! -1 and 1 that keeps the level constant, the equivalent control (Utkin, *Sliding modes in control and optimization*,
//! 1992, chapter 2), which is Filippov's solution wherever the sign enters the rates linearly. Sliding ends where that
//! value leaves -1 to 1.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use rustc_hash::FxHashMap;

use pebo_cas::{Arena, Expr, Function, Node, Symbol};
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Diagnostic, Span};

use crate::experiment::layout::{Layout, time};
use crate::observe::design::program;

/// Rounds of the iteration for simultaneous sliding: each switch is solved for with the others held.
const ROUNDS: usize = 200;

/// The iteration ends once the values change by less than this.
const FOUND: f64 = 1e-13;

/// A sliding switch this far beyond 1 is released.
const BEYOND: f64 = 1e-12;

/// The signs of varying levels, extracted from rates.
#[derive(Debug, Default)]
pub(crate) struct Switches {
    /// The symbol of each sign, then of the rate of each signal that levels depend on.
    pub(crate) symbols: Vec<Symbol>,
    /// The argument of each sign.
    pub(crate) levels: Vec<Expr>,
    /// The rates of the levels.
    pub(crate) slopes: Vec<Expr>,
    /// The signals that levels depend on.
    pub(crate) signals: Vec<Symbol>,
}

impl Switches {
    /// Extracts the signs from the rates of a run's state; their symbols are at the end of its table.
    pub(crate) fn of(arena: &Arena, layout: Layout, rates: &mut [Expr]) -> (Layout, Self) {
        let (state, signals) = (&layout.symbols[layout.state.clone()], &layout.symbols[layout.signals.clone()]);
        let switches = Self::take(arena, rates, state, signals);
        let symbols = layout.symbols.iter().chain(&switches.symbols).copied().collect();
        (Layout { symbols, ..layout }, switches)
    }

    /// Extracts the signs from the rates of a state; the sign of a level held from sample to sample is a number, and is
    /// kept.
    pub(crate) fn take(arena: &Arena, rates: &mut [Expr], state: &[Symbol], signals: &[Symbol]) -> Self {
        let moving: BTreeSet<Symbol> = state.iter().chain(signals).copied().chain([time(arena)]).collect();
        let (mut found, mut values) = (Self::default(), FxHashMap::default());
        for part in arena.postorder(rates) {
            let Node::Call(Function::Sign, arguments) = arena.node(part) else { continue };
            let level = arena.replace(arguments[0], &values);
            if arena.depends_on(level, &moving) {
                let symbol = arena.generated(&format!("switch {}", found.levels.len() + 1));
                values.insert(part, arena.of_symbol(symbol));
                found.symbols.push(symbol);
                found.levels.push(level);
            }
        }
        if found.levels.is_empty() {
            return found;
        }
        for rate in rates.iter_mut() {
            *rate = arena.replace(*rate, &values);
        }
        let mut along: BTreeMap<Symbol, Expr> = state.iter().copied().zip(rates.iter().copied()).collect();
        along.insert(time(arena), arena.one());
        let read = arena.symbols_of(&found.levels);
        for signal in signals.iter().filter(|signal| read.contains(signal)) {
            let rate = arena.generated(&format!("rate of {}", arena.name(*signal)));
            along.insert(*signal, arena.of_symbol(rate));
            found.symbols.push(rate);
            found.signals.push(*signal);
        }
        found.slopes = found.levels.iter().map(|level| arena.directional(*level, &along)).collect();
        found
    }

    /// The same as programs on a table of these symbols, with those of the signs at its end; none where there are no
    /// switches.
    pub(crate) fn programs(
        &self,
        arena: &Arena,
        table: &[Symbol],
        span: Span,
    ) -> Result<Option<SwitchPrograms>, Diagnostic> {
        if self.levels.is_empty() {
            return Ok(None);
        }
        let first = table.len() - self.symbols.len();
        let rates = first + self.levels.len()..table.len();
        let place = |symbol: &Symbol| table.iter().position(|known| known == symbol);
        Ok(Some(SwitchPrograms {
            levels: program(arena, table, &self.levels, span)?,
            slopes: program(arena, table, &self.slopes, span)?,
            places: first..rates.start,
            moving: self.signals.iter().filter_map(place).zip(rates).collect(),
        }))
    }
}

/// The switches as programs on the table of a run.
#[derive(Debug)]
pub(crate) struct SwitchPrograms {
    pub(crate) levels: Program,
    pub(crate) slopes: Program,
    /// The positions of the signs in the table.
    pub(crate) places: Range<usize>,
    /// The positions of signals that levels depend on, each with that of its rate.
    pub(crate) moving: Vec<(usize, usize)>,
}

/// The mode of a switch.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// Held at this value.
    Held(f64),
    /// Sliding: the level is held at zero.
    Sliding,
}

/// The state of the switches in a run.
#[derive(Debug)]
pub(crate) struct SwitchState {
    levels: Interpreter,
    slopes: Interpreter,
    places: Range<usize>,
    pub(crate) moving: Vec<(usize, usize)>,
    modes: Vec<Mode>,
    /// The largest absolute value of each level so far.
    peaks: Vec<f64>,
    /// The integrator's tolerances for a level: relative to its largest absolute value, and absolute.
    tolerance: (f64, f64),
    /// The rate at which a sliding level is led back to zero, in 1/s: rounding would let it wander.
    pull: f64,
    at: Vec<f64>,
    moves: Vec<f64>,
}

impl SwitchState {
    /// The switches before a run, with the relative and the absolute tolerance of the integrator.
    pub(crate) fn new(switched: &SwitchPrograms, tolerance: (f64, f64)) -> Self {
        let count = switched.places.len();
        Self {
            levels: Interpreter::new(&switched.levels),
            slopes: Interpreter::new(&switched.slopes),
            places: switched.places.clone(),
            moving: switched.moving.clone(),
            modes: vec![Mode::Held(0.0); count],
            peaks: vec![0.0; count],
            tolerance,
            pull: 0.0,
            at: vec![0.0; count],
            moves: vec![0.0; count],
        }
    }

    /// Prepares an interval of this length in seconds.
    pub(crate) fn begin(&mut self, length: f64) {
        self.pull = 1.0 / length;
    }

    /// Decides the mode of each switch from here on; those of `reached` are at zero whatever their levels round to.
    pub(crate) fn decide(&mut self, table: &mut [f64], reached: &[bool]) {
        self.hold(table);
        self.levels.run(table, &mut self.at);
        let mut open = Vec::new();
        for switch in 0..self.modes.len() {
            let level = self.at[switch];
            self.peaks[switch] = self.peaks[switch].max(level.abs());
            let is_at_zero = level.abs() <= self.near(switch) || reached.get(switch).copied().unwrap_or_default();
            if is_at_zero {
                open.push(switch);
            } else {
                self.modes[switch] = Mode::Held(level.signum());
                table[self.places.start + switch] = level.signum();
            }
        }
        for _ in 0..ROUNDS {
            let mut change: f64 = 0.0;
            for &switch in &open {
                let (value, mode) = self.value_at_zero(switch, table);
                let place = self.places.start + switch;
                change = change.max((value - table[place]).abs());
                (table[place], self.modes[switch]) = (value, mode);
            }
            if change <= FOUND {
                break;
            }
        }
    }

    /// The value of a switch whose level is at zero, with the others as they are.
    fn value_at_zero(&mut self, switch: usize, table: &mut [f64]) -> (f64, Mode) {
        let (below, above) = self.sides(switch, table);
        let level = self.at[switch];
        let sign = if level == 0.0 { 0.0 } else { level.signum() };
        let held = |value: f64| (value, Mode::Held(value));
        if above < 0.0 && below > 0.0 {
            // Both sides lead back.
            return ((below + above) / (below - above), Mode::Sliding);
        }
        match (below, above) {
            (below, above) if below >= 0.0 && above > 0.0 => held(1.0),
            (below, above) if below < 0.0 && above <= 0.0 => held(-1.0),
            // The level is constant with this value.
            (_, above) if above == 0.0 && below > 0.0 => held(1.0),
            (below, _) if below == 0.0 && above < 0.0 => held(-1.0),
            // The level is constant at any value.
            (below, above) if below == 0.0 && above == 0.0 => held(sign),
            // Both sides lead away: it keeps its side.
            _ => match self.modes[switch] {
                Mode::Held(value) if value != 0.0 => held(value),
                _ => held(if sign == 0.0 { 1.0 } else { sign }),
            },
        }
    }

    /// The rates of a level with its switch at -1 and at 1, with the pull back to zero.
    fn sides(&mut self, switch: usize, table: &mut [f64]) -> (f64, f64) {
        let place = self.places.start + switch;
        let now = table[place];
        let [below, above] = [-1.0, 1.0].map(|value| {
            table[place] = value;
            self.slopes.run(table, &mut self.moves);
            self.moves[switch]
        });
        table[place] = now;
        let back = self.pull * self.at[switch];
        // A constant level needs no pull.
        if below == 0.0 && above == 0.0 { (0.0, 0.0) } else { (below + back, above + back) }
    }

    /// Writes the values of all switches for the state and signals of the table.
    pub(crate) fn hold(&mut self, table: &mut [f64]) {
        let mut sliding = false;
        for (switch, mode) in self.modes.iter().enumerate() {
            match mode {
                Mode::Held(value) => table[self.places.start + switch] = *value,
                Mode::Sliding => sliding = true,
            }
        }
        if !sliding {
            return;
        }
        self.levels.run(table, &mut self.at);
        for _ in 0..ROUNDS {
            let mut change: f64 = 0.0;
            for switch in
                (0..self.modes.len()).filter(|switch| self.modes[*switch] == Mode::Sliding).collect::<Vec<_>>()
            {
                let (below, above) = self.sides(switch, table);
                // A switch that no longer acts on its level keeps its value until all is decided anew.
                if below <= above {
                    continue;
                }
                let place = self.places.start + switch;
                let value = (below + above) / (below - above);
                change = change.max((value - table[place]).abs());
                table[place] = value;
            }
            // NaN ends the iteration.
            if change.is_nan() || change <= FOUND {
                break;
            }
        }
    }

    /// The switches whose mode has ended: a level changed its sign, or a sliding value is beyond 1.
    pub(crate) fn reached(&mut self, table: &mut [f64]) -> Option<Vec<bool>> {
        self.hold(table);
        self.levels.run(table, &mut self.at);
        let reached = |switch: usize| {
            let (level, value) = (self.at[switch], table[self.places.start + switch]);
            match self.modes[switch] {
                Mode::Held(side) if side != 0.0 => side * level < -self.near(switch),
                Mode::Held(_) => level.abs() > self.near(switch),
                Mode::Sliding => value.abs() > 1.0 + BEYOND,
            }
        };
        let all: Vec<bool> = (0..self.modes.len()).map(reached).collect();
        for (peak, level) in self.peaks.iter_mut().zip(&self.at) {
            *peak = peak.max(level.abs());
        }
        all.contains(&true).then_some(all)
    }

    /// The distance within which a level counts as zero.
    fn near(&self, switch: usize) -> f64 {
        self.tolerance.1 + self.tolerance.0 * self.peaks[switch]
    }
}
