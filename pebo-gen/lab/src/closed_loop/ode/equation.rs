//! The differential equation of a run, for the methods that integrate it.
//!
//! In: programs of rates and their derivatives, with the table that they read. Out: their values at an instant and a
//! state.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;

use differential_equations::ode::ODE;
use pebo_runtime::nalgebra::{SMatrix, SVector};

use pebo_design::program::Interpreter;

use super::switching::SwitchState;
use crate::closed_loop::signal::SignalCursor;
use crate::experiment::layout::TIME;

/// The relative tolerance. Errors of estimates matter down to a millionth; the truth has to be much better than that.
pub(crate) const RELATIVE: f64 = 1e-10;

/// The absolute tolerance, for states that pass through zero: far below any value of interest in SI units.
pub(crate) const ABSOLUTE: f64 = 1e-12;

/// A smaller rate is zero: over years it moves nothing by as much as [`ABSOLUTE`]. The library divides by the square of
/// a step's error, which underflows for a rate that fades away.
const STILL: f64 = 1e-100;

/// The shortest step that still makes progress, as a share of the interval.
pub(crate) const SHORTEST: f64 = 1e-12;

/// A standstill of the integration.
#[derive(Clone, Debug)]
pub(crate) struct Standstill {
    /// The steps that it took.
    pub(crate) steps: u64,
    /// The time, in seconds.
    pub(crate) at: f64,
    /// The last state.
    pub(crate) state: Vec<f64>,
    /// If it advanced, but too slowly for the run: the index of the fastest state, and its rate in 1/s.
    pub(crate) fast: Option<(usize, f64)>,
}

/// The right side as the library calls it: through a shared reference.
#[derive(Debug)]
pub(crate) struct Equation(pub(crate) RefCell<Rates>);

/// The right side, with the table that its formulas read.
#[derive(Debug)]
pub(crate) struct Rates {
    pub(crate) table: Vec<f64>,
    pub(crate) state: Range<usize>,
    /// The time at which the integration began.
    pub(crate) origin: f64,
    /// Signals that the rates depend on, with their positions in the table.
    pub(crate) signals: Vec<(usize, SignalCursor)>,
    pub(crate) formulas: Interpreter,
    /// The derivatives of the formulas by the state, by rows.
    pub(crate) slopes: Option<Interpreter>,
    /// True if the rates depend on more than the state.
    pub(crate) moves: bool,
    pub(crate) switching: Option<SwitchState>,
    /// The distance of the difference quotient for the signals' rates, to either side, in seconds.
    pub(crate) aside: f64,
}

impl Rates {
    /// Writes state, time and signals of an instant into the table, `t` seconds behind the origin.
    pub(crate) fn place(&mut self, t: f64, state: &[f64]) {
        let now = self.origin + t;
        self.table[TIME] = now;
        let (moving, aside) = (self.switching.iter().flat_map(|switching| &switching.moving), self.aside);
        for (position, signal) in &mut self.signals {
            self.table[*position] = signal.value(now);
            for (_, rate) in moving.clone().filter(|(of, _)| of == position) {
                self.table[*rate] = (signal.value(now + aside) - signal.value(now - aside)) / (2.0 * aside);
            }
        }
        self.table[self.state.clone()].copy_from_slice(&state[..self.state.len()]);
    }

    /// Writes time and signals of an instant into the table, `t` seconds behind the origin.
    pub(crate) fn follow(&mut self, t: f64) {
        let now = self.origin + t;
        self.table[TIME] = now;
        for (position, signal) in &mut self.signals {
            self.table[*position] = signal.value(now);
        }
    }

    /// The fastest component of the state where the integration was last, and its rate in 1/s, in any units.
    pub(crate) fn fastest(&mut self, state: &[f64]) -> Option<(usize, f64)> {
        let (slopes, table, place) = (self.slopes.as_mut()?, &self.table, &self.state);
        let of =
            |position: usize| if place.contains(&position) { state[position - place.start] } else { table[position] };
        let slopes: Vec<f64> = slopes.evaluate(of).collect();
        let count = state.len();
        // By itself, or combined with another, back and forth.
        let rate = |row: usize| {
            (0..count)
                .map(|other| (slopes[row * count + other] * slopes[other * count + row]).abs().sqrt())
                .fold(0.0, f64::max)
        };
        (0..count).map(|row| (row, rate(row))).max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Prepares an integration from this instant.
    pub(crate) fn begin(&mut self, origin: f64, state: &[f64], reached: &[bool]) {
        self.origin = origin;
        self.place(0.0, state);
        if let Some(switching) = &mut self.switching {
            switching.decide(&mut self.table, reached);
        }
    }

    /// The switches whose mode has ended.
    pub(crate) fn reached(&mut self, t: f64, state: &[f64]) -> Option<Vec<bool>> {
        self.place(t, state);
        self.switching.as_mut()?.reached(&mut self.table)
    }
}

/// Called at each step's end, with the seconds since the start and the state; true ends the integration.
pub(crate) type StepCallback<'a> = dyn FnMut(f64, &[f64]) -> bool + 'a;

/// A method that integrates a state.
pub(crate) trait Solver: fmt::Debug {
    /// Advances the state by `length` seconds in at most this number of steps, or until the callback ends it; returns
    /// the number of steps.
    fn solve(
        &mut self,
        rates: &Equation,
        state: &mut [f64],
        length: f64,
        most: u64,
        watch: Option<&mut StepCallback<'_>>,
    ) -> Result<u64, Standstill>;
}

impl<const N: usize> ODE<f64, [f64; N]> for Equation {
    fn diff(&self, t: f64, state: &[f64; N], rates: &mut [f64; N]) {
        let mut inner = self.0.borrow_mut();
        if inner.switching.is_some() {
            inner.place(t, state);
            let Rates { table, switching, .. } = &mut *inner;
            if let Some(switching) = switching {
                switching.hold(table);
            }
        }
        inner.follow(t);
        let Rates { table, state: place, formulas, .. } = &mut *inner;
        let of =
            |position: usize| if place.contains(&position) { state[position - place.start] } else { table[position] };
        for (index, value) in formulas.evaluate(of).enumerate() {
            rates[index] = if value.abs() < STILL { 0.0 } else { value };
        }
        rates[place.len()..].fill(0.0);
    }
}

impl Equation {
    /// The instant at which the integration's time is zero.
    pub(crate) fn origin(&self) -> f64 {
        self.0.borrow().origin
    }

    /// True if the rates depend on more than the state.
    pub(crate) fn moves(&self) -> bool {
        self.0.borrow().moves
    }

    /// The rates.
    pub(crate) fn at<const N: usize>(&self, t: f64, state: &SVector<f64, N>) -> SVector<f64, N> {
        let mut rates = [0.0; N];
        self.diff(t, &state.data.0[0], &mut rates);
        rates.into()
    }

    /// The derivatives of the rates by the state; zero for the padding.
    pub(crate) fn slopes<const N: usize>(&self, t: f64, state: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        let mut inner = self.0.borrow_mut();
        inner.follow(t);
        let Rates { table, state: place, slopes, .. } = &mut *inner;
        let mut matrix = SMatrix::zeros();
        let Some(slopes) = slopes else { return matrix };
        let of =
            |position: usize| if place.contains(&position) { state[position - place.start] } else { table[position] };
        for (index, value) in slopes.evaluate(of).enumerate() {
            matrix[(index / place.len(), index % place.len())] = value;
        }
        matrix
    }
}
