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
use super::estimates::ScoredEstimate;
use super::layout::Layout;
use super::panels::Panels;
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
    pub(crate) span: Span,
}

/// The parts of an experiment before they are programs.
pub(crate) struct Parts<'a> {
    pub(crate) plant: &'a Plant,
    pub(crate) derivation: &'a Derivation,
    /// The values of the parameters.
    pub(crate) numbers: &'a BTreeMap<Symbol, Expr>,
    pub(crate) design: Design,
    pub(crate) layout: Layout,
    pub(crate) has_truth: bool,
    pub(crate) baselines: Vec<(String, NamedBaseline)>,
    pub(crate) scored: (Vec<ScoredEstimate>, Vec<Expr>),
    pub(crate) panels: Panels,
    pub(crate) columns: Columns,
    /// The section that describes it.
    pub(crate) span: Span,
}

impl Parts<'_> {
    /// The experiment; formulas that need a symbol without a value are reported.
    pub(crate) fn compile(self, problems: &mut Diagnostics) -> Option<Experiment> {
        let Self { plant, derivation, numbers, layout, span, scored: (scored, errors), panels, .. } = self;
        let arena = &plant.arena;
        let mut compile = |values: &[Expr]| problems.keep(layout.program(arena, values, span));
        Some(Experiment {
            title: plant.title.clone().unwrap_or_else(|| plant.name.clone()),
            design: self.design,
            has_truth: self.has_truth,
            followers: self.baselines.into_iter().map(|(name, by)| (layout.of_baseline(&name), by)).collect(),
            scored,
            errors: compile(&errors)?,
            curves: compile(&panels.values)?,
            panels: panels.panels,
            assumed: AssumedDomain::of(plant, &derivation.conditions, &layout.symbols, |assumed| {
                compile(&arena.substitute_all(assumed, numbers))
            })?,
            columns: self.columns,
            layout,
            span,
        })
    }
}
