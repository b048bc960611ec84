//! The panels of a run's figure: those that the model file describes, or the usual ones.

use std::collections::BTreeMap;

use pebo_cas::Expr;
use pebo_design::model::Scale;
use pebo_design::plant::lower;
use pebo_design::source::Diagnostics;

use super::scope::{Estimates, Names, Sight, View};
use crate::experiment::panels::{CurveValue, PanelBuilder};
use crate::figure::label::Label;
use crate::figure::panel::PanelCurve;
use crate::figure::unit;

/// Adds the panels of the model file, else the usual ones; `errors` are those of the observer's estimates.
pub(crate) fn add_panels(
    builder: &mut PanelBuilder<'_>,
    names: &Names,
    (hats, errors): (&Estimates, &[Expr]),
    problems: &mut Diagnostics,
) {
    if !names.simulation.panels.is_empty() {
        return written(builder, names, (hats, errors), problems);
    }
    // Without noise errors are on a logarithmic axis, which alone shows how they die out.
    let scale = if names.simulation.noise.is_empty() { Scale::Log } else { Scale::Linear };
    let curve = |((state, _), error): (&(String, Expr), &Expr)| {
        let curve = PanelCurve::settling(Label::error(state), false);
        (names.plant.arena.symbol(state), curve, CurveValue::plain(*error))
    };
    builder.usual(Label::name, (scale, hats.iter().zip(errors).map(curve).collect()), Vec::new());
}

/// The panels of the file; estimate less truth is the error, for an angle the shorter way round.
fn written(
    builder: &mut PanelBuilder<'_>,
    names: &Names,
    (hats, errors): (&Estimates, &[Expr]),
    problems: &mut Diagnostics,
) {
    let arena = &names.plant.arena;
    let differences = hats.iter().map(|(state, hat)| arena.sub(*hat, arena.variable(state)));
    let errors: BTreeMap<Expr, Expr> = differences.zip(errors.iter().copied()).collect();
    let meant = |curve: Expr| errors.get(&curve).copied().unwrap_or(curve);
    let scope = names.scope(&View { sight: Sight::Everything, own: None, hats: hats.clone() });
    for panel in &names.simulation.panels {
        let curves = panel.curves.iter().filter_map(|f| {
            let value = meant(problems.keep(lower(arena, &scope, f))?);
            Some((PanelCurve::plain(Label::formula(f)), CurveValue::plain(value)))
        });
        let curves = curves.collect();
        let known = |name: &str| names.plant.units.get(&arena.symbol(name)).map(String::as_str);
        let unit = match &panel.unit {
            Some(unit) => Some(unit.value.clone()),
            None => unit::same(panel.curves.iter().map(|curve| unit::of(curve, &known))).map(str::to_owned),
        };
        builder.add((&panel.title.value, unit, panel.scale.value), curves);
    }
}
