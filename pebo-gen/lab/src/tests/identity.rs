//! The identity of the transform, z = chi + theta (z = xi + Psi theta in a generalised cascade), along the run of
//! every accepted model.
//!
//! The identity is one of differential equations. A sampled observer integrates h by the trapezoidal rule, so its own
//! chi is off by the square of the step; that says nothing about the transform. So the plant and the extension are
//! integrated here as one equation, along the closed loop with the inputs of its observer; and the error of sampling is
//! tested to be of second order, which is its cause.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

use crate::closed_loop::ode::Flow;
use crate::closed_loop::simulated::SimulatedPlant;
use crate::experiment::follow::ExperimentState;
use crate::experiment::layout::time;
use crate::{Overrides, Scenario};
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::{Model, Observer, RegressionForm};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, lower};

use super::run::ROTATION;
use super::{read, with};

/// The share of a component's largest absolute value so far by which the two sides may differ. Relative to that, and
/// not to the value at the instant, since momenta and currents pass through zero.
const SHARE: f64 = 1e-9;

/// The rounding error: some hundred units in the last place of the two sides, which are summed up from a run's steps.
const ROUNDING: f64 = 1e-13;

/// Samples in which the sampled extension is compared; enough for the inputs and outputs to move.
const SAMPLES: u64 = 200;

/// Samples of a whole run in which the identity is looked at: the loop is closed through the estimates, at least so
/// often.
const MOST_SAMPLES: u64 = 20_000;

/// The closed loop of a text, with the programs of its transform.
struct Loop {
    plant: Plant,
    derivation: Derivation,
    model: Model,
}

impl Loop {
    /// Without re-basing, which replaces the identity at every sample by another, without the steps of a plant, which
    /// no transform knows, and without baselines and their panels.
    fn of(text: &str) -> Self {
        let mut model = read(text).unwrap();
        // In the output form outputs are among the coordinates.
        if !model.observer.has_gains() {
            let extension = std::mem::take(&mut model.observer.extension);
            // A monotone regression takes its samples one by one.
            let is_monotone = model.regression_form.as_ref().is_some_and(|form| form.value == RegressionForm::Monotone);
            let gains = if is_monotone { "observer: {window: 1, gain: 1}" } else { PENDULUM };
            let gains =
                read(&format!("model: m\nx: [p]\ny: [q]\nu: [tau]\nf_x: {{p: tau}}\nf_y: {{q: p}}\n{gains}")).unwrap();
            model.observer = Observer { extension, ..gains.observer };
        }
        if let Some(simulation) = &mut model.simulation {
            simulation.baselines.clear();
            simulation.panels.clear();
        }
        for course in model.simulation.iter_mut().flat_map(|simulation| &mut simulation.plant) {
            course.value.truncate(1);
        }
        let plant = Plant::resolve(&model).unwrap();
        let derivation = Derivation::derive(&plant);
        Self { plant, derivation, model }
    }

    fn scenario(&self, overrides: &Overrides) -> Scenario {
        let mut scenario = Scenario::resolve(&self.model, &self.plant, &self.derivation, overrides).unwrap();
        scenario.experiment.design.settings.rebase = None;
        scenario
    }

    fn at_values(&self, formulas: &[Expr]) -> Vec<Expr> {
        let given = self.plant.parameters.iter().filter_map(|p| Some((p.symbol, p.value.clone()?)));
        let numbers: BTreeMap<Symbol, Expr> = given.map(|(s, value)| (s, self.plant.arena.number(value))).collect();
        self.plant.arena.substitute_all(formulas, &numbers)
    }

