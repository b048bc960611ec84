//! An experiment, resolved: what it needs beside the source of its samples.
//!
//! In: an accepted derivation, an observer with its settings, a table, and panels. Out: the programs from the table.

use std::collections::BTreeMap;
use std::ops::Range;

use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::program::Program;
use pebo_design::source::{Diagnostics, Span};

use super::columns::Columns;
use super::estimates::{ScoredEstimate, scored};
use super::layout::Layout;
use super::panels::PanelBuilder;
use crate::closed_loop::baseline::NamedBaseline;
use crate::figure::panel::Panel;
use crate::observe::design::Design;
use crate::score::domain::AssumedDomain;

/// An observer with baselines, ready to be run over samples.
#[derive(Debug)]
pub(crate) struct Experiment {
    pub(crate) title: String,
    pub(crate) layout: Layout,
    pub(crate) design: Design,
    /// True if the states in the table are those of the plant, and not samples of them.
    pub(crate) has_truth: bool,
    /// Baselines that take samples, with the positions of their estimates.
    pub(crate) followers: Vec<(Range<usize>, NamedBaseline)>,
    /// The estimates that are compared, those of the observer first.
    pub(crate) scored: Vec<ScoredEstimate>,
    /// Their errors.
    pub(crate) errors: Program,
    /// What the plant's author assumes of it.
    pub(crate) assumed: AssumedDomain,
    pub(crate) panels: Vec<Panel>,
    /// The values of the panels' curves.
    pub(crate) curves: Program,
    pub(crate) columns: Columns,
    /// The section that describes it.
    pub(crate) span: Span,
}

impl Experiment {
    /// The experiment of a derivation with these values of parameters; `panels` adds those of the figure, by the formulas of
    /// errors. A symbol without a value is reported.
    pub(crate) fn resolve(
        (plant, derivation, numbers): (&Plant, &Derivation, &BTreeMap<Symbol, Expr>),
        (design, layout): (Design, Layout),
        (has_truth, baselines): (bool, Vec<(String, NamedBaseline)>),
        panels: impl FnOnce(&mut PanelBuilder<'_>, (&[ScoredEstimate], &[Expr]), &mut Diagnostics),
        (span, problems): (Span, &mut Diagnostics),
    ) -> Option<Self> {
        let (scored, errors) = scored(plant, derivation, numbers, &layout);
        let mut builder = PanelBuilder::new(plant, &layout);
        panels(&mut builder, (&scored, &errors), problems);
        let (panels, curves) = builder.finish();
        let mut compile = |values: &[Expr]| problems.keep(layout.program(&plant.arena, values, span));
        Some(Self {
            title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
            design,
            has_truth,
            followers: baselines.into_iter().map(|(name, by)| (layout.of_baseline(&name), by)).collect(),
            scored,
            errors: compile(&errors)?,
            curves: compile(&curves)?,
            panels,
            assumed: AssumedDomain::of(plant, &derivation.conditions, &layout.symbols, |assumed| {
                compile(&plant.arena.substitute_all(assumed, numbers))
            })?,
            columns: Columns::new(plant, &layout, has_truth),
            layout,
            span,
        })
    }
}
