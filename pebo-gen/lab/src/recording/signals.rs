//! Resolves the signals of the plant in the columns of a log.
//!
//! In: the section `recording`, and the names of the columns. Out: a program from the cells of a row to its time and
//! signals, or diagnostics of missing ones. A signal without a formula is the column of its own name.

use std::collections::{BTreeMap, BTreeSet};

use crate::observe::design::program;
use crate::observe::request::Request;
use crate::settings::Shown;
use pebo_cas::{Expr, Symbol};
use pebo_design::model::formula::{Formula, PI};
use pebo_design::model::{Entry, Recording, unknown_name};
use pebo_design::plant::{Plant, Scope, lower};
use pebo_design::program::{Interpreter, Program};
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span, listed};

use super::alignment::InputRow;
use super::log::{Log, Unreadable};

/// The signals of a row.
#[derive(Debug)]
pub(super) struct Signals {
    /// The columns that are read.
    pub(super) wanted: Vec<usize>,
    /// From their cells to the time if it is recorded, measured states, outputs, and inputs without the time.
    pub(super) program: Program,
    /// The period as a fraction, if times are not recorded.
    pub(super) period: Option<(f64, f64)>,
    /// Positions in x of the states that were measured.
    pub(super) measured: Vec<usize>,
    /// For each column that is read, true if only outputs need it.
    pub(super) of_outputs: Vec<bool>,
}

impl Signals {
    pub(super) fn resolve(request: &Request, log: &Log, problems: &mut Diagnostics) -> Option<Self> {
        let written = request.model.recording.clone().unwrap_or_default();
        let columns = Columns::of(request, log);
        let mut pass = SignalResolver { request, log, written: &written, columns, problems };
        let (plant, arena) = (request.plant, &request.plant.arena);
        let period = written.step.as_ref().map(|step| pass.period(step));
        let mut formulas = Vec::new();
        if period.is_none() {
            formulas.push(pass.time());
        }
        let states: Vec<Option<Expr>> = plant.x.iter().map(|state| pass.measured(&arena.name(state.symbol))).collect();
        let measured = (0..states.len()).filter(|place| states[*place].is_some()).collect();
        formulas.extend(states.into_iter().flatten().map(Some));
        let needed = plant.y.iter().map(|output| output.symbol).chain(plant.commanded());
        formulas.extend(needed.map(|signal| pass.needed(&arena.name(signal))));
        let formulas = formulas.into_iter().collect::<Option<Vec<Expr>>>()?;
        let period = match period {
            Some(period) => Some(period?),
            None => None,
        };
        let used = arena.symbols_of(&formulas);
        let used = pass.columns.symbols.iter().enumerate().filter(|(_, symbol)| used.contains(symbol));
        let (wanted, symbols): (Vec<usize>, Vec<Symbol>) = used.map(|(place, symbol)| (place, *symbol)).unzip();
        let inputs = formulas.len() - plant.commanded().count();
        let before = inputs - plant.y.len();
        let others = arena.symbols_of(&[&formulas[..before], &formulas[inputs..]].concat());
        let of_outputs = symbols.iter().map(|symbol| !others.contains(symbol)).collect();
        let program = problems.keep(program(arena, &symbols, &formulas, request.section))?;
        Some(Self { wanted, program, period, measured, of_outputs })
    }
}

/// The rows of which is asked what they show: enough for a median, and no long wait where they come one by one. More are
/// asked where an output came seldom, or no input moved that an output has in it.
const HEAD: [usize; 3] = [256, 1024, 4096];

/// The samples of each output that are waited for: of fewer little can be said.
const ENOUGH: usize = 32;

