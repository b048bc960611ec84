//! Identifiability with non-smooth formulas: cell by cell.
//!
//! In: the decision for analytic formulas. Out: the decision on the whole domain. The rank at a point, and an
//! unobservable direction there, hold almost everywhere in the cell of the point alone: with `p*max(q, 0)` p is
//! identifiable while q is positive; with `a + b*sign(w)` both are once w has had both signs.

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::cells::Cell;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr};

use super::crossing::{CellRows, all_identified};
use super::trajectory::identifiable;
use crate::analysis::design::{
    BlindTrajectory, Cascade, Claim, Excitation, Identifiability, Regression, Trajectories, TrajectoryCondition,
    Verdict,
};
use crate::analysis::left_inverse::checking::at_phi;

/// An answer where all formulas are analytic.
pub(super) struct AnalyticDecision {
    /// The verdict.
    pub(super) claim: Claim<Identifiability>,
    /// The directions of the unknowns that are never observable.
    pub(super) hidden: Vec<Vec<Expr>>,
    /// The rows of the regressor, with the derivatives that were looked at.
    pub(super) rows: Vec<Vec<Expr>>,
}

impl AnalyticDecision {
    fn kind(&self) -> Option<Excitation> {
        self.claim.result.as_ref().map(|result| result.kind)
    }
}

impl From<Claim<Identifiability>> for AnalyticDecision {
    fn from(claim: Claim<Identifiability>) -> Self {
        Self { claim, hidden: Vec::new(), rows: Vec::new() }
    }
}

/// The formulas that may be non-smooth.
pub(super) struct Formulas {
    /// The regressor.
    pub(super) regressor: Vec<Expr>,
    /// All rates.
    pub(super) rates: Vec<Expr>,
    /// The formulas that vanish on the domain: they count too.
    pub(super) identities: Vec<Expr>,
}

impl Formulas {
    fn of_regressor(&self) -> Vec<Expr> {
        [self.regressor.as_slice(), &self.identities].concat()
    }

    fn all(&self) -> Vec<Expr> {
        [self.regressor.as_slice(), &self.rates, &self.identities].concat()
    }
}

/// Answers on the whole domain, for parameters of every sign that the assumptions leave; an obstacle where that is
/// open.
pub(super) fn decide(
    plant: &Plant,
    domain: &Domain,
    (cascade, regression): (&Cascade, &Regression),
    formulas: &Formulas,
    found: &mut Vec<Diagnostic>,
    on: impl Fn(&Domain, &mut Vec<Diagnostic>) -> AnalyticDecision,
) -> Result<Claim<Identifiability>, Obstacle> {
    let arena = &plant.arena;
    let mut reported = Vec::new();
    let whole = on_cells(plant, domain, (cascade, regression), formulas, &mut reported, &on)?;
    let identified =
        |claim: &Claim<Identifiability>| claim.result.as_ref().is_some_and(|result| result.kind != Excitation::Never);
    if identified(&whole) {
        let cells = domain.cells(arena, &formulas.all(), |expr| !varies(plant, expr))?;
        for cell in cells.iter().filter(|cell| !cell.sides.is_empty()) {
            let claim = on_cells(plant, &cell.domain, (cascade, regression), formulas, &mut Vec::new(), &on)?;
            let at_once = |claim: &Claim<Identifiability>| {
                claim.result.as_ref().is_some_and(|result| result.kind == Excitation::Instant)
            };
            if !identified(&claim) || at_once(&whole) && !at_once(&claim) {
                found.push(depends_on_signs(plant, cell));
                return Ok(Claim { verdict: Verdict::Undecided, result: None });
            }
        }
    }
    found.extend(reported);
    Ok(whole)
}

/// Tests whether an expression depends on more than the parameters.
pub(super) fn varies(plant: &Plant, expr: Expr) -> bool {
    let is_constant = |symbol| plant.parameters.iter().any(|known| known.symbol == symbol);
    plant.arena.symbols_of(&[expr]).into_iter().any(|symbol| !is_constant(symbol))
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

/// No cell identifies all unknowns, and no trajectory was found that passes from one into another and identifies them.
fn not_combined(plant: &Plant, cells: &[Cell]) -> Diagnostic {
    let dividers: BTreeSet<Expr> = cells.iter().flat_map(|cell| cell.sides.iter().map(|(expr, _)| *expr)).collect();
    let dividers: Vec<String> = dividers.into_iter().map(|expr| format!("`{}`", plant.arena.print(expr))).collect();
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "no trajectory was found that identifies the unknowns",
    )
    .label(format!(
        "while {} {} one sign, not all of them are identifiable",
        dividers.join(", "),
        if dividers.len() == 1 { "keeps" } else { "keep" }
    ))
    .note("and no trajectory was found that passes to another sign and identifies them all")
    .help("choose a phi of what is identifiable on one side alone, and state that side under `assume`")
}

/// The trajectories within cells on which not all unknowns are identifiable: of all cells at once, where all have the
/// same.
fn of_cells(plant: &Plant, within: &[(&Cell, Vec<BlindTrajectory>)], cells: usize) -> Vec<BlindTrajectory> {
    let key = |blind: &BlindTrajectory| (blind.condition(plant), blind.identifiable.clone());
    let mut found: Vec<BlindTrajectory> = Vec::new();
    for (cell, trajectories) in within {
        for trajectory in trajectories {
            let is_same =
                |(_, others): &&(&Cell, Vec<BlindTrajectory>)| others.iter().any(|other| key(other) == key(trajectory));
            let condition = if within.iter().filter(is_same).count() == cells {
                trajectory.condition.clone()
            } else {
                TrajectoryCondition::Within(cell.sides.clone(), Box::new(trajectory.condition.clone()))
            };
            let trajectory = BlindTrajectory { condition, ..trajectory.clone() };
            if !found.iter().any(|other| key(other) == key(&trajectory)) {
                found.push(trajectory);
            }
        }
    }
    found
}

