//! A replay: a model and the header of a recording, resolved to programs.
//!
//! In: an accepted derivation with its model, and the columns. Out: the replay, or every mistake in the sections
//! `observer` and `recording`. After this, only rows can be wrong.

use crate::closed_loop::baseline::{NamedBaseline, StartError};
use crate::closed_loop::scope::{self, Estimates};
use crate::experiment::columns::Columns;
use crate::experiment::estimates::{ScoredEstimate, scored};
use crate::experiment::layout::{ComparedBaseline, Layout, SourceSymbols, estimate, residual};
use crate::experiment::panels::{CurveValue, PanelBuilder, Panels};
use crate::experiment::setup::{Experiment, Parts};
use crate::figure::label::Label;
use crate::figure::panel::PanelCurve;
use crate::observe::design::Design;
use crate::observe::request::Request;
use crate::settings::{KnownNumbers, Shown};
use crate::summary::advice::{Origin, advise};
use pebo_cas::Symbol;
use pebo_design::analysis::Derivation;
use pebo_design::model::{Baseline, Entry, Model, Recording, Scale};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Diagnostics};

use super::alignment::InputRow;
use super::log::Log;
use super::replayed::Replayed;
use super::residual::Residuals;
use super::signals::Signals;

/// An observer and the meaning of a log's columns, ready to be run.
#[derive(Debug)]
pub struct Replay {
    pub(super) experiment: Experiment,
    pub(super) signals: Signals,
    pub(super) residuals: Residuals<Program>,
    pub(super) names: Names,
    /// The usual time from row to row, in seconds.
    period: Option<f64>,
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
        self.experiment.design.settings.output
            && self.experiment.design.rows.iter().any(|row| self.names.y[*row] == output)
    }

    /// The known numbers behind the observer's settings; none where gains are written.
    pub(super) fn known(&self) -> Option<&KnownNumbers> {
        self.experiment.design.settings.known.as_ref()
    }

    /// The advice on a recording that contradicts the observer's numbers, or on which the estimates did not converge:
    /// reason and mend.
    pub fn advise(&self, replayed: &Replayed) -> Vec<Diagnostic> {
        advise(&replayed.summary, (&self.experiment.design.settings.estimator, Origin::Recorded), self.experiment.span)
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
    let name = |symbol: Symbol| arena.name(symbol);
    let recovered = design.recovered.iter().map(|state| name(*state));
    let hat = |state: String| (state.clone(), arena.of_symbol(estimate(arena, &state)));
    let hats: Estimates = recovered.map(hat).collect();
    let residuals = Residuals::resolve(plant, (&hats, design.settings.late.as_ref()), &numbers);
    let states: Vec<String> = plant.x.iter().map(|state| name(state.symbol)).collect();
    let compared: Vec<ComparedBaseline> =
        baselines.iter().map(|(baseline, _)| (baseline.clone(), states.clone())).collect();
    let with_residual = residuals.outputs.iter().map(|(output, _)| plant.y[*output].symbol);
    let source = SourceSymbols {
        x: signals.measured.iter().map(|place| plant.x[*place].symbol).collect(),
        residuals: with_residual.map(|output| residual(arena, &name(output))).collect(),
        ..SourceSymbols::default()
    };
    let layout = Layout::new(plant, &design, &compared, source);
    let scored = scored(plant, derivation, &numbers, &layout);
    let panels = panels(plant, (&layout, &compared), &scored.0, &residuals.outputs);
    let residuals = residuals.compile(arena, &layout, (span, problems))?;
    Some(Replay {
        names: Names {
            columns: signals.wanted.iter().map(|column| log.columns()[*column].clone()).collect(),
            y: plant.y.iter().map(|output| name(output.symbol)).collect(),
            units: plant.y.iter().map(|output| plant.units.get(&output.symbol).cloned()).collect(),
            u: plant.commanded().map(name).collect(),
            left_out,
        },
        signals,
        residuals,
        period: shown.period(),
        experiment: Parts {
            plant,
            derivation,
            numbers: &numbers,
            baselines,
            columns: Columns::new(arena, &layout, std::iter::empty()),
            design,
            layout,
            has_truth: false,
            scored,
            panels,
            span,
        }
        .compile(problems)?,
    })
}

/// The panels: estimates beside measured states; errors; where no state was measured, residuals of these outputs.
fn panels(
    plant: &Plant,
    (layout, baselines): (&Layout, &[ComparedBaseline]),
    scored: &[ScoredEstimate],
    residuals: &[(usize, bool)],
) -> Panels {
    let arena = &plant.arena;
    let curve = |symbol: Symbol, label: Label, place: usize| {
        let value = CurveValue::plain(arena.of_symbol(layout.symbols[place]));
        (symbol, PanelCurve::settling(label, false), value)
    };
    let errors = scored.iter().zip(layout.errors.clone()).map(|(ScoredEstimate { estimate, truth, .. }, place)| {
        let label = Label::error(&estimate.state);
        let label = estimate.baseline.iter().fold(label, |label, baseline| label.remark(baseline));
        curve(layout.symbols[*truth], label, place)
    });
    let residuals = residuals.iter().zip(layout.residuals.clone()).filter(|_| scored.is_empty());
    let residuals = residuals.map(|((output, _), place)| {
        let output = plant.y[*output].symbol;
        curve(output, Label::name(&arena.name(output)), place)
    });
    let mut builder = PanelBuilder { plant, layout, baselines, found: Panels::default() };
    let measured = |state: &str| Label::name(state).remark("measured");
    // A recording has noise.
    builder.usual(measured, (Scale::Linear, errors.collect()), residuals.collect());
    builder.found
}

/// The baselines by name, with their names, and the names of those that have equations.
fn baselines(
    request: &Request,
    design: &Design,
    problems: &mut Diagnostics,
) -> (Vec<(String, NamedBaseline)>, Vec<String>) {
    let Request { model, plant, .. } = *request;
    let Some(simulation) = &model.simulation else { return (Vec::new(), Vec::new()) };
    let names = scope::Names { model, simulation, plant };
    let (with_equations, named): (Vec<_>, Vec<_>) =
        simulation.baselines.iter().partition(|entry| entry.value.equations().is_some());
    let own = design.settings.known.as_ref().map(|known| known.of(KnownNumbers::START)).unwrap_or_default();
    let mut resolve = |entry: &Entry<Baseline>| {
        let resolved = NamedBaseline::resolve(&names, entry, StartError::Assumed(&own), problems)?;
        Some((entry.name.value.clone(), resolved))
    };
    let resolved = named.into_iter().filter_map(&mut resolve).collect();
    (resolved, with_equations.into_iter().map(|entry| entry.name.value.clone()).collect())
}
