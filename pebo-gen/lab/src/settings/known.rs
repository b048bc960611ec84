//! The known start of the plant: where it puts the extension, and the settings that would lose it.

use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::{Parameter, Plant};
use pebo_design::source::{Code, Diagnostic, Span};
use std::collections::BTreeMap;

use super::point::Point;

/// The components of the extension that the known start fixes, with their values.
pub(super) fn components(plant: &Plant, point: &Point<'_>) -> Vec<(usize, Rational)> {
    let arena = &plant.arena;
    let given = plant.parameters.iter().filter_map(|p| Some((p.symbol, arena.number(p.value.clone()?))));
    let given: BTreeMap<Symbol, Expr> = given.collect();
    let number = |value: Expr| {
        let exact = arena.as_number(arena.substitute(value, &given));
        exact.or_else(|| Rational::from_f64_exact(point.value(value)?))
    };
    plant.known_components().into_iter().filter_map(|(component, value)| Some((component, number(value)?))).collect()
}

/// The refusal of a setting under which the known start would be lost: of an extension with another start, of a start
/// anew at a time when the states are not known, or of an estimator that waits for all unknowns to be excited.
pub(super) fn refused(model: &Model, plant: &Plant, derivation: &Derivation) -> Option<Diagnostic> {
    let observer = &model.observer;
    let by_start = derivation.identifiability.result.as_ref().is_some_and(|result| !result.by_start.is_empty());
    let refuse = |(key, span): (&str, Span), note: &str, help: String| {
        let message = format!("`{key}` does not go with a start that `known` fixes");
        Some(Diagnostic::error(Code::SettingConflict, span, message).note(note).help(help))
    };
    let known: Vec<Expr> = plant.known.iter().map(|(_, value)| value.expr).collect();
    let used = plant.arena.symbols_of(&known);
    let is_open = |parameter: &&Parameter| parameter.value.is_none() && used.contains(&parameter.symbol);
    if let Some((open, (_, value))) = plant.parameters.iter().find(is_open).zip(plant.known.first()) {
        let name = plant.arena.name(open.symbol);
        let message = format!("where the observer starts depends on `{name}`, which has no value");
        let diagnostic = Diagnostic::error(Code::SimulationIncomplete, value.span, message);
        return Some(diagnostic.help(format!("write the value of the parameter: `{name}: 1`")));
    }
    if let Some(first) = observer.extension.first().filter(|_| !plant.known_components().is_empty()) {
        let note = "the extension starts at phi of the known states, so that theta is zero there";
        return refuse(("extension", first.span), note, "remove `extension`".to_owned());
    }
    if let Some(gap) = observer.gap.as_ref().filter(|_| by_start) {
        let note = "after a gap the observer begins anew, where the plant does not start";
        return refuse(("gap", gap.span), note, "remove `gap`, or measure another output".to_owned());
    }
    let written = observer.estimator.as_ref().map(|estimator| (estimator.value.name(), estimator.span));
    let estimator = written.filter(|(name, _)| by_start && name.contains("drem"))?;
    let note = "it waits for all unknowns to be excited, and no output shows those that the start fixes";
    refuse(
        ("estimator", estimator.1),
        note,
        format!("write `least-squares` or `gradient` in place of `{}`", estimator.0),
    )
}
