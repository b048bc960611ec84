//! A scenario: a model's sections `observer` and `simulation`, resolved to the programs of a run.
//!
//! In: an accepted derivation with its model, and settings of the call. Out: the scenario, or every mistake in the
//! sections. After this, a run can fail only by its numbers.

use std::collections::BTreeMap;

use crate::settings::{Shown, start as start_of_extension};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::{Baseline, Entry, Equations, Model, Simulation};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_runtime::Fault;

use super::baseline::ResolvedBaseline;
use super::estimator::{estimator_text, overridden};
use super::failure::{Failure, refused};
use super::ode::switching::{SwitchPrograms, Switches};
use super::panels::add_panels;
use super::scope::{Names, Sight, View};
use super::sensor::Sensors;
use super::signal::Signal;
use super::truth::Truth;
use super::{control, ode};
use crate::experiment::layout::{
    Layout, SourceSymbols, baseline_estimates, baseline_state, course, estimates, last_sample,
};
use crate::experiment::setup::Experiment;
use crate::observe::design::Design;
use crate::overrides::Overrides;
use crate::summary::advice::{Origin, advise};
use crate::summary::{Summary, short};
use crate::timing::Timing;

/// The most numbers of a table; as text this is some hundred megabytes.
const MOST_VALUES: f64 = 2e7;

/// A closed loop, ready to be run.
#[derive(Debug)]
pub struct Scenario {
    pub(crate) experiment: Experiment,
    /// The estimator with its settings, as a file would have them.
    pub(crate) estimator: String,
    /// The baseline or `truth`, where the control law does not see the observer's estimates.
    pub(crate) feedback: Option<String>,
    pub(crate) timing: Timing,
    pub(crate) signals: Vec<Signal>,
    /// The state at the start.
    pub(crate) start: Program,
    /// The values of states and outputs that are not integrated, with their positions in the table.
    pub(crate) given: (Vec<usize>, Program),
    pub(crate) sensors: Sensors,
    /// The seed of the random numbers.
    pub(crate) seed: u64,
    /// The differences of plant and sensors from the model: keys of the section.
    pub(crate) departures: Vec<&'static str>,
    /// The first state that is given a course, if no parameter is.
    moving_state: Option<String>,
    /// The rates of the state.
    pub(crate) rates: Program,
    /// Their derivatives by the state, by rows, with signs held.
    pub(crate) slopes: Program,
    /// The signs in them, if there are any.
    pub(crate) switches: Option<SwitchPrograms>,
    /// The baselines' estimates.
    pub(crate) baseline_estimates: Program,
    /// The inputs.
    pub(crate) control: Program,
    /// The names of the table's values.
    pub(crate) names: Vec<String>,
    /// The help where the left inverse has no value at the start of the extension.
    restart: String,
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
        let mut problems = Diagnostics::new();
        let model = &*overridden(model, overrides);
        let Some(simulation) = &model.simulation else { return Err(vec![missing(model)]) };
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

    /// The estimator with its settings, as a file would have them: `gradient, gain: [1e7, 1e7]`.
    pub fn estimator(&self) -> &str {
        &self.estimator
    }

    /// True if samples scatter.
    pub(crate) fn is_noisy(&self) -> bool {
        self.departures.contains(&"noise")
    }

    /// The advice on a run whose samples contradict the observer's numbers, and on one that did not converge: reason and
    /// mend.
    pub fn advise(&self, summary: &Summary) -> Vec<Diagnostic> {
        advise(
            summary,
            (
                &self.experiment.design.settings.estimator,
                Origin::Simulated(&self.departures, self.moving_state.as_deref()),
            ),
            self.experiment.span,
        )
    }

    /// A failure of a run as a diagnostic at the section that was run.
    pub fn explain(&self, failure: &Failure) -> Diagnostic {
        let code = match failure {
            Failure::Stopped { .. } => Code::LimitReached,
            _ => Code::SimulationFailed,
        };
        let help = match failure {
            Failure::Refused { at, fault: Fault::Estimate, .. } if *at <= 0.0 => self.restart.clone(),
            Failure::NotFinite { name, .. } if self.experiment.design.names.inputs.contains(name) => {
                format!(
                    "the formula of `{name}` under `control` has no value there: check its roots, logarithms and quotients"
                )
            }
            _ => failure.help().to_owned(),
        };
        let message = match failure {
            Failure::Refused { at, samples, fault } => {
                format!("{}: {}", refused(*at, *samples), self.experiment.design.names.words(*fault))
            }
            _ => failure.to_string(),
        };
        Diagnostic::error(code, self.experiment.span, message).help(help)
    }
}