impl Signals {
    /// What the first rows show of the plant; nothing where they cannot be read, which the run will report. Rows that do
    /// not show where an observer begins whose gains follow from that are reported.
    pub(super) fn shown(
        &self,
        request: &Request,
        log: &mut Log,
        problems: &mut Diagnostics,
    ) -> Option<(Shown, InputRow)> {
        let plant = request.plant;
        let signals = self.measured.iter().map(|state| plant.x[*state].symbol);
        let outputs: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
        let signals: Vec<Symbol> = signals.chain(outputs.iter().copied()).chain(plant.commanded()).collect();
        let Head { times, samples, unreadable } = self.head(plant, &signals, log);
        let count = samples[0].1.len();
        // A state that is measured besides may be missing.
        let mut needed = samples.iter().skip(self.measured.len());
        let unknown = needed.find(|(_, values)| !values.iter().any(|value| value.is_finite()));
        let needed = unknown.filter(|_| !request.model.observer.has_gains() && request.model.simulation.is_none());
        if let (Some(_), Some(unreadable)) = (needed, &unreadable) {
            problems.push(unreadable.explain(log.name()));
            return None;
        }
        if let Some((signal, _)) = needed {
            let (name, signal) = (log.name(), plant.arena.name(*signal));
            let message = match count {
                0 => format!("{name} has no rows"),
                count => format!("none of the first {count} rows of {name} has a value of `{signal}`"),
            };
            problems.push(Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, message).help(
                "give rows with a value of each output and input: they say where the plant starts, as no `simulation` does",
            ));
            return None;
        }
        if let Some(found) = self.time_in_another_unit(request, log) {
            problems.push(found);
        }
        let period = self.period.map(|(above, below)| above / below);
        let instants: Vec<f64> = times.iter().copied().filter(|time| time.is_finite()).collect();
        let stands = self.period.is_none() && !instants.windows(2).any(|pair| pair[1] > pair[0]);
        if stands && !request.model.observer.has_gains() && request.model.simulation.is_none() {
            let message = match times.len() {
                1 => format!("{} has one row", log.name()),
                rows => format!("the time of {} does not increase in its first {rows} rows", log.name()),
            };
            problems.push(Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, message).help(
                "give rows in the order of their times, which say how often samples come; or that under `recording`, as \
                 `step: 1e-3`",
            ));
            return None;
        }
        Some((Shown::by_samples((&times, period), &samples, &outputs), InputRow::of(plant, &samples).0))
    }

    /// A column `t` that is taken for seconds, where the row of units says another unit.
    fn time_in_another_unit(&self, request: &Request, log: &Log) -> Option<Diagnostic> {
        let is_column =
            self.period.is_none() && request.model.recording.as_ref().is_none_or(|written| written.t.is_none());
        let place = log.columns().iter().position(|column| column == Recording::T).filter(|_| is_column)?;
        let unit = log.units().get(place)?.trim_matches(['[', ']', '(', ')']).to_lowercase();
        let seconds = match unit.as_str() {
            "ms" | "msec" => "t/1000",
            "us" | "µs" | "μs" | "usec" => "t/1e6",
            "ns" => "t/1e9",
            "min" => "60*t",
            "h" | "hr" => "3600*t",
            _ => return None,
        };
        let message =
            format!("the times of {} are in {unit}, as its row of units says, and not in seconds", log.name());
        let help = format!("write `recording: {{t: {seconds}}}`");
        Some(Diagnostic::error(Code::RecordingMalformed, Span::NOWHERE, message).help(help))
    }

    /// The first rows: as many as it takes, if there are as many.
    fn head(&self, plant: &Plant, signals: &[Symbol], log: &mut Log) -> Head {
        let mut head = Head::default();
        for most in HEAD {
            head = self.first_rows(signals, log, most);
            let of_outputs = head.samples.iter().skip(self.measured.len()).take(plant.y.len());
            let mut counts = of_outputs.map(|(_, values)| values.iter().filter(|value| value.is_finite()).count());
            let are_enough = counts.all(|count| count >= ENOUGH) && InputRow::of(plant, &head.samples).1;
            if are_enough || head.samples[0].1.len() < most {
                break;
            }
        }
        head
    }

    fn first_rows(&self, signals: &[Symbol], log: &mut Log, most: usize) -> Head {
        let (rows, unreadable) = log.head(&self.wanted, most).unwrap_or_default();
        let mut interpreter = Interpreter::new(&self.program);
        let mut values = vec![0.0; self.program.outputs.len()];
        let timed = usize::from(self.period.is_none());
        let samples = signals.iter().map(|signal| (*signal, Vec::new())).collect();
        let mut head = Head { samples, unreadable, ..Head::default() };
        for row in &rows {
            interpreter.run(row, &mut values);
            head.times.extend(values[..timed].first());
            head.samples.iter_mut().zip(&values[timed..]).for_each(|((_, samples), value)| samples.push(*value));
        }
        head
    }
}

/// The first rows of a recording: their instants where the period is not known, the samples of each signal, and why a
/// row after them cannot be read.
#[derive(Default)]
struct Head {
    times: Vec<f64>,
    samples: Vec<(Symbol, Vec<f64>)>,
    unreadable: Option<Unreadable>,
}

/// The columns as names of formulas.
struct Columns {
    /// A symbol for each.
    symbols: Vec<Symbol>,
    scope: Scope,
    /// Each name, with its column if that is unique.
    places: BTreeMap<String, Option<usize>>,
}

