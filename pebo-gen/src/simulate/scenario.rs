//! A model's sections `observer` and `simulation`, resolved: everything that a run needs, as programs.
//!
//! In: an accepted derivation with what was written, and settings of the call. Out: the scenario, or
//! every mistake in the sections. After this, a run can fail only by what its numbers do.

use std::collections::BTreeMap;

use crate::analysis::Derivation;
use crate::cas::{Expr, Symbol};
use crate::model::Model;
use crate::plant::Plant;
use crate::program::Program;
use crate::source::{Code, Diagnostic, Diagnostics, Span};

use super::control;
use super::failure::Failure;
use super::flow;
use super::layout::{Layout, estimate};
use super::observer::Design;
use super::panel::{Panel, Panels};
use super::rival::Rival;
use super::scope::{Estimates, Names, Sight, View};
use super::signal::Signal;
use super::timing::Timing;

/// Numbers that a table may hold; as text this is some hundred megabytes.
const MOST_VALUES: f64 = 2e7;

/// Settings of a call, which go before those of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Whose estimates the control law sees: `observer`, `truth`, or a baseline.
    pub feedback: Option<String>,
    /// The duration in seconds.
    pub duration: Option<f64>,
    /// The sampling period in seconds.
    pub step: Option<f64>,
    /// The time between rows of the table in seconds; a thousandth of the duration if absent.
    pub every: Option<f64>,
}

/// A closed loop, ready to be run.
#[derive(Debug)]
pub struct Scenario {
    pub(super) title: String,
    /// The baseline or `truth`, where the control law does not see the observer's estimates.
    pub(super) feedback: Option<String>,
    pub(super) timing: Timing,
    pub(super) layout: Layout,
    pub(super) design: Design,
    pub(super) signals: Vec<Signal>,
    /// The state at the start.
    pub(super) start: Program,
    /// The rates of the state.
    pub(super) rates: Program,
    /// The baselines' estimates.
    pub(super) rivals: Program,
    /// The inputs.
    pub(super) control: Program,
    /// The errors of the observer's estimates.
    pub(super) errors: Program,
    pub(super) panels: Vec<Panel>,
    /// The values of the panels' curves.
    pub(super) curves: Program,
    /// The names of the trace's columns.
    pub(super) columns: Vec<String>,
    /// The names of the table's values.
    pub(super) names: Vec<String>,
    span: Span,
}

impl Scenario {
    /// Resolves the sections of a model.
    ///
    /// The errors are those of the derivation where it is not accepted.
    pub fn resolve(
        model: &Model,
        plant: &Plant,
        derivation: &Derivation,
        overrides: &Overrides,
    ) -> Result<Self, Vec<Diagnostic>> {
        derivation.admit().map_err(<[Diagnostic]>::to_vec)?;
        let Some(simulation) = &model.simulation else { return Err(vec![missing(model)]) };
        let mut problems = Diagnostics::new();
        let names = Names { model, simulation, plant };
        let scenario = Resolution { names, problems: &mut problems }.scenario(derivation, overrides);
        problems.propagate()?;
        // Without a scenario there is an error, which was propagated.
        scenario.ok_or_else(Vec::new)
    }

    /// The number of samples of a run.
    pub fn samples(&self) -> u64 {
        self.timing.samples
    }

    /// A failure of a run as a diagnostic at the section that was run.
    pub fn explain(&self, failure: &Failure) -> Diagnostic {
        let code = match failure {
            Failure::Stopped { .. } => Code::LimitReached,
            _ => Code::SimulationFailed,
        };
        Diagnostic::error(code, self.span, failure.to_string()).help(failure.help())
    }
}

fn missing(model: &Model) -> Diagnostic {
    let message = format!("the model `{}` does not say what to simulate", model.name.value);
    Diagnostic::error(Code::SimulationMissing, model.name.span, message)
        .help("add a section `simulation` with duration, step, initial and control; models/cuk.yaml is an example")
}

struct Resolution<'a> {
    names: Names<'a>,
    problems: &'a mut Diagnostics,
}

impl Resolution<'_> {
    fn scenario(self, derivation: &Derivation, overrides: &Overrides) -> Option<Scenario> {
        let Self { names, problems } = self;
        let Names { simulation, plant, .. } = names;
        let (arena, span) = (&plant.arena, names.section());
        names.check(problems);
        if plant.parameters.iter().any(|parameter| parameter.value.is_none()) {
            // That was reported; every formula with the parameter would be reported again.
            return None;
        }
        let numbers = names.numbers();
        let timing = Timing::resolve(simulation, overrides, span, problems);
        let design = Design::resolve(&names, derivation, &numbers, problems);

        let in_time = names.scope(&View { sight: Sight::Signals, ..View::default() });
        let signals: Vec<Signal> =
            simulation.signals.iter().map(|entry| Signal::resolve(arena, &in_time, entry, problems)).collect();
        let rivals: Vec<Rival> =
            simulation.baselines.iter().map(|entry| Rival::resolve(&names, entry, problems)).collect();
        let start = start(&names, &rivals, problems);
        let rates = rates(plant, &numbers, &rivals, span, problems);
        let (timing, design, rates) = (timing?, design?, rates?);

        let hats: Estimates = design
            .recovered
            .iter()
            .map(|s| arena.name(*s))
            .map(|s| (s.clone(), arena.of_symbol(estimate(arena, &s))))
            .collect();
        let feedback = control::feedback(&names, overrides, problems)?;
        let control = control::law(&names, &feedback, &hats, problems);
        let errors = errors(plant, derivation, &numbers, &hats);
        let panels = Panels::resolve(&names, &hats, &errors, &rivals, problems);

        let layout = Layout::new(plant, simulation, &design.recovered);
        if layout.state.len() > flow::LARGEST {
            let message = format!("plant and baselines have {} states", layout.state.len());
            problems.push(
                Diagnostic::error(Code::SimulationUnsupported, span, message)
                    .help(format!("the simulator has room for {}", flow::LARGEST)),
            );
        }
        let columns = columns(plant, &design.recovered, &rivals);
        problems.keep(admit_table(&timing, columns.len()));
        let estimates: Vec<Expr> = rivals.iter().flat_map(|rival| rival.estimates.iter().map(|e| e.1)).collect();
        let mut compile = |values: &[Expr]| problems.keep(layout.program(arena, values, span));
        Some(Scenario {
            title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
            feedback: (feedback != control::OBSERVER).then_some(feedback),
            start: compile(&start)?,
            rates: compile(&rates)?,
            rivals: compile(&estimates)?,
            control: compile(&control)?,
            errors: compile(&errors)?,
            curves: compile(&panels.values)?,
            panels: panels.panels,
            names: layout.names(arena, &(0..layout.symbols.len())),
            timing,
            design,
            signals,
            columns,
            layout,
            span,
        })
    }
}

