//! Integrates the plant and the baselines with equations between two samples, as one ordinary differential equation.
//!
//! It is started anew at each sample, where the inputs jump, where a signal that the rates depend on jumps, and where a
//! sign in the rates changes (`switching`), which bisection of the step finds. The method is explicit; once an interval
//! needs very many steps, the one for stiff plants (`stiff`) is taken if it needs fewer.

pub(crate) mod equation;
mod explicit;
mod stiff;
pub(crate) mod switching;

use std::cell::RefCell;
use std::ops::Range;

use pebo_design::program::{Interpreter, Program};

use super::signal::Signal;
use crate::experiment::layout::TIME;
use crate::timing::real;
use equation::{ABSOLUTE, Equation, RELATIVE, Rates, SHORTEST, Solver, Standstill};
use explicit::ExplicitMethod;
use stiff::StiffMethod;
use switching::{SwitchPrograms, SwitchState};

/// The most steps between two samples before the plant counts as too stiff; about a second of computing.
const MOST_STEPS: u64 = 1_000_000;

/// Explicit steps between two samples from which on the plant may be stiff.
const MANY_STEPS: u64 = 1000;

/// The most steps of a whole run: a plant that needs hundreds a sample is given up after minutes, not days.
const MOST_STEPS_IN_ALL: u64 = 400_000_000;

/// Steps after which the number for a whole run is extrapolated; some seconds of computing at most.
const ENOUGH_STEPS: u64 = 2_000_000;

/// The largest state that is integrated.
pub(crate) const LARGEST: usize = 64;

/// Changes of signs between two samples that are located one by one. Where there are more the signs change ever faster,
/// as those of a mass that a relay and friction bring to rest; from then on they are evaluated [`LOOKS`] times a
/// period.
const MOST_SWITCHES: u64 = 100;

/// Evaluations between two samples of signs that change without end: a level then moves by no more than in so small a
/// share of the period.
const LOOKS: f64 = 1000.0;

/// The distance of the difference quotient for a signal's rate, as a share of the interval: for a formula whose third
/// derivative is one over the interval cubed, the relative error of the rate is 2e-9.
const ASIDE: f64 = 1e-4;

/// The differential equation of a run.
#[derive(Debug)]
pub(crate) struct Flow {
    rates: Equation,
    solver: Box<dyn Solver>,
    /// The method for stiff plants, until it turns out to need as many steps.
    stiff: Option<Box<dyn Solver>>,
    /// True once the plant has turned out to be stiff.
    is_stiff: bool,
    state: Range<usize>,
    /// The times at which the rates jump.
    jumps: Vec<f64>,
    next_jump: usize,
    slack: f64,
    /// The steps that may still be taken.
    left: u64,
    /// The end of the run in seconds, if it is known.
    until: f64,
}

impl Flow {
    /// The equation with the rates of the table's positions `state`, and their derivatives by these where it may be
    /// stiff; it follows those of the `signals` that it reads.
    pub(crate) fn new(
        (rates, slopes): (&Program, Option<&Program>),
        switches: Option<&SwitchPrograms>,
        state: Range<usize>,
        signals: &[(usize, &Signal)],
        slack: f64,
    ) -> Self {
        let is_read = |position: usize| {
            rates.reads(position) || switches.is_some_and(|switches| switches.moving.iter().any(|of| of.0 == position))
        };
        let read: Vec<_> = signals.iter().filter(|(position, _)| is_read(*position)).collect();
        let mut jumps: Vec<f64> = read.iter().flat_map(|(_, signal)| signal.jumps()).collect();
        jumps.sort_by(f64::total_cmp);
        let inner = Rates {
            table: vec![0.0; rates.inputs.len()],
            state: state.clone(),
            origin: 0.0,
            signals: read.iter().map(|(position, signal)| (*position, signal.course())).collect(),
            formulas: Interpreter::new(rates),
            slopes: slopes.map(Interpreter::new),
            moves: !read.is_empty() || rates.reads(TIME),
            switching: switches.map(|switches| SwitchState::new(switches, (RELATIVE, ABSOLUTE))),
            aside: 0.0,
        };
        // A library's step takes an array: sizes are rounded up, and the padding is 0.
        let (solver, stiff): (Box<dyn Solver>, Box<dyn Solver>) = match state.len() {
            0..=4 => (Box::new(ExplicitMethod::<4>::new()), Box::new(StiffMethod::<4>::new())),
            5..=8 => (Box::new(ExplicitMethod::<8>::new()), Box::new(StiffMethod::<8>::new())),
            9..=16 => (Box::new(ExplicitMethod::<16>::new()), Box::new(StiffMethod::<16>::new())),
            _ => (Box::new(ExplicitMethod::<LARGEST>::new()), Box::new(StiffMethod::<LARGEST>::new())),
        };
        let rates = Equation(RefCell::new(inner));
        // Where signs change, steps are short for another reason.
        let stiff = slopes.filter(|_| switches.is_none()).map(|_| stiff);
        Self {
            rates,
            solver,
            stiff,
            is_stiff: false,
            state,
            jumps,
            next_jump: 0,
            slack,
            left: MOST_STEPS_IN_ALL,
            until: 0.0,
        }
    }

