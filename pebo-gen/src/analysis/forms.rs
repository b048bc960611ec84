//! Which form a relation between the components of the transform takes.
//!
//! In: the regression and its identifiability as they were proved of the plant's equations as they stand. Out: the same,
//! or those of a relation under the derivative, where these are to be preferred or the model asks for them.

use crate::cas::domain::Domain;
use crate::plant::{Plant, RelationForm};
use crate::source::Diagnostic;

use crate::analysis::design::{
    Alternative, Cascade, Claim, Class, Excitation, Identifiability, LeftInverse, Regression, RegressionKind, Verdict,
};
use crate::analysis::{identifiability, permitted, regression};

/// The two claims in the form to be preferred. Of the diagnostics, those from `before` on are of these claims.
pub(super) fn preferred(
    plant: &Plant,
    domain: &Domain,
    (class, cascade, inverse): (Class, &Cascade, Option<&LeftInverse>),
    (mut given, seen): (Claim<Regression>, Claim<Identifiability>),
    found: &mut Vec<Diagnostic>,
    before: usize,
) -> (Claim<Regression>, Claim<Identifiability>) {
    let is_static = given.result.as_ref().is_none_or(|result| result.kind == RegressionKind::Static);
    if plant.arena.budget().is_exhausted() || !is_static {
        return (given, seen);
    }
    let Some(mut other) = regression::differentiated(plant, domain, cascade, inverse, &given) else {
        return if plant.relation_form == Some(RelationForm::Differentiated) {
            refused(plant, found)
        } else {
            (given, seen)
        };
    };
    let unknowns = |claim: &Claim<Regression>| claim.result.as_ref().map(|result| result.eta.len());
    let (of_given, of_other) = (unknowns(&given), unknowns(&other));
    let offer = |claim: &mut Claim<Regression>, form, unknowns: Option<usize>| {
        if let (Some(result), Some(unknowns)) = (&mut claim.result, unknowns) {
            result.alternative = Some(Alternative { form, unknowns });
        }
    };
    // An author's own identity is used as it is written.
    let wanted = match plant.relation_form {
        Some(form) => form == RelationForm::Differentiated,
        None => plant.identities.is_empty() || given.verdict != Verdict::Proved,
    };
    if wanted {
        let mut said = Vec::new();
        offer(&mut other, RelationForm::Static, of_given);
        let other = permitted::regression(plant, class, other, &mut said);
        let shown = other
            .result
            .as_ref()
            .filter(|_| other.verdict == Verdict::Proved)
            .map(|result| identifiability::prove(plant, domain, cascade, result, inverse, &mut said));
        let asked = plant.relation_form.is_some();
        match shown {
            Some(shown) if shown.verdict == Verdict::Proved && (asked || !at_once(&seen) || at_once(&shown)) => {
                found.truncate(before);
                found.extend(said);
                return (other, shown);
            }
            _ if asked => return refused(plant, found),
            _ => {}
        }
    } else {
        offer(&mut given, RelationForm::Differentiated, of_other);
    }
    (given, seen)
}

/// Whether one moment shows all unknowns.
pub(super) fn at_once(claim: &Claim<Identifiability>) -> bool {
    claim.verdict == Verdict::Proved && claim.result.as_ref().is_some_and(|result| result.kind == Excitation::Instant)
}

/// The claims where a form is asked for that there is not.
fn refused(plant: &Plant, found: &mut Vec<Diagnostic>) -> (Claim<Regression>, Claim<Identifiability>) {
    found.push(regression::not_differentiable(plant));
    (Claim { verdict: Verdict::Undecided, result: None }, Claim::skipped())
}
