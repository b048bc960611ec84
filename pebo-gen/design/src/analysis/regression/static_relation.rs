//! Static regressions: from identities, or from relations between the components of the transform.

use std::collections::{BTreeMap, BTreeSet};

use super::{cleared, combined, relations, separation};
use crate::analysis::affine;
use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::plant::matrix::dot;
use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::forms::tidy::{proved_shortest, shortest, shortest_equal};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::equation::{Equation, outputs_in, outputs_of};
use super::functions::steps;
use super::refusal::undecided;

/// An affine function of z that vanishes, with the positions of the outputs whose equation it is.
type OutputRow = (affine::Row, Vec<usize>);

/// A static regression `Phi_0 = Phi_1 eta` from the identities.
pub(in crate::analysis) fn from_identities(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let span = plant.y.first().map_or(Span::point(0), |output| output.span);
    if plant.identities.is_empty() {
        if let Some(claim) = from_relations(plant, domain, cascade, left_inverse, found) {
            return claim;
        }
        found.push(
            Diagnostic::error(
                Code::RegressionNonlinear,
                span,
                "the model gives no equation from which the unknowns could be estimated",
            )
            .label("no output has a rate under `f_y`, and there are no `identities`")
            .help("give `f_y` for an output, or an expression in x and y that is zero under `identities`"),
        );
        return Claim { verdict: Verdict::Refuted, result: None };
    }
    if cascade.lambda.is_some() {
        let of = |identity: &Formula| match cleared::rows(plant, domain, identity.expr) {
            Ok(rows) => rows.into_iter().map(|row| Ok((row, outputs_of(plant, identity)))).collect(),
            Err(obstacle) => vec![Err(obstacle)],
        };
        let rows = plant.identities.iter().flat_map(of).collect();
        return under_lambda(plant, domain, (rows, plant.identities[0].span), found);
    }
    let Some(left_inverse) = left_inverse else { return Claim { verdict: Verdict::Skipped, result: None } };
    let identities = cleared::in_z(plant, domain, left_inverse);
    constant_relation(plant, domain, (cascade, left_inverse), (&identities, plant.identities[0].span), found)
}

/// A static regression from the identities that are affine in the transform; none if these are all, or there are none.
pub(in crate::analysis) fn from_affine_identities(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let identities = cleared::in_z(plant, domain, left_inverse?);
    let affine: Vec<Equation> =
        identities.iter().filter(|e| combined::affine(plant, domain, e.rate).is_some()).cloned().collect();
    if affine.is_empty() || affine.len() == identities.len() {
        return None;
    }
    combined::joined(plant, domain, cascade, left_inverse, &affine, found)
}

/// A static regression from relations between the components of the transform; none if there are none, or theta cannot
/// be recovered from them.
pub(super) fn from_relations(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let relations = relations::among(plant, domain).ok().filter(|relations| !relations.is_empty())?;
    let mut own = Vec::new();
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let claim = if cascade.lambda.is_some() {
        let row = |relation: &Expr| Some(Ok((in_z(plant, *relation)?, outputs_in(plant, *relation))));
        let rows = relations.iter().filter_map(row).collect();
        under_lambda(plant, domain, (rows, span), &mut own)
    } else {
        let relations: Vec<Equation> = relations.into_iter().map(|rate| Equation::relation(plant, rate)).collect();
        constant_relation(plant, domain, (cascade, left_inverse?), (&relations, span), &mut own)
    };
    // An undecided claim is left to the rates, which the author can mend.
    if claim.verdict == Verdict::Undecided && own.iter().any(|d| d.code == Code::RegressionUndecided) {
        return None;
    }
    found.extend(own);
    Some(claim)
}

/// A vanishing relation as an affine function of z, the known term first; none where it is no such function.
fn in_z(plant: &Plant, relation: Expr) -> Option<affine::Row> {
    let arena = &plant.arena;
    let z: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let slopes: Vec<Expr> = plant.z.iter().map(|z| arena.derivative(relation, *z)).collect();
    let origin: BTreeMap<Symbol, Expr> = plant.z.iter().map(|z| (*z, arena.zero())).collect();
    let affine = slopes.iter().all(|slope| !arena.depends_on(*slope, &z));
    affine.then(|| [vec![arena.substitute(relation, &origin)], slopes].concat())
}