    /// The same for a run with this end: given up once that would take too many steps.
    pub(crate) fn until(self, end: f64) -> Self {
        Self { until: end, ..self }
    }

    /// Integrates the state in `table` from the instant `from` to `to`, all other values held.
    pub(crate) fn advance(&mut self, table: &mut [f64], from: f64, to: f64) -> Result<(), Standstill> {
        let mut at = from;
        while let Some(&jump) = self.jumps.get(self.next_jump).filter(|jump| **jump < to - self.slack) {
            self.next_jump += 1;
            if jump > at + self.slack {
                self.integrate(table, at, jump)?;
                at = jump;
            }
        }
        self.integrate(table, at, to)?;
        let taken = MOST_STEPS_IN_ALL - self.left;
        if taken > ENOUGH_STEPS && real(taken) * self.until > real(MOST_STEPS_IN_ALL) * to {
            let state = table[self.state.clone()].to_vec();
            let fast = self.rates.0.get_mut().fastest(&state);
            return Err(Standstill { steps: taken, at: to, state, fast });
        }
        Ok(())
    }

    fn integrate(&mut self, table: &mut [f64], from: f64, to: f64) -> Result<(), Standstill> {
        let rates = self.rates.0.get_mut();
        rates.table.copy_from_slice(table);
        rates.origin = from;
        rates.aside = ASIDE * (to - from);
        for (_, signal) in &mut rates.signals {
            signal.select(from + self.slack);
        }
        let state = &mut table[self.state.clone()];
        if let Some(switching) = &mut rates.switching {
            switching.begin(to - from);
            return self.switch(state, from, to);
        }
        self.left -= self.smooth(state, to - from)?;
        Ok(())
    }

    /// Integrates the state over `length` seconds of smooth rates; returns the number of steps.
    fn smooth(&mut self, state: &mut [f64], length: f64) -> Result<u64, Standstill> {
        let most = self.left.min(MOST_STEPS);
        let Some(stiff) = &mut self.stiff else { return self.solver.solve(&self.rates, state, length, most, None) };
        if self.is_stiff {
            return stiff.solve(&self.rates, state, length, most, None);
        }
        let few = most.min(MANY_STEPS);
        let mut begun = state.to_vec();
        match self.solver.solve(&self.rates, &mut begun, length, few, None) {
            Ok(steps) => {
                state.copy_from_slice(&begun);
                return Ok(steps);
            }
            // More steps would not help.
            Err(standstill) if standstill.steps < few => return Err(standstill),
            Err(_) => {}
        }
        begun.copy_from_slice(state);
        if let Ok(steps) = stiff.solve(&self.rates, &mut begun, length, few, None) {
            state.copy_from_slice(&begun);
            self.is_stiff = true;
            return Ok(steps);
        }
        self.stiff = None;
        self.solver.solve(&self.rates, state, length, most, None)
    }

    /// Integrates the state from one change of a sign to the next.
    fn switch(&mut self, state: &mut [f64], from: f64, to: f64) -> Result<(), Standstill> {
        let length = to - from;
        let (mut at, mut reached, mut most) = (0.0, Vec::new(), self.left.min(MOST_STEPS));
        let left = most;
        let mut switches = 0;
        while length - at > SHORTEST * length {
            let rest = length - at;
            self.rates.0.get_mut().begin(from + at, state, &reached);
            if switches == MOST_SWITCHES {
                let part = rest.min(length / LOOKS);
                most -= self.solver.solve(&self.rates, state, part, most, None)?;
                at += part;
                continue;
            }
            switches += 1;
            // The last step before a sign changes, and the one after it.
            let (mut before, mut after) = ((0.0, state.to_vec()), None);
            let rates = &self.rates;
            let mut watch = |t: f64, state: &[f64]| {
                let is_reached = rates.0.borrow_mut().reached(t, state).is_some();
                if is_reached {
                    after = Some((t, state.to_vec()));
                } else {
                    before = (t, state.to_vec());
                }
                is_reached
            };
            most -= self.solver.solve(rates, state, rest, most, Some(&mut watch))?;
            let Some((t, end)) = after else {
                at = length;
                continue;
            };
            let (start, begun) = before;
            let (mut early, mut late, mut end) = (0.0, t - start, end);
            self.rates.0.get_mut().origin = from + at + start;
            while late - early > SHORTEST * length {
                let middle = early + (late - early) / 2.0;
                let mut halved = begun.clone();
                most -= self.solver.solve(&self.rates, &mut halved, middle, most, None)?;
                if self.rates.0.get_mut().reached(middle, &halved).is_some() {
                    (late, end) = (middle, halved);
                } else {
                    early = middle;
                }
            }
            reached = self.rates.0.get_mut().reached(late, &end).unwrap_or_default();
            state.copy_from_slice(&end);
            at += start + late;
            if switches == MOST_SWITCHES {
                reached.clear();
            }
        }
        self.left -= left - most;
        Ok(())
    }
}
