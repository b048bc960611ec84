//! A replay: a model and the header of a recording, resolved to programs.
//!
//! In: an accepted derivation with its model, and the columns. Out: the replay, or every mistake in the sections
//! `observer` and `recording`. After this, only rows can be wrong.

use crate::closed_loop::baseline::{NamedBaseline, StartError};
use crate::closed_loop::scope;
use crate::experiment::estimates::ScoredEstimate;
use crate::experiment::layout::{Layout, SourceSymbols, estimates, residual};
use crate::experiment::panels::{CurveValue, PanelBuilder};
use crate::experiment::setup::Experiment;
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
use pebo_design::source::{Diagnostic, Diagnostics};

use super::alignment::InputRow;
use super::log::Log;
use super::replayed::Replayed;
use super::residual::{Residuals, formulas};
use super::signals::Signals;

/// An observer and the meaning of a log's columns, ready to be run.
#[derive(Debug)]
pub struct Replay {
    pub(super) experiment: Experiment,
    pub(super) signals: Signals,
    pub(super) residuals: Residuals,
    pub(super) names: Names,
    /// The usual time from row to row, in seconds.
    period: Option<f64>,
}

/// Names of a recording's columns and of what is beside them.
#[derive(Debug)]
pub(super) struct Names {
    /// The columns that are read.
    pub(super) columns: Vec<String>,
    /// The units of y.
    pub(super) units: Vec<Option<String>>,
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
            && self.experiment.design.rows.iter().any(|row| self.experiment.design.names.outputs[*row] == output)
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
    let hats = estimates(arena, &design);
    let (outputs, formulas) = formulas(plant, (&hats, design.settings.late.as_ref()), &numbers);
    let states: Vec<String> = plant.x.iter().map(|state| name(state.symbol)).collect();
    let compared: Vec<_> = baselines.iter().map(|(baseline, _)| (baseline.clone(), states.clone())).collect();
    let with_residual = outputs.iter().map(|(output, _)| plant.y[*output].symbol);
    let source = SourceSymbols {
        x: signals.measured.iter().map(|place| plant.x[*place].symbol).collect(),
        residuals: with_residual.map(|output| residual(arena, &name(output))).collect(),
        ..SourceSymbols::default()
    };
    let layout = Layout::new(plant, &design, &compared, source);
    let residuals = problems.keep(layout.program(arena, &formulas, span))?;
    let experiment = Experiment::resolve(
        (plant, derivation, &numbers),
        (design, layout),
        (false, baselines),
        |builder, (scored, _), _| add_panels(builder, plant, scored, &outputs),
        (span, problems),
    )?;
    Some(Replay {
        names: Names {
            columns: signals.wanted.iter().map(|column| log.columns()[*column].clone()).collect(),
            units: plant.y.iter().map(|output| plant.units.get(&output.symbol).cloned()).collect(),
            left_out,
        },
        signals,
        experiment,
        residuals: Residuals { outputs, formulas: residuals },
        period: shown.period(),
    })
}

/// Adds the panels: estimates beside measured states; errors; where no state was measured, residuals of these outputs.
fn add_panels(builder: &mut PanelBuilder<'_>, plant: &Plant, scored: &[ScoredEstimate], residuals: &[(usize, bool)]) {
    let (arena, layout) = (&plant.arena, builder.layout);
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
    let measured = |state: &str| Label::name(state).remark("measured");
    // A recording has noise.
    builder.usual(measured, (Scale::Linear, errors.collect()), residuals.collect());
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
