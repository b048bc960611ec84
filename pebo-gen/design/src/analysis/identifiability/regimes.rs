//! Identifiability for parameters of other signs than those of the file.
//!
//! In: the decision on a domain. Out: the decision for all values of the parameters that the assumptions leave: where
//! those of some signs have another answer, the signs of the file are conditions.

use crate::analysis::design::{Claim, Excitation, Identifiability, Verdict};
use crate::analysis::left_inverse::checking::at_phi;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::cells::{Cell, walls};
use pebo_cas::domain::zero;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr};

use super::divided::{Formulas, kind, on_cells};
use super::flow::varies;
use super::joined::Joined;
use super::problem::ObservabilityProblem;
use super::special::{SpecialValues, on_boundary};

/// Answers on the whole domain; an obstacle where that is open.
pub(super) fn decide(
    problem: &ObservabilityProblem<'_>,
    formulas: &Formulas,
    found: &mut Vec<Diagnostic>,
) -> Result<Claim<Identifiability>, Obstacle> {
    let &ObservabilityProblem { plant, domain, .. } = problem;
    let on_cells = |domain: &Domain, found: &mut Vec<Diagnostic>| on_cells(&problem.on(domain), formulas, found);
    let regimes = regimes(plant, domain, formulas)?;
    if let [_] = regimes.as_slice() {
        return on_cells(domain, found);
    }
    let is_identified = |claim: &Claim<Identifiability>| kind(claim).is_some_and(|kind| kind != Excitation::Never);
    if let Some(between) = at_given_walls(plant, domain, &walls(&regimes)) {
        let mut reported = Vec::new();
        let claim = on_cells(&between, &mut reported)?;
        if !is_identified(&claim) {
            found.append(&mut reported);
            return Ok(claim);
        }
    }
    let mut claims = Vec::new();
    for regime in &regimes {
        let mut reported = Vec::new();
        claims.push((regime, on_cells(&regime.domain, &mut reported)?, reported));
    }
    let first = kind(&claims[0].1);
    let is_whole = matches!(first, Some(Excitation::Instant | Excitation::Never));
    if is_whole && claims.iter().all(|(_, claim, _)| kind(claim) == first) {
        let whole = on_cells(domain, found)?;
        if kind(&whole) == first {
            return Ok(whole);
        }
    }
    if let Some((other, ..)) = claims.iter().find(|(_, claim, _)| !is_identified(claim)) {
        let is_given = |regime: &Cell| !domain.fixed.is_empty() && regime.domain.fixed == domain.fixed;
        let own = claims.iter().find(|(regime, claim, _)| is_given(regime) && is_identified(claim));
        let Some((regime, claim, reported)) = own else {
            found.push(depends_on_signs(plant, other));
            return Ok(Claim { verdict: Verdict::Undecided, result: None });
        };
        let mut claim = claim.clone();
        if let Some(result) = &mut claim.result {
            let sides = regime.distinct_sides(&plant.arena, domain).into_iter();
            result.positive = sides.map(|(divider, side)| side.positive(&plant.arena, divider)).collect();
        }
        found.extend(reported.iter().cloned());
        return Ok(claim);
    }
    let mut joined = Joined::new();
    for (regime, claim, _) in &claims {
        if let Some(result) = &claim.result {
            joined.add(result, || regime.distinct_sides(&plant.arena, domain));
        }
    }
    // The values between the regimes are in none of them.
    for divider in walls(&regimes) {
        let there = on_boundary(plant, domain, &[divider]);
        joined.exclude(match on_cells(&there, &mut Vec::new()) {
            Ok(Claim { result: Some(result), verdict: Verdict::Proved }) => {
                on_wall(plant, domain, divider, &result, &joined.constants)
            }
            Ok(_) => SpecialValues { nonzero: vec![divider], complete: true },
            Err(_) => SpecialValues::none(false),
        });
    }
    Ok(joined.claim(plant, claims.len()))
}

/// The domain at the given values of the parameters, if these are between regimes: where walls are zero.
fn at_given_walls(plant: &Plant, domain: &Domain, walls: &[Expr]) -> Option<Domain> {
    let arena = &plant.arena;
    let is_zero = |wall: &&Expr| zero::is_zero(arena, arena.substitute(**wall, &domain.fixed), domain);
    let zero: Vec<Expr> = walls.iter().filter(is_zero).copied().collect();
    (!zero.is_empty()).then(|| Domain { fixed: domain.fixed.clone(), ..on_boundary(plant, domain, &zero) })
}

/// The values of the parameters that a claim for those on a wall excludes, but for those that others exclude: wall and
/// constant are zero there.
fn on_wall(plant: &Plant, domain: &Domain, wall: Expr, result: &Identifiability, others: &[Expr]) -> SpecialValues {
    let arena = &plant.arena;
    let is_excluded = |constant: Expr| {
        let there = on_boundary(plant, domain, &[wall, constant]);
        others.iter().any(|other| zero::is_zero(arena, *other, &there))
    };
    let square = |expr: Expr| arena.mul(expr, expr);
    let both = |constant: Expr| arena.add(square(wall), square(constant));
    let constants =
        result.constants.iter().map(|constant| arena.dividers(&[*constant]).first().copied().unwrap_or(*constant));
    let is_complete = result.trajectories.as_ref().is_none_or(|all| all.parameters);
    SpecialValues {
        nonzero: constants.filter(|constant| !is_excluded(*constant)).map(both).collect(),
        complete: is_complete && result.positive.is_empty(),
    }
}

/// The cells of the parameters: the signs of those of their functions that occur in the rows on a cell of the domain.
fn regimes(plant: &Plant, domain: &Domain, formulas: &Formulas) -> Result<Vec<Cell>, Obstacle> {
    let mut dividers = walls(&domain.cells(&plant.arena, &formulas.all(), |_| true)?);
    dividers.retain(|divider| !varies(plant, *divider));
    domain.divided_by(&plant.arena, &dividers)
}

/// With parameters of other signs there is another answer.
fn depends_on_signs(plant: &Plant, cell: &Cell) -> Diagnostic {
    let sides: Vec<String> =
        cell.sides.iter().map(|(expr, side)| format!("`{} {}`", plant.arena.print(*expr), side.sign())).collect();
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "whether the unknowns can be identified depends on the signs of parameters",
    )
    .label(format!("it was not shown for parameters with {}", sides.join(", ")))
    .help("state the signs of the parameters under `assume`")
}
