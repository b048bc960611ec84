//! A scenario: a model's sections `observer` and `simulation`, resolved to the programs of a run.
//!
//! In: an accepted derivation with its model, and settings of the call. Out: the scenario, or every mistake in the
//! sections. After this, a run can fail only by its numbers.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::settings::{Shown, start as start_of_extension};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::{Model, Simulation};
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_runtime::Fault;

use super::baseline::{NamedBaseline, ResolvedBaseline};
use super::estimator::{estimator_text, overridden};
use super::failure::{Failure, refused};
use super::layout::{Layout, baseline_estimate, estimate};
use super::ode::switching::{SwitchPrograms, Switches};
use super::panels::Panels;
use super::scope::{Estimates, Names, Sight, View};
use super::sensor::Sensors;
use super::signal::Signal;
use super::trace::Trace;
use super::truth::Truth;
use super::{control, ode};
use crate::figure::panel::Panel;
use crate::observe::design::{Design, program};
use crate::overrides::Overrides;
use crate::score::domain::AssumedDomain;
use crate::summary::advice::{Origin, advise};
use crate::summary::{Estimate, Summary, short};
use crate::timing::Timing;

/// The most numbers of a table; as text this is some hundred megabytes.
const MOST_VALUES: f64 = 2e7;

/// A closed loop, ready to be run.
#[derive(Debug)]
pub struct Scenario {
    pub(crate) title: String,
    /// The estimator with its settings, as a file would have them.
    pub(crate) estimator: String,
    /// The baseline or `truth`, where the control law does not see the observer's estimates.
    pub(crate) feedback: Option<String>,
    pub(crate) timing: Timing,
    pub(crate) layout: Layout,
    pub(crate) design: Design,
    pub(crate) signals: Vec<Signal>,
    /// The state at the start.
    pub(crate) start: Program,
    /// The values of states and outputs that are not integrated, with their positions in the table.
    pub(crate) given: (Vec<usize>, Program),
    /// The last samples of the sensors.
    pub(crate) measured: Program,
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
    /// Baselines that take samples, with the positions of their estimates.
    pub(crate) followers: Vec<(Range<usize>, NamedBaseline)>,
    /// The inputs.
    pub(crate) control: Program,
    /// The estimates, those of the observer first.
    pub(crate) scored: Vec<ScoredEstimate>,
    /// Their errors.
    pub(crate) errors: Program,
    pub(crate) panels: Vec<Panel>,
    /// The values of the panels' curves.
    pub(crate) curves: Program,
    /// What the plant's author assumes of it.
    pub(crate) assumed: AssumedDomain,
    /// The names of the trace's columns.
    pub(crate) columns: Vec<String>,
    /// The names of the table's values.
    pub(crate) names: Vec<String>,
    /// The help where the left inverse has no value at the start of the extension.
    restart: String,
    span: Span,
}