/// The help where the left inverse has no value at the start of the extension: the start that is chosen by default, if
/// there is one.
fn restart(names: &Names, derivation: &Derivation) -> String {
    let plant = names.plant;
    let phi: Vec<String> = plant.phi.iter().map(|phi| plant.arena.print(phi.expr)).collect();
    let whose = format!("phi = [{}] of a state that the plant can have", phi.join(", "));
    match start_of_extension(names.model, plant, derivation, &Shown::default()) {
        Some(z) => {
            let z: Vec<String> = z.iter().map(|value| value.to_f64().to_string()).collect();
            format!("choose another start for the extension, as `observer: {{extension: [{}]}}`: {whose}", z.join(", "))
        }
        None => format!("say where the extension starts, as `observer: {{extension: [..]}}` with {whose}"),
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
        let in_time = names.scope(&View { sight: Sight::Signals, ..View::default() });
        let courses = simulation.signals.iter().chain(&simulation.plant);
        let signals: Vec<Signal> = courses.map(|entry| Signal::resolve(arena, &in_time, entry, problems)).collect();
        let baselines: Vec<ResolvedBaseline> = simulation
            .baselines
            .iter()
            .filter_map(|entry| ResolvedBaseline::resolve(&names, entry, problems))
            .collect();
        let truth = Truth::resolve(&names, problems);
        let start = start(&names, &truth, &baselines, problems);
        let rates = rates(&names, &truth, &baselines, problems);
        // After the start, of which it takes its numbers where none are written.
        let shown = Shown::of_period(overrides.step);
        let design = Design::resolve(&names.request(), derivation, &numbers, &shown, problems);
        let (timing, design, mut rates) = (timing?, design?, rates?);
        problems.keep(admit_delays(names.model, &timing))?;

        let hats = estimates(arena, &design);
        let feedback = control::feedback(&names, overrides, problems)?;
        let control = control::law(&names, &feedback, &hats, problems);

        let compared = |entry: &Entry<Baseline>| {
            let states = baseline_estimates(plant, entry).into_iter().map(|(state, _)| state);
            (entry.name.value.clone(), states.collect())
        };
        let compared: Vec<_> = simulation.baselines.iter().map(compared).collect();
        let layout = Layout::new(plant, &design, &compared, symbols(&names));
        let (layout, switches) = Switches::of(arena, layout, &mut rates);
        let switches = problems.keep(switches.programs(arena, &layout.symbols, span));
        if layout.state.len() > ode::LARGEST {
            let message = format!("plant and baselines have {} states", layout.state.len());
            problems.push(
                Diagnostic::error(Code::SimulationUnsupported, span, message)
                    .help(format!("the simulator has room for {}", ode::LARGEST)),
            );
        }
        let of_baselines: Vec<Expr> =
            baselines.iter().flat_map(|baseline| baseline.estimates.iter().map(|e| e.1)).collect();
        let outputs = plant.y.iter().map(|output| output.symbol);
        let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).chain(outputs).collect();
        let (places, given): (Vec<usize>, Vec<Expr>) = truth.given(&states).into_iter().unzip();
        let sensors = Sensors::resolve(plant, simulation, (&timing, span), problems);
        let named = baselines.into_iter().filter_map(|baseline| Some((baseline.name, baseline.sampled?)));
        let mut experiment = Experiment::resolve(
            (plant, derivation, &numbers),
            (design, layout),
            (true, named.collect()),
            |builder, (_, errors), problems| add_panels(builder, &names, (&hats, &errors[..hats.len()]), problems),
            (span, &mut *problems),
        )?;
        problems.keep(admit_table(&timing, experiment.columns.names.len()));
        let layout = &experiment.layout;
        let mut compile = |values: &[Expr]| problems.keep(layout.program(arena, values, span));
        let control = compile(&control)?;
        if let Some(share) = overrides.initial_error {
            let chi_0 = &mut experiment.design.settings.chi_0;
            begin(&names, (layout, &signals, &control), &start, share, chi_0);
        }
        Some(Scenario {
            estimator: estimator_text(&names.model.observer),
            feedback: (feedback != Simulation::OBSERVER).then_some(feedback),
            start: compile(&start)?,
            given: (places.iter().map(|place| layout.state.start + place).collect(), compile(&given)?),
            sensors,
            departures: simulation.departures(&names.model.observer.delay),
            moving_state: moving_state(&names),
            seed: overrides.seed.unwrap_or(Overrides::SEED),
            rates: compile(&rates)?,
            slopes: compile(&slopes(arena, &rates, &layout.symbols[layout.state.clone()]))?,
            switches: switches?,
            baseline_estimates: compile(&of_baselines)?,
            control,
            names: layout.symbols.iter().map(|symbol| arena.name(*symbol)).collect(),
            timing,
            signals,
            restart: restart(&names, derivation),
            experiment,
        })
    }
}