/// The decision on a domain from those on its cells.
fn on_cells(
    plant: &Plant,
    domain: &Domain,
    (cascade, regression): (&Cascade, &Regression),
    formulas: &Formulas,
    found: &mut Vec<Diagnostic>,
    on: &impl Fn(&Domain, &mut Vec<Diagnostic>) -> AnalyticDecision,
) -> Result<Claim<Identifiability>, Obstacle> {
    let arena = &plant.arena;
    let varies = |expr: Expr| varies(plant, expr);
    let mut reported = Vec::new();
    let whole = on(domain, &mut reported);
    let instant = |cell: &Cell| on(&cell.domain, &mut Vec::new()).kind() == Some(Excitation::Instant);
    if whole.kind() == Some(Excitation::Instant) {
        let listed = whole.claim.result.as_ref().is_some_and(|result| result.everywhere_else);
        let everywhere = match domain.cells(arena, &formulas.of_regressor(), varies) {
            Ok(cells) => cells.len() == 1 || cells.iter().all(instant),
            // The drop of the rank is reported even so.
            Err(Obstacle::TooLarge | Obstacle::OutOfBudget | Obstacle::NoPoint) if listed => true,
            Err(obstacle) => return Err(obstacle),
        };
        if everywhere {
            found.extend(reported);
            return Ok(whole.claim);
        }
    }
    let cells = domain.cells(arena, &formulas.all(), varies)?;
    if cells.len() == 1 {
        found.extend(reported);
        return Ok(whole.claim);
    }
    let mut blind = Vec::new();
    let mut within: Vec<(&Cell, Vec<BlindTrajectory>)> = Vec::new();
    let mut observed = Vec::new();
    let mut constants: Vec<Expr> = Vec::new();
    let mut parameters = true;
    let mut by_itself = Some(true);
    let symbols = if regression.is_linear(plant) { &plant.z } else { &regression.eta_symbols };
    for cell in &cells {
        let mut reported = Vec::new();
        let decided = on(&cell.domain, &mut reported);
        match decided.kind() {
            None => {
                found.extend(reported);
                return Ok(decided.claim);
            }
            Some(Excitation::Instant) => {}
            Some(Excitation::Excitation) => {
                let trajectories = decided.claim.result.as_ref().and_then(|result| result.trajectories.as_ref());
                let also = trajectories.and_then(|trajectories| trajectories.by_itself);
                by_itself = if [by_itself, also].contains(&Some(false)) { Some(false) } else { by_itself.and(also) };
                within.extend(trajectories.map(|trajectories| (cell, trajectories.blind.clone())));
            }
            Some(Excitation::Never) => blind.push(BlindTrajectory {
                condition: TrajectoryCondition::Cell(cell.sides.clone()),
                identifiable: identifiable(arena, symbols, &decided.hidden),
                hidden: decided.hidden.clone(),
            }),
        }
        observed.push(CellRows { cell, rows: decided.rows });
        if let Some(result) = decided.claim.result {
            parameters &= result.trajectories.is_none_or(|trajectories| trajectories.parameters);
            for constant in result.constants {
                if !constants.contains(&constant) {
                    constants.push(constant);
                }
            }
        }
    }
    if blind.len() == cells.len() {
        // A direction that no cell observes is a statement on the whole domain only if it is the same in all.
        let one = |direction: &Vec<Expr>| direction.iter().all(|entry| !varies(*entry));
        if whole.kind() == Some(Excitation::Never) && whole.hidden.first().is_some_and(one) {
            found.extend(reported);
            return Ok(whole.claim);
        }
        // A fundamental matrix varies with time: rows of two instants do not compare.
        let entries: Vec<Expr> = observed.iter().flat_map(|cell| cell.rows.concat()).collect();
        let by_psi = arena.symbols_of(&entries).iter().any(|s| plant.psi.iter().flatten().any(|psi| psi == s));
        if by_psi {
            return Err(Obstacle::NoWitness);
        }
        if !all_identified(plant, cascade, varies, &observed, regression.eta.len())? {
            found.push(not_combined(plant, &cells));
            return Ok(Claim { verdict: Verdict::Undecided, result: None });
        }
    }
    // Several cells identify the unknowns while the plant moves from one to the other.
    let by_itself = by_itself.filter(|_| blind.len() < cells.len());
    blind.extend(of_cells(plant, &within, cells.len()));
    // On the borders too a column may vanish.
    let on_whole = whole.claim.result.and_then(|result| result.trajectories).map(|trajectories| trajectories.blind);
    let is_undecided = |of: &BlindTrajectory| matches!(of.condition, TrajectoryCondition::Undecided(_));
    let is_new = |of: &BlindTrajectory| blind.iter().all(|other| other.condition(plant) != of.condition(plant));
    let others: Vec<BlindTrajectory> =
        on_whole.into_iter().flatten().filter(|of| is_undecided(of) && is_new(of)).collect();
    blind.extend(others);
    let trajectories = Trajectories { by_itself, at_rest: false, blind, everywhere: false, parameters };
    Ok(Claim {
        verdict: Verdict::Proved,
        result: Some(Identifiability {
            kind: Excitation::Excitation,
            singular_where: Vec::new(),
            everywhere_else: false,
            constants,
            direction: None,
            trajectories: Some(trajectories),
            gram: None,
        }),
    })
}
