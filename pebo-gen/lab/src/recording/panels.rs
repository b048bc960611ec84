//! The panels of a replay's figure: a panel for each estimate, beside the state where that was measured; errors;
//! residuals where no state was; outputs; inputs. On a linear axis all signals have one unit.

use crate::figure::curve::GrowingCurve;
use crate::figure::label::Label;
use crate::figure::panel::Panel;
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
}

/// The panels, and the sources of their curves.
#[derive(Debug, Default)]
pub(super) struct Panels {
    panels: Vec<Panel>,
    sources: Vec<CurveSource>,
}

impl Panels {
    /// `errors` are the recovered states that were measured.
    pub(super) fn resolve(plant: &Plant, layout: &Layout, errors: &[Symbol], residuals: &Residuals) -> Self {
        let name = |symbol: Symbol| plant.arena.name(symbol);
        let mut panels = Self::default();
        for (place, (state, _)) in layout.hat.clone().zip(&layout.estimated) {
            let title = match plant.units.get(state) {
                Some(_) => "Estimate".to_owned(),
                None => format!("Estimate of {}", name(*state)),
            };
            let mut curves = vec![(*state, Label::estimate(&name(*state)), CurveSource::Table(place))];
            if let Some(measured) = layout.of_state(*state) {
                curves.push((*state, Label::name(&name(*state)).remark("measured"), CurveSource::Table(measured)));
            }
            panels.add(plant, &title, Scale::Linear, curves);
        }
        let numbered = errors.iter().enumerate();
        let curves = numbered.map(|(place, state)| (*state, Label::error(&name(*state)), CurveSource::Error(place)));
        panels.add(plant, "Estimation errors", Scale::Log, curves.collect());
        if errors.is_empty() {
            let numbered = residuals.outputs.iter().enumerate();
            let curves = numbered.map(|(place, (output, _))| {
                let output = plant.y[*output].symbol;
                (output, Label::name(&name(output)), CurveSource::Residual(place))
            });
            panels.add(plant, "Residuals of the outputs", Scale::Linear, curves.collect());
        }
        let signals = |symbols: Vec<Symbol>, places: std::ops::Range<usize>| {
            let both = symbols.into_iter().zip(places);
            both.map(|(symbol, place)| (symbol, Label::name(&name(symbol)), CurveSource::Table(place))).collect()
        };
        let outputs = plant.y.iter().map(|output| output.symbol).collect();
        panels.add(plant, "Outputs", Scale::Linear, signals(outputs, layout.y.clone()));
        panels.add(plant, "Inputs", Scale::Linear, signals(plant.commanded().collect(), layout.u.clone()));
        panels
    }

    fn add(&mut self, plant: &Plant, title: &str, scale: Scale, curves: Vec<(Symbol, Label, CurveSource)>) {
        for curves in Panel::groups(plant, scale, curves, |(symbol, ..)| *symbol) {
            let (labels, sources): (Vec<_>, Vec<CurveSource>) =
                curves.into_iter().map(|(symbol, label, from)| ((symbol, label), from)).unzip();
            self.panels.push(Panel::of_signals(plant, title, scale, labels));
            self.sources.extend(sources);
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
            };
            curve.add((t, value));
        }
    }

    /// The points of each panel's curves.
    pub(super) fn finish(self) -> Vec<Vec<Vec<(f64, f64)>>> {
        let mut curves = self.curves.into_iter().map(GrowingCurve::finish);
        let panels = self.panels.panels.iter();
        panels.map(|panel| curves.by_ref().take(panel.curves.len()).collect()).collect()
    }
}