    /// The extension with its rates and its start: chi, or xi and the entries of Psi.
    fn extension(&self, chi_0: &[f64]) -> (Vec<Symbol>, Vec<Expr>, Vec<f64>) {
        let (plant, cascade) = (&self.plant, self.derivation.cascade.result.as_ref().unwrap());
        let Some(lambda) = &cascade.lambda else { return (plant.chi.clone(), cascade.h.clone(), chi_0.to_vec()) };
        let arena = &plant.arena;
        let times = |row: &[Expr], vector: &mut dyn Iterator<Item = Symbol>| {
            arena.sum(row.iter().zip(vector).map(|(a, b)| arena.mul(*a, arena.of_symbol(b))))
        };
        let (mut symbols, mut start) = (plant.xi.clone(), chi_0.to_vec());
        let moved = lambda.iter().map(|row| times(row, &mut plant.xi.iter().copied()));
        let mut rates: Vec<Expr> = moved.zip(&cascade.h).map(|(moved, h)| arena.add(moved, *h)).collect();
        for (i, (entries, row)) in plant.psi.iter().zip(lambda).enumerate() {
            for (j, entry) in entries.iter().enumerate() {
                symbols.push(*entry);
                rates.push(times(row, &mut plant.psi.iter().map(|r| r[j])));
                start.push(if i == j { 1.0 } else { 0.0 });
            }
        }
        (symbols, rates, start)
    }

    /// The largest difference of the two sides along the run, as a share of the component. Sampled so often at most:
    /// the identity does not depend on the sampling.
    fn worst(&self, samples: u64) -> f64 {
        let own = self.scenario(&Overrides::default());
        let step = own.timing.step.max(own.timing.at(own.samples()) / crate::timing::real(samples));
        let scenario = self.scenario(&Overrides { step: Some(step), ..Overrides::default() });
        let (plant, arena, layout) = (&self.plant, &self.plant.arena, &scenario.experiment.layout);
        let (extension, moves, start) = self.extension(&scenario.experiment.design.settings.chi_0);
        let known = plant.rates();
        let outputs = plant.y.iter().map(|output| output.symbol).filter(|output| known.contains_key(output));
        let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).chain(outputs).collect();
        let mut rates: Vec<Expr> = states.iter().map(|state| known[state]).collect();
        rates.extend(moves);
        let outside: Vec<Symbol> = layout.u.clone().chain(layout.signals.clone()).map(|i| layout.symbols[i]).collect();
        let symbols = [vec![time(arena)], states.clone(), extension.clone(), outside].concat();
        let state = 1..=states.len() + extension.len();
        let state = *state.start()..state.end() + 1;

        let mut progress = |_| ControlFlow::Continue(());
        let mut plant_state = SimulatedPlant::new(&scenario, &mut progress);
        let mut machine = ExperimentState::start(&scenario.experiment).unwrap();
        machine.step(&mut plant_state).unwrap();
        let mut table = vec![0.0; symbols.len()];
        for (state, place) in states.iter().zip(1..) {
            let position = layout.symbols.iter().position(|symbol| symbol == state).unwrap();
            table[place] = machine.table[position];
        }
        table[states.len() + 1..state.end].copy_from_slice(&start);
        let inputs = state.end..state.end + layout.u.len();
        let signals: Vec<_> = (inputs.end..).zip(&scenario.signals).collect();
        let rates = lower(arena, &symbols, &self.at_values(&rates)).unwrap();
        let mut flow = Flow::new((&rates, None), None, state.clone(), &signals, scenario.timing.slack());