/// x, y and the baselines' states at the start.
fn start(names: &Names, rivals: &[Rival], problems: &mut Diagnostics) -> Vec<Expr> {
    let plant = names.plant;
    let states = plant.x.iter().map(|state| state.symbol);
    let wanted: Vec<Symbol> = states.chain(plant.y.iter().map(|output| output.symbol)).collect();
    let scope = names.scope(&View::default());
    let mut found = names.entries(&scope, &wanted, ("initial", &names.simulation.initial), problems);
    let values: BTreeMap<Symbol, Expr> = wanted.into_iter().zip(found.iter().copied()).collect();
    let others: Vec<Expr> = rivals.iter().flat_map(|rival| rival.start.iter().copied()).collect();
    found.extend(plant.arena.substitute_all(&others, &values));
    found
}

/// The rates of x, y and the baselines' states.
fn rates(
    plant: &Plant,
    numbers: &BTreeMap<Symbol, Expr>,
    rivals: &[Rival],
    span: Span,
    problems: &mut Diagnostics,
) -> Option<Vec<Expr>> {
    let mut found: Vec<Expr> = plant.x.iter().map(|state| state.rate.expr).collect();
    for output in &plant.y {
        found.extend(output.rate.map(|rate| rate.expr));
        if output.rate.is_none() {
            let name = plant.arena.name(output.symbol);
            let missing = Diagnostic::error(Code::SimulationIncomplete, output.span, format!("`{name}` has no rate"))
                .also(span, "the simulation needs it")
                .help(format!("give the rate of `{name}` under `f_y`"));
            problems.push(match &output.value {
                None => missing,
                Some(value) => missing.also(value.span, "an input moves this value, and its own rate is not known"),
            });
        }
    }
    let mut found = plant.arena.substitute_all(&found, numbers);
    found.extend(rivals.iter().flat_map(|rival| rival.rates.iter().copied()));
    (!problems.has_errors()).then_some(found)
}

/// Estimate less truth; for an angle, the difference that is least in magnitude.
fn errors(plant: &Plant, derivation: &Derivation, numbers: &BTreeMap<Symbol, Expr>, hats: &Estimates) -> Vec<Expr> {
    use crate::cas::Function::{Atan2, Cos, Sin};
    let arena = &plant.arena;
    let modulo = derivation.left_inverse.result.iter().flat_map(|inverse| &inverse.modulo);
    let periods: BTreeMap<Symbol, Expr> =
        modulo.map(|(state, period)| (*state, arena.substitute(*period, numbers))).collect();
    let error = |(state, hat): &(String, Expr)| {
        let symbol = arena.symbol(state);
        let difference = arena.sub(*hat, arena.of_symbol(symbol));
        let Some(&period) = periods.get(&symbol) else { return difference };
        let turn = arena.div(arena.mul(arena.number(2), arena.pi()), period);
        let angle = arena.mul(turn, difference);
        arena.div(arena.call(Atan2, &[arena.call(Sin, &[angle]), arena.call(Cos, &[angle])]), turn)
    };
    hats.iter().map(error).collect()
}

fn columns(plant: &Plant, recovered: &[Symbol], rivals: &[Rival]) -> Vec<String> {
    let arena = &plant.arena;
    let states = plant.x.iter().map(|state| state.symbol);
    let signals = states.chain(plant.y.iter().map(|output| output.symbol)).chain(plant.u.iter().copied());
    let mut columns = vec!["t".to_owned()];
    columns.extend(signals.map(|symbol| arena.name(symbol)));
    for state in recovered.iter().map(|state| arena.name(*state)) {
        columns.extend([format!("{state}_hat"), format!("{state}_error")]);
    }
    for rival in rivals {
        columns.extend(rival.estimates.iter().map(|(state, _)| format!("{}.{state}_hat", rival.name)));
    }
    columns
}

/// Only a call asks for a table that is too large: a file does not say how often rows are written.
fn admit_table(timing: &Timing, columns: usize) -> Result<(), Diagnostic> {
    let columns = u64::try_from(columns).unwrap_or(u64::MAX);
    let values = super::timing::real(timing.rows()) * super::timing::real(columns);
    if values <= MOST_VALUES {
        return Ok(());
    }
    let message = format!("the table would have {} rows of {columns} values", timing.rows());
    Err(Diagnostic::error(Code::SimulationTooLong, Span::NOWHERE, message).help("choose a larger `--every`"))
}
