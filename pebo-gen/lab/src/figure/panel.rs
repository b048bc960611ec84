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
    /// The labels of its curves.
    pub(crate) curves: Vec<Label>,
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

    /// A panel of signals: a common unit goes to the axis, else each goes beside its curve.
    pub(crate) fn of_signals(plant: &Plant, title: &str, scale: Scale, curves: Vec<(Symbol, Label)>) -> Self {
        let unit_of = |symbol: &Symbol| plant.units.get(symbol).map(String::as_str);
        let unit = unit::same(curves.iter().map(|curve| unit_of(&curve.0))).map(str::to_owned);
        let labelled = |(symbol, label): (Symbol, Label)| match unit_of(&symbol).filter(|_| unit.is_none()) {
            Some(unit) => label.in_unit(unit),
            None => label,
        };
        let curves = curves.into_iter().map(labelled).collect();
        Self { title: title.to_owned(), unit, scale, curves }
    }
}
