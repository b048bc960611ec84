//! Identifiability with non-smooth formulas: cell by cell.
//!
//! In: the decision for analytic formulas. Out: the decision on the whole domain. The rank at a point, and an
//! unobservable direction there, hold almost everywhere in the cell of the point alone: with `p*max(q, 0)` p is
//! identifiable while q is positive; with `a + b*sign(w)` both are once w has had both signs.

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::cells::{Cell, Side};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::crossing::{CellRows, all_identified, driven};
use super::trajectory::{TrajectoryProblem, identifiable};
use crate::analysis::design::{
    BlindTrajectory, Cascade, Claim, Excitation, Identifiability, Regression, Trajectories, TrajectoryCondition,
    Verdict,
};
use crate::analysis::left_inverse::checking::at_phi;

/// The share of the remaining budget for trajectories between cells, as for others.
const SHARE_OF_WALLS: u64 = 8;

/// Dividers with their signs.
type Sides = Vec<(Expr, Side)>;

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

/// Answers on the whole domain, for all values of the parameters that the assumptions leave; an obstacle where that is
/// open. Parameters of some signs may have another answer than those of the file: then the signs of the file are
/// conditions.
pub(super) fn decide(
    plant: &Plant,
    domain: &Domain,
    (cascade, regression): (&Cascade, &Regression),
    formulas: &Formulas,
    found: &mut Vec<Diagnostic>,
    on: impl Fn(&Domain, &mut Vec<Diagnostic>) -> AnalyticDecision,
) -> Result<Claim<Identifiability>, Obstacle> {
    let on_cells = |domain: &Domain, found: &mut Vec<Diagnostic>| {
        on_cells(plant, domain, (cascade, regression), formulas, found, &on)
    };
    let regimes = regimes(plant, domain, formulas)?;
    if let [_] = regimes.as_slice() {
        return on_cells(domain, found);
    }
    let mut claims = Vec::new();
    for regime in &regimes {
        let mut reported = Vec::new();
        claims.push((regime, on_cells(&regime.domain, &mut reported)?, reported));
    }
    let kind = |claim: &Claim<Identifiability>| claim.result.as_ref().map(|result| result.kind);
    if claims.iter().all(|(_, claim, _)| kind(claim) == Some(Excitation::Instant))
        || claims.iter().all(|(_, claim, _)| kind(claim) == Some(Excitation::Never))
    {
        let whole = on_cells(domain, found)?;
        if kind(&whole) == kind(&claims[0].1) {
            return Ok(whole);
        }
    }
    let is_identified = |claim: &Claim<Identifiability>| kind(claim).is_some_and(|kind| kind != Excitation::Never);
    let other = claims.iter().find(|(_, claim, _)| !is_identified(claim)).map(|(regime, ..)| *regime);
    if let Some(other) = other {
        let is_given = |regime: &Cell| !domain.fixed.is_empty() && regime.domain.fixed == domain.fixed;
        let own = claims.iter_mut().find(|(regime, claim, _)| is_given(regime) && is_identified(claim));
        let Some((regime, claim, reported)) = own else {
            found.push(depends_on_signs(plant, other));
            return Ok(Claim { verdict: Verdict::Undecided, result: None });
        };
        if let Some(result) = &mut claim.result {
            let sides = regime.distinct_sides(&plant.arena, domain).into_iter();
            result.positive = sides.map(|(divider, side)| side.positive(&plant.arena, divider)).collect();
        }
        found.append(reported);
        return Ok(claim.clone());
    }
    Ok(of_regimes(plant, domain, &claims))
}

/// The cells of the parameters: the signs of those of their functions that occur in the rows on a cell of the domain.
fn regimes(plant: &Plant, domain: &Domain, formulas: &Formulas) -> Result<Vec<Cell>, Obstacle> {
    let arena = &plant.arena;
    let cells = domain.cells(arena, &formulas.all(), |_| true)?;
    let mut dividers: Vec<Expr> = Vec::new();
    for (divider, _) in cells.iter().flat_map(|cell| &cell.sides) {
        if !varies(plant, *divider) && !dividers.contains(divider) {
            dividers.push(*divider);
        }
    }
    domain.divided_by(arena, &dividers)
}

