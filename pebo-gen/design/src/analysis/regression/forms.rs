//! The form of a relation between the components of the transform: as it holds at every instant, or under the
//! derivative.

use super::build;
use super::pool::Pool;
use super::selection::is_long;
use super::trial::Trial;
use crate::analysis::design::Alternative;
use crate::plant::RelationForm;

/// The trial in the preferable form of its relation, with the other one where there is one. An author's own identity is
/// used as it is written.
pub(super) fn preferred(pool: &Pool<'_>, mut given: Trial) -> Trial {
    let plant = pool.premises.plant;
    let unknowns = given.regression.eta.len();
    if plant.wants(RelationForm::Differentiated) {
        let other = build::regression(&pool.premises, pool.of_states(), &mut Vec::new());
        let offer = |unknowns| Alternative { form: RelationForm::Static, unknowns };
        given.regression.alternative = other.ok().map(|other| offer(other.eta.len()));
        return given;
    }
    if !is_long(plant, &given) {
        return given;
    }
    let equations = pool.differentiated();
    if equations.is_empty() {
        return given;
    }
    if plant.relation_form.is_some() || !plant.identities.is_empty() {
        let offer = Alternative { form: RelationForm::Differentiated, unknowns: plant.theta.len() };
        given.regression.alternative = Some(offer);
        return given;
    }
    let wanted = |other: &Trial| other.is_identified() && (!given.is_at_once() || other.is_at_once());
    let Some(mut other) = Trial::of(&pool.premises, equations).ok().filter(wanted) else { return given };
    other.regression.alternative = Some(Alternative { form: RelationForm::Static, unknowns });
    other
}

/// Tests whether a trial is of the form that the model chooses.
pub(super) fn is_chosen(pool: &Pool<'_>, trial: &Trial) -> bool {
    match pool.premises.plant.relation_form {
        None => true,
        Some((RelationForm::Static, _)) => trial.equations.iter().any(|equation| equation.is_instant(&pool.premises)),
        Some((RelationForm::Differentiated, _)) => trial.is_identified(),
    }
}