/// A static regression under a generalised cascade, `z = xi + Psi theta`, from an affine function of z that vanishes.
///
/// Functions of theta are not used here: with Psi between them, they would be functions of known signals too.
fn under_lambda(
    plant: &Plant,
    domain: &Domain,
    (rows, span): (Vec<Result<OutputRow, Obstacle>>, Span),
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let xi: Vec<Expr> = plant.xi.iter().map(|s| arena.of_symbol(*s)).collect();
    let theta: Vec<Expr> = plant.theta.iter().map(|s| arena.of_symbol(*s)).collect();
    let (mut phi_0, mut phi_1) = (Vec::new(), Vec::new());
    let mut known_rows: Vec<&affine::Row> = Vec::new();
    let mut sources: Vec<Vec<usize>> = Vec::new();
    for (row, outputs) in rows.iter().filter_map(|row| row.as_ref().ok()) {
        let opposite: affine::Row = row.iter().map(|entry| arena.neg(*entry)).collect();
        if let Some(known) = known_rows.iter().position(|known| *known == row || **known == opposite) {
            sources[known].extend(outputs);
            continue;
        }
        known_rows.push(row);
        sources.push(outputs.clone());
        // known + factors (xi + Psi theta) = 0
        phi_0.push(proved_shortest(arena, domain, arena.add(row[0], dot(arena, &row[1..], &xi))));
        let column = |column: usize| {
            let psi: Vec<Expr> = plant.psi.iter().map(|row| arena.of_symbol(row[column])).collect();
            proved_shortest(arena, domain, arena.neg(dot(arena, &row[1..], &psi)))
        };
        phi_1.push((0..theta.len()).map(column).collect());
    }
    if phi_0.is_empty() {
        let obstacle = rows.into_iter().find_map(Result::err);
        found.push(match obstacle {
            Some(obstacle) => undecided(plant, plant.y.len(), span, &obstacle),
            None => Diagnostic::error(
                Code::RegressionUndecided,
                span,
                "for a generalised cascade, no regression was found in this identity",
            )
            .label("not an affine function of phi with coefficients in y and u")
            .note(
                "for a generalised cascade, z = xi + Psi theta, a regression in functions of theta is not searched for",
            )
            .help("choose a phi in which it is affine, or one whose derivative is free of x"),
        });
        return Claim { verdict: Verdict::Undecided, result: None };
    }
    let eta_symbols = plant.eta(theta.len());
    let result = Regression {
        kind: RegressionKind::Static,
        sources,
        phi_0,
        phi_1,
        primitive_0: Vec::new(),
        primitive_1: Vec::new(),
        theta: eta_symbols.iter().map(|s| arena.of_symbol(*s)).collect(),
        eta: theta,
        eta_symbols,
        steps: Vec::new(),
        alternative: None,
        unused: Vec::new(),
    };
    Claim { verdict: Verdict::Proved, result: Some(result) }
}

/// A static regression from expressions in z that vanish.
fn constant_relation(
    plant: &Plant,
    domain: &Domain,
    (cascade, left_inverse): (&Cascade, &LeftInverse),
    (equations, span): (&[Equation], Span),
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    if equations.iter().all(|equation| combined::affine(plant, domain, equation.rate).is_some())
        && let Some(claim) = combined::joined(plant, domain, cascade, Some(left_inverse), equations, found)
    {
        return claim;
    }
    let in_z: &[Expr] = &equations.iter().map(|equation| equation.rate).collect::<Vec<_>>();
    match separation::separate(plant, domain, in_z) {
        Ok(Some(separated)) => {
            let separated = separation::absorb_constants(plant, domain, separated);
            if let Some((separated, recovered)) = separation::recoverable(plant, domain, separated) {
                let steps = match steps(plant, domain, left_inverse, &separated.eta, &recovered, found) {
                    Ok(steps) => steps,
                    Err(verdict) => return Claim { verdict, result: None },
                };
                // identity = known + factors eta = 0, so known = -factors eta
                let negated = |row: &Vec<Expr>| row.iter().map(|e| shortest(arena, domain, arena.neg(*e))).collect();
                let result = Regression {
                    kind: RegressionKind::Static,
                    sources: equations.iter().map(|equation| equation.outputs.clone()).collect(),
                    phi_1: separated.factors.iter().map(negated).collect(),
                    phi_0: as_written(plant, domain, in_z, &separated.known),
                    primitive_0: Vec::new(),
                    primitive_1: Vec::new(),
                    eta_symbols: plant.eta(separated.eta.len()),
                    steps,
                    alternative: None,
                    unused: Vec::new(),
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

/// The known term, as the relation itself at z = chi where that is shorter, without the constants that the unknowns
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
