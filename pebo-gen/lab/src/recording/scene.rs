//! A replay: a model and the header of a recording, resolved to programs.
//!
//! In: an accepted derivation with its model, and the columns. Out: the replay, or every mistake in the sections
//! `observer` and `recording`. After this, only rows can be wrong.

use crate::closed_loop::scenario::{Periods, ScoredEstimate, scored};
use crate::closed_loop::trace::Trace;
use crate::observe::design::Design;
use crate::observe::request::Request;
use crate::score::domain::AssumedDomain;
use crate::summary::advice::{Origin, advise};
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::{Model, Recording};
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostic, Diagnostics, Span};

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
    /// The estimates of these.
    pub(super) scored: Vec<ScoredEstimate>,
    /// Their errors.
    pub(super) errors: Program,
    pub(super) residuals: Residuals,
    /// What the plant's author assumes of it.
    pub(super) assumed: AssumedDomain,
    pub(super) panels: Panels,
    /// The names of the columns that are written.
    pub(super) columns: Vec<String>,
    pub(super) names: Names,
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
}

impl Replay {
    /// Resolves the sections of a model for a log with these columns.
    ///
    /// The errors are those of the derivation where it is not accepted.
    pub fn resolve(model: &Model, plant: &Plant, derivation: &Derivation, log: &Log) -> Result<Self, Vec<Diagnostic>> {
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

    /// The advice on a recording on which the estimates did not converge: reason and mend.
    pub fn advise(&self, replayed: &Replayed) -> Option<Diagnostic> {
        advise(&replayed.summary, (&self.design.settings.estimator, Origin::Recorded), self.span)
    }
}

fn replay(request: &Request, derivation: &Derivation, log: &Log, problems: &mut Diagnostics) -> Option<Replay> {
    let (plant, arena, span) = (request.plant, &request.plant.arena, request.section);
    let numbers = request.numbers();
    let signals = Signals::resolve(request, log, problems);
    let period = signals.as_ref().and_then(|signals| signals.period).map(|(above, below)| above / below);
    let design = Design::resolve(request, derivation, &numbers, period, problems);
    let (signals, design) = (signals?, design?);
    let layout = Layout::new(plant, &signals.measured, &design.recovered);
    let name = |symbol: Symbol| arena.name(symbol);
    let hats: Vec<(String, Expr)> =
        layout.estimated.iter().map(|(state, hat)| (name(*state), arena.of_symbol(*hat))).collect();
    let measured: Vec<usize> =
        (0..hats.len()).filter(|place| layout.of_state(layout.estimated[*place].0).is_some()).collect();
    let compared: Vec<(String, Expr)> = measured.iter().map(|place| hats[*place].clone()).collect();
    let (scored, errors) = scored((plant, &layout.symbols), &Periods::of(plant, derivation, &numbers), &compared, &[]);
    let states: Vec<Symbol> = measured.iter().map(|place| layout.estimated[*place].0).collect();
    let errors = problems.keep(layout.program(arena, &errors, span))?;
    let assumed = AssumedDomain::of(plant, &layout.symbols, |assumed| {
        problems.keep(layout.program(arena, &arena.substitute_all(assumed, &numbers), span))
    })?;
    let residuals = Residuals::resolve(plant, &layout, &numbers, (span, problems))?;
    Some(Replay {
        title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
        panels: Panels::resolve(plant, &layout, &states, &residuals),
        columns: columns(&hats, &measured),
        names: Names {
            columns: signals.wanted.iter().map(|column| log.columns()[*column].clone()).collect(),
            y: plant.y.iter().map(|output| name(output.symbol)).collect(),
            units: plant.y.iter().map(|output| plant.units.get(&output.symbol).cloned()).collect(),
            u: plant.commanded().map(name).collect(),
        },
        signals,
        design,
        layout,
        measured,
        scored,
        errors,
        residuals,
        assumed,
        span,
    })
}

/// `t`, then estimates, each with its error if the state was measured.
fn columns(hats: &[(String, Expr)], measured: &[usize]) -> Vec<String> {
    let mut columns = vec![Recording::T.to_owned()];
    for (recovered, (state, _)) in hats.iter().enumerate() {
        columns.push(format!("{state}_hat"));
        if measured.contains(&recovered) {
            columns.push(format!("{state}{}", Trace::ERROR));
        }
    }
    columns
}
