//! The plant, and the baselines that have equations, between two samples: one ordinary differential equation.
//!
//! Method: Dormand and Prince's explicit Runge-Kutta pair of order 5(4), from a library, started anew
//! at each sample, where the inputs jump, where a signal that the rates depend on jumps, and where a sign in the rates
//! changes (`switching`), which is found by halving the step in which it does.
//! Holds when: the plant is not stiff at its sampling period. The first step tried is the whole
//! interval: a loop that is sampled well needs one step a sample. From an interval on that needs very many, the method for
//! stiff plants (`stiff`) is taken if it needs fewer.
//!
//! One thing with `stiff`: both methods solve the same equation.

use std::cell::RefCell;
use std::fmt;
use std::ops::Range;

use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

use pebo_runtime::nalgebra::{SMatrix, SVector};

use crate::program::{Interpreter, Program};

use super::layout::TIME;
use super::signal::{Course, Signal};
use super::stiff::Stiff;
use super::switching::{Switched, Switching};
use super::timing::real;

/// Errors of estimates are looked at down to a millionth; the truth has to be much better than that.
pub(super) const RELATIVE: f64 = 1e-10;

/// For states that pass through zero: far below any value of interest in SI units.
pub(super) const ABSOLUTE: f64 = 1e-12;

/// A rate this small is zero: over years it moves nothing by as much as [`ABSOLUTE`]. The library divides by the square
/// of a step's error, which for a rate that fades away becomes too small to be divided by.
const STILL: f64 = 1e-100;

/// Steps between two samples before the plant counts as too stiff; about a second of computing.
const MOST_STEPS: u64 = 1_000_000;

/// Explicit steps between two samples from which on the plant may be stiff.
const MANY_STEPS: u64 = 1000;

/// Steps of a whole run: a plant that needs hundreds a sample is given up after minutes, not days.
const MOST_STEPS_IN_ALL: u64 = 400_000_000;

/// Steps after which it is known how many a whole run takes; some seconds of computing at most.
const ENOUGH_STEPS: u64 = 2_000_000;

/// A step that is this small a part of the interval will not get anywhere.
pub(super) const SHORTEST: f64 = 1e-12;

/// The largest state that is integrated.
pub(super) const LARGEST: usize = 64;

/// Changes of signs between two samples that are followed one by one. Where there are more the signs change ever faster, as
/// those of a mass that a relay and friction bring to rest; from then on they are looked at [`LOOKS`] times a period.
const MOST_SWITCHES: u64 = 100;

/// How often between two samples signs may change that change without end: a level then moves by no more than it does in so
/// small a part of the period.
const LOOKS: f64 = 1000.0;

/// How far to either side a signal is looked at for its rate, as a part of the interval: of a formula whose third derivative
/// is one over the interval cubed, the rate errs by 2e-9 of itself.
const ASIDE: f64 = 1e-4;

/// The integration came to a stand.
#[derive(Clone, Debug)]
pub(super) struct Stuck {
    /// The steps that it took.
    pub(super) steps: u64,
    /// When, in seconds.
    pub(super) at: f64,
    /// The last state that it came to.
    pub(super) state: Vec<f64>,
    /// Where it got on, but too slowly for the run: the place of the state that moves fastest, and its rate in 1/s.
    pub(super) fast: Option<(usize, f64)>,
}

/// The differential equation of a run.
#[derive(Debug)]
pub(super) struct Flow {
    rates: Equation,
    solver: Box<dyn Solve>,
    /// The method for stiff plants, until it has shown that it needs as many steps.
    stiff: Option<Box<dyn Solve>>,
    /// Whether the plant has shown that it is stiff.
    is_stiff: bool,
    state: Range<usize>,
    /// When the rates jump.
    jumps: Vec<f64>,
    next_jump: usize,
    slack: f64,
    /// The steps that may still be taken.
    left: u64,
    /// The end of the run in seconds, if it is known.
    until: f64,
}

/// The right side as the library calls it: through a shared reference.
#[derive(Debug)]
pub(super) struct Equation(RefCell<Rates>);

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
    /// The derivatives of the formulas by the state, by rows.
    slopes: Option<Interpreter>,
    /// Whether the rates depend on more than the state.
    moves: bool,
    switching: Option<Switching>,
    /// How far to either side of an instant signals are looked at for their rates, in seconds.
    aside: f64,
}

