//! The linearised plant of the model, for baselines by name.
//!
//! In: the plant. Out: programs of the rates and of the outputs, each with its derivatives by the states. The states
//! are those of x and the outputs that have rates; outputs given by value are measured functions of them.

use std::collections::BTreeSet;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Extension as _, Fault, Flow, Fundamental};

use crate::closed_loop::scope::Names;
use crate::closed_loop::truth::Truth;
use crate::observe::design::program;
use crate::observe::sizes::LARGEST;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Expr, Symbol};
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};

/// The programs of a plant in states and inputs.
#[derive(Debug)]
pub(super) struct LinearisedPlant {
    /// The states of x, then outputs that have rates.
    pub(super) states: Vec<Symbol>,
    /// The number of outputs.
    pub(super) outputs: usize,
    /// The index of each output among the states, if it has a rate.
    pub(super) places: Vec<Option<usize>>,
    inputs: usize,
    /// True if no derivative depends on a state, which is proved.
    pub(super) is_affine: bool,
    /// The rates, then their derivatives by rows.
    rates: Program,
    /// The outputs, then their derivatives by rows.
    values: Program,
}

impl LinearisedPlant {
    /// The programs; `span` is that of the baseline.
    pub(super) fn resolve(names: &Names, (name, span): (&str, Span), problems: &mut Diagnostics) -> Option<Self> {
        let (plant, arena) = (names.plant, &names.plant.arena);
        let model = Truth::of_model(names)?;
        let rated = plant.y.iter().filter(|output| !model.gives(output.symbol));
        let mut states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
        let mut rates: Vec<Expr> = plant.x.iter().map(|state| state.rate.expr).collect();
        for output in rated {
            states.push(output.symbol);
            // An output with neither rate nor value has been reported.
            rates.push(output.rate?.expr);
        }
        let values: Vec<Expr> = plant.y.iter().map(|output| arena.of_symbol(output.symbol)).collect();
        let (rates, values) = (model.of_plant(names, &rates), model.of_plant(names, &values));
        let unknown = arena.symbols_of(&[rates.as_slice(), &values].concat()).into_iter().find(|s| plant.w.contains(s));
        if let Some(signal) = unknown {
            let message = format!("`{name}` does not know the unmeasured signal `{}`", arena.name(signal));
            problems.push(
                Diagnostic::error(Code::SimulationUnsupported, span, message)
                    .help("remove it: its plant has states, outputs, inputs and parameters alone"),
            );
            return None;
        }
        if states.len().max(values.len()) > LARGEST {
            let message = format!("`{name}` has {} states and {} outputs", states.len(), values.len());
            problems.push(
                Diagnostic::error(Code::SimulationUnsupported, span, message)
                    .help(format!("the simulator has room for {LARGEST} of each")),
            );
            return None;
        }
        let slopes = |formulas: &[Expr]| -> Vec<Expr> {
            let by_states = |formula: &Expr| states.iter().map(|s| arena.derivative(*formula, *s)).collect::<Vec<_>>();
            formulas.iter().flat_map(by_states).collect()
        };
        let (rate_slopes, value_slopes) = (slopes(&rates), slopes(&values));
        let (among, domain): (BTreeSet<Symbol>, _) = (states.iter().copied().collect(), plant.domain());
        let is_free = |slope: &Expr| {
            let bent = |state: &Symbol| !is_zero(arena, arena.derivative(*slope, *state), &domain);
            !arena.depends_on(*slope, &among) || !states.iter().any(bent)
        };
        let is_affine = rate_slopes.iter().chain(&value_slopes).all(is_free);
        let arguments = [states.as_slice(), &plant.u].concat();
        let mut compile = |parts: [&[Expr]; 2]| problems.keep(program(arena, &arguments, &parts.concat(), span));
        let (rates, values) = (compile([&rates, &rate_slopes])?, compile([&values, &value_slopes])?);
        let place = |output: Symbol| states.iter().position(|state| *state == output);
        Some(Self {
            outputs: plant.y.len(),
            places: plant.y.iter().map(|output| place(output.symbol)).collect(),
            inputs: plant.u.len(),
            states,
            is_affine,
            rates,
            values,
        })
    }
}

/// The programs, with room for their values, padded to N.
#[derive(Debug)]
pub(super) struct PaddedPlant<const N: usize> {
    states: usize,
    outputs: usize,
    inputs: usize,
    rates: Interpreter,
    values: Interpreter,
    arguments: Vec<f64>,
    found: Vec<f64>,
}

/// The transition of states and their errors over a step.
#[derive(Clone, Debug)]
pub(super) struct Transition<const N: usize> {
    /// The states at its end.
    pub(super) state: SVector<f64, N>,
    /// The derivative of the states in the middle of the step by those at its start.
    pub(super) half: SMatrix<f64, N, N>,
    /// The derivative of the states at its end by those at its start.
    pub(super) whole: SMatrix<f64, N, N>,
}

impl<const N: usize> PaddedPlant<N> {
    pub(super) fn new(plant: &LinearisedPlant) -> Self {
        let most = plant.rates.outputs.len().max(plant.values.outputs.len());
        Self {
            states: plant.states.len(),
            outputs: plant.outputs,
            inputs: plant.inputs,
            rates: Interpreter::new(&plant.rates),
            values: Interpreter::new(&plant.values),
            arguments: Vec::new(),
            found: vec![0.0; most],
        }
    }

    /// Advances the states by `dt` seconds with the inputs held: exact for an affine plant, and of second order for
    /// others (the exponential Euler method of Rosenbrock's kind: Hochbruck and Ostermann, *Exponential integrators*,
    /// Acta Numerica, 2010).
    ///
    /// # Errors
    /// A step that is too long for an exponential.
    pub(super) fn advance(&mut self, state: &SVector<f64, N>, u: &[f64], dt: f64) -> Result<Transition<N>, Fault> {
        let (h, lambda) = self.at(state, u, true);
        let flow = Flow { lambda, h };
        let mut motion = Fundamental::<f64, N>::new(SVector::zeros());
        motion.advance(&flow, &flow, dt / 2.0)?;
        let half = *motion.psi();
        motion.advance(&flow, &flow, dt / 2.0)?;
        Ok(Transition { state: state + motion.xi(), half, whole: *motion.psi() })
    }

    /// The outputs, and their derivatives by the states.
    pub(super) fn measure(&mut self, state: &SVector<f64, N>, u: &[f64]) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        self.at(state, u, false)
    }

    fn at(&mut self, state: &SVector<f64, N>, u: &[f64], is_rate: bool) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        self.arguments.clear();
        self.arguments.extend(&state.as_slice()[..self.states]);
        self.arguments.extend(&u[..self.inputs]);
        let (program, rows) = if is_rate { (&mut self.rates, self.states) } else { (&mut self.values, self.outputs) };
        let found = &mut self.found[..rows * (1 + self.states)];
        program.run(&self.arguments, found);
        let (values, slopes) = found.split_at(rows);
        let mut matrix = SMatrix::zeros();
        for (row, slopes) in slopes.chunks_exact(self.states).enumerate() {
            for (column, slope) in slopes.iter().enumerate() {
                matrix[(row, column)] = *slope;
            }
        }
        (crate::observe::sizes::pad(values), matrix)
    }
}