impl Columns {
    fn of(request: &Request, log: &Log) -> Self {
        let arena = &request.plant.arena;
        let symbols: Vec<Symbol> =
            (0..log.columns().len()).map(|place| arena.generated(&format!("column {}", place + 1))).collect();
        let mut places: BTreeMap<String, Option<usize>> = BTreeMap::new();
        for (place, name) in log.columns().iter().enumerate() {
            places.entry(name.clone()).and_modify(|other| *other = None).or_insert(Some(place));
        }
        let mut scope = Scope::new();
        let numbers = request.numbers();
        let parameters = request.plant.parameters.iter().map(|parameter| parameter.symbol);
        let parameters: BTreeMap<String, Expr> =
            parameters.filter_map(|symbol| Some((arena.name(symbol), *numbers.get(&symbol)?))).collect();
        for (name, value) in &parameters {
            if places.contains_key(name) {
                scope.bar(name, "both a parameter and a column of the recording: rename the column");
            } else {
                scope.define(name, *value);
            }
        }
        for (name, place) in &places {
            match place {
                Some(place) if !parameters.contains_key(name) => scope.define(name, arena.of_symbol(symbols[*place])),
                Some(_) => {}
                None => scope.bar(name, "several columns of the recording have this name: rename them"),
            }
        }
        Self { symbols, scope, places }
    }
}

struct SignalResolver<'a> {
    request: &'a Request<'a>,
    log: &'a Log<'a>,
    written: &'a Recording,
    columns: Columns,
    problems: &'a mut Diagnostics,
}

impl SignalResolver<'_> {
    /// The meaning of a formula; unknown names are reported.
    fn formula(&mut self, formula: &Formula) -> Option<Expr> {
        let known: BTreeSet<&str> =
            self.columns.scope.names().chain(self.columns.places.keys().map(String::as_str)).collect();
        let names = formula.names();
        let unknown: Vec<_> = names.iter().filter(|(name, _)| !known.contains(name) && *name != PI).collect();
        for (name, span) in &unknown {
            let diagnostic = unknown_name(name, *span, known.iter().copied());
            self.problems.push(diagnostic.note(self.listed()));
        }
        if !unknown.is_empty() {
            return None;
        }
        self.problems.keep(lower(&self.request.plant.arena, &self.columns.scope, formula))
    }

    /// The period, a number above zero.
    fn period(&mut self, step: &Entry<Formula>) -> Option<(f64, f64)> {
        let arena = &self.request.plant.arena;
        let value = self.formula(&step.value)?;
        let number = arena.as_number(value).filter(|number| number.signum() > 0);
        if number.is_none() {
            let message = "the step of a recording is a number above zero";
            self.problems.push(
                Diagnostic::error(Code::NumberOutOfRange, step.value.span, message)
                    .help("write seconds from row to row, as `step: 1e-5`, or `t`, a formula in columns"),
            );
        }
        number.map(|number| (number.numerator().to_f64(), number.denominator().to_f64()))
    }

    fn time(&mut self) -> Option<Expr> {
        if let Some(entry) = &self.written.t {
            return self.formula(&entry.value);
        }
        let declared =
            self.request.plant.time.is_none() && self.request.model.names().any(|name| name.value == Recording::T);
        if let Some(column) = self.column(Recording::T).filter(|_| !declared) {
            return Some(column);
        }
        self.lacks(
            "the time of its rows",
            "add `t`, a formula in columns, or `step`, the seconds from row to row, under `recording`",
        );
        None
    }

    /// A state, if it was measured.
    fn measured(&mut self, name: &str) -> Option<Expr> {
        match self.written.of_signal(name) {
            Some(entry) => self.formula(&entry.value),
            None => self.column(name),
        }
    }

    /// A signal without which the observer cannot run.
    fn needed(&mut self, name: &str) -> Option<Expr> {
        if let Some(entry) = self.written.of_signal(name) {
            return self.formula(&entry.value);
        }
        let column = self.column(name);
        if self.columns.places.get(name) == Some(&None) {
            let message = format!("{} has several columns `{name}`", self.log.name());
            let help = format!("rename all but one, or remove them: which is `{name}` is not said");
            let found = Diagnostic::error(Code::RecordingIncomplete, self.request.section, message);
            self.problems.push(found.note(self.listed()).help(help));
        } else if column.is_none() {
            let help = format!("add `{name}`, a formula in columns and parameters, under `recording`");
            self.lacks(&format!("`{name}`"), &help);
        }
        column
    }

    /// The column of this name.
    fn column(&self, name: &str) -> Option<Expr> {
        let place = (*self.columns.places.get(name)?)?;
        Some(self.request.plant.arena.of_symbol(self.columns.symbols[place]))
    }

    fn lacks(&mut self, what: &str, help: &str) {
        let message = format!("{} does not say {what}", self.log.name());
        self.problems.push(
            Diagnostic::error(Code::RecordingIncomplete, self.request.section, message).note(self.listed()).help(help),
        );
    }

    fn listed(&self) -> String {
        let (name, columns) = (self.log.name(), self.log.columns());
        match columns {
            [one] => format!("{name} has one column, `{one}`: commas, semicolons or tabs separate columns"),
            _ => format!("the columns of {name} are {}", listed(columns.iter().map(String::as_str))),
        }
    }
}
