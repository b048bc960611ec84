//! Chooses the start of the extension by default.
//!
//! In: the left inverse, and the plant's start as far as it is known. Out: numbers for z where the left inverse has a
//! value: zeros if it has one there, else phi of a state that the assumptions admit. A flux of 0 has no position, and
//! neither has a quotient by a zero component of phi.

use pebo_cas::{Expr, Rational, Relation, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;

use super::digits::rounded;
use super::known;
use super::point::Point;
use super::shown::Shown;

/// Shares of the plant's start to try for the extension, in this order: the start itself last, as the observer is to
/// find it.
const SHARES: [f64; 4] = [0.5, 2.0, 0.9, 1.0];

/// The most states whose signs are all tried at a distance of 1 from zero.
const MOST_SIGNS: usize = 6;

/// The number for an unknown signal or parameter.
const ANY: f64 = 1.0;

/// The default extension at the start; none where no point was found at which the left inverse has a value.
pub(crate) fn start(model: &Model, plant: &Plant, derivation: &Derivation, shown: &Shown) -> Option<Vec<Rational>> {
    beginning(&Point::of(model, plant, shown), plant, derivation)
}

/// The same for a plant that starts at a point, with the components that the known start of the plant fixes.
pub(super) fn beginning(point: &Point, plant: &Plant, derivation: &Derivation) -> Option<Vec<Rational>> {
    let fixed = known::components(plant, point);
    let zeros = || (!fixed.is_empty()).then(|| vec![Rational::from(0); plant.phi.len()]);
    let mut begun = near(point, plant, derivation).or_else(zeros)?;
    for (component, value) in fixed {
        begun[component] = value;
    }
    Some(begun)
}

fn near(known: &Point, plant: &Plant, derivation: &Derivation) -> Option<Vec<Rational>> {
    let inverse = derivation.left_inverse.result.as_ref()?;
    let mut left: Vec<Expr> = inverse.x.iter().map(|(_, formula)| *formula).collect();
    let local = derivation.regression.result.as_ref().filter(|regression| regression.is_at_estimate());
    if let Some(regression) = local {
        let z: Vec<Expr> = plant.z.iter().map(|z| plant.arena.of_symbol(*z)).collect();
        let there = regression.with_extension(plant, &z);
        left.extend(there.phi_0.iter().chain(there.phi_1.iter().flatten()));
    }
    let phi: Vec<Expr> = plant.phi.iter().map(|phi| phi.expr).collect();
    let x: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    let unknown = x.iter().copied().collect();
    let others = plant.y.iter().map(|output| output.symbol).chain(plant.u.iter().copied()).chain(plant.w.clone());
    let others = others.chain(plant.parameters.iter().map(|parameter| parameter.symbol));
    let psi: Vec<f64> = (0..phi.len().pow(2)).map(|k| f64::from(k / phi.len() == k % phi.len())).collect();
    let missing: Vec<Symbol> = others.filter(|symbol| known.of_symbol(*symbol).is_none()).collect();
    let around = known.with(&missing, &vec![ANY; missing.len()]).with(&plant.psi.concat(), &psi);
    let has_value = |z: &[f64]| {
        let values = around.with(&plant.z, z).values(&left);
        values.is_some_and(|values| values.iter().all(|value| value.is_finite()))
    };
    let zeros = vec![0.0; phi.len()];
    // A local regression converges from a neighbourhood: zero is far away as a rule.
    if local.is_none() && has_value(&zeros) {
        return exact(&zeros);
    }
    let of_state = |state: &[f64]| around.with(&x, state).values(&phi).filter(|z| has_value(z)).and_then(|z| exact(&z));
    let is_admitted = |state: &[f64]| {
        let at = around.with(&x, state);
        let about_states = plant.assumptions.iter().filter(|known| plant.arena.depends_on(known.expr, &unknown));
        about_states.into_iter().all(|assumption| match (at.value(assumption.expr), assumption.relation) {
            (Some(value), Relation::Positive) => value > 0.0,
            (Some(value), Relation::NonNegative) => value >= 0.0,
            (Some(value), Relation::NonZero) => value != 0.0,
            (None, _) => true,
        })
    };
    let origin = if local.is_none() { of_state(&vec![0.0; x.len()]) } else { None };
    let known: Option<Vec<f64>> = x.iter().map(|state| known.of_symbol(*state)).collect();
    let near = known.into_iter().flat_map(|state| SHARES.map(|part| state.iter().map(|value| part * value).collect()));
    let signs = (0..1_usize << x.len().min(MOST_SIGNS)).map(|signs| -> Vec<f64> {
        (0..x.len()).map(|place| if signs >> place.min(MOST_SIGNS) & 1 == 1 { -1.0 } else { 1.0 }).collect()
    });
    origin.or_else(|| near.chain(signs).filter(|state| is_admitted(state)).find_map(|state| of_state(&state)))
}

fn exact(z: &[f64]) -> Option<Vec<Rational>> {
    z.iter().map(|value| rounded(*value)).collect()
}
