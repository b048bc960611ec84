//! The scopes of the formulas in the section `simulation`.
//!
//! Parameters are the model's numbers here; an output is the last sample of its sensor. A definition is lowered for
//! each use anew, so that `hat(x)` in it is the estimate of that formula; where it needs a hidden name, the definition
//! is hidden too.

use std::collections::BTreeMap;

use pebo_cas::{Expr, Symbol};
use pebo_design::model::{Decimal, Entry, Equations, Formula, Model, Simulation, Spanned};
use pebo_design::plant::{Plant, Scope, lower};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span, listed};

use crate::experiment::layout::{baseline_state, last_sample, time};
use crate::observe::request::Request;

/// Estimates by the state's name.
pub(crate) type Estimates = Vec<(String, Expr)>;

/// The number of a name among the entries.
pub(crate) fn number(entries: &[Entry<Spanned<Decimal>>], name: &str) -> Option<f64> {
    entries.iter().find(|entry| entry.name.value == name).map(|entry| entry.value.value.to_f64())
}

/// The names visible to a formula besides parameters; each level has more than the one before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// Constants only.
    #[default]
    Constants,
    /// Time and signals, and the definitions.
    Signals,
    /// Outputs.
    Outputs,
    /// Inputs.
    Inputs,
    /// Unmeasured states and signals.
    Everything,
}

/// The names visible to a formula.
#[derive(Clone, Debug, Default)]
pub(crate) struct View<'a> {
    pub(crate) sight: Sight,
    /// The states of this baseline are visible.
    pub(crate) own: Option<(&'a str, &'a Equations)>,
    /// The values of `hat(x)`.
    pub(crate) hats: Estimates,
}

/// The names of a model and its simulation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Names<'a> {
    pub(crate) model: &'a Model,
    pub(crate) simulation: &'a Simulation,
    pub(crate) plant: &'a Plant,
}

impl<'a> Names<'a> {
    /// The span of the section: its first line, for complaints about missing keys.
    pub(crate) fn section(&self) -> Span {
        let Simulation { duration, step, initial, signals, control, feedback, .. } = self.simulation;
        let numbers = [duration, step].into_iter().flatten().map(|number| number.span);
        let entries = initial.iter().chain(control).map(|entry| entry.name.span);
        let signals = signals.iter().map(|entry| entry.name.span);
        let feedback = feedback.iter().map(|feedback| feedback.span);
        numbers.chain(entries).chain(signals).chain(feedback).min().unwrap_or(self.model.name.span)
    }