/// An estimate that is compared with the state that it is of.
#[derive(Debug)]
pub(crate) struct ScoredEstimate {
    pub(crate) estimate: Estimate,
    /// The position of the state in the table.
    pub(crate) truth: usize,
    /// The period of an angle.
    pub(crate) period: Option<f64>,
    /// The step, if the outputs determine the state only up to multiples of it.
    pub(crate) step: Option<f64>,
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
            (&self.design.settings.estimator, Origin::Simulated(&self.departures, self.moving_state.as_deref())),
            self.span,
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
            Failure::NotFinite { name, .. } if self.inputs().any(|input| input == name) => {
                format!(
                    "the formula of `{name}` under `control` has no value there: check its roots, logarithms and quotients"
                )
            }
            _ => failure.help().to_owned(),
        };
        let message = match failure {
            Failure::Refused { at, samples, fault } => {
                format!("{}: {}", refused(*at, *samples), self.design.names.words(*fault))
            }
            _ => failure.to_string(),
        };
        Diagnostic::error(code, self.span, message).help(help)
    }

    /// The names of the inputs.
    fn inputs(&self) -> impl Iterator<Item = &String> {
        self.names[self.layout.u.clone()].iter()
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
        let mut baselines: Vec<ResolvedBaseline> = simulation
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
        let (timing, mut design, mut rates) = (timing?, design?, rates?);
        problems.keep(admit_delays(names.model, &timing))?;

        let hats: Estimates = design
            .recovered
            .iter()
            .map(|s| arena.name(*s))
            .map(|s| (s.clone(), arena.of_symbol(estimate(arena, &s))))
            .collect();
        let feedback = control::feedback(&names, overrides, problems)?;
        let control = control::law(&names, &feedback, &hats, problems);
        let errors = errors(plant, &Periods::of(plant, derivation, &numbers), &hats);
        let panels = Panels::resolve(&names, (&hats, design.predicts()), &errors, &baselines, problems);

        let layout = Layout::new(plant, simulation, &design);
        let (layout, switches) = Switches::of(arena, layout, &mut rates);
        let state = &layout.symbols[layout.state.clone()];
        let switches = problems.keep(switches.programs(arena, &layout.symbols, span));
        if layout.state.len() > ode::LARGEST {
            let message = format!("plant and baselines have {} states", layout.state.len());
            problems.push(
                Diagnostic::error(Code::SimulationUnsupported, span, message)
                    .help(format!("the simulator has room for {}", ode::LARGEST)),
            );
        }
        let columns = columns(plant, &design, &baselines);
        problems.keep(admit_table(&timing, columns.len()));
        let followers = followers(plant, &layout, &mut baselines);
        let estimates: Vec<Expr> =
            baselines.iter().flat_map(|baseline| baseline.estimates.iter().map(|e| e.1)).collect();
        let outputs = plant.y.iter().map(|output| output.symbol);
        let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).chain(outputs.clone()).collect();
        let (places, given): (Vec<usize>, Vec<Expr>) = truth.given(&states).into_iter().unzip();
        let measured: Vec<Expr> = outputs.map(|output| names.measured(output)).collect();
        let sensors = Sensors::resolve(plant, simulation, (&timing, span), problems);
        let compared: Vec<(String, Estimates)> =
            baselines.iter().map(|baseline| (baseline.name.clone(), baseline.estimates.clone())).collect();
        let (scored, errors) =
            scored((plant, &layout.symbols), &Periods::of(plant, derivation, &numbers), &hats, &compared);
        let mut compile = |values: &[Expr]| problems.keep(layout.program(arena, values, span));
        let control = compile(&control)?;
        if let Some(share) = overrides.initial_error {
            begin(&names, (&layout, &signals, &control), &start, share, &mut design.settings.chi_0);
        }
        Some(Scenario {
            title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
            estimator: estimator_text(&names.model.observer),
            feedback: (feedback != Simulation::OBSERVER).then_some(feedback),
            start: compile(&start)?,
            given: (places.iter().map(|place| layout.state.start + place).collect(), compile(&given)?),
            measured: compile(&measured)?,
            sensors,
            departures: simulation.departures(&names.model.observer.delay),
            moving_state: moving_state(&names),
            seed: overrides.seed.unwrap_or(Overrides::SEED),
            rates: compile(&rates)?,
            slopes: compile(&slopes(arena, &rates, state))?,
            switches: switches?,
            baseline_estimates: compile(&estimates)?,
            followers,
            control,
            scored,
            errors: compile(&errors)?,
            curves: compile(&panels.values)?,
            panels: panels.panels,
            assumed: AssumedDomain::of(plant, &derivation.conditions, &layout.symbols, |assumed| {
                compile(&arena.substitute_all(assumed, &numbers))
            })?,
            names: layout.names(arena, &(0..layout.symbols.len())),
            timing,
            design,
            signals,
            columns,
            layout,
            restart: restart(&names, derivation),
            span,
        })
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

/// The baselines that take samples, with the positions of their estimates.
fn followers(plant: &Plant, layout: &Layout, baselines: &mut [ResolvedBaseline]) -> Vec<(Range<usize>, NamedBaseline)> {
    let first = plant.x.first().map(|state| plant.arena.name(state.symbol)).unwrap_or_default();
    let follower = |baseline: &mut ResolvedBaseline| {
        let sampled = baseline.sampled.take()?;
        let symbol = baseline_estimate(&plant.arena, &baseline.name, &first);
        let start = layout.symbols.iter().position(|known| *known == symbol)?;
        Some((start..start + plant.x.len(), sampled))
    };
    baselines.iter_mut().filter_map(follower).collect()
}

