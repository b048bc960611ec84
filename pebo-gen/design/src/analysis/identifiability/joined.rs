//! Joins the claims on the cells of a domain.
//!
//! In: claims, each on a cell on which the unknowns are identified over time or at every instant. Out: the weakest of
//! them for the whole domain, with the trajectories of each cell on which not all unknowns are identifiable.

use crate::analysis::design::{
    BlindTrajectory, Claim, Excitation, Identifiability, InputCourses, Trajectories, Verdict,
};
use crate::plant::Plant;
use pebo_cas::Expr;
use pebo_cas::domain::cells::{Side, wall_between};

use super::special::SpecialValues;

/// Dividers with their signs.
type Sides = Vec<(Expr, Side)>;

/// The claims so far.
pub(super) struct Joined {
    /// Combinations of the parameters that must not be zero.
    pub(super) constants: Vec<Expr>,
    /// True if the conditions on the parameters are complete.
    parameters: bool,
    /// True if no input has to move.
    pub(super) by_itself: Option<bool>,
    /// The trajectories within cells.
    within: Vec<(Sides, Vec<BlindTrajectory>)>,
    /// Trajectories on the whole domain.
    pub(super) blind: Vec<BlindTrajectory>,
}

impl Joined {
    pub(super) fn new() -> Self {
        Self { constants: Vec::new(), parameters: true, by_itself: Some(true), within: Vec::new(), blind: Vec::new() }
    }

    /// Adds the claim on a cell.
    pub(super) fn add(&mut self, result: &Identifiability, sides: impl FnOnce() -> Sides) {
        for constant in &result.constants {
            if !self.constants.contains(constant) {
                self.constants.push(*constant);
            }
        }
        if let Some(Trajectories { by_itself, blind, parameters, .. }) = &result.trajectories {
            let is_false = [self.by_itself, *by_itself].contains(&Some(false));
            self.by_itself = if is_false { Some(false) } else { self.by_itself.and(*by_itself) };
            self.parameters &= parameters;
            self.within.push((sides(), blind.clone()));
        }
    }

    /// Adds conditions on the parameters.
    pub(super) fn exclude(&mut self, special: SpecialValues) {
        self.parameters &= special.complete;
        let is_new = |combination: &Expr| !self.constants.contains(combination);
        let new: Vec<Expr> = special.nonzero.into_iter().filter(is_new).collect();
        self.constants.extend(new);
    }

    /// Adds the trajectories within so many cells to those on the whole domain: of all cells at once, where all have
    /// the same.
    pub(super) fn add_cells(&mut self, plant: &Plant, cells: usize) {
        let key = |blind: &BlindTrajectory| (blind.condition(plant), blind.identifiable.clone());
        let mut found: Vec<BlindTrajectory> = Vec::new();
        for (sides, trajectories) in &self.within {
            for trajectory in trajectories {
                let is_same = |others: &Vec<BlindTrajectory>| others.iter().any(|other| key(other) == key(trajectory));
                let mut trajectory = trajectory.clone();
                if self.within.iter().filter(|(_, others)| is_same(others)).count() < cells {
                    trajectory.condition.sides.splice(0..0, sides.iter().copied());
                }
                if !found.iter().any(|other| key(other) == key(&trajectory)) {
                    found.push(trajectory);
                }
            }
        }
        self.blind.append(&mut found);
        self.within.clear();
    }

    /// Makes one statement of those that neighbouring cells have in common.
    pub(super) fn join_neighbours(&mut self) {
        while let Some((first, second, sides)) = self.neighbours() {
            self.blind[first].condition.sides = sides;
            self.blind.remove(second);
        }
    }

    /// Two cells that hide the same, with the sides of both.
    fn neighbours(&self) -> Option<(usize, usize, Sides)> {
        let cells =
            || self.blind.iter().enumerate().filter_map(|(index, blind)| Some((index, blind.cell()?, &blind.hidden)));
        cells().find_map(|(second, sides, hidden)| {
            let mut others = cells().take_while(|(first, ..)| *first < second).filter(|(.., other)| *other == hidden);
            others.find_map(|(first, own, _)| Some((first, second, without_wall(own, sides)?)))
        })
    }

    /// The claim on the domain.
    pub(super) fn claim(mut self, plant: &Plant, cells: usize) -> Claim<Identifiability> {
        self.add_cells(plant, cells);
        let Self { constants, parameters, by_itself, blind, .. } = self;
        // Of cells that hide unknowns, and of the paths between cells, other courses were not worked out.
        let courses = InputCourses::Constant;
        let trajectories = Trajectories { by_itself, courses, at_rest: false, blind, everywhere: false, parameters };
        Claim {
            verdict: Verdict::Proved,
            result: Some(Identifiability {
                constants,
                trajectories: Some(trajectories),
                ..Identifiability::new(Excitation::Excitation)
            }),
        }
    }
}

/// The common sides of two cells, if one divider alone distinguishes them.
fn without_wall(own: &[(Expr, Side)], sides: &[(Expr, Side)]) -> Option<Sides> {
    wall_between(own, sides)?;
    let common: Sides = own.iter().filter(|side| sides.contains(side)).copied().collect();
    let is_whole = [own, sides].iter().all(|all| all.len() == common.len() + 1);
    (is_whole && !common.is_empty()).then_some(common)
}
