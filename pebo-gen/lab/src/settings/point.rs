//! The operating point, at which slopes are taken.
//!
//! In: the section `simulation` with the plant's start and inputs. Out: numbers for parameters, states, outputs and
//! inputs as far as they are known, and the values of formulas there.

use std::collections::BTreeMap;

use pebo_cas::{Expr, Symbol};
use pebo_design::model::{Entry, Formula, Model, Piece};
use pebo_design::plant::{Plant, Scope, lower};
use pebo_design::program::{self, Interpreter};

use super::shown::Shown;

/// An unknown order of magnitude: 1 of its unit.
pub(super) const UNIT: f64 = 1.0;

/// Numbers for symbols.
#[derive(Clone, Debug)]
pub(super) struct Point<'a> {
    plant: &'a Plant,
    values: BTreeMap<Symbol, f64>,
}

impl<'a> Point<'a> {
    /// The points along the course of samples, with the numbers of this one for all other symbols; this alone where there are
    /// no samples.
    pub(super) fn along(&self, shown: &Shown) -> Vec<Self> {
        match shown.course.as_slice() {
            [] => vec![self.clone()],
            course => course.iter().map(|row| self.with(&shown.signals, row)).collect(),
        }
    }

    /// The start of the plant: the first samples, and besides what the model says; a formula that has no value there is
    /// left out.
    pub(super) fn of(model: &Model, plant: &'a Plant, shown: &Shown) -> Self {
        let mut point = Self::of_model(model, plant);
        point.values.extend(&shown.first);
        if shown.is_recorded {
            for (state, value) in &plant.known {
                if !point.values.contains_key(state) {
                    point.set(*state, Some(value.expr));
                }
            }
            // Nobody says where the plant of a recording started: a state has the order of magnitude of its unit.
            for state in &plant.x {
                point.values.entry(state.symbol).or_insert(UNIT);
            }
        }
        point
    }

    fn of_model(model: &Model, plant: &'a Plant) -> Self {
        let arena = &plant.arena;
        let given = plant.parameters.iter().filter_map(|p| Some((p.symbol, p.value.as_ref()?.to_f64())));
        let mut point = Self { plant, values: given.collect() };
        point.values.extend(plant.time.map(|time| (time, 0.0)));
        let Some(simulation) = &model.simulation else { return point };
        let mut scope = Scope::new();
        for parameter in &plant.parameters {
            scope.define(arena.name(parameter.symbol), arena.of_symbol(parameter.symbol));
        }
        scope.define("t", arena.zero());
        for (name, formula) in firsts(&simulation.signals).chain(firsts(&simulation.plant)) {
            if let Ok(value) = lower(arena, &scope, formula) {
                scope.define(name, value);
            }
        }
        // The true values of parameters are not the model's.
        for parameter in &plant.parameters {
            scope.define(arena.name(parameter.symbol), arena.of_symbol(parameter.symbol));
        }
        let states = || plant.x.iter().map(|state| state.symbol).chain(plant.y.iter().map(|output| output.symbol));
        let courses: Vec<Symbol> = states().collect();
        for symbol in courses {
            let name = arena.name(symbol);
            let written = simulation.initial.iter().find(|entry| entry.name.value == name).map(|entry| &entry.value);
            let course = || firsts(&simulation.plant).find(|(known, _)| *known == name).map(|(_, formula)| formula);
            let value = written.or_else(course).and_then(|formula| lower(arena, &scope, formula).ok());
            let known = || plant.known.iter().find(|(known, _)| *known == symbol).map(|(_, value)| value.expr);
            point.set(symbol, value.or_else(known));
        }
        for output in &plant.y {
            if !point.values.contains_key(&output.symbol) {
                point.set(output.symbol, output.value.map(|value| value.expr));
            }
        }
        for symbol in states() {
            scope.define(arena.name(symbol), arena.of_symbol(symbol));
            scope.define_estimate(arena.name(symbol), arena.of_symbol(symbol));
        }
        for entry in model.define.iter().chain(&simulation.define) {
            if let Ok(value) = lower(arena, &scope, &entry.value) {
                scope.define(&entry.name.value, value);
            }
        }
        for input in plant.commanded() {
            let name = arena.name(input);
            let law = simulation.control.iter().find(|entry| entry.name.value == name);
            point.set(input, law.and_then(|entry| lower(arena, &scope, &entry.value).ok()));
        }
        // Outputs given by value may need inputs.
        for output in &plant.y {
            if !point.values.contains_key(&output.symbol) {
                point.set(output.symbol, output.value.map(|value| value.expr));
            }
        }
        point
    }