/// The symbols of a simulation: the state, signals, and samples of imperfect sensors.
fn symbols(names: &Names) -> SourceSymbols {
    let Names { plant, simulation, .. } = names;
    let arena = &plant.arena;
    let with_equations = simulation.baselines.iter().filter_map(|b| Some((&b.name.value, b.value.equations()?)));
    let of_baseline = |(name, b): (&String, &Equations)| -> Vec<Symbol> {
        b.state.iter().map(|entry| baseline_state(arena, name, &entry.name.value)).collect()
    };
    let signals = simulation.signals.iter().map(|signal| arena.symbol(&signal.name.value));
    let courses = simulation.plant.iter().map(|entry| course(arena, &entry.name.value));
    let imperfect = plant.y.iter().filter(|_| simulation.is_imperfect());
    SourceSymbols {
        x: plant.x.iter().map(|state| state.symbol).collect(),
        baselines: with_equations.flat_map(of_baseline).collect(),
        signals: signals.chain(courses).collect(),
        last_samples: imperfect.map(|output| last_sample(arena, &arena.name(output.symbol))).collect(),
        residuals: Vec::new(),
    }
}

/// The first state that `plant` gives a course, if it names no parameter.
fn moving_state(names: &Names) -> Option<String> {
    let of_plant = || names.simulation.plant.iter().map(|entry| &entry.name.value);
    let is_state = |name: &&String| names.model.x.iter().any(|state| state.value == **name);
    of_plant().all(|name| is_state(&name)).then(|| of_plant().next().cloned())?
}

/// x, y and the baselines' states at the start.
fn start(names: &Names, truth: &Truth, baselines: &[ResolvedBaseline], problems: &mut Diagnostics) -> Vec<Expr> {
    let (plant, arena) = (names.plant, &names.plant.arena);
    let states = plant.x.iter().map(|state| state.symbol);
    let states: Vec<Symbol> = states.chain(plant.y.iter().map(|output| output.symbol)).collect();
    let moving: Vec<Symbol> = states.iter().copied().filter(|symbol| !truth.gives(*symbol)).collect();
    let scope = names.scope(&View::default());
    let found = names.entries(&scope, &moving, ("initial", &names.simulation.initial), problems);
    let mut values: BTreeMap<Symbol, Expr> = moving.into_iter().zip(found).collect();
    for (place, value) in truth.given(&states) {
        values.insert(states[place], arena.substitute(value, &values));
    }
    let all: Vec<Expr> = states.into_iter().map(|symbol| arena.of_symbol(symbol)).collect();
    let others = baselines.iter().flat_map(|baseline| baseline.start.iter().copied());
    arena.substitute_all(&all.into_iter().chain(others).collect::<Vec<_>>(), &values)
}