        let z_of = lower(arena, &symbols, &self.at_values(&plant.transform())).unwrap();
        let (mut z_of, n) = (Interpreter::new(&z_of), plant.phi.len());
        let mut z = vec![0.0; n];
        z_of.run(&table, &mut z);
        let theta: Vec<f64> = z.iter().zip(&start).map(|(z, chi)| z - chi).collect();
        let sum = |own: &[f64]| -> Vec<f64> {
            let psi = |i: usize, j: usize| own.get(n + i * n + j).copied().unwrap_or(if i == j { 1.0 } else { 0.0 });
            (0..n).map(|i| own[i] + (0..n).map(|j| psi(i, j) * theta[j]).sum::<f64>()).collect()
        };
        let mut largest: Vec<f64> = z.iter().map(|z| z.abs()).collect();
        let mut worst = 0.0_f64;
        for sample in 1..=scenario.samples() {
            table[inputs.clone()].copy_from_slice(&machine.table[layout.u.clone()]);
            for (to, from) in (inputs.end..symbols.len()).zip(layout.signals.clone()) {
                table[to] = machine.table[from];
            }
            let (from, to) = (scenario.timing.at(sample - 1), scenario.timing.at(sample));
            flow.advance(&mut table, from, to).unwrap();
            table[0] = to;
            assert!(machine.step(&mut plant_state).unwrap());
            z_of.run(&table, &mut z);
            for ((z, other), largest) in z.iter().zip(sum(&table[states.len() + 1..state.end])).zip(&mut largest) {
                *largest = largest.max(z.abs());
                worst = worst.max((z - other).abs() / *largest);
            }
        }
        worst
    }

    /// The error of the observer's own, sampled, extension after some samples: the largest over the time of `SAMPLES`
    /// steps of the file's, for each component, with its possible rounding.
    fn sampled(&self, refined: u64) -> Vec<(f64, f64)> {
        let step = self.scenario(&Overrides::default()).timing.step;
        let refine = |steps: u64| step / crate::timing::real(steps);
        let overrides = Overrides { step: Some(refine(refined)), ..Overrides::default() };
        let scenario = self.scenario(&overrides);
        let (plant, layout) = (&self.plant, &scenario.experiment.layout);
        let symbols = &layout.symbols[..layout.state.end];
        let z_of = lower(&plant.arena, symbols, &self.at_values(&plant.transform())).unwrap();
        let mut z_of = Interpreter::new(&z_of);
        let mut progress = |_| ControlFlow::Continue(());
        let mut plant_state = SimulatedPlant::new(&scenario, &mut progress);
        let mut machine = ExperimentState::start(&scenario.experiment).unwrap();
        machine.step(&mut plant_state).unwrap();
        let mut z = vec![0.0; plant.phi.len()];
        z_of.run(&machine.table[..symbols.len()], &mut z);
        let theta: Vec<f64> =
            z.iter().zip(&scenario.experiment.design.settings.chi_0).map(|(z, chi)| z - chi).collect();
        let mut worst = vec![(0.0_f64, 0.0_f64); z.len()];
        for _ in 1..=SAMPLES * refined {
            assert!(machine.step(&mut plant_state).unwrap());
            z_of.run(&machine.table[..symbols.len()], &mut z);
            for ((z, other), (off, scale)) in z.iter().zip(machine.driver.observer.coordinates(&theta)).zip(&mut worst)
            {
                *off = off.max((z - other).abs());
                *scale = scale.max(z.abs()).max(1e-3);
            }
        }
        worst.into_iter().map(|(off, scale)| (off, ROUNDING * scale)).collect()
    }
}

/// The smallest model says nothing about simulation.
const PENDULUM: &str = "\
observer: {filter: 20, gain: 2}
simulation: {duration: 4, step: 1e-4, initial: {p: 0.5, q: 1}, control: {tau: 0}}
";

/// Every model of the project, and a generalised cascade, of which it has none: names and texts.
fn models() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.filter(|path| path.extension().is_some_and(|e| e == "yaml")).collect();
    files.sort();
    let mut found = vec![("a generalised cascade".to_owned(), ROTATION.to_owned())];
    for file in files {
        let mut text = std::fs::read_to_string(&file).unwrap();
        if !text.contains("\nsimulation:") {
            text = with(&text, "model: pendulum\n", &format!("model: pendulum\n{PENDULUM}"));
        }
        found.push((file.file_stem().unwrap().to_string_lossy().into_owned(), text));
    }
    assert!(found.len() > 10, "the models are elsewhere");
    found
}

#[test]
fn the_coordinates_are_extension_and_theta_all_along() {
    // Whole runs take a while: two at a time.
    let models = std::sync::Mutex::new(models().into_iter());
    let next = || models.lock().unwrap().next();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((name, text)) = next() {
                    let worst = Loop::of(&text).worst(MOST_SAMPLES);
                    println!("{name}: {worst:.1e}");
                    assert!(worst < SHARE, "{name}: {worst:e}");
                }
            });
        }
    });
}

#[test]
fn the_error_of_sampling_is_of_second_order() {
    for (name, text) in models() {
        let closed = Loop::of(&text);
        for (component, (coarse, fine)) in closed.sampled(2).into_iter().zip(closed.sampled(4)).enumerate() {
            println!("{name} z{}: {:.1e}, {:.1e}", component + 1, coarse.0, fine.0);
            // A quarter by the trapezoidal rule, a half by one of first order.
            assert!(fine.0 < 0.3 * coarse.0 + fine.1, "{name} z{}: {coarse:?} {fine:?}", component + 1);
        }
    }
}
