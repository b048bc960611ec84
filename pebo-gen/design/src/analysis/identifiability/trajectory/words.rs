//! Sentences on the necessary motion and on the trajectories that hide unknowns.

use crate::analysis::design::{BlindTrajectory, Trajectories, TrajectoryCondition};
use crate::plant::Plant;
use pebo_cas::Expr;
use pebo_cas::domain::cells::Side;

impl Trajectories {
    /// Tests whether there are cells of the domain in which not all unknowns are identifiable.
    pub fn is_divided(&self) -> bool {
        self.blind.iter().any(|blind| matches!(blind.condition, TrajectoryCondition::Cell(_)))
    }

    /// The necessary motion, in a line, and the trajectories that hide unknowns, in a line each.
    pub fn lines(&self, plant: &Plant) -> Vec<String> {
        let first = match (self.by_itself, self.at_rest, self.everywhere) {
            _ if self.is_divided() => self.of_cells(),
            (Some(true), true, true) if self.blind.is_empty() => {
                "the unknowns are identified without excitation by the inputs, even at rest"
            }
            (Some(true), true, true)
                if self
                    .blind
                    .iter()
                    .all(|blind| matches!(blind.condition, TrajectoryCondition::UndecidedAtRest(_))) =>
            {
                "the unknowns are identified without excitation by the inputs, even at rest, but for these points"
            }
            (Some(true), true, true) => {
                "the unknowns are identified without excitation by the inputs, even at rest, but for these trajectories"
            }
            (Some(true), true, false) => {
                "the unknowns are identified without excitation by the inputs on almost every trajectory, and almost wherever \
                 the plant rests"
            }
            (Some(true), false, true) => "the unknowns are identified while the plant moves, also with constant inputs",
            (Some(true), false, false) => {
                "the unknowns are identified on almost every trajectory, also with constant inputs"
            }
            (Some(false), ..) => "the unknowns are identified under excitation: keep the inputs varying",
            (None, ..) => {
                "the unknowns are identified on almost every trajectory; it was not decided whether the inputs have to vary"
            }
        };
        let blind = self.blind.iter().map(|blind| blind.line(plant));
        let parameters = (!self.parameters && !plant.parameters.is_empty())
            .then(|| "it was not worked out for which special values of the parameters this is not so".to_owned());
        let others = (!self.everywhere && !self.blind.is_empty())
            .then(|| "these were found: there may be other trajectories of this kind".to_owned());
        std::iter::once(first.to_owned()).chain(blind).chain(others).chain(parameters).collect()
    }

    /// The first line where there are cells of the domain in which not all unknowns are identifiable.
    fn of_cells(&self) -> &'static str {
        match (self.by_itself, self.at_rest) {
            (Some(true), true) => {
                "the unknowns are identified on almost every trajectory that does not stay where one of these holds"
            }
            (Some(true), false) => {
                "the unknowns are identified on almost every trajectory that neither rests nor stays where one of these holds"
            }
            (Some(false), _) => {
                "the unknowns are identified under excitation that does not stay where one of these holds: keep the inputs \
                 varying"
            }
            (None, _) => {
                "the unknowns are identified on almost every trajectory that does not stay where one of these holds; it was not \
                 decided whether the inputs have to vary"
            }
        }
    }
}

impl BlindTrajectory {
    /// The trajectory.
    pub fn condition(&self, plant: &Plant) -> String {
        self.worded(plant).replace('`', "")
    }

    /// The trajectory, with formulas as code.
    fn worded(&self, plant: &Plant) -> String {
        self.condition.worded(plant)
    }

    fn line(&self, plant: &Plant) -> String {
        let identifiable: Vec<String> =
            self.identifiable.iter().map(|e| format!("`{}`", plant.arena.print(*e))).collect();
        if self.condition.is_undecided() {
            return format!("while {}, it was not decided what is identified", self.worded(plant));
        }
        let identifiable =
            if identifiable.is_empty() { "nothing".to_owned() } else { format!("only {}", identifiable.join(", ")) };
        format!("while {}, {identifiable} is identified", self.worded(plant))
    }
}

impl TrajectoryCondition {
    /// The trajectory, with formulas as code.
    fn worded(&self, plant: &Plant) -> String {
        let arena = &plant.arena;
        match self {
            TrajectoryCondition::Equilibrium(zeros) | TrajectoryCondition::UndecidedAtRest(zeros) => {
                let zeros = zeros.iter().map(|zero| format!(" and `{} = 0`", arena.print(*zero)));
                format!("the plant rests{}", zeros.collect::<String>())
            }
            TrajectoryCondition::Constant(inputs) if inputs.len() > 1 && inputs.len() == plant.commanded().count() => {
                "all inputs are constant".to_owned()
            }
            TrajectoryCondition::Constant(inputs) => {
                let names: Vec<String> = inputs.iter().map(|input| format!("`{}`", arena.name(*input))).collect();
                format!("{} is constant", names.join(", "))
            }
            TrajectoryCondition::Value(input, value) => format!("`{} = {}`", arena.name(*input), arena.print(*value)),
            TrajectoryCondition::Steady(symbol, value) => {
                let others = match (plant.u.contains(symbol), plant.commanded().count()) {
                    (true, 0 | 1) | (false, 0) => "",
                    (true, 2) => "the other input is constant and ",
                    (true, _) => "the other inputs are constant and ",
                    (false, 1) => "the input is constant and ",
                    (false, _) => "the inputs are constant and ",
                };
                format!("{others}`{} = {}`", arena.name(*symbol), arena.print(*value))
            }
            TrajectoryCondition::Zero(zeros) => {
                zeros.iter().map(|zero| format!("`{} = 0`", arena.print(*zero))).collect::<Vec<_>>().join(" and ")
            }
            TrajectoryCondition::Undecided(zero) => format!("`{} = 0`", arena.print(*zero)),
            TrajectoryCondition::Cell(sides) => on_sides(plant, sides),
            TrajectoryCondition::Within(sides, condition) => {
                format!("{} and {}", on_sides(plant, sides), condition.worded(plant))
            }
        }
    }

    /// Tests whether its identifiability is undecided.
    fn is_undecided(&self) -> bool {
        match self {
            Self::Undecided(_) | Self::UndecidedAtRest(_) => true,
            Self::Within(_, condition) => condition.is_undecided(),
            _ => false,
        }
    }
}

/// Signs, with formulas as code.
pub fn on_sides(plant: &Plant, sides: &[(Expr, Side)]) -> String {
    let side = |(expr, side): &(Expr, Side)| format!("`{} {}`", plant.arena.print(*expr), side.sign());
    sides.iter().map(side).collect::<Vec<_>>().join(" and ")
}
