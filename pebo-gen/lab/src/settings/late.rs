//! Finds what stands in for outputs that arrive late.
//!
//! In: the delays of the section `observer` and the equations of the regression. Out: the rows that wait for each output,
//! and the outputs that the observer expects until their samples arrive. One that nothing but its own equations needs is
//! waited for alone.

use std::collections::BTreeSet;

use pebo_cas::{Rational, Symbol};
use pebo_design::analysis::{Derivation, Regression};
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::plant::settings::Late;
use pebo_design::source::{Code, Diagnostic, Diagnostics};

use super::equations::{Equations, SampleRows};
use super::kind::ObserverKind;

/// The most samples on their way: each is some hundred bytes in a run. Of more the newest are joined.
const MOST_INSTANTS: u16 = 1024;

/// The samples on their way where the period is not known.
const ASSUMED_INSTANTS: u16 = 64;

/// The late outputs of an observer of this kind with these equations; none where no output is late. Where one cannot be
/// late, that is reported.
pub(super) fn late(
    (model, plant): (&Model, &Plant),
    (derivation, regression): (&Derivation, &Regression),
    (kind, period): (ObserverKind, Option<f64>),
    problems: &mut Diagnostics,
) -> Result<Option<Late<Rational>>, ()> {
    let arena = &plant.arena;
    let mut delays = Vec::new();
    for output in &plant.y {
        let written = model.observer.delay.of(&arena.name(output.symbol));
        delays.push(match written {
            Some(delay) => Rational::from_decimal(delay.value.text()).map_err(|_| ())?,
            None => Rational::from(0),
        });
    }
    let longest = delays.iter().map(Rational::to_f64).fold(0.0, f64::max);
    if longest <= 0.0 {
        return Ok(None);
    }
    let equations = Equations::of(plant, regression, kind);
    let SampleRows { rows, is_expected } = equations.rows(plant, &delays);
    for (output, measured) in plant.y.iter().enumerate().filter(|(output, _)| !delays[*output].is_zero()) {
        let name = arena.name(measured.symbol);
        let lacking = if kind == ObserverKind::Filtered {
            "the filter of this observer takes every sample for one of the moment".to_owned()
        } else if !is_expected[output] && is_needed(plant, derivation, &equations, measured.symbol) {
            format!("the observer needs it at every instant, and no equation of the form `{name} = ..` says what it is")
        } else {
            continue;
        };
        let span = model.observer.delay.of(&name).map_or(model.name.span, |delay| delay.span);
        let message = format!("`{name}` cannot be late: {lacking}");
        problems.push(Diagnostic::error(Code::SettingConflict, span, message).help(format!(
            "remove the delay of `{name}`, and give the observer its inputs and other outputs as late: the estimate is then \
             as old"
        )));
        return Err(());
    }
    // The instants of now and of the delay, and one for a part of a period.
    let wanted = period.map_or(f64::from(ASSUMED_INSTANTS), |period| (longest / period).ceil() + 2.0);
    let instants = (3..MOST_INSTANTS).find(|count| f64::from(*count) >= wanted).unwrap_or(MOST_INSTANTS);
    Ok(Some(Late { delays, rows, is_expected, instants: instants.into() }))
}

/// True if the observer computes with an output besides its own equations.
fn is_needed(plant: &Plant, derivation: &Derivation, equations: &Equations, output: Symbol) -> bool {
    let own = BTreeSet::from([output]);
    let mut inverse = derivation.left_inverse.result.iter().flat_map(|inverse| &inverse.x);
    equations.drive(plant, derivation, output) || inverse.any(|(_, state)| plant.arena.depends_on(*state, &own))
}
