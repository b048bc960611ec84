//! Sentences on the necessary motion and on the trajectories that hide unknowns.

use std::collections::BTreeMap;

use crate::analysis::design::{BlindTrajectory, Determined, InputCourses, Still, Trajectories, TrajectoryCondition};
use crate::analysis::identifiability::flow::varies;
use crate::plant::Plant;
use crate::source::{counted, listed};
use pebo_cas::domain::cells::Side;
use pebo_cas::{Expr, Node, Symbol};

/// Characters of a combination of unknowns up to which it is written: in a longer one a reader finds nothing.
const LONGEST: usize = 120;

impl Trajectories {
    /// Tests whether there are cells of the domain in which not all unknowns are identifiable.
    pub fn is_divided(&self) -> bool {
        self.blind.iter().any(|blind| blind.cell().is_some())
    }

    /// The necessary motion, in a line, and the trajectories that hide unknowns, in a line each.
    pub fn lines(&self, plant: &Plant) -> Vec<String> {
        let has_no_inputs = plant.commanded().next().is_none();
        let are_points = self.blind.iter().all(|blind| !blind.is_decided() && blind.is_at_rest());
        let first = match (self.by_itself, self.at_rest, self.everywhere) {
            _ if self.is_divided() => self.of_cells(),
            (Some(true), true, true) if self.courses == InputCourses::Constant && self.blind.is_empty() => {
                "with constant inputs the unknowns are identified, even at rest, with others on almost every trajectory"
            }
            (Some(true), true, true) if self.courses == InputCourses::Constant => {
                "with constant inputs the unknowns are identified, even at rest, but for what follows; with others on almost \
                 every trajectory"
            }
            (Some(true), true, true) if self.blind.is_empty() => {
                "the unknowns are identified without excitation by the inputs, even at rest"
            }
            (Some(true), true, true) if are_points => {
                "the unknowns are identified without excitation by the inputs, even at rest, but for these points"
            }
            (Some(true), true, true) => {
                "the unknowns are identified without excitation by the inputs, even at rest, but for these trajectories"
            }
            (Some(true), true, false) => {
                "the unknowns are identified without excitation by the inputs on almost every trajectory, and almost wherever \
                 the plant rests"
            }
            (Some(true), false, true) if has_no_inputs => "the unknowns are identified while the plant moves",
            (Some(true), false, true) if self.courses == InputCourses::All => {
                "the unknowns are identified without excitation by the inputs while the plant moves"
            }
            // A course of the inputs may keep a plant where it hides unknowns, as a current that is controlled does.
            (Some(true), false, true) => {
                "with constant inputs the unknowns are identified while the plant moves, with others on almost every trajectory"
            }
            (Some(true), false, false) if has_no_inputs => "the unknowns are identified on almost every trajectory",
            (Some(true), false, false) => {
                "the unknowns are identified on almost every trajectory, also with constant inputs"
            }
            (Some(false), ..) => "the unknowns are identified under excitation: keep the inputs varying",
            (None, ..) => {
                "the unknowns are identified on almost every trajectory; it was not decided whether the inputs have to vary"
            }
        };
        let (decided, open): (Vec<_>, Vec<_>) = self.blind.iter().partition(|blind| blind.is_decided());
        let blind = decided.into_iter().map(|blind| blind.line(plant)).chain(undecided(plant, &open));
        let parameters = (!self.parameters && !plant.parameters.is_empty())
            .then(|| "it was not worked out for which special values of the parameters this is not so".to_owned());
        let others = (!self.everywhere).then(|| match self.blind.as_slice() {
            [] => "trajectories that hide unknowns were not worked out: there may be some".to_owned(),
            _ => "these were found: there may be other trajectories of this kind".to_owned(),
        });
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

/// The lines on trajectories of which nothing was decided: several at which one formula is zero in one.
fn undecided(plant: &Plant, open: &[&BlindTrajectory]) -> Vec<String> {
    let line = |condition: String| format!("while {condition}, it was not decided what is identified");
    let is_plain = |blind: &&&BlindTrajectory| {
        let TrajectoryCondition { sides, still, zeros } = &blind.condition;
        sides.is_empty() && *still == Still::Nothing && zeros.len() == 1
    };
    let plain: Vec<String> = open.iter().filter(is_plain).map(|blind| blind.condition.worded(plant)).collect();
    if plain.len() < MANY {
        return open.iter().map(|blind| line(blind.condition.worded(plant))).collect();
    }
    let others = open.iter().filter(|blind| !is_plain(blind)).map(|blind| line(blind.condition.worded(plant)));
    std::iter::once(line(format!("one of {} holds", plain.join(", ")))).chain(others).collect()
}

/// So many lines of one kind are one: a table has one for each point.
const MANY: usize = 4;

impl BlindTrajectory {
    /// The trajectory.
    pub fn condition(&self, plant: &Plant) -> String {
        self.condition.worded(plant).replace('`', "")
    }

    /// Its cell, if it is a statement on all of it.
    pub(in crate::analysis::identifiability) fn cell(&self) -> Option<&Vec<(Expr, Side)>> {
        let TrajectoryCondition { sides, still, zeros } = &self.condition;
        (*still == Still::Nothing && zeros.is_empty()).then_some(sides)
    }

    /// The identifiable combinations of the unknowns; and those whose factors depend on unmeasured states: each stands
    /// for a function that changes as it does.
    pub fn combinations(&self, plant: &Plant) -> (Vec<Expr>, Vec<Expr>) {
        let hidden = plant.hidden();
        self.identifiable.iter().partition(|combination| !plant.arena.depends_on(**combination, &hidden))
    }

    fn is_at_rest(&self) -> bool {
        self.condition.still == Still::Plant
    }

    fn line(&self, plant: &Plant) -> String {
        let condition = self.condition.worded(plant);
        let (known, mut of_states) = self.combinations(plant);
        let (short, long): (Vec<Expr>, Vec<Expr>) =
            known.into_iter().partition(|combination| plant.arena.print(*combination).len() <= LONGEST);
        of_states.extend(long);
        let mut identifiable: Vec<String> = short.iter().map(|e| format!("`{}`", plant.arena.print(*e))).collect();
        if !of_states.is_empty() {
            let is_unknown = |symbol: &Symbol| !plant.declares(*symbol) && !plant.is_of_extension(*symbol);
            let unknowns = plant.arena.symbols_of(&of_states).into_iter().filter(is_unknown);
            let unknowns: Vec<String> = unknowns.map(|symbol| plant.arena.name(symbol)).collect();
            let count = counted(of_states.len(), "function");
            identifiable.push(format!("{count} of {}", listed(unknowns.iter().map(String::as_str))));
        }
        let identifiable =
            if identifiable.is_empty() { "nothing".to_owned() } else { format!("only {}", identifiable.join(", ")) };
        let are_several = self.identifiable.len() > 1;
        let (verb, determines) = if are_several { ("are", "determine") } else { ("is", "determines") };
        let determined = match &self.determined {
            Determined::Nothing => None,
            Determined::Theta => Some("theta".to_owned()),
            Determined::States(states) => {
                let names: Vec<String> = states.iter().map(|state| plant.arena.name(*state)).collect();
                Some(listed(names.iter().map(String::as_str)))
            }
        };
        let rest = determined.map(|known| format!(", which {determines} {known} near almost every value"));
        let rest = rest.unwrap_or_default();
        format!("while {condition}, {identifiable} {verb} identified{rest}")
    }
}

impl TrajectoryCondition {
    /// The sides that the zeros leave open: of `ph > 0` and `ph = 1` the second says all.
    fn sides_beside_zeros(&self, plant: &Plant) -> Vec<(Expr, Side)> {
        let arena = &plant.arena;
        let values = self.zeros.iter().filter_map(|zero| solved(plant, *zero)).collect();
        let is_open = |(divider, side): &&(Expr, Side)| {
            let there = arena.substitute(side.positive(arena, *divider), &values);
            !arena.symbols_of(&[there]).is_empty()
                || !arena.separated_from_zero(there, &BTreeMap::new()).is_some_and(|value| value.is_positive())
        };
        self.sides.iter().filter(is_open).copied().collect()
    }

    /// The trajectory, with formulas as code.
    fn worded(&self, plant: &Plant) -> String {
        let still = match &self.still {
            Still::Nothing => None,
            Still::Inputs(inputs) if inputs.len() > 1 && inputs.len() == plant.commanded().count() => {
                Some("all inputs are constant".to_owned())
            }
            Still::Inputs(inputs) => {
                let names: Vec<String> = inputs.iter().map(|input| format!("`{}`", plant.arena.name(*input))).collect();
                let verb = if names.len() > 1 { "are" } else { "is" };
                Some(format!("{} {verb} constant", names.join(", ")))
            }
            Still::Plant => Some("the plant rests".to_owned()),
        };
        let sides = self.sides_beside_zeros(plant);
        let sides = (!sides.is_empty()).then(|| on_sides(plant, &sides));
        let mut parts: Vec<String> = sides.into_iter().chain(still).collect();
        for zero in &self.zeros {
            let part = format!("`{}`", equation(plant, *zero));
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
        parts.join(" and ")
    }
}

/// A symbol, a signal if there is one, whose value a zero makes a number or another symbol; with that value.
fn solved(plant: &Plant, zero: Expr) -> Option<(Symbol, Expr)> {
    let arena = &plant.arena;
    if let Some(symbol) = arena.as_symbol(zero) {
        return Some((symbol, arena.zero()));
    }
    let Node::Sum(sum) = arena.node(zero) else { return None };
    sum.terms.iter().find_map(|(term, slope)| {
        let symbol = arena.as_symbol(*term).filter(|_| varies(plant, *term) == varies(plant, zero))?;
        let value = arena.sub(*term, arena.scale(zero, &slope.recip()?));
        (arena.as_symbol(value).is_some() || arena.symbols_of(&[value]).is_empty()).then_some((symbol, value))
    })
}

/// The equation of a zero, for a symbol if it gives one.
fn equation(plant: &Plant, zero: Expr) -> String {
    let arena = &plant.arena;
    match solved(plant, zero) {
        Some((symbol, value)) => format!("{} = {}", arena.name(symbol), arena.print(value)),
        None => format!("{} = 0", arena.print(zero)),
    }
}

/// The side of a number on which a symbol is, if the sign is of the two: `soc > 0.8`.
fn threshold(plant: &Plant, expr: Expr, side: Side) -> Option<String> {
    let arena = &plant.arena;
    let Node::Sum(sum) = arena.node(expr) else { return None };
    let [(term, slope)] = sum.terms.as_slice() else { return None };
    arena.as_symbol(*term)?;
    let at = arena.number(-&sum.constant.checked_div(slope)?);
    let is_above = (side == Side::Positive) != slope.is_negative();
    Some(format!("{} {} {}", arena.print(*term), if is_above { ">" } else { "<" }, arena.print(at)))
}

/// Signs, with formulas as code.
pub fn on_sides(plant: &Plant, sides: &[(Expr, Side)]) -> String {
    let side = |(expr, side): &(Expr, Side)| match threshold(plant, *expr, *side) {
        Some(threshold) => format!("`{threshold}`"),
        None => format!("`{} {}`", plant.arena.print(*expr), side.sign()),
    };
    sides.iter().map(side).collect::<Vec<_>>().join(" and ")
}
