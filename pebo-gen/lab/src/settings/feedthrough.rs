//! Finds the outputs that hold an input at once and drive the observer.
//!
//! In: the equations of the regression and the cascade. Out: for each row the output that it gives by its value with an
//! input in it, if the rates of the observer need that output: its sample is of the instant before a held input jumps, and
//! the next interval begins after it.

use pebo_cas::Rational;
use pebo_design::analysis::{Derivation, Regression};
use pebo_design::plant::Plant;
use pebo_design::plant::settings::Late;

use super::equations::Equations;
use super::kind::ObserverKind;

/// The outputs of the rows of an observer of this kind; none where no output is of this sort.
pub(super) fn feedthrough(
    plant: &Plant,
    derivation: &Derivation,
    (regression, kind): (&Regression, ObserverKind),
    late: Option<&Late<Rational>>,
) -> Option<Vec<Option<usize>>> {
    if kind == ObserverKind::Filtered || plant.u.is_empty() {
        return None;
    }
    let equations = Equations::of(plant, regression, kind);
    let delays = late.map_or_else(|| vec![Rational::from(0); plant.y.len()], |late| late.delays.clone());
    let given = equations.with_inputs(plant, &equations.rows(plant, &delays));
    let drives = |output: &usize| equations.drive(plant, derivation, plant.y[*output].symbol);
    let found: Vec<Option<usize>> = given.into_iter().map(|output| output.filter(drives)).collect();
    found.iter().any(Option::is_some).then_some(found)
}