impl Flow {
    /// The equation with the rates of the table's positions `state`, and their derivatives by these where it may be stiff; of
    /// the `signals`, those that it reads are followed.
    pub(super) fn new(
        (rates, slopes): (&Program, Option<&Program>),
        switches: Option<&Switched>,
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
            switching: switches.map(|switches| Switching::new(switches, (RELATIVE, ABSOLUTE))),
            aside: 0.0,
        };
        // A library's step takes an array: sizes are rounded up, and what is beyond the state stays 0.
        let (solver, stiff): (Box<dyn Solve>, Box<dyn Solve>) = match state.len() {
            0..=4 => (Box::new(Solver::<4>::new()), Box::new(Stiff::<4>::new())),
            5..=8 => (Box::new(Solver::<8>::new()), Box::new(Stiff::<8>::new())),
            9..=16 => (Box::new(Solver::<16>::new()), Box::new(Stiff::<16>::new())),
            _ => (Box::new(Solver::<LARGEST>::new()), Box::new(Stiff::<LARGEST>::new())),
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

    /// The same for a run that ends then: once it is known that this would take too many steps, it is given up.
    pub(super) fn until(self, end: f64) -> Self {
        Self { until: end, ..self }
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
        self.integrate(table, at, to)?;
        let taken = MOST_STEPS_IN_ALL - self.left;
        if taken > ENOUGH_STEPS && real(taken) * self.until > real(MOST_STEPS_IN_ALL) * to {
            let state = table[self.state.clone()].to_vec();
            let fast = self.rates.0.get_mut().fastest(&state);
            return Err(Stuck { steps: taken, at: to, state, fast });
        }
        Ok(())
    }

    fn integrate(&mut self, table: &mut [f64], from: f64, to: f64) -> Result<(), Stuck> {
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

    /// Moves the state on by `length` seconds of smooth rates; gives the number of steps.
    fn smooth(&mut self, state: &mut [f64], length: f64) -> Result<u64, Stuck> {
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
            // It will not get on with more steps.
            Err(stuck) if stuck.steps < few => return Err(stuck),
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

    /// Moves the state on from one change of a sign to the next.
    fn switch(&mut self, state: &mut [f64], from: f64, to: f64) -> Result<(), Stuck> {
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

impl Rates {
    /// Writes state, time and signals of an instant into the table, `t` seconds behind the origin.
    fn place(&mut self, t: f64, state: &[f64]) {
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
    fn follow(&mut self, t: f64) {
        let now = self.origin + t;
        self.table[TIME] = now;
        for (position, signal) in &mut self.signals {
            self.table[*position] = signal.value(now);
        }
    }

    /// Which component of the state moves fastest where the integration was last, and its rate in 1/s, whatever the units.
    fn fastest(&mut self, state: &[f64]) -> Option<(usize, f64)> {
        let (slopes, table, place) = (self.slopes.as_mut()?, &self.table, &self.state);
        let of =
            |position: usize| if place.contains(&position) { state[position - place.start] } else { table[position] };
        let slopes: Vec<f64> = slopes.evaluate(of).collect();
        let count = state.len();
        // By itself, or to and fro with another.
        let rate = |row: usize| {
            (0..count)
                .map(|other| (slopes[row * count + other] * slopes[other * count + row]).abs().sqrt())
                .fold(0.0, f64::max)
        };
        (0..count).map(|row| (row, rate(row))).max_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Before an integration from this instant.
    fn begin(&mut self, origin: f64, state: &[f64], reached: &[bool]) {
        self.origin = origin;
        self.place(0.0, state);
        if let Some(switching) = &mut self.switching {
            switching.decide(&mut self.table, reached);
        }
    }

    /// Which switches can no longer do what they do.
    fn reached(&mut self, t: f64, state: &[f64]) -> Option<Vec<bool>> {
        self.place(t, state);
        self.switching.as_mut()?.reached(&mut self.table)
    }
}

/// Told of each step's end, in seconds since the start, with the state there; whether to end there.
pub(super) type Watch<'a> = dyn FnMut(f64, &[f64]) -> bool + 'a;

/// What moves a state on.
pub(super) trait Solve: fmt::Debug {
    /// Moves the state on by `length` seconds in at most so many steps, or to where it is watched to end; gives the number of
    /// steps.
    fn solve(
        &mut self,
        rates: &Equation,
        state: &mut [f64],
        length: f64,
        most: u64,
        watch: Option<&mut Watch<'_>>,
    ) -> Result<u64, Stuck>;
}

/// The method, made once for the run: its start sets all that a step changes but the count of its steps, which nothing
/// depends on.
struct Solver<const N: usize>(DormandPrinceOf<N>);

type DormandPrinceOf<const N: usize> = ExplicitRungeKutta<Ordinary, DormandPrince, f64, [f64; N], 5, 7, 7>;

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
    fn solve(
        &mut self,
        rates: &Equation,
        state: &mut [f64],
        length: f64,
        most: u64,
        mut watch: Option<&mut Watch<'_>>,
    ) -> Result<u64, Stuck> {
        let mut start = [0.0; N];
        start[..state.len()].copy_from_slice(state);
        let method = &mut self.0;
        let origin = rates.0.borrow().origin;
        let stuck = |method: &DormandPrinceOf<N>, steps| Stuck {
            steps,
            at: origin + method.t(),
            state: method.y()[..state.len()].to_vec(),
            fast: None,
        };
        method.h0 = length;
        let mut steps = 0;
        if method.init(rates, 0.0, length, &start).is_err() {
            return Err(Stuck { steps, at: origin, state: state.to_vec(), fast: None });
        }
        loop {
            let rest = length - method.t();
            if rest <= SHORTEST * length {
                break;
            }
            if steps == most || method.h().is_nan() || method.h() <= SHORTEST * length {
                return Err(stuck(method, steps));
            }
            if method.h() > rest {
                method.set_h(rest);
            }
            let before = method.t();
            if method.step(rates).is_err() {
                return Err(stuck(method, steps));
            }
            steps += 1;
            // A step that was refused has moved nothing.
            if method.t() > before
                && let Some(watch) = &mut watch
                && watch(method.t(), &method.y()[..state.len()])
            {
                break;
            }
        }
        state.copy_from_slice(&method.y()[..state.len()]);
        Ok(steps)
    }
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
    /// The instant from which the integration counts.
    pub(super) fn origin(&self) -> f64 {
        self.0.borrow().origin
    }

    /// Whether the rates depend on more than the state.
    pub(super) fn moves(&self) -> bool {
        self.0.borrow().moves
    }

    /// The rates.
    pub(super) fn at<const N: usize>(&self, t: f64, state: &SVector<f64, N>) -> SVector<f64, N> {
        let mut rates = [0.0; N];
        self.diff(t, &state.data.0[0], &mut rates);
        rates.into()
    }

    /// The derivatives of the rates by the state; of what is beyond the state, none.
    pub(super) fn slopes<const N: usize>(&self, t: f64, state: &SVector<f64, N>) -> SMatrix<f64, N, N> {
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
