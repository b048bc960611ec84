//! The panels of an experiment's figure: a panel for each estimate, beside the state where that is known, with the band of
//! its standard error; errors; residuals where no state is known; outputs; inputs. On a linear axis all signals have one
//! unit.
//!
//! A curve that shows estimates of the observer is drawn once more for each baseline that estimates the same states, with
//! the baseline's name beside it.

use std::collections::BTreeSet;
use std::ops::Range;

use pebo_cas::{Expr, Symbol};
use pebo_design::model::Scale;
use pebo_design::plant::Plant;

use super::layout::{Layout, estimate, standard_error};
use crate::figure::label::Label;
use crate::figure::panel::{Panel, PanelCurve};

/// The value of a curve, and the edges of the band about it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurveValue {
    value: Expr,
    edges: Option<[Expr; 2]>,
}

impl CurveValue {
    /// A value without a band.
    pub(crate) fn plain(value: Expr) -> Self {
        Self { value, edges: None }
    }
}

/// The curve of a signal.
pub(crate) type SignalCurve = (Symbol, PanelCurve, CurveValue);

/// The panels so far, and the values of their curves one after the other, each with the edges of its band.
pub(crate) struct PanelBuilder<'a> {
    plant: &'a Plant,
    pub(crate) layout: &'a Layout,
    panels: Vec<Panel>,
    values: Vec<Expr>,
}

impl<'a> PanelBuilder<'a> {
    pub(crate) fn new(plant: &'a Plant, layout: &'a Layout) -> Self {
        Self { plant, layout, panels: Vec::new(), values: Vec::new() }
    }

    pub(crate) fn finish(self) -> (Vec<Panel>, Vec<Expr>) {
        (self.panels, self.values)
    }

    /// Each estimate beside the state with its label; errors on an axis of this scale; residuals; outputs and inputs, each
    /// unit on an axis of its own.
    pub(crate) fn usual(
        &mut self,
        known: impl Fn(&str) -> Label,
        (scale, errors): (Scale, Vec<SignalCurve>),
        residuals: Vec<SignalCurve>,
    ) {
        let (plant, layout) = (self.plant, self.layout);
        let arena = &plant.arena;
        let is_predicted = !layout.standard_errors.is_empty();
        for placed in &layout.estimates[..layout.hat.len()] {
            let state = &placed.estimate.state;
            let (symbol, hat) = (arena.symbol(state), arena.of_symbol(layout.symbols[placed.hat]));
            let edges = is_predicted.then(|| {
                let standard_error = arena.of_symbol(standard_error(arena, state));
                [arena.sub(hat, standard_error), arena.add(hat, standard_error)]
            });
            let curve = PanelCurve::settling(Label::estimate(state), is_predicted);
            let mut curves = vec![(symbol, curve, CurveValue { value: hat, edges })];
            let truth = CurveValue::plain(arena.of_symbol(symbol));
            curves.extend(placed.truth.map(|_| (symbol, PanelCurve::plain(known(state)), truth)));
            self.signals(&Panel::of_estimate(plant, symbol), Scale::Linear, curves);
        }
        for (title, errors) in Panel::of_errors(plant, scale, errors, |(symbol, ..)| *symbol) {
            self.signals(&title, scale, errors);
        }
        let signal = |symbol: Symbol, place: usize| {
            let value = CurveValue::plain(arena.of_symbol(layout.symbols[place]));
            (symbol, PanelCurve::plain(Label::name(&arena.name(symbol))), value)
        };
        let outputs = plant.y.iter().zip(layout.measured()).map(|(output, place)| signal(output.symbol, place));
        let inputs = plant.commanded().zip(layout.u.clone()).map(|(input, place)| signal(input, place));
        self.signals("Residuals of the outputs", Scale::Linear, residuals);
        self.signals("Outputs", Scale::Linear, outputs.collect());
        self.signals("Inputs", Scale::Linear, inputs.collect());
    }

    fn signals(&mut self, title: &str, scale: Scale, curves: Vec<SignalCurve>) {
        for curves in Panel::groups(self.plant, scale, curves, |(symbol, ..)| *symbol) {
            let (curves, values): (Vec<_>, Vec<CurveValue>) =
                curves.into_iter().map(|(symbol, curve, value)| ((symbol, curve), value)).unzip();
            let panel = Panel::of_signals(self.plant, title, scale, curves);
            self.add((title, panel.unit, scale), panel.curves.into_iter().zip(values).collect());
        }
    }

    /// Adds a panel of these curves and of those of baselines.
    pub(crate) fn add(
        &mut self,
        (title, unit, scale): (&str, Option<String>, Scale),
        curves: Vec<(PanelCurve, CurveValue)>,
    ) {
        let mut shown = Vec::new();
        for (curve, CurveValue { value, edges }) in curves {
            shown.push(curve.clone());
            self.values.push(value);
            self.values.extend(edges.into_iter().flatten());
            for (baseline, places) in &self.layout.baselines {
                if let Some(other) = self.through(value, places) {
                    let label = curve.label.clone().remark(baseline);
                    shown.push(PanelCurve { label, has_band: false, ..curve });
                    self.values.push(other);
                }
            }
        }
        self.panels.push(Panel { title: title.to_owned(), unit, scale, curves: shown });
    }

    /// The value with the estimates of a baseline at these places, if the observer's are in it and it has them all.
    fn through(&self, value: Expr, baseline: &Range<usize>) -> Option<Expr> {
        let (arena, Layout { symbols, hat, estimates, .. }) = (&self.plant.arena, self.layout);
        let hats: BTreeSet<Symbol> = symbols[hat.clone()].iter().copied().collect();
        let of_baseline = estimates.iter().filter(|placed| baseline.contains(&placed.hat));
        let others = of_baseline
            .map(|placed| (estimate(arena, &placed.estimate.state), arena.of_symbol(symbols[placed.hat])))
            .collect();
        let replaced = arena.substitute(value, &others);
        (arena.depends_on(value, &hats) && !arena.depends_on(replaced, &hats)).then_some(replaced)
    }
}
