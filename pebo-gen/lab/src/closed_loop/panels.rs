//! The panels of a run's figure: those that the model file describes, or estimates, errors, outputs and inputs.
//!
//! A curve that shows estimates of the observer is drawn once more for each baseline that estimates
//! the same states, with the baseline's name beside it.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::{Expr, Symbol};
use pebo_design::model::Scale;
use pebo_design::plant::lower;
use pebo_design::source::Diagnostics;

use super::baseline::ResolvedBaseline;
use super::layout::{baseline_estimate, estimate, standard_error};
use super::scope::{Estimates, Names, Sight, View};
use crate::figure::label::Label;
use crate::figure::panel::{Panel, PanelCurve};
use crate::figure::unit;

/// The panels, and the values of their curves one after the other, each with the edges of its band.
#[derive(Debug, Default)]
pub(crate) struct Panels {
    pub(crate) panels: Vec<Panel>,
    pub(crate) values: Vec<Expr>,
}

impl Panels {
    /// The panels of the model file, else the usual ones.
    pub(crate) fn resolve(
        names: &Names,
        (hats, predicted): (&Estimates, bool),
        errors: &[Expr],
        baselines: &[ResolvedBaseline],
        problems: &mut Diagnostics,
    ) -> Self {
        let mut pass = PanelResolver { names, hats, predicted, baselines, found: Self::default() };
        if names.simulation.panels.is_empty() {
            pass.usual(errors);
        } else {
            pass.written(errors, problems);
        }
        pass.found
    }
}

/// The value of a curve, and the edges of the band about it.
#[derive(Clone, Copy, Debug)]
struct CurveValue {
    value: Expr,
    edges: Option<[Expr; 2]>,
}

struct PanelResolver<'a> {
    names: &'a Names<'a>,
    hats: &'a Estimates,
    /// True if the observer predicts the standard errors of its estimates.
    predicted: bool,
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
            let curves = curves
                .filter_map(|f| {
                    let value = meant(problems.keep(lower(arena, &scope, f))?);
                    Some((PanelCurve::plain(Label::formula(f)), CurveValue { value, edges: None }))
                })
                .collect();
            let known = |name: &str| self.unit(arena.symbol(name));
            let unit = match &panel.unit {
                Some(unit) => Some(unit.value.clone()),
                None => unit::same(panel.curves.iter().map(|curve| unit::of(curve, &known))).map(str::to_owned),
            };
            self.add((&panel.title.value, unit, panel.scale.value), curves);
        }
    }

    /// Each estimate beside the state, with the band of its standard error; errors, without noise on a logarithmic axis,
    /// which alone shows how they die out; outputs and inputs, each unit on an axis of its own.
    fn usual(&mut self, errors: &[Expr]) {
        let plant = self.names.plant;
        let arena = &plant.arena;
        let plain = |value: Expr| CurveValue { value, edges: None };
        for (state, hat) in self.hats {
            let symbol = arena.symbol(state);
            let edges = self.predicted.then(|| {
                let standard_error = arena.of_symbol(standard_error(arena, state));
                [arena.sub(*hat, standard_error), arena.add(*hat, standard_error)]
            });
            let estimate = PanelCurve::settling(Label::estimate(state), self.predicted);
            let curves = vec![
                (symbol, estimate, CurveValue { value: *hat, edges }),
                (symbol, PanelCurve::plain(Label::name(state)), plain(arena.of_symbol(symbol))),
            ];
            self.signals(&Panel::of_estimate(plant, symbol), Scale::Linear, curves);
        }
        let errors = self.hats.iter().zip(errors).map(|((state, _), error)| {
            (arena.symbol(state), PanelCurve::settling(Label::error(state), false), plain(*error))
        });
        let signal =
            |symbol: Symbol, value: Expr| (symbol, PanelCurve::plain(Label::name(&arena.name(symbol))), plain(value));
        let outputs = plant.y.iter().map(|output| signal(output.symbol, self.names.measured(output.symbol))).collect();
        let inputs = plant.commanded().map(|input| signal(input, arena.of_symbol(input))).collect();
        let scale = if self.names.simulation.noise.is_empty() { Scale::Log } else { Scale::Linear };
        for (title, errors) in Panel::of_errors(plant, scale, errors.collect(), |(symbol, ..)| *symbol) {
            self.signals(&title, scale, errors);
        }
        self.signals("Outputs", Scale::Linear, outputs);
        self.signals("Inputs", Scale::Linear, inputs);
    }

    fn signals(&mut self, title: &str, scale: Scale, curves: Vec<(Symbol, PanelCurve, CurveValue)>) {
        for curves in Panel::groups(self.names.plant, scale, curves, |(symbol, ..)| *symbol) {
            let (curves, values): (Vec<_>, Vec<CurveValue>) =
                curves.into_iter().map(|(symbol, curve, value)| ((symbol, curve), value)).unzip();
            let panel = Panel::of_signals(self.names.plant, title, scale, curves);
            self.add((title, panel.unit, scale), panel.curves.into_iter().zip(values).collect());
        }
    }

    /// The unit that the model gives a signal.
    fn unit(&self, symbol: Symbol) -> Option<&str> {
        self.names.plant.units.get(&symbol).map(String::as_str)
    }

    fn add(&mut self, (title, unit, scale): (&str, Option<String>, Scale), curves: Vec<(PanelCurve, CurveValue)>) {
        let mut shown = Vec::new();
        for (curve, CurveValue { value, edges }) in curves {
            shown.push(curve.clone());
            self.found.values.push(value);
            self.found.values.extend(edges.into_iter().flatten());
            for baseline in self.baselines {
                if let Some(other) = through(self.names, self.hats, value, baseline) {
                    let label = curve.label.clone().remark(&baseline.name);
                    shown.push(PanelCurve { label, has_band: false, ..curve });
                    self.found.values.push(other);
                }
            }
        }
        self.found.panels.push(Panel { title: title.to_owned(), unit, scale, curves: shown });
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
