//! The panels of a run's figure: those that the model file describes, or errors, outputs and inputs.
//!
//! A curve that shows estimates of the observer is drawn once more for each baseline that estimates
//! the same states, with the baseline's name beside it.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::{Expr, Symbol};
use pebo_design::model::Scale;
use pebo_design::plant::lower;
use pebo_design::source::Diagnostics;

use super::baseline::ResolvedBaseline;
use super::layout::{baseline_estimate, estimate};
use super::scope::{Estimates, Names, Sight, View};
use crate::figure::label::Label;
use crate::figure::panel::Panel;
use crate::figure::unit;

/// The panels, and the values of their curves one after the other.
#[derive(Debug, Default)]
pub(crate) struct Panels {
    pub(crate) panels: Vec<Panel>,
    pub(crate) values: Vec<Expr>,
}

impl Panels {
    /// The panels of the model file, else the usual ones.
    pub(crate) fn resolve(
        names: &Names,
        hats: &Estimates,
        errors: &[Expr],
        baselines: &[ResolvedBaseline],
        problems: &mut Diagnostics,
    ) -> Self {
        let mut pass = PanelResolver { names, hats, baselines, found: Self::default() };
        if names.simulation.panels.is_empty() {
            pass.usual(errors);
        } else {
            pass.written(errors, problems);
        }
        pass.found
    }
}

struct PanelResolver<'a> {
    names: &'a Names<'a>,
    hats: &'a Estimates,
    baselines: &'a [ResolvedBaseline],
    found: Panels,
}

impl PanelResolver<'_> {
    /// The panels of the file; estimate less truth is the error, for an angle the shorter way round.
    fn written(&mut self, errors: &[Expr], problems: &mut Diagnostics) {
        let arena = &self.names.plant.arena;
        let differences = self.hats.iter().map(|(state, hat)| arena.sub(*hat, arena.variable(state)));
        let errors: BTreeMap<Expr, Expr> = differences.zip(errors.iter().copied()).collect();
        let meant = |curve: Expr| errors.get(&curve).copied().unwrap_or(curve);
        let scope = self.names.scope(&View { sight: Sight::Everything, own: None, hats: self.hats.clone() });
        for panel in &self.names.simulation.panels {
            let curves = panel.curves.iter();
            let curves: Vec<(Label, Expr)> = curves
                .filter_map(|f| Some((Label::formula(f), meant(problems.keep(lower(arena, &scope, f))?))))
                .collect();
            let known = |name: &str| self.unit(arena.symbol(name));
            let unit = match &panel.unit {
                Some(unit) => Some(unit.value.clone()),
                None => unit::same(panel.curves.iter().map(|curve| unit::of(curve, &known))).map(str::to_owned),
            };
            self.add((&panel.title.value, unit, panel.scale), curves);
        }
    }

    /// Errors on a logarithmic axis, which alone shows all units and sizes; outputs and inputs, each unit on an axis of
    /// its own.
    fn usual(&mut self, errors: &[Expr]) {
        let plant = self.names.plant;
        let arena = &plant.arena;
        let states = self.hats.iter().map(|(state, _)| arena.symbol(state));
        let errors = self.hats.iter().zip(errors).map(|((state, _), error)| (Label::error(state), *error));
        let errors = states.zip(errors).map(|(state, (label, error))| (state, label, error)).collect();
        let named = |symbol: Symbol| (symbol, Label::name(&arena.name(symbol)), arena.of_symbol(symbol));
        let measured = |symbol: Symbol| (symbol, Label::name(&arena.name(symbol)), self.names.measured(symbol));
        let outputs = plant.y.iter().map(|output| measured(output.symbol)).collect();
        let inputs = plant.commanded().map(named).collect();
        self.signals("Estimation errors", Scale::Log, errors);
        self.signals("Outputs", Scale::Linear, outputs);
        self.signals("Inputs", Scale::Linear, inputs);
    }

    fn signals(&mut self, title: &str, scale: Scale, curves: Vec<(Symbol, Label, Expr)>) {
        for curves in Panel::groups(self.names.plant, scale, curves, |(symbol, ..)| *symbol) {
            let (labels, values): (Vec<_>, Vec<Expr>) =
                curves.into_iter().map(|(symbol, label, value)| ((symbol, label), value)).unzip();
            let panel = Panel::of_signals(self.names.plant, title, scale, labels);
            self.add((title, panel.unit, scale), panel.curves.into_iter().zip(values).collect());
        }
    }

    /// The unit that the model gives a signal.
    fn unit(&self, symbol: Symbol) -> Option<&str> {
        self.names.plant.units.get(&symbol).map(String::as_str)
    }

    fn add(&mut self, (title, unit, scale): (&str, Option<String>, Scale), curves: Vec<(Label, Expr)>) {
        let mut labels = Vec::new();
        for (label, value) in curves {
            labels.push(label.clone());
            self.found.values.push(value);
            for baseline in self.baselines {
                if let Some(other) = through(self.names, self.hats, value, baseline) {
                    labels.push(label.clone().remark(&baseline.name));
                    self.found.values.push(other);
                }
            }
        }
        self.found.panels.push(Panel { title: title.to_owned(), unit, scale, curves: labels });
    }
}

/// The value with a baseline's estimates in place of the observer's, if there are any in it and it has them all.
fn through(names: &Names, hats: &Estimates, value: Expr, baseline: &ResolvedBaseline) -> Option<Expr> {
    let arena = &names.plant.arena;
    let symbols: BTreeSet<Symbol> = hats.iter().filter_map(|(_, hat)| arena.as_symbol(*hat)).collect();
    let own: BTreeMap<Symbol, Expr> = (baseline.estimates.iter())
        .map(|(state, _)| (estimate(arena, state), arena.of_symbol(baseline_estimate(arena, &baseline.name, state))))
        .collect();
    let replaced = arena.substitute(value, &own);
    (arena.depends_on(value, &symbols) && !arena.depends_on(replaced, &symbols)).then_some(replaced)
}
