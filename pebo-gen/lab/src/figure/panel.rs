//! A panel of the figure: its title, unit, scale and labels.

use pebo_cas::Symbol;
use pebo_design::model::Scale;
use pebo_design::plant::Plant;

use super::label::Label;
use super::unit;

/// A panel of the figure.
#[derive(Debug)]
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) unit: Option<String>,
    pub(crate) scale: Scale,
    pub(crate) curves: Vec<PanelCurve>,
}

/// A curve of a panel.
#[derive(Clone, Debug)]
pub(crate) struct PanelCurve {
    pub(crate) label: Label,
    /// True if it comes from a start that says nothing of its size: an estimate, or its error.
    pub(crate) settles: bool,
    /// True if there is a band about it.
    pub(crate) has_band: bool,
}

impl PanelCurve {
    /// The curve of a signal.
    pub(crate) fn plain(label: Label) -> Self {
        Self { label, settles: false, has_band: false }
    }

    /// The curve of an estimate, with or without the band of its standard error, or of an error.
    pub(crate) fn settling(label: Label, has_band: bool) -> Self {
        Self { label, settles: true, has_band }
    }
}

impl Panel {
    /// Groups signals that share an axis: on a linear one, those of one unit. A flow in cubic metres per second is flat
    /// at zero beside a temperature in kelvin.
    pub(crate) fn groups<C>(plant: &Plant, scale: Scale, curves: Vec<C>, symbol: impl Fn(&C) -> Symbol) -> Vec<Vec<C>> {
        let mut groups: Vec<(Option<&String>, Vec<C>)> = Vec::new();
        for curve in curves {
            let unit = Some(symbol(&curve)).filter(|_| scale == Scale::Linear).and_then(|s| plant.units.get(&s));
            match groups.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, group)) => group.push(curve),
                None => groups.push((unit, vec![curve])),
            }
        }
        groups.into_iter().map(|(_, group)| group).collect()
    }

    /// The title of the panel of a state's estimate: where the state has no unit, its name.
    pub(crate) fn of_estimate(plant: &Plant, state: Symbol) -> String {
        match plant.units.get(&state) {
            Some(_) => "Estimate".to_owned(),
            None => format!("Estimate of {}", plant.arena.name(state)),
        }
    }

    /// The errors that share a panel, with its title: on a linear axis, one without a unit stands by itself.
    pub(crate) fn of_errors<C>(
        plant: &Plant,
        scale: Scale,
        errors: Vec<C>,
        symbol: impl Fn(&C) -> Symbol,
    ) -> Vec<(String, Vec<C>)> {
        let is_alone = |error: &C| scale == Scale::Linear && !plant.units.contains_key(&symbol(error));
        let (alone, together): (Vec<C>, Vec<C>) = errors.into_iter().partition(is_alone);
        let title = "Estimation errors".to_owned();
        let together = Some((title, together)).filter(|(_, errors)| !errors.is_empty());
        let alone =
            alone.into_iter().map(|error| (format!("Error of {}", plant.arena.name(symbol(&error))), vec![error]));
        together.into_iter().chain(alone).collect()
    }

    /// A panel of signals: a common unit goes to the axis, else each goes beside its curve.
    pub(crate) fn of_signals(plant: &Plant, title: &str, scale: Scale, curves: Vec<(Symbol, PanelCurve)>) -> Self {
        let unit_of = |symbol: &Symbol| plant.units.get(symbol).map(String::as_str);
        let unit = unit::same(curves.iter().map(|curve| unit_of(&curve.0))).map(str::to_owned);
        let labelled = |(symbol, curve): (Symbol, PanelCurve)| match unit_of(&symbol).filter(|_| unit.is_none()) {
            Some(unit) => PanelCurve { label: curve.label.in_unit(unit), ..curve },
            None => curve,
        };
        let curves = curves.into_iter().map(labelled).collect();
        Self { title: title.to_owned(), unit, scale, curves }
    }
}