/// The extension at the start, with the share of its error that the call asks for.
fn begin(
    names: &Names,
    (layout, signals, control): (&Layout, &[Signal], &Program),
    start: &[Expr],
    share: f64,
    chi_0: &mut [f64],
) {
    let (plant, arena) = (names.plant, &names.plant.arena);
    let states = plant.x.iter().map(|state| state.symbol).chain(plant.y.iter().map(|output| output.symbol));
    let at: BTreeMap<Symbol, Expr> = states.zip(start.iter().copied()).chain(names.numbers()).collect();
    let mut table = vec![0.0; layout.symbols.len()];
    for (position, signal) in layout.signals.clone().zip(signals) {
        table[position] = signal.course().value(0.0);
    }
    // Before the first sample the law knows no estimate.
    let mut inputs = vec![0.0; layout.u.len()];
    Interpreter::new(control).run(&table, &mut inputs);
    let inputs = inputs.into_iter().map(|input| if input.is_finite() { input } else { 0.0 });
    table.splice(layout.u.clone(), inputs);
    for (formula, chi) in plant.phi.iter().zip(chi_0) {
        let mut value = [f64::NAN];
        if let Ok(program) = layout.program(arena, &[arena.substitute(formula.expr, &at)], Span::NOWHERE) {
            Interpreter::new(&program).run(&table, &mut value);
        }
        // Where phi has no value at the start, the extension keeps its own.
        if value[0].is_finite() {
            *chi = value[0] + share * (*chi - value[0]);
        }
    }
}

/// The rates of x, y and the baselines' states; 0 for those that are not integrated.
fn rates(
    names: &Names,
    truth: &Truth,
    baselines: &[ResolvedBaseline],
    problems: &mut Diagnostics,
) -> Option<Vec<Expr>> {
    let (plant, arena) = (truth.plant(names), &names.plant.arena);
    let rate = |symbol: Symbol, rate: Expr| if truth.gives(symbol) { arena.zero() } else { rate };
    let mut found: Vec<Expr> = plant.x.iter().map(|state| rate(state.symbol, state.rate.expr)).collect();
    for output in &plant.y {
        match output.rate {
            Some(given) => found.push(rate(output.symbol, given.expr)),
            None if truth.gives(output.symbol) => found.push(arena.zero()),
            None => {
                let name = arena.name(output.symbol);
                problems.push(
                    Diagnostic::error(Code::SimulationIncomplete, output.span, format!("`{name}` has no rate"))
                        .also(names.section(), "the simulation needs it")
                        .help(format!("give the rate of `{name}` under `f_y`, or its value under `g_y`")),
                );
            }
        }
    }
    let mut found = truth.of_plant(names, &found);
    let others: Vec<Expr> = baselines.iter().flat_map(|baseline| baseline.rates.iter().copied()).collect();
    found.extend(truth.between_samples(names, &others));
    (!problems.has_errors()).then_some(found)
}

/// The derivatives of rates by the state, by rows.
fn slopes(arena: &Arena, rates: &[Expr], state: &[Symbol]) -> Vec<Expr> {
    rates.iter().flat_map(|rate| state.iter().map(|symbol| arena.derivative(*rate, *symbol))).collect()
}

/// Refuses a run that ends before the first late sample arrives.
fn admit_delays(model: &Model, timing: &Timing) -> Result<(), Diagnostic> {
    let duration = timing.at(timing.samples);
    let Some(delay) = model.observer.delay.written().find(|delay| delay.value.to_f64() >= duration) else {
        return Ok(());
    };
    let message =
        format!("a sample that is {} s late does not arrive within {} s", delay.value.text(), short(duration));
    let help = "simulate longer: the observer begins when the first sample is there";
    Err(Diagnostic::error(Code::NumberOutOfRange, delay.span, message).help(help))
}

/// Refuses a table that is too large. Only a call can ask for one, as a file does not set the interval of rows.
fn admit_table(timing: &Timing, columns: usize) -> Result<(), Diagnostic> {
    let columns = u64::try_from(columns).unwrap_or(u64::MAX);
    let values = crate::timing::real(timing.rows()) * crate::timing::real(columns);
    if values <= MOST_VALUES {
        return Ok(());
    }
    let message = format!("the table would have {} rows of {columns} values", timing.rows());
    Err(Diagnostic::error(Code::SimulationTooLong, Span::NOWHERE, message).help("choose a larger `--every`"))
}
