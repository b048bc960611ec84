//! The panels of a replay's figure: a panel for each estimate, beside the state where that was measured; errors;
//! residuals where no state was; outputs; inputs. On a linear axis all signals have one unit.

use crate::closed_loop::scenario::ScoredEstimate;
use crate::figure::curve::{DrawnCurve, GrowingCurve, drawn};
use crate::figure::label::Label;
use crate::figure::panel::{Panel, PanelCurve};
use pebo_cas::Symbol;
use pebo_design::model::Scale;
use pebo_design::plant::Plant;

use super::layout::Layout;
use super::residual::Residuals;

/// The source of a curve's values.
#[derive(Clone, Copy, Debug)]
enum CurveSource {
    /// At this position of the table.
    Table(usize),
    /// The error with this index.
    Error(usize),
    /// The residual with this index.
    Residual(usize),
    /// The edge of the band about an estimate: its position, that of its standard error, and the side.
    Edge(usize, usize, f64),
}

/// The panels, and the sources of their curves.
#[derive(Debug, Default)]
pub(super) struct Panels {
    panels: Vec<Panel>,
    sources: Vec<CurveSource>,
}

impl Panels {
    /// `errors` are the estimates that are compared with measured states.
    pub(super) fn resolve(plant: &Plant, layout: &Layout, errors: &[ScoredEstimate], residuals: &Residuals) -> Self {
        let name = |symbol: Symbol| plant.arena.name(symbol);
        let mut panels = Self::default();
        for (place, (state, _)) in layout.hat.clone().zip(&layout.estimated) {
            let standard_error = (place - layout.hat.start) + layout.standard_errors.start;
            let has_band = layout.standard_errors.contains(&standard_error);
            let edges = [-1.0, 1.0].map(|side| CurveSource::Edge(place, standard_error, side));
            let sources = std::iter::once(CurveSource::Table(place)).chain(edges.into_iter().filter(|_| has_band));
            let estimate = PanelCurve::settling(Label::estimate(&name(*state)), has_band);
            let mut curves = vec![(*state, estimate, sources.collect())];
            for (baseline, place) in layout.baselines_of(*state) {
                let label = Label::estimate(&name(*state)).remark(baseline);
                curves.push((*state, PanelCurve::settling(label, false), vec![CurveSource::Table(place)]));
            }
            if let Some(measured) = layout.of_state(*state) {
                let label = Label::name(&name(*state)).remark("measured");
                curves.push((*state, PanelCurve::plain(label), vec![CurveSource::Table(measured)]));
            }
            panels.add(plant, &Panel::of_estimate(plant, *state), Scale::Linear, curves);
        }
        // A recording has noise.
        let numbered = errors.iter().enumerate();
        let curves = numbered.map(|(place, ScoredEstimate { estimate, truth, .. })| {
            let label = Label::error(&estimate.state);
            let label = estimate.baseline.iter().fold(label, |label, baseline| label.remark(baseline));
            (layout.symbols[*truth], PanelCurve::settling(label, false), vec![CurveSource::Error(place)])
        });
        for (title, curves) in Panel::of_errors(plant, Scale::Linear, curves.collect(), |(symbol, ..)| *symbol) {
            panels.add(plant, &title, Scale::Linear, curves);
        }
        if errors.is_empty() {
            let numbered = residuals.outputs.iter().enumerate();
            let curves = numbered.map(|(place, (output, _))| {
                let output = plant.y[*output].symbol;
                (output, PanelCurve::settling(Label::name(&name(output)), false), vec![CurveSource::Residual(place)])
            });
            panels.add(plant, "Residuals of the outputs", Scale::Linear, curves.collect());
        }
        let signals = |symbols: Vec<Symbol>, places: std::ops::Range<usize>| {
            let both = symbols.into_iter().zip(places);
            let curve = |symbol| PanelCurve::plain(Label::name(&name(symbol)));
            both.map(|(symbol, place)| (symbol, curve(symbol), vec![CurveSource::Table(place)])).collect()
        };
        let outputs = plant.y.iter().map(|output| output.symbol).collect();
        panels.add(plant, "Outputs", Scale::Linear, signals(outputs, layout.y.clone()));
        panels.add(plant, "Inputs", Scale::Linear, signals(plant.commanded().collect(), layout.u.clone()));
        panels
    }

    fn add(&mut self, plant: &Plant, title: &str, scale: Scale, curves: Vec<(Symbol, PanelCurve, Vec<CurveSource>)>) {
        for curves in Panel::groups(plant, scale, curves, |(symbol, ..)| *symbol) {
            let (curves, sources): (Vec<_>, Vec<Vec<CurveSource>>) =
                curves.into_iter().map(|(symbol, curve, from)| ((symbol, curve), from)).unzip();
            self.panels.push(Panel::of_signals(plant, title, scale, curves));
            self.sources.extend(sources.into_iter().flatten());
        }
    }

    pub(super) fn panels(&self) -> &[Panel] {
        &self.panels
    }

    /// The curves before the first row.
    pub(super) fn start(&self) -> Curves<'_> {
        Curves { panels: self, curves: vec![GrowingCurve::default(); self.sources.len()] }
    }
}

/// The curves so far.
#[derive(Debug)]
pub(super) struct Curves<'a> {
    panels: &'a Panels,
    curves: Vec<GrowingCurve>,
}

impl Curves<'_> {
    /// Adds a row.
    pub(super) fn add(&mut self, t: f64, table: &[f64], errors: &[f64], residuals: &[f64]) {
        for (curve, source) in self.curves.iter_mut().zip(&self.panels.sources) {
            let value = match *source {
                CurveSource::Table(place) => table[place],
                CurveSource::Error(place) => errors[place],
                CurveSource::Residual(place) => residuals[place],
                CurveSource::Edge(estimate, error, side) => table[estimate] + side * table[error],
            };
            curve.add((t, value));
        }
    }

    /// Interrupts all curves at an instant.
    pub(super) fn interrupt(&mut self, t: f64) {
        self.curves.iter_mut().for_each(|curve| curve.add((t, f64::NAN)));
    }

    /// Each panel's curves.
    pub(super) fn finish(self) -> Vec<Vec<DrawnCurve>> {
        drawn(&self.panels.panels, self.curves.into_iter().map(GrowingCurve::finish))
    }
}
