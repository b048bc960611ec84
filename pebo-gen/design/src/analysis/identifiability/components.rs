//! Identifiability where the identities hold in several ways: component by component.
//!
//! In: the decision on a domain whose equations are no products. Out: the decision on all components, where it is the
//! same on each: `(a^2 + b^2)*(a^2 + b^2 - 1) = 0` is a circle and the origin, and a plant remains on one of them.

use crate::plant::Plant;
use crate::source::Diagnostic;
use pebo_cas::Domain;
use pebo_cas::tower::Obstacle;

use super::divided::Formulas;
use crate::analysis::design::{Claim, Excitation, Identifiability, Verdict};

/// The common decision; none where the components are not found, or differ.
pub(super) fn on_components(
    plant: &Plant,
    domain: &Domain,
    formulas: &Formulas,
    decide: impl Fn(&Domain, &mut Vec<Diagnostic>) -> Result<Claim<Identifiability>, Obstacle>,
) -> Option<Claim<Identifiability>> {
    let components = domain.components(&plant.arena, &[], &formulas.identities, &plant.elimination_order()).ok()?;
    let mut claims = components.iter().map(|there| decide(&there.domain, &mut Vec::new()).ok());
    let mut common = claims.next()??;
    for claim in claims {
        join(plant, &mut common, claim?)?;
    }
    let is_identified = common.result.as_ref().is_some_and(|result| result.kind != Excitation::Never);
    (common.verdict == Verdict::Proved && is_identified).then_some(common)
}

/// Adds the conditions of another component; none if its decision is another.
fn join(plant: &Plant, common: &mut Claim<Identifiability>, other: Claim<Identifiability>) -> Option<()> {
    let (own, other) = (common.result.as_mut().filter(|_| common.verdict == other.verdict)?, other.result?);
    let statements = |result: &Identifiability| {
        let trajectories = result.trajectories.as_ref();
        trajectories.map(|trajectories| {
            let blind = trajectories.blind.iter();
            let blind: Vec<_> = blind.map(|blind| (blind.condition(plant), blind.identifiable.clone())).collect();
            (trajectories.by_itself, trajectories.parameters, blind)
        })
    };
    if own.kind != other.kind || own.positive != other.positive || statements(own) != statements(&other) {
        return None;
    }
    let is_new = |condition: &String| !own.singular_where.contains(condition);
    let conditions: Vec<String> = other.singular_where.into_iter().filter(is_new).collect();
    own.singular_where.extend(conditions);
    let constants: Vec<_> = other.constants.into_iter().filter(|constant| !own.constants.contains(constant)).collect();
    own.constants.extend(constants);
    own.everywhere_else &= other.everywhere_else;
    // Its determinant on one component says nothing of the others.
    own.gram = None;
    Some(())
}
