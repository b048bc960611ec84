//! Static regressions: from identities, or from what the components of the transform have to do with each other.

use std::collections::BTreeMap;

use crate::analysis::design::{Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::analysis::tidy::{shortest, shortest_equal};
use crate::analysis::{relations, separation};
use crate::cas::domain::Domain;
use crate::cas::field::Obstacle;
use crate::cas::{Expr, Symbol};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};

use super::functions::turned_away;
use super::refusal::undecided;

/// A static regression `Phi_0 = Phi_1 eta` from the identities.
pub(in crate::analysis) fn from_identities(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let span = plant.y.first().map_or(Span::point(0), |output| output.span);
    if plant.identities.is_empty() {
        if let Some(claim) = from_relations(plant, domain, left_inverse, found) {
            return claim;
        }
        found.push(
            Diagnostic::error(Code::RegressionNonlinear, span, "there is nothing to estimate the unknowns from")
                .label("no output has a rate under `f_y`, and there are no `identities`")
                .help("give `f_y` for an output, or an expression in x and y that is zero under `identities`"),
        );
        return Claim { verdict: Verdict::Refuted, result: None };
    }
    let Some(left_inverse) = left_inverse else { return Claim { verdict: Verdict::Skipped, result: None } };
    let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
    let identities: Vec<Expr> = plant.identities.iter().map(|i| arena.substitute(i.expr, &inverse)).collect();
    standing_still(plant, domain, left_inverse, (&identities, plant.identities[0].span), found)
}

/// A static regression from what the components of the transform have to do with each other; none if that
/// is nothing, or nothing that theta can be recovered from.
pub(super) fn from_relations(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let relations = relations::among(plant, domain).ok().filter(|relations| !relations.is_empty())?;
    let mut own = Vec::new();
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let claim = standing_still(plant, domain, left_inverse?, (&relations, span), &mut own);
    // A claim that is undecided here is left to what the author can mend: the rates.
    if claim.verdict == Verdict::Undecided && own.iter().any(|d| d.code == Code::RegressionUndecided) {
        return None;
    }
    found.extend(own);
    Some(claim)
}

/// A static regression from expressions in z that vanish.
fn standing_still(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    (in_z, span): (&[Expr], Span),
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    match separation::separate(plant, domain, in_z) {
        Ok(Some(separated)) => {
            let separated = separation::absorb_constants(plant, domain, separated);
            if let Some(recovered) = separation::recover(plant, domain, &separated.eta) {
                if let Some(refusal) = turned_away(plant, domain, left_inverse, &separated.eta, &recovered, found) {
                    return refusal;
                }
                // identity = known + factors eta = 0, so known = -factors eta
                let negated = |row: &Vec<Expr>| row.iter().map(|e| shortest(arena, domain, arena.neg(*e))).collect();
                let result = Regression {
                    kind: RegressionKind::Static,
                    rows: Vec::new(),
                    phi_1: separated.factors.iter().map(negated).collect(),
                    phi_0: as_written(plant, domain, in_z, &separated.known),
                    primitive_0: Vec::new(),
                    primitive_1: Vec::new(),
                    eta_symbols: plant.eta(separated.eta.len()),
                    eta: separated.eta,
                    theta: recovered.theta,
                };
                return Claim { verdict: Verdict::Proved, result: Some(result) };
            }
            found.push(undecided(plant, 0, span, &Obstacle::NoWitness));
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Ok(None) => {
            found.push(
                Diagnostic::error(
                    Code::RegressionUndecided,
                    span,
                    "no regression that is linear in functions of theta was found in this identity",
                )
                .help("write it as a polynomial in the components of phi, or give `f_y` for an output"),
            );
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Err(obstacle) => {
            found.push(undecided(plant, 0, span, &obstacle));
            Claim { verdict: Verdict::Undecided, result: None }
        }
    }
}

/// What is known, as the relation itself at z = chi where that is shorter, but for the constants that the unknowns
/// have absorbed.
fn as_written(plant: &Plant, domain: &Domain, in_z: &[Expr], known: &[Expr]) -> Vec<Expr> {
    let arena = &plant.arena;
    let at_chi: BTreeMap<Symbol, Expr> =
        plant.z.iter().copied().zip(plant.chi.iter().map(|s| arena.of_symbol(*s))).collect();
    let of = |(relation, known): (&Expr, &Expr)| {
        let relation = arena.substitute(*relation, &at_chi);
        let constant = shortest(arena, domain, arena.sub(*known, relation));
        shortest_equal(arena, domain, *known, &[arena.add(relation, constant)])
    };
    in_z.iter().zip(known).map(of).collect()
}
