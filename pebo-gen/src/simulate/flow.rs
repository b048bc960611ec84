//! The plant, and the baselines that have equations, between two samples: one ordinary differential equation.
//!
//! Method: Dormand and Prince's explicit Runge-Kutta pair of order 5(4), from a library, started anew
//! at each sample, where the inputs jump, and where a signal that the rates depend on jumps.
//! Holds when: the plant is not stiff at its sampling period. The first step tried is the whole
//! interval: a loop that is sampled well needs one step a sample.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;

use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

use crate::program::{Interpreter, Program};

use super::layout::TIME;
use super::signal::{Course, Signal};

/// Errors of estimates are looked at down to a millionth; the truth has to be much better than that.
const RELATIVE: f64 = 1e-10;

/// For states that pass through zero: far below any value of interest in SI units.
const ABSOLUTE: f64 = 1e-12;

/// A rate this small is zero: over years it moves nothing by as much as [`ABSOLUTE`]. The library divides by the square
/// of a step's error, which for a rate that fades away becomes too small to be divided by.
const STILL: f64 = 1e-100;

/// Steps between two samples before the plant counts as too stiff; about a second of computing.
const MOST_STEPS: u64 = 1_000_000;

/// Steps of a whole run: a plant that needs hundreds a sample is given up after minutes, not days.
const MOST_STEPS_IN_ALL: u64 = 400_000_000;

/// A step that is this small a part of the interval will not get anywhere.
const SHORTEST: f64 = 1e-12;

/// The largest state that is integrated.
pub(super) const LARGEST: usize = 64;

/// The integration came to a stand after that many steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stuck(pub(super) u64);

/// The differential equation of a run.
#[derive(Debug)]
pub(super) struct Flow {
    rates: Equation,
    solver: Box<dyn Solve>,
    state: Range<usize>,
    /// When the rates jump.
    jumps: Vec<f64>,
    next_jump: usize,
    slack: f64,
    /// The steps that may still be taken.
    left: u64,
}

/// The right side as the library calls it: through a shared reference.
#[derive(Debug)]
struct Equation(RefCell<Rates>);

/// The right side, with the table that its formulas read.
#[derive(Debug)]
struct Rates {
    table: Vec<f64>,
    state: Range<usize>,
    /// Where the integration began.
    origin: f64,
    /// Signals that the rates depend on, with their positions in the table.
    signals: Vec<(usize, Course)>,
    formulas: Interpreter,
}

impl Flow {
    /// The equation with the rates of the table's positions `state`; of the `signals`, those that it reads are followed.
    pub(super) fn new(rates: &Program, state: Range<usize>, signals: &[(usize, &Signal)], slack: f64) -> Self {
        let read: Vec<_> = signals.iter().filter(|(position, _)| rates.reads(*position)).collect();
        let mut jumps: Vec<f64> = read.iter().flat_map(|(_, signal)| signal.jumps()).collect();
        jumps.sort_by(f64::total_cmp);
        let inner = Rates {
            table: vec![0.0; rates.inputs.len()],
            state: state.clone(),
            origin: 0.0,
            signals: read.iter().map(|(position, signal)| (*position, signal.course())).collect(),
            formulas: Interpreter::new(rates),
        };
        // A library's step takes an array: sizes are rounded up, and what is beyond the state stays 0.
        let solver: Box<dyn Solve> = match state.len() {
            0..=4 => Box::new(Solver::<4>::new()),
            5..=8 => Box::new(Solver::<8>::new()),
            9..=16 => Box::new(Solver::<16>::new()),
            _ => Box::new(Solver::<LARGEST>::new()),
        };
        let rates = Equation(RefCell::new(inner));
        Self { rates, solver, state, jumps, next_jump: 0, slack, left: MOST_STEPS_IN_ALL }
    }

    /// Moves the state in `table` from the instant `from` to `to`, all other values held.
    pub(super) fn advance(&mut self, table: &mut [f64], from: f64, to: f64) -> Result<(), Stuck> {
        let mut at = from;
        while let Some(&jump) = self.jumps.get(self.next_jump).filter(|jump| **jump < to - self.slack) {
            self.next_jump += 1;
            if jump > at + self.slack {
                self.integrate(table, at, jump)?;
                at = jump;
            }
        }
        self.integrate(table, at, to)
    }

    fn integrate(&mut self, table: &mut [f64], from: f64, to: f64) -> Result<(), Stuck> {
        let rates = self.rates.0.get_mut();
        rates.table.copy_from_slice(table);
        rates.origin = from;
        for (_, signal) in &mut rates.signals {
            signal.select(from + self.slack);
        }
        let state = &mut table[self.state.clone()];
        self.left -= self.solver.solve(&self.rates, state, to - from, self.left.min(MOST_STEPS))?;
        Ok(())
    }
}

/// What moves a state on.
trait Solve: fmt::Debug {
    /// Moves the state on by `length` seconds in at most so many steps; gives their number.
    fn solve(&mut self, rates: &Equation, state: &mut [f64], length: f64, most: u64) -> Result<u64, Stuck>;
}

/// The method, made once for the run: its start sets all that a step changes but the count of its steps, which nothing
/// depends on.
struct Solver<const N: usize>(ExplicitRungeKutta<Ordinary, DormandPrince, f64, [f64; N], 5, 7, 7>);

impl<const N: usize> Solver<N> {
    fn new() -> Self {
        Self(ExplicitRungeKutta::dopri5().rtol(RELATIVE).atol(ABSOLUTE).max_steps(usize::MAX))
    }
}

impl<const N: usize> fmt::Debug for Solver<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Solver<{N}>")
    }
}

impl<const N: usize> Solve for Solver<N> {
    fn solve(&mut self, rates: &Equation, state: &mut [f64], length: f64, most: u64) -> Result<u64, Stuck> {
        let mut start = [0.0; N];
        start[..state.len()].copy_from_slice(state);
        let method = &mut self.0;
        method.h0 = length;
        let mut steps = 0;
        method.init(rates, 0.0, length, &start).map_err(|_| Stuck(steps))?;
        loop {
            let rest = length - method.t();
            if rest <= SHORTEST * length {
                break;
            }
            if steps == most || method.h().is_nan() || method.h() <= SHORTEST * length {
                return Err(Stuck(steps));
            }
            if method.h() > rest {
                method.set_h(rest);
            }
            method.step(rates).map_err(|_| Stuck(steps))?;
            steps += 1;
        }
        state.copy_from_slice(&method.y()[..state.len()]);
        Ok(steps)
    }
}

impl<const N: usize> ODE<f64, [f64; N]> for Equation {
    fn diff(&self, t: f64, state: &[f64; N], rates: &mut [f64; N]) {
        let mut inner = self.0.borrow_mut();
        let Rates { table, state: place, origin, signals, formulas } = &mut *inner;
        let now = *origin + t;
        table[TIME] = now;
        for (position, signal) in signals {
            table[*position] = signal.value(now);
        }
        let of =
            |position: usize| if place.contains(&position) { state[position - place.start] } else { table[position] };
        for (index, value) in formulas.evaluate(of).enumerate() {
            rates[index] = if value.abs() < STILL { 0.0 } else { value };
        }
        rates[place.len()..].fill(0.0);
    }
}