    /// The simulation's request for the model's observer.
    pub(crate) fn request(&self) -> Request<'a> {
        Request { model: self.model, plant: self.plant, section: self.section(), who: "the simulation" }
    }

    /// The values of the parameters that have one.
    pub(crate) fn numbers(&self) -> BTreeMap<Symbol, Expr> {
        self.request().numbers()
    }

    /// The last sample of an output's sensor.
    pub(crate) fn measured(&self, output: Symbol) -> Expr {
        let arena = &self.plant.arena;
        if self.simulation.is_imperfect() {
            arena.of_symbol(last_sample(arena, &arena.name(output)))
        } else {
            arena.of_symbol(output)
        }
    }

    /// The scope of a formula.
    pub(crate) fn scope(&self, view: &View) -> Scope {
        let (plant, arena) = (self.plant, &self.plant.arena);
        let mut scope = Scope::new();
        let numbers = self.numbers();
        for parameter in &plant.parameters {
            let symbol = parameter.symbol;
            let value = numbers.get(&symbol).copied().unwrap_or_else(|| arena.of_symbol(symbol));
            scope.define(arena.name(symbol), value);
        }
        let mut show = |symbols: Vec<Symbol>, needed: Sight, reason: &str| {
            for symbol in symbols {
                if view.sight >= needed {
                    scope.define(arena.name(symbol), arena.of_symbol(symbol));
                } else {
                    scope.bar(arena.name(symbol), reason);
                }
            }
        };
        let signals = self.simulation.signals.iter().map(|signal| arena.symbol(&signal.name.value));
        show(signals.chain([time(arena)]).collect(), Sight::Signals, "varies in time");
        show(
            plant.x.iter().map(|state| state.symbol).collect(),
            Sight::Everything,
            "an unmeasured state: use its estimate hat(..)",
        );
        show(plant.y.iter().map(|output| output.symbol).collect(), Sight::Outputs, "an output, which varies in time");
        // Time is the true one, not that of the last sample.
        show(plant.commanded().collect(), Sight::Inputs, "an input, whose value is not known here");
        // After the signals, which give w its course.
        show(plant.w.clone(), Sight::Everything, "not measured");
        for output in plant.y.iter().map(|output| output.symbol).filter(|_| view.sight >= Sight::Outputs) {
            scope.define(arena.name(output), self.measured(output));
        }
        if let Some((name, baseline)) = view.own {
            for state in &baseline.state {
                let symbol = baseline_state(arena, name, &state.name.value);
                scope.define(&state.name.value, arena.of_symbol(symbol));
            }
        }
        for (state, estimate) in &view.hats {
            scope.define_estimate(state, *estimate);
        }
        if view.sight >= Sight::Signals {
            for definition in self.definitions() {
                let name = &definition.name.value;
                match lower(arena, &scope, &definition.value) {
                    Ok(meaning) => scope.define(name, meaning),
                    Err(_) => scope.bar(name, "its definition uses names that are not known here"),
                }
            }
        }
        scope
    }

    /// The formula of each name; those without one are reported.
    pub(crate) fn entries(
        &self,
        scope: &Scope,
        wanted: &[Symbol],
        (section, written): (&str, &[Entry<Formula>]),
        problems: &mut Diagnostics,
    ) -> Vec<Expr> {
        let arena = &self.plant.arena;
        let (mut found, mut missing) = (Vec::new(), Vec::new());
        for symbol in wanted {
            let name = arena.name(*symbol);
            match written.iter().find(|entry| entry.name.value == name) {
                Some(entry) => found.extend(problems.keep(lower(arena, scope, &entry.value))),
                None => missing.push(name),
            }
        }
        if !missing.is_empty() {
            let message = format!("`{section}` has no entry for {}", listed(missing.iter().map(String::as_str)));
            let lines = missing.iter().map(|name| format!("{name}: 0")).collect::<Vec<_>>().join(", ");
            let formula = if missing.len() == 1 { "its formula" } else { "their formulas" };
            problems.push(
                Diagnostic::error(Code::SimulationIncomplete, self.section(), message)
                    .help(format!("add `{lines}`, or {formula}, under `{section}`")),
            );
        }
        found
    }

    fn definitions(&self) -> impl Iterator<Item = &'a Entry<Formula>> {
        self.model.define.iter().chain(&self.simulation.define)
    }

    /// Reports definitions that have no meaning in any scope, and parameters without a value.
    pub(crate) fn check(&self, problems: &mut Diagnostics) {
        let arena = &self.plant.arena;
        let truth = self.plant.x.iter().map(|x| (arena.name(x.symbol), arena.of_symbol(x.symbol)));
        let everything = View { sight: Sight::Everything, own: None, hats: truth.collect() };
        let scope = self.scope(&everything);
        for definition in &self.simulation.define {
            problems.keep(lower(arena, &scope, &definition.value));
        }
        self.request().check(problems);
        for unmeasured in &self.plant.w {
            let name = arena.name(*unmeasured);
            if !self.simulation.signals.iter().any(|signal| signal.name.value == name) {
                let message = format!("the simulation does not say what the unmeasured signal `{name}` is");
                problems.push(
                    Diagnostic::error(Code::SimulationIncomplete, self.section(), message)
                        .help(format!("give its values over time under `signals`, as `{name}: 0`")),
                );
            }
        }
    }
}
