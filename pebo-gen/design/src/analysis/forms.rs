//! The form of a relation between the components of the transform.
//!
//! In: the regression and its identifiability, proved of the plant's equations as given. Out: the same, or those of a
//! relation under the derivative where these are preferable; in any case a regression of the form that the model
//! chooses, or a refusal.

use crate::plant::{Plant, RelationForm};
use crate::source::Diagnostic;
use pebo_cas::{Domain, Expr};

use super::design::{
    Alternative, Cascade, Claim, Class, Excitation, Identifiability, LeftInverse, Regression, RegressionKind, Verdict,
};
use super::{identifiability, permitted, regression};

/// The two claims in the preferable form. Of the diagnostics, those from `before` on are of these claims.
pub(super) fn preferred(
    plant: &Plant,
    domain: &Domain,
    (class, cascade, inverse): (Class, &Cascade, Option<&LeftInverse>),
    (mut given, identifiability): (Claim<Regression>, Claim<Identifiability>),
    found: &mut Vec<Diagnostic>,
    before: usize,
) -> (Claim<Regression>, Claim<Identifiability>) {
    let is_static = given.result.as_ref().is_none_or(|result| result.kind == RegressionKind::Static);
    let is_wanted = plant.wants(RelationForm::Differentiated);
    if plant.arena.budget().is_exhausted() || !(is_static || is_wanted) {
        return (given, identifiability);
    }
    let Some(mut other) = regression::differentiated(plant, domain, cascade, inverse, &given) else {
        return if is_wanted { refused(plant, found) } else { (given, identifiability) };
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
        Some(_) => is_wanted,
        None => plant.identities.is_empty() || given.verdict != Verdict::Proved,
    };
    if wanted {
        let mut said = Vec::new();
        offer(&mut other, RelationForm::Static, of_given.filter(|_| is_static));
        match proved(plant, domain, (class, cascade, inverse), other, &mut said) {
            Some((other, identified)) if is_wanted || !at_once(&identifiability) || at_once(&identified) => {
                found.truncate(before);
                found.extend(said);
                return (other, identified);
            }
            _ if is_wanted => return refused(plant, found),
            _ => {}
        }
    } else {
        offer(&mut given, RelationForm::Differentiated, of_other);
    }
    (given, identifiability)
}

/// Tests whether one instant identifies all unknowns.
pub(super) fn at_once(claim: &Claim<Identifiability>) -> bool {
    claim.verdict == Verdict::Proved && claim.result.as_ref().is_some_and(|result| result.kind == Excitation::Instant)
}

/// Tests whether all unknowns are identified without a movement of the inputs.
pub(super) fn by_itself(claim: &Claim<Identifiability>) -> bool {
    let moves_not = |result: &Identifiability| {
        result.kind == Excitation::Instant || result.trajectories.as_ref().is_some_and(|t| t.by_itself == Some(true))
    };
    claim.verdict == Verdict::Proved && claim.result.as_ref().is_some_and(moves_not)
}

/// The two claims with a relation as it holds at every instant, where the model chooses that and the given regression
/// has none. Of the diagnostics, those from `before` on are of these claims.
pub(super) fn static_form(
    plant: &Plant,
    domain: &Domain,
    (class, cascade, inverse): (Class, &Cascade, Option<&LeftInverse>),
    given: (Claim<Regression>, Claim<Identifiability>),
    found: &mut Vec<Diagnostic>,
    before: usize,
) -> (Claim<Regression>, Claim<Identifiability>) {
    let is_static = |regression: &Regression| match regression.kind {
        RegressionKind::Static => true,
        RegressionKind::Dynamic => false,
        RegressionKind::Implicit => {
            let held = regression.primitive_0.iter().zip(&regression.primitive_1);
            let nothing = |expr: &Expr| plant.arena.is_zero(*expr);
            held.into_iter().any(|(known, factor)| nothing(known) && factor.iter().all(nothing))
        }
    };
    if !plant.wants(RelationForm::Static) || given.0.result.as_ref().is_none_or(is_static) {
        return given;
    }
    let mut said = Vec::new();
    let other = regression::from_identities(plant, domain, cascade, inverse, &mut said);
    let Some(both) = proved(plant, domain, (class, cascade, inverse), other, &mut said) else {
        return refused(plant, found);
    };
    found.truncate(before);
    found.extend(said);
    both
}

/// A regression with its identifiability, where both claims are proved, and its diagnostics.
pub(super) fn proved(
    plant: &Plant,
    domain: &Domain,
    (class, cascade, inverse): (Class, &Cascade, Option<&LeftInverse>),
    regression: Claim<Regression>,
    said: &mut Vec<Diagnostic>,
) -> Option<(Claim<Regression>, Claim<Identifiability>)> {
    let regression = permitted::regression(plant, class, regression, said);
    let result = regression.result.as_ref().filter(|_| regression.verdict == Verdict::Proved)?;
    let identified = identifiability::prove(plant, domain, cascade, result, inverse, said);
    (identified.verdict == Verdict::Proved).then_some((regression, identified))
}

/// The claims where the chosen form does not exist.
fn refused(plant: &Plant, found: &mut Vec<Diagnostic>) -> (Claim<Regression>, Claim<Identifiability>) {
    found.extend(plant.relation_form.map(|wanted| regression::no_such_form(plant, wanted)));
    (Claim { verdict: Verdict::Undecided, result: None }, Claim::skipped())
}