/// The weakest answer of several signs of the parameters, with all trajectories of each.
fn of_regimes(
    plant: &Plant,
    domain: &Domain,
    claims: &[(&Cell, Claim<Identifiability>, Vec<Diagnostic>)],
) -> Claim<Identifiability> {
    let results = || claims.iter().filter_map(|(_, claim, _)| claim.result.as_ref());
    let mut within = Vec::new();
    let mut constants: Vec<Expr> = Vec::new();
    for (regime, claim, _) in claims {
        let Some(result) = &claim.result else { continue };
        constants.extend(
            result.constants.iter().filter(|constant| !constants.contains(constant)).copied().collect::<Vec<_>>(),
        );
        if let Some(trajectories) = &result.trajectories {
            within.push((regime.distinct_sides(&plant.arena, domain), trajectories.blind.clone()));
        }
    }
    let trajectories = || results().filter_map(|result| result.trajectories.as_ref());
    let by_itself = match trajectories().map(|trajectories| trajectories.by_itself) {
        all if all.clone().all(|by_itself| by_itself == Some(true)) => Some(true),
        mut all => {
            if all.any(|by_itself| by_itself == Some(false)) {
                Some(false)
            } else {
                None
            }
        }
    };
    let trajectories = Trajectories {
        by_itself,
        at_rest: false,
        blind: of_cells(plant, &within, claims.len()),
        everywhere: false,
        parameters: trajectories().all(|trajectories| trajectories.parameters),
    };
    Claim {
        verdict: Verdict::Proved,
        result: Some(Identifiability {
            constants,
            trajectories: Some(trajectories),
            ..Identifiability::new(Excitation::Excitation)
        }),
    }
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
fn of_cells(plant: &Plant, within: &[(Sides, Vec<BlindTrajectory>)], cells: usize) -> Vec<BlindTrajectory> {
    let key = |blind: &BlindTrajectory| (blind.condition(plant), blind.identifiable.clone());
    let mut found: Vec<BlindTrajectory> = Vec::new();
    for (sides, trajectories) in within {
        for trajectory in trajectories {
            let is_same = |others: &Vec<BlindTrajectory>| others.iter().any(|other| key(other) == key(trajectory));
            let condition = if within.iter().filter(|(_, others)| is_same(others)).count() == cells {
                trajectory.condition.clone()
            } else {
                trajectory.condition.clone().within(sides)
            };
            let trajectory = BlindTrajectory { condition, ..trajectory.clone() };
            if !found.iter().any(|other| key(other) == key(&trajectory)) {
                found.push(trajectory);
            }
        }
    }
    found
}

impl TrajectoryCondition {
    /// The condition on a cell.
    fn within(self, sides: &[(Expr, Side)]) -> Self {
        match self {
            Self::Cell(own) => Self::Cell([sides, &own].concat()),
            Self::Within(own, condition) => Self::Within([sides, &own].concat(), condition),
            condition => Self::Within(sides.to_vec(), Box::new(condition)),
        }
    }
}

/// The statements on cells, where neighbours say the same as one.
fn joined(mut blind: Vec<BlindTrajectory>) -> Vec<BlindTrajectory> {
    let neighbours = |blind: &[BlindTrajectory]| {
        for (second, other) in blind.iter().enumerate() {
            for (first, one) in blind[..second].iter().enumerate() {
                if let (TrajectoryCondition::Cell(own), TrajectoryCondition::Cell(sides)) =
                    (&one.condition, &other.condition)
                    && one.hidden == other.hidden
                    && let Some(common) = without_border(own, sides)
                {
                    return Some((first, second, common));
                }
            }
        }
        None
    };
    while let Some((first, second, sides)) = neighbours(&blind) {
        blind[first].condition = TrajectoryCondition::Cell(sides);
        blind.remove(second);
    }
    blind
}

/// The common sides of two cells, if one divider alone distinguishes them.
fn without_border(own: &[(Expr, Side)], sides: &[(Expr, Side)]) -> Option<Vec<(Expr, Side)>> {
    let common: Vec<_> = own.iter().filter(|side| sides.contains(side)).copied().collect();
    let is_apart = |side: &&(Expr, Side)| !common.contains(side);
    let (one, other) = (own.iter().find(is_apart)?, sides.iter().find(is_apart)?);
    let is_border = one.0 == other.0 && own.len() == common.len() + 1 && sides.len() == common.len() + 1;
    (is_border && !common.is_empty()).then_some(common)
}

/// The trajectories that stay between two cells, on which not all unknowns are identifiable: undecided where no rule
/// decides it.
fn on_walls(
    plant: &Plant,
    domain: &Domain,
    (cascade, regression): (&Cascade, &Regression),
    cells: &[Cell],
    (by_itself, listed): (Option<bool>, &[BlindTrajectory]),
) -> Vec<BlindTrajectory> {
    let problem = TrajectoryProblem { plant, domain, cascade, regression, unknowns: regression.eta.len() };
    let inputs: BTreeSet<Symbol> = plant.commanded().collect();
    let rows = [
        regression.phi_1.concat(),
        regression.primitive_1.concat(),
        cascade.lambda.iter().flatten().flatten().copied().collect(),
    ]
    .concat();
    let mut walls: Vec<Expr> = Vec::new();
    for (wall, _) in cells.iter().flat_map(|cell| &cell.sides) {
        if !walls.contains(wall) {
            walls.push(*wall);
        }
    }
    let at_wall = |wall: Expr| {
        let own = plant.arena.symbols_of(&[wall]);
        let mut held: BTreeSet<Symbol> =
            if by_itself == Some(true) { inputs.clone() } else { inputs.intersection(&own).copied().collect() };
        // A signal that an input drives is constant on its wall, by the input, which the rows must not hold then.
        if let Some(signal) = driven(plant, wall).filter(|_| !inputs.is_subset(&held))
            && plant.arena.symbols_of(&rows).is_disjoint(&inputs)
        {
            held.insert(signal);
        }
        problem.at_zero(wall, &held, listed).map_or_else(
            |_| vec![BlindTrajectory::undecided(TrajectoryCondition::Undecided(wall))],
            |(decided, _)| decided,
        )
    };
    plant.arena.budget().share(SHARE_OF_WALLS, || walls.into_iter().flat_map(at_wall).collect())
}

/// Tests whether inputs alone distinguish the cells: then no trajectory passes from one into another without them.
fn are_of_inputs(plant: &Plant, cells: &[Cell]) -> bool {
    let arena = &plant.arena;
    let is_known = |symbol: Symbol| plant.u.contains(&symbol) || !varies(plant, arena.of_symbol(symbol));
    let dividers = cells.iter().flat_map(|cell| &cell.sides);
    dividers.into_iter().all(|(divider, _)| arena.symbols_of(&[*divider]).into_iter().all(is_known))
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
    let mut within: Vec<(Sides, Vec<BlindTrajectory>)> = Vec::new();
    let sides = |cell: &Cell| cell.distinct_sides(arena, domain);
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
                within.extend(trajectories.map(|trajectories| (sides(cell), trajectories.blind.clone())));
            }
            Some(Excitation::Never) => blind.push(BlindTrajectory {
                condition: TrajectoryCondition::Cell(sides(cell)),
                identifiable: identifiable(arena, symbols, &decided.hidden),
                hidden: decided.hidden.clone(),
            }),
        }
        observed.push(CellRows { cell, rows: decided.rows, hidden: decided.hidden });
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
    let by_itself = if blind.len() == cells.len() { are_of_inputs(plant, &cells).then_some(false) } else { by_itself };
    blind.extend(of_cells(plant, &within, cells.len()));
    let mut blind = joined(blind);
    for wall in on_walls(plant, domain, (cascade, regression), &cells, (by_itself, &blind)) {
        if blind.iter().all(|other| other.condition(plant) != wall.condition(plant)) {
            blind.push(wall);
        }
    }
    let trajectories = Trajectories { by_itself, at_rest: false, blind, everywhere: false, parameters };
    Ok(Claim {
        verdict: Verdict::Proved,
        result: Some(Identifiability {
            constants,
            trajectories: Some(trajectories),
            ..Identifiability::new(Excitation::Excitation)
        }),
    })
}
