//! A replay: a model and the header of a recording, resolved to programs.
//!
//! In: an accepted derivation with its model, and the columns. Out: the replay, or every mistake in the sections
//! `observer` and `recording`. After this, only rows can be wrong.

use std::ops::Range;

use crate::closed_loop::baseline::{NamedBaseline, StartError};
use crate::closed_loop::scenario::{Periods, ScoredEstimate, scored};
use crate::closed_loop::scope::{self, Estimates};
use crate::closed_loop::trace::Trace;
use crate::observe::design::Design;
use crate::observe::request::Request;
use crate::score::domain::AssumedDomain;
use crate::settings::{KnownNumbers, Shown};
use crate::summary::advice::{Origin, advise};
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::{Baseline, Entry, Model, Recording};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Diagnostics, Span};

use super::alignment::InputRow;
use super::layout::Layout;
use super::log::Log;
use super::panels::Panels;
use super::replayed::Replayed;
use super::residual::Residuals;
use super::signals::Signals;

/// An observer and the meaning of a log's columns, ready to be run.
#[derive(Debug)]
pub struct Replay {
    pub(super) title: String,
    pub(super) signals: Signals,
    pub(super) design: Design,
    pub(super) layout: Layout,
    /// Indices of the measured states among the recovered ones.
    pub(super) measured: Vec<usize>,
    /// The estimates of these, then those of measured states by each baseline.
    pub(super) scored: Vec<ScoredEstimate>,
    /// Baselines, each with the positions of its estimates.
    pub(super) baselines: Vec<(Range<usize>, NamedBaseline)>,
    /// Their errors.
    pub(super) errors: Program,
    pub(super) residuals: Residuals,
    /// What the plant's author assumes of it.
    pub(super) assumed: AssumedDomain,
    pub(super) panels: Panels,
    /// The names of the columns that are written.
    pub(super) columns: Vec<String>,
    pub(super) names: Names,
    /// The usual time from row to row, in seconds.
    period: Option<f64>,
    pub(super) span: Span,
}

/// The names of signals, in their order.
#[derive(Debug)]
pub(super) struct Names {
    /// The columns that are read.
    pub(super) columns: Vec<String>,
    pub(super) y: Vec<String>,
    /// The units of y.
    pub(super) units: Vec<Option<String>>,
    pub(super) u: Vec<String>,
    /// The baselines that only a simulation can run.
    pub(super) left_out: Vec<String>,
}

impl Replay {
    /// Resolves the sections of a model for a log with these columns.
    ///
    /// The errors are those of the derivation where it is not accepted.
    pub fn resolve(
        model: &Model,
        plant: &Plant,
        derivation: &Derivation,
        log: &mut Log,
    ) -> Result<Self, Vec<Diagnostic>> {
        derivation.admit().map_err(<[Diagnostic]>::to_vec)?;
        let section = model.recording.as_ref().and_then(Recording::span).unwrap_or(model.name.span);
        let request = Request { model, plant, section, who: "the replay" };
        let mut problems = Diagnostics::new();
        request.check(&mut problems);
        // Every formula with a parameter without a value would be reported again.
        problems.propagate()?;
        let replay = replay(&request, derivation, log, &mut problems);
        problems.propagate()?;
        // Without a replay there is an error, which was propagated.
        replay.ok_or_else(Vec::new)
    }

    /// The period of the first rows.
    pub(super) fn period(&self) -> Option<f64> {
        self.period
    }

    /// True if the output is a state of the observer: its rate is in the regression.
    pub(super) fn has_rate(&self, output: &str) -> bool {
        self.design.settings.output && self.design.rows.iter().any(|row| self.names.y[*row] == output)
    }

    /// The known numbers behind the observer's settings; none where gains are written.
    pub(super) fn known(&self) -> Option<&KnownNumbers> {
        self.design.settings.known.as_ref()
    }

    /// The advice on a recording that contradicts the observer's numbers, or on which the estimates did not converge:
    /// reason and mend.
    pub fn advise(&self, replayed: &Replayed) -> Vec<Diagnostic> {
        advise(&replayed.summary, (&self.design.settings.estimator, Origin::Recorded), self.span)
    }
}

