//! Identifiability where the identities hold in several ways: component by component.
//!
//! In: the decision on a domain whose equations are no products. Out: the decision on all components, where it is the
//! same on each: `(a^2 + b^2)*(a^2 + b^2 - 1) = 0` is a circle and the origin, and a plant remains on one of them.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::Expr;

use super::divided::Formulas;
use super::problem::ObservabilityProblem;
use super::regimes;
use crate::analysis::design::{Claim, Excitation, Identifiability, InputCourses, Verdict};

/// The common decision; none where the components are not found, or differ.
pub(super) fn on_components(problem: &ObservabilityProblem<'_>, formulas: &Formulas) -> Option<Claim<Identifiability>> {
    let plant = problem.plant;
    let components =
        problem.domain.components(&plant.arena, &[], &formulas.identities, &plant.elimination_order()).ok()?;
    let equations: Vec<Vec<Expr>> =
        components.iter().map(|there| there.domain.manifold.reduced(&plant.arena)).collect();
    let mut claims = Vec::new();
    for there in &components {
        claims.push(regimes::decide(&problem.on(&there.domain), formulas, &mut Vec::new()).ok()?);
    }
    let singular = |claim: &Claim<Identifiability>| claim.result.as_ref().map(|result| result.singular_where.clone());
    if claims.iter().any(|claim| singular(claim) != singular(&claims[0])) {
        for (claim, own) in claims.iter_mut().zip(&equations) {
            let is_own = |equation: &&Expr| !equations.iter().all(|others| others.contains(*equation));
            let own: Vec<Expr> = own.iter().filter(is_own).copied().collect();
            claim.result.iter_mut().for_each(|result| within(plant, &own, &mut result.singular_where));
        }
    }
    let mut claims = claims.into_iter();
    let mut common = claims.next()?;
    for claim in claims {
        join(plant, &mut common, claim)?;
    }
    let is_identified = common.result.as_ref().is_some_and(|result| result.kind != Excitation::Never);
    (common.verdict == Verdict::Proved && is_identified).then_some(common)
}

/// Makes conditions on signals those on the component with these equations.
fn within(plant: &Plant, equations: &[Expr], conditions: &mut [String]) {
    for condition in conditions {
        let own = equations.iter().map(|equation| format!("{} = 0", plant.arena.print(*equation)));
        let all: BTreeSet<String> = own.chain([condition.clone()]).collect();
        *condition = all.into_iter().collect::<Vec<_>>().join(" and ");
    }
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
    if let (Some(trajectories), Some(others)) = (&mut own.trajectories, &other.trajectories) {
        trajectories.everywhere &= others.everywhere;
        if others.courses == InputCourses::Constant {
            trajectories.courses = InputCourses::Constant;
        }
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
