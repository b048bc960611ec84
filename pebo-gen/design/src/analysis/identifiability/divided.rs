//! Identifiability with non-smooth formulas: cell by cell.
//!
//! In: the decision for analytic formulas. Out: the decision on a domain. The rank at a point, and an unobservable
//! direction there, hold almost everywhere in the cell of the point alone: with `p*max(q, 0)` p is identifiable while q
//! is positive; with `a + b*sign(w)` both are once w has had both signs.

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::cells::{Cell, walls};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::analytic::{AnalyticDecision, where_analytic};
use super::crossing::{CellRows, all_identified, driven};
use super::flow::varies;
use super::joined::Joined;
use super::observation::Observation;
use super::problem::{ObservabilityProblem, SHARE_OF_REMARKS};
use super::special;
use super::trajectory::{List, assuming};
use crate::analysis::design::{
    BlindTrajectory, Claim, Excitation, Identifiability, Still, TrajectoryCondition, Verdict,
};
use crate::analysis::left_inverse::checking::at_phi;

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

    pub(super) fn all(&self) -> Vec<Expr> {
        [self.regressor.as_slice(), &self.rates, &self.identities].concat()
    }
}

/// The kind of excitation that a claim states.
pub(super) fn kind(claim: &Claim<Identifiability>) -> Option<Excitation> {
    claim.result.as_ref().map(|result| result.kind)
}

/// The decision on a domain from those on its cells.
pub(super) fn on_cells(
    problem: &ObservabilityProblem<'_>,
    formulas: &Formulas,
    found: &mut Vec<Diagnostic>,
) -> Result<Claim<Identifiability>, Obstacle> {
    let &ObservabilityProblem { plant, domain, cascade, regression, .. } = problem;
    let arena = &plant.arena;
    let on = |domain: &Domain, found: &mut Vec<Diagnostic>| where_analytic(&problem.on(domain), found);
    let varies = |expr: Expr| varies(plant, expr);
    let mut reported = Vec::new();
    let whole = on(domain, &mut reported);
    let instant = |cell: &Cell| kind(&on(&cell.domain, &mut Vec::new()).claim) == Some(Excitation::Instant);
    if kind(&whole.claim) == Some(Excitation::Instant) {
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
    // A fundamental matrix varies with time: rows of two instants do not compare.
    let entries: Vec<Expr> = regression.phi_1.iter().chain(&regression.primitive_1).flatten().copied().collect();
    let by_psi = !arena.symbols_of(&entries).is_disjoint(&plant.psi.iter().flatten().copied().collect());
    let mut joined = Joined::new();
    let mut observed = Vec::new();
    for cell in &cells {
        let mut reported = Vec::new();
        let AnalyticDecision { claim, observed: rows } = on(&cell.domain, &mut reported);
        let Some(result) = &claim.result else {
            found.extend(reported);
            return Ok(claim);
        };
        let sides = || cell.distinct_sides(arena, domain);
        joined.add(result, sides);
        if let Some(rows) = &rows {
            let condition = TrajectoryCondition { sides: sides(), ..TrajectoryCondition::default() };
            joined.blind.push(problem.blind(condition, rows));
        }
        let Observation { stack, hidden, .. } = rows.unwrap_or_default();
        observed.push(CellRows { cell, rows: if by_psi { Vec::new() } else { stack }, hidden });
    }
    // At the given values of the parameters some cells may have no points.
    let given: Vec<&CellRows<'_>> = observed.iter().filter(|cell| cell.cell.domain.fixed == domain.fixed).collect();
    let identify = |cells: &[&CellRows<'_>]| -> Result<bool, Obstacle> {
        let combined = || all_identified(plant, cascade, varies, cells, regression.eta.len());
        Ok(cells.iter().any(|cell| cell.is_identified()) || (!by_psi && combined()?))
    };
    if joined.blind.len() == cells.len() {
        // A direction that no cell observes is a statement on the whole domain only if it is the same in all.
        let is_one = |whole: &Observation| whole.hidden[0].iter().all(|entry| !varies(*entry));
        if whole.observed.as_ref().is_some_and(is_one) {
            found.extend(reported);
            return Ok(whole.claim);
        }
        if by_psi {
            return Err(Obstacle::NoWitness);
        }
        if !identify(&observed.iter().collect::<Vec<_>>())? {
            found.push(not_combined(plant, &cells));
            return Ok(Claim { verdict: Verdict::Undecided, result: None });
        }
        // Several cells identify the unknowns while the plant moves from one to the other.
        joined.by_itself = are_of_inputs(plant, &cells).then_some(false);
    }
    if !identify(&given)? {
        found.push(not_combined(plant, &given.iter().map(|cell| cell.cell.clone()).collect::<Vec<_>>()));
        return Ok(Claim { verdict: Verdict::Undecided, result: None });
    }
    joined.exclude(special::of_cells(plant, domain, &observed, regression.eta.len()));
    joined.add_cells(plant, cells.len());
    joined.join_neighbours();
    let there = assuming(domain, &joined.constants, &[]);
    for wall in on_walls(&problem.on(&there), &cells, (joined.by_itself, &joined.blind)) {
        if joined.blind.iter().all(|other| other.condition(plant) != wall.condition(plant)) {
            joined.blind.push(wall);
        }
    }
    Ok(joined.claim(plant, cells.len()))
}

/// Tests whether inputs alone distinguish the cells: then no trajectory passes from one into another without them.
fn are_of_inputs(plant: &Plant, cells: &[Cell]) -> bool {
    let is_known = |symbol: &Symbol| plant.u.contains(symbol) || !varies(plant, plant.arena.of_symbol(*symbol));
    plant.arena.symbols_of(&walls(cells)).iter().all(is_known)
}

/// The trajectories that stay between two cells, on which not all unknowns are identifiable: undecided where no rule
/// decides it.
fn on_walls(
    problem: &ObservabilityProblem<'_>,
    cells: &[Cell],
    (by_itself, listed): (Option<bool>, &[BlindTrajectory]),
) -> Vec<BlindTrajectory> {
    let &ObservabilityProblem { plant, cascade, regression, .. } = problem;
    let inputs: BTreeSet<Symbol> = plant.commanded().collect();
    let lambda = cascade.lambda.iter().flatten().flatten();
    let rows: Vec<Expr> =
        [&regression.phi_1, &regression.primitive_1].into_iter().flatten().flatten().chain(lambda).copied().collect();
    let holds_inputs = !plant.arena.symbols_of(&rows).is_disjoint(&inputs);
    let (free, steady) = (problem.whole(Still::Nothing), problem.whole(problem.inputs()));
    let mut list = List::new(problem, listed);
    plant.arena.budget().share(SHARE_OF_REMARKS, || {
        for wall in walls(cells) {
            // A signal that an input drives is constant on its wall, by the input, which the rows must not hold then.
            let held = driven(plant, wall).filter(|signal| !inputs.contains(signal) && !holds_inputs);
            let moving = list.add_zero(&free, wall, &held.into_iter().collect());
            let is_decided = if by_itself == Some(true) { list.add_zero(&steady, wall, &inputs) } else { moving };
            if is_decided.is_err() {
                list.leave_open(&free, Some(wall));
            }
        }
    });
    list.statements()
}

/// No cell identifies all unknowns, and no trajectory was found that passes from one into another and identifies them.
fn not_combined(plant: &Plant, cells: &[Cell]) -> Diagnostic {
    let dividers: Vec<String> = walls(cells).into_iter().map(|expr| format!("`{}`", plant.arena.print(expr))).collect();
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