fn replay(request: &Request, derivation: &Derivation, log: &mut Log, problems: &mut Diagnostics) -> Option<Replay> {
    let (plant, arena, span) = (request.plant, &request.plant.arena, request.section);
    let numbers = request.numbers();
    let signals = Signals::resolve(request, log, problems);
    let (shown, input_row) = match &signals {
        Some(signals) => signals.shown(request, log, problems)?,
        None => (Shown::default(), InputRow::Before),
    };
    let design = Design::resolve(request, derivation, &numbers, &shown, problems);
    let (signals, design) = (signals?, design?);
    let design = if input_row == InputRow::Same { design.with_instant() } else { design };
    let (baselines, left_out) = baselines(request, &design, problems);
    let (named, resolved): (Vec<&str>, Vec<NamedBaseline>) = baselines.into_iter().unzip();
    let layout = Layout::new(plant, &signals.measured, &design, &named);
    let name = |symbol: Symbol| arena.name(symbol);
    let hats: Vec<(String, Expr)> =
        layout.estimated.iter().map(|(state, hat)| (name(*state), arena.of_symbol(*hat))).collect();
    let measured: Vec<usize> =
        (0..hats.len()).filter(|place| layout.of_state(layout.estimated[*place].0).is_some()).collect();
    let all: Estimates = plant.x.iter().map(|state| (name(state.symbol), arena.of_symbol(state.symbol))).collect();
    let compared: Vec<(String, Estimates)> = named.iter().map(|name| ((*name).to_owned(), all.clone())).collect();
    let (scored, errors) =
        scored((plant, &layout.symbols), &Periods::of(plant, derivation, &numbers), &hats, &compared);
    let errors = problems.keep(layout.program(arena, &errors, span))?;
    let assumed = AssumedDomain::of(plant, &derivation.conditions, &layout.symbols, |assumed| {
        problems.keep(layout.program(arena, &arena.substitute_all(assumed, &numbers), span))
    })?;
    let residuals = Residuals::resolve(plant, (&layout, design.settings.late.as_ref()), &numbers, (span, problems))?;
    Some(Replay {
        title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
        panels: Panels::resolve(plant, &layout, &scored, &residuals),
        columns: columns((plant, &layout), &measured, design.predicts()),
        names: Names {
            columns: signals.wanted.iter().map(|column| log.columns()[*column].clone()).collect(),
            y: plant.y.iter().map(|output| name(output.symbol)).collect(),
            units: plant.y.iter().map(|output| plant.units.get(&output.symbol).cloned()).collect(),
            u: plant.commanded().map(name).collect(),
            left_out,
        },
        baselines: layout
            .baselines
            .clone()
            .step_by(plant.x.len().max(1))
            .map(|first| first..first + plant.x.len())
            .zip(resolved)
            .collect(),
        signals,
        design,
        layout,
        measured,
        scored,
        errors,
        residuals,
        assumed,
        period: shown.period(),
        span,
    })
}

/// The baselines by name, with their names, and the names of those that have equations.
fn baselines<'a>(
    request: &Request<'a>,
    design: &Design,
    problems: &mut Diagnostics,
) -> (Vec<(&'a str, NamedBaseline)>, Vec<String>) {
    let Request { model, plant, .. } = *request;
    let Some(simulation) = &model.simulation else { return (Vec::new(), Vec::new()) };
    let names = scope::Names { model, simulation, plant };
    let (with_equations, named): (Vec<_>, Vec<_>) =
        simulation.baselines.iter().partition(|entry| entry.value.equations().is_some());
    let own = design.settings.known.as_ref().map(|known| known.of(KnownNumbers::START)).unwrap_or_default();
    let mut resolve = |entry: &'a Entry<Baseline>| {
        let resolved = NamedBaseline::resolve(&names, entry, StartError::Assumed(&own), problems)?;
        Some((entry.name.value.as_str(), resolved))
    };
    let resolved = named.into_iter().filter_map(&mut resolve).collect();
    (resolved, with_equations.into_iter().map(|entry| entry.name.value.clone()).collect())
}

/// `t`, then estimates, each with its error if the state was measured; estimates of baselines; then the standard errors,
/// if they are predicted.
fn columns((plant, layout): (&Plant, &Layout), measured: &[usize], predicted: bool) -> Vec<String> {
    let name = |symbol: &Symbol| plant.arena.name(*symbol);
    let mut columns = vec![Recording::T.to_owned()];
    for (recovered, (state, _)) in layout.estimated.iter().enumerate() {
        columns.push(format!("{}_hat", name(state)));
        if measured.contains(&recovered) {
            columns.push(format!("{}{}", name(state), Trace::ERROR));
        }
    }
    columns.extend(layout.of_baselines.iter().map(|(baseline, state)| format!("{baseline}.{}_hat", name(state))));
    let predicted = layout.estimated.iter().filter(|_| predicted);
    columns.extend(predicted.map(|(state, _)| format!("{}{}", name(state), Trace::STANDARD_ERROR)));
    columns
}