/// Periods up to which states are known.
#[derive(Debug)]
pub(crate) struct Periods {
    /// Of angles: values that differ by it are the same.
    of_angles: BTreeMap<Symbol, Expr>,
    /// Of states that are no angles: the outputs do not distinguish values that differ by it.
    steps: BTreeMap<Symbol, Expr>,
}

impl Periods {
    pub(crate) fn of(plant: &Plant, derivation: &Derivation, numbers: &BTreeMap<Symbol, Expr>) -> Self {
        let each = |pairs: &[(Symbol, Expr)]| {
            pairs.iter().map(|(state, period)| (*state, plant.arena.substitute(*period, numbers))).collect()
        };
        Self {
            of_angles: each(derivation.left_inverse.result.as_ref().map_or(&[], |inverse| &inverse.modulo)),
            steps: each(derivation.regression.result.as_ref().map_or(&[], |regression| &regression.steps)),
        }
    }
}

/// Estimate less truth; for an angle, the difference with the least absolute value.
fn errors(plant: &Plant, periods: &Periods, hats: &Estimates) -> Vec<Expr> {
    use pebo_cas::Function::{Atan2, Cos, Sin};
    let arena = &plant.arena;
    let error = |(state, hat): &(String, Expr)| {
        let symbol = arena.symbol(state);
        let difference = arena.sub(*hat, arena.of_symbol(symbol));
        let Some(&period) = periods.of_angles.get(&symbol) else { return difference };
        let turn = arena.div(arena.turn(), period);
        let angle = arena.mul(turn, difference);
        arena.div(arena.call(Atan2, &[arena.call(Sin, &[angle]), arena.call(Cos, &[angle])]), turn)
    };
    hats.iter().map(error).collect()
}

/// Every estimate of a state of the table with its error: those of the observer, then those of each baseline.
pub(crate) fn scored(
    (plant, table): (&Plant, &[Symbol]),
    periods: &Periods,
    hats: &Estimates,
    baselines: &[(String, Estimates)],
) -> (Vec<ScoredEstimate>, Vec<Expr>) {
    let arena = &plant.arena;
    let of_baselines = baselines.iter().flat_map(|(baseline, estimates)| {
        let written = |state: &String| arena.of_symbol(baseline_estimate(arena, baseline, state));
        estimates.iter().map(move |(state, _)| (Some(baseline.clone()), (state.clone(), written(state))))
    });
    let own = hats.iter().cloned().map(|estimate| (None, estimate));
    let is_known = |(_, (state, _)): &(Option<String>, (String, Expr))| table.contains(&arena.symbol(state));
    let (names, estimates): (Vec<_>, Estimates) = own.chain(of_baselines).filter(is_known).unzip();
    let judge = |(baseline, (state, _)): (Option<String>, &(String, Expr))| {
        let symbol = arena.symbol(state);
        let number = |periods: &BTreeMap<Symbol, Expr>| {
            let program = program(arena, &[], &[*periods.get(&symbol)?], Span::NOWHERE).ok()?;
            Interpreter::new(&program).evaluate(|_| f64::NAN).next()
        };
        Some(ScoredEstimate {
            estimate: Estimate { baseline, state: state.clone(), unit: plant.units.get(&symbol).cloned() },
            truth: table.iter().position(|known| *known == symbol)?,
            period: number(&periods.of_angles),
            step: number(&periods.steps),
        })
    };
    let scored = names.into_iter().zip(&estimates).filter_map(judge).collect();
    (scored, errors(plant, periods, &estimates))
}

fn columns(plant: &Plant, design: &Design, baselines: &[ResolvedBaseline]) -> Vec<String> {
    let arena = &plant.arena;
    let states = plant.x.iter().map(|state| state.symbol);
    let signals = states.chain(plant.y.iter().map(|output| output.symbol)).chain(plant.commanded());
    let mut columns = vec!["t".to_owned()];
    columns.extend(signals.map(|symbol| arena.name(symbol)));
    let recovered = || design.recovered.iter().map(|state| arena.name(*state));
    for state in recovered() {
        columns.extend([format!("{state}_hat"), format!("{state}{}", Trace::ERROR)]);
    }
    for baseline in baselines {
        columns.extend(baseline.estimates.iter().map(|(state, _)| format!("{}.{state}_hat", baseline.name)));
    }
    let predicted = recovered().filter(|_| design.predicts());
    columns.extend(predicted.map(|state| format!("{state}{}", Trace::STANDARD_ERROR)));
    columns
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
