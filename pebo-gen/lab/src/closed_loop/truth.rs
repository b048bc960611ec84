//! The true plant of a simulation, which may differ from its model.
//!
//! In: the plant, and the section `simulation`. Out: the true value of each parameter, a number or a course in time,
//! and of each state and output that is not integrated: a constant state with a course, an output given by value. Only
//! the plant's own trajectory uses these; observers and control law have the model's parameters.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::plant::Plant;
use pebo_design::source::{Code, Diagnostic, Diagnostics, listed};

use super::scope::Names;
use crate::experiment::layout::{course, time};

/// The true values of the plant.
#[derive(Debug)]
pub(crate) struct Truth {
    /// The values of the parameters, and of an input that is the time.
    numbers: BTreeMap<Symbol, Expr>,
    /// States and outputs given by value: formulas in the others, inputs and signals.
    given: BTreeMap<Symbol, Expr>,
    /// The plant with its parameters that are zero in the model alone; none where there are none.
    plant: Option<Plant>,
}

/// The plant with the parameters that have a course and are zero in the model, whose formulas are without them.
fn real(names: &Names, problems: &mut Diagnostics) -> Option<Plant> {
    let is_zero = |name: &str| {
        let parameters = names.plant.parameters.iter();
        let mut zeros = parameters.filter(|parameter| parameter.value.as_ref().is_some_and(Rational::is_zero));
        zeros.any(|parameter| names.plant.arena.name(parameter.symbol) == name)
    };
    let courses = names.simulation.plant.iter().map(|entry| entry.name.value.as_str());
    let zeros: Vec<&str> = courses.filter(|name| is_zero(name)).collect();
    if zeros.is_empty() {
        return None;
    }
    match names.plant.with_symbols(names.model, &zeros) {
        Ok(plant) => Some(plant),
        Err(found) => {
            for problem in found {
                problems.push(problem);
            }
            None
        }
    }
}

impl Truth {
    /// The truth of a simulation; contradictions are reported.
    pub(crate) fn resolve(names: &Names, problems: &mut Diagnostics) -> Self {
        let mut truth = Self { numbers: names.numbers(), given: BTreeMap::new(), plant: real(names, problems) };
        // The plant uses the true time, not the samples of it that observers measure.
        let arena = &names.plant.arena;
        truth.numbers.extend(names.plant.time.map(|input| (input, arena.of_symbol(time(arena)))));
        truth.courses(names, problems);
        truth.values(names, problems);
        for entry in &names.simulation.initial {
            let symbol = names.plant.arena.symbol(&entry.name.value);
            if truth.given.contains_key(&symbol) {
                let message = format!("`{}` has a value of its own at the start", entry.name.value);
                problems.push(
                    Diagnostic::error(Code::SettingConflict, entry.name.span, message)
                        .help("remove it from `initial`: its value is what `plant` or `g_y` says"),
                );
            }
        }
        truth
    }

    /// The plant of the model, with outputs given by value substituted; none where these are circular, which is
    /// reported with the truth.
    pub(crate) fn of_model(names: &Names) -> Option<Self> {
        let mut model = Self { numbers: names.numbers(), given: BTreeMap::new(), plant: None };
        let mut circles = Diagnostics::new();
        model.values(names, &mut circles);
        (!circles.has_errors()).then_some(model)
    }

    /// Parameters and constant states with a course.
    fn courses(&mut self, names: &Names, problems: &mut Diagnostics) {
        let arena = &names.plant.arena;
        for entry in &names.simulation.plant {
            let name = &entry.name.value;
            let symbol = arena.symbol(name);
            let value = arena.of_symbol(course(arena, name));
            let Some(state) = names.plant.x.iter().find(|state| state.symbol == symbol) else {
                self.numbers.insert(symbol, value);
                continue;
            };
            if !arena.is_zero(state.rate.expr) {
                let message = format!("`{name}` moves by its own rate, and cannot be given a course");
                problems.push(
                    Diagnostic::error(Code::SettingConflict, entry.name.span, message)
                        .also(state.rate.span, "its rate")
                        .help("give courses to parameters, and to states whose rate is 0"),
                );
            }
            self.given.insert(symbol, value);
        }
    }

    /// Outputs given by value. A value may need others: each round substitutes one level of them.
    fn values(&mut self, names: &Names, problems: &mut Diagnostics) {
        let arena = &names.plant.arena;
        let written = self.plant.as_ref().unwrap_or(names.plant).y.clone();
        let outputs = || written.iter().filter(|output| output.value.is_some());
        for output in outputs() {
            let value = output.value.map(|value| arena.substitute(value.expr, &self.numbers));
            self.given.extend(value.map(|value| (output.symbol, value)));
        }
        let known: BTreeSet<Symbol> = self.given.keys().copied().collect();
        for _ in outputs() {
            let put = |value: &Expr| arena.substitute(*value, &self.given);
            self.given = self.given.iter().map(|(symbol, value)| (*symbol, put(value))).collect();
        }
        let circle = outputs().filter(|output| arena.depends_on(self.given[&output.symbol], &known));
        let circle: Vec<_> = circle.collect();
        if let Some(first) = circle.first() {
            let circular: Vec<String> = circle.iter().map(|output| arena.name(output.symbol)).collect();
            let message = format!("the values of {} need one another", listed(circular.iter().map(String::as_str)));
            problems.push(
                Diagnostic::error(Code::CircularDefinition, first.span, message)
                    .help("give one of them by the states and inputs, or by its rate under `f_y`"),
            );
        }
    }

    /// The plant as it is.
    pub(crate) fn plant<'a>(&'a self, names: &Names<'a>) -> &'a Plant {
        self.plant.as_ref().unwrap_or(names.plant)
    }

    /// True if this state or output is given by value, so that it is not integrated.
    pub(crate) fn gives(&self, symbol: Symbol) -> bool {
        self.given.contains_key(&symbol)
    }

    /// The formulas of those of these states and outputs that are given by value, each with its index among them.
    pub(crate) fn given(&self, symbols: &[Symbol]) -> Vec<(usize, Expr)> {
        let found = symbols.iter().enumerate().filter_map(|(place, symbol)| Some((place, *self.given.get(symbol)?)));
        found.collect()
    }

    /// Formulas of the plant in integrated states, inputs and signals.
    pub(crate) fn of_plant(&self, names: &Names, formulas: &[Expr]) -> Vec<Expr> {
        self.between_samples(names, &names.plant.arena.substitute_all(formulas, &self.numbers))
    }

    /// Formulas without the parameters, in the same symbols.
    pub(crate) fn between_samples(&self, names: &Names, formulas: &[Expr]) -> Vec<Expr> {
        names.plant.arena.substitute_all(formulas, &self.given)
    }
}