    fn set(&mut self, symbol: Symbol, formula: Option<Expr>) {
        let value = formula.and_then(|formula| self.value(formula)).filter(|value| value.is_finite());
        if let Some(value) = value {
            self.values.insert(symbol, value);
        }
    }

    /// The same point with more or other numbers.
    pub(super) fn with(&self, symbols: &[Symbol], numbers: &[f64]) -> Self {
        let mut point = self.clone();
        point.values.extend(symbols.iter().copied().zip(numbers.iter().copied()));
        point
    }

    /// Points around the periods of the states that are angles; none where no state is one. With several angles each goes
    /// round at a pace of its own.
    pub(super) fn turned(&self, count: u32) -> Vec<Self> {
        let angles = self.plant.x.iter().filter_map(|state| {
            let period = self.value(self.plant.period(state.symbol)?)?;
            Some((state.symbol, self.of_symbol(state.symbol)?, period))
        });
        let angles: Vec<(Symbol, f64, f64)> = angles.collect();
        let count = if angles.is_empty() { 0 } else { count };
        let turned = |part: u32| {
            let moved = (1_u32..)
                .zip(&angles)
                .map(|(pace, (_, at, period))| at + period * f64::from(part * pace % count) / f64::from(count));
            let symbols: Vec<Symbol> = angles.iter().map(|(symbol, ..)| *symbol).collect();
            self.with(&symbols, &moved.collect::<Vec<f64>>())
        };
        (0..count).map(turned).collect()
    }

    /// The number of a symbol.
    pub(super) fn of_symbol(&self, symbol: Symbol) -> Option<f64> {
        self.values.get(&symbol).copied()
    }

    /// The first parameter, state, output or input of these formulas that has no number.
    pub(super) fn lacks(&self, formulas: &[Expr]) -> Option<Symbol> {
        let plant = self.plant;
        let states = plant.x.iter().map(|state| state.symbol).chain(plant.y.iter().map(|output| output.symbol));
        let parameters = plant.parameters.iter().map(|parameter| parameter.symbol);
        let used = plant.arena.symbols_of(formulas);
        let mut all = parameters.chain(states).chain(plant.u.iter().copied());
        all.find(|symbol| used.contains(symbol) && !self.values.contains_key(symbol))
    }

    /// The values of formulas, NaN outside their domains. None where a symbol has no number.
    pub(super) fn values(&self, formulas: &[Expr]) -> Option<Vec<f64>> {
        let symbols: Vec<Symbol> = self.values.keys().copied().collect();
        let numbers: Vec<f64> = self.values.values().copied().collect();
        let program = program::lower(&self.plant.arena, &symbols, formulas).ok()?;
        let mut values = vec![0.0; formulas.len()];
        Interpreter::new(&program).run(&numbers, &mut values);
        Some(values)
    }

    /// The value of a formula, if its symbols have numbers.
    pub(super) fn value(&self, formula: Expr) -> Option<f64> {
        Some(self.values(&[formula])?[0])
    }
}

/// The first pieces of signals.
fn firsts(entries: &[Entry<Vec<Piece>>]) -> impl Iterator<Item = (&str, &Formula)> {
    entries.iter().filter_map(|entry| Some((entry.name.value.as_str(), &entry.value.first()?.formula)))
}
