//! Measures the digits that the emitted functions keep, in `f32` and `f64`.
//!
//! In: the programs that are emitted and the formulas that they must compute. Out: for each function the
//! largest error over points of the domain, in units of the effect of rounding its arguments alone:
//! the change of the exact value when each argument and parameter varies by a relative unit roundoff, and
//! the rounding of the result. Exact values are enclosures. Holds after: a function that loses more than
//! [`MOST`] units, or is not finite where the exact value exists, is found at the points of the measurement.

mod points;

mod cause;
mod core;
mod exact;
mod moved;
mod own;
mod rounded;
mod spot;

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use super::definition::tasks::varying;
use super::definition::{Argument, Definitions, FUNCTIONS, Group, OUTPUT_SLOPES, PERIODS, TRANSFORM, VELOCITY};
use super::literal::Scalar;
use super::module::prose::section;
pub use cause::Cause;
use exact::MOST;
use moved::BITS;
use own::Own;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Arena, Expr, Rational, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::program::{Program, StagedPrograms, Task, stage};
use points::{Place, places};
use rounded::{round, run};
use spot::Spot;

/// Steps of work that a measurement may take: beyond, it takes fewer points.
const MOST_VALUES: usize = 100_000;

/// The accuracy of all functions.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "answer", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Accuracy {
    /// The number of points of the measurement.
    pub places: usize,
    /// The functions.
    pub losses: Vec<Loss>,
}

/// The loss of one function.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "answer", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Loss {
    /// The function of the runtime's `Model`.
    pub function: &'static str,
    /// In `f32`.
    pub single: Worst,
    /// In `f64`.
    pub double: Worst,
}

/// The largest error that was found.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "answer", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Worst {
    /// The error, in units of the effect of rounding the arguments; infinite if the value was not finite, which is null
    /// in JSON.
    pub units: f64,
    /// The point, as `y2 = 0.01, z1 = 0.5`.
    pub place: String,
    /// The cause of the loss.
    pub cause: Cause,
}

impl Accuracy {
    /// Losses of the author's formulas in this scalar wherever they are computed, worst first.
    pub fn cautions(&self, scalar: Scalar) -> Vec<(&'static str, &Worst)> {
        let mut found: Vec<(&'static str, &Worst)> =
            self.of(scalar).filter(|(_, worst)| worst.is_loss() && worst.cause == Cause::Model).collect();
        found.sort_by(|(_, a), (_, b)| b.units.total_cmp(&a.units));
        found
    }

    /// The losses in this scalar.
    pub fn of(&self, scalar: Scalar) -> impl Iterator<Item = (&'static str, &Worst)> {
        self.losses.iter().map(move |loss| (loss.function, loss.worst(scalar)))
    }
}

impl Worst {
    /// The computed value is a number there.
    pub fn is_finite(&self) -> bool {
        self.units.is_finite()
    }

    /// The error as a reader takes it.
    pub fn told(&self) -> String {
        if self.is_finite() { told_units(self.units) } else { "not finite".to_owned() }
    }

    /// It exceeds the loss that an author expects.
    pub(super) fn is_loss(&self) -> bool {
        self.units > MOST
    }

    /// The order of reports: a refusal before the author's loss, that before one that does not matter.
    fn rank(&self) -> (u8, f64) {
        let cause = match self.cause {
            _ if !self.is_loss() => 0,
            Cause::Small => 1,
            Cause::Model => 2,
            Cause::Form => 3,
        };
        (cause, self.units)
    }

    /// The emission is refused for it.
    pub(super) fn is_refused(&self) -> bool {
        self.is_loss() && self.cause == Cause::Form
    }
}

impl Loss {
    fn worst(&self, scalar: Scalar) -> &Worst {
        match scalar {
            Scalar::F32 => &self.single,
            Scalar::F64 => &self.double,
        }
    }

    fn worst_mut(&mut self, scalar: Scalar) -> &mut Worst {
        match scalar {
            Scalar::F32 => &mut self.single,
            Scalar::F64 => &mut self.double,
        }
    }
}

/// The points at which the functions of a plant are measured.
pub(super) struct Ground<'a> {
    plant: &'a Plant,
    spots: Vec<Spot>,
}

/// The entries of functions that lose digits somewhere, by function.
pub(super) type Losing = BTreeMap<&'static str, BTreeSet<usize>>;

impl<'a> Ground<'a> {
    /// Places of the plant's domain, with values of the arguments that the definitions name.
    pub(super) fn of(plant: &'a Plant, derivation: &Derivation, definitions: &Definitions) -> Self {
        let places = places(plant, derivation);
        let spots = places.iter().filter_map(|place| Some(Spot::new(extended(plant, definitions, place)?)));
        Self { plant, spots: spots.collect() }
    }

    /// Entries that lose digits somewhere in this scalar, the author's losses among them.
    pub(super) fn losing(&self, definitions: &Definitions, staged: &StagedPrograms, scalar: Scalar) -> Losing {
        let arena = &self.plant.arena;
        let groups = definitions.groups();
        let mut losing = Losing::new();
        for spot in self.spots(&groups) {
            let there = spot.there(scalar);
            there.prepare(arena, &measured(&groups));
            let computed = by_groups(self.plant, definitions, staged, scalar, &there.place);
            for (group, found) in groups.iter().zip(computed).filter(|(group, _)| is_measured(group)) {
                let units = there.exact(arena, &values(group)).units(&found, scalar);
                for (entry, _) in units.iter().enumerate().filter(|(_, units)| **units > MOST) {
                    losing.entry(group.name).or_default().insert(entry);
                }
            }
        }
        losing
    }

    /// A formula, computed by itself, keeps its digits wherever the equal value exists.
    pub(super) fn keeps(&self, form: Expr, value: Expr, definitions: &Definitions, scalar: Scalar) -> bool {
        let arena = &self.plant.arena;
        let parameters: Vec<Symbol> = self.plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let sampled = definitions.symbols(Argument::Y);
        let is_argument = |symbol: &Symbol| !parameters.contains(symbol) && !sampled.contains(symbol);
        let arguments: Vec<Symbol> = arena.symbols_of(&[form]).into_iter().filter(is_argument).collect();
        let task = Task { arguments: arguments.clone(), parts: Vec::new(), outputs: vec![form], is_regular: true };
        let Ok(staged) = stage(arena, &parameters, &sampled, &[task]) else { return false };
        self.spots(&definitions.groups()).iter().all(|spot| {
            let there = spot.there(scalar);
            let found =
                &computed(self.plant, &staged, (&sampled, std::slice::from_ref(&arguments)), scalar, &there.place)[0];
            there.exact(arena, &[value]).units(found, scalar).iter().all(|units| *units <= MOST)
        })
    }

    /// Measures the functions that run with every sample.
    pub(super) fn measure(&self, definitions: &Definitions, staged: &StagedPrograms) -> Accuracy {
        let Self { plant, .. } = *self;
        let groups = definitions.groups();
        let spots = self.spots(&groups);
        let functions = groups.iter().filter(|group| is_measured(group));
        let mut losses: Vec<Loss> = functions
            .map(|group| Loss { function: group.name, single: Worst::default(), double: Worst::default() })
            .collect();
        let own = OnceCell::new();
        let cause = |value: Expr, place: &Place, scalar: Scalar, units: f64| {
            own.get_or_init(|| Own::of(plant, definitions, spots)).cause(value, place, scalar, units)
        };
        for spot in spots {
            for scalar in [Scalar::F32, Scalar::F64] {
                let there = spot.there(scalar);
                there.prepare(&plant.arena, &measured(&groups));
                let computed = by_groups(plant, definitions, staged, scalar, &there.place);
                for (group, found) in groups.iter().zip(computed).filter(|(group, _)| is_measured(group)) {
                    let values = values(group);
                    let Some(loss) = losses.iter_mut().find(|loss| loss.function == group.name) else { continue };
                    let worst = loss.worst_mut(scalar);
                    let units = there.exact(&plant.arena, &values).units(&found, scalar);
                    for (&value, units) in values.iter().zip(units) {
                        // A loss that the author does not have is not to hide behind a larger one that he has.
                        let cause = if units > MOST { cause(value, &there.place, scalar, units) } else { Cause::Form };
                        let place = || told(&plant.arena, &values, &spot.place);
                        let found = Worst { units, place: String::new(), cause };
                        if found.rank() > worst.rank() {
                            *worst = Worst { place: place(), ..found };
                        }
                    }
                }
            }
        }
        Accuracy { places: spots.len(), losses }
    }

    /// The points of the measurement; the fewer, the longer the formulas are.
    fn spots(&self, groups: &[Group]) -> &[Spot] {
        let size = self.plant.arena.postorder(&measured(groups)).len().max(1);
        &self.spots[..self.spots.len().min((MOST_VALUES / size).max(4))]
    }
}

/// The formulas that are measured.
fn measured(groups: &[Group]) -> Vec<Expr> {
    groups.iter().filter(|group| is_measured(group)).flat_map(values).collect()
}

/// The function runs with every sample, and its digits count: the observer subtracts with the slopes what it adds with them,
/// so that their errors weigh as much as the difference between a sample and its expectation.
fn is_measured(group: &Group) -> bool {
    ![VELOCITY, PERIODS, FUNCTIONS, TRANSFORM, OUTPUT_SLOPES, "theta"].contains(&group.name)
}

/// The formulas of a group.
fn values(group: &Group) -> Vec<Expr> {
    group.members.iter().flat_map(|member| member.rows.concat()).collect()
}

/// A point with values of the transform, the extension and the fundamental matrix.
fn extended(plant: &Plant, definitions: &Definitions, place: &Place) -> Option<Place> {
    let exact = intervals(place.iter().map(|(&symbol, &value)| (symbol, value)))?;
    let mut extended = place.clone();
    let transform = plant.arena.enclose_over(&plant.transform(), &exact, Precision::new(BITS))?;
    for ((z, chi), value) in definitions.symbols(Argument::Z).into_iter().zip(&definitions.chi).zip(transform) {
        let value = round(Scalar::F32, value.lo());
        extended.insert(z, value);
        // Half of z is known and half is not.
        extended.insert(*chi, 0.5 * value);
    }
    for (column, entries) in definitions.psi.iter().enumerate() {
        for (row, &entry) in entries.iter().enumerate() {
            // Near the identity, where it starts, and nowhere zero.
            let k = u8::try_from((3 * row + 5 * column) % 7).unwrap_or(0);
            extended.insert(entry, f64::from(u8::from(row == column)) + f64::from(k + 1) / 16.0);
        }
    }
    for symbol in definitions.symbols(Argument::Y).into_iter().chain(definitions.symbols(Argument::U)) {
        // A signal on which nothing depends.
        extended.entry(symbol).or_insert(1.0);
    }
    Some(extended)
}

/// The results of the functions of groups at a point, group by group.
fn by_groups(
    plant: &Plant,
    definitions: &Definitions,
    staged: &StagedPrograms,
    scalar: Scalar,
    place: &Place,
) -> Vec<Vec<f64>> {
    let groups = definitions.groups();
    let arguments = groups.iter().map(|group| varying(&group.arguments).flat_map(|a| definitions.symbols(a)).collect());
    let arguments: Vec<Vec<Symbol>> = arguments.collect();
    computed(plant, staged, (&definitions.symbols(Argument::Y), &arguments), scalar, place)
}

/// The results of programs at a point, for the sampled symbols and the arguments of each.
fn computed(
    plant: &Plant,
    staged: &StagedPrograms,
    (sampled, arguments): (&[Symbol], &[Vec<Symbol>]),
    scalar: Scalar,
    place: &Place,
) -> Vec<Vec<f64>> {
    let of = |symbols: &[Symbol]| symbols.iter().map(|symbol| place.get(symbol).copied().unwrap_or(1.0)).collect();
    let parameters: Vec<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let parameters: Vec<f64> = of(&parameters);
    let mut inputs = run(&staged.setup, scalar, &parameters);
    let outputs: Vec<f64> = of(sampled);
    inputs.extend(outputs);
    let terms = run(&staged.sample, scalar, &inputs);
    inputs.extend(terms);
    let program = |(symbols, program): (&Vec<Symbol>, &Program)| {
        let arguments: Vec<f64> = of(symbols);
        run(program, scalar, &[inputs.as_slice(), &arguments].concat())
    };
    arguments.iter().zip(&staged.programs).map(program).collect()
}

/// Values as intervals.
fn intervals(values: impl Iterator<Item = (Symbol, f64)>) -> Option<BTreeMap<Symbol, Interval>> {
    let interval = |value| Interval::from_rational(&Rational::from_f64_exact(value)?, Precision::new(BITS));
    values.map(|(symbol, value)| Some((symbol, interval(value)?))).collect()
}

/// The section of the module's documentation.
pub(super) fn lines(accuracy: &Accuracy) -> Vec<String> {
    let mut lines = section("Accuracy");
    if accuracy.places == 0 {
        lines.push("Not measured: no point of the domain was found.".to_owned());
        return lines;
    }
    lines.push(format!(
        "The largest error at {} places of the domain, in units of what rounding of the arguments alone causes, up to the \
         next power of two:",
        accuracy.places
    ));
    lines.extend(["", "| function | `f32` | `f64` |", "|---|---|---|"].map(str::to_owned));
    for loss in &accuracy.losses {
        lines.push(format!("| `{}` | {} | {} |", loss.function, loss.single.told(), loss.double.told()));
    }
    for loss in &accuracy.losses {
        for (scalar, worst) in [(Scalar::F32, &loss.single), (Scalar::F64, &loss.double)] {
            if worst.is_loss() {
                let cause = match worst.cause {
                    Cause::Form => "",
                    Cause::Model => ", by a part that the model's own formulas have",
                    Cause::Small => ", where it is small: the error is a rounding of what it is elsewhere",
                };
                let (function, scalar, place) = (loss.function, scalar.name(), &worst.place);
                lines.extend([String::new(), format!("`{function}` loses digits in `{scalar}` at {place}{cause}.")]);
            }
        }
    }
    lines
}

/// The next power of two: the last digits of a largest error are those of the host's functions.
pub(super) fn told_units(units: f64) -> String {
    units.max(1.0).log2().ceil().exp2().to_string()
}

/// A number of `f32` in as few letters as tell it.
fn number(value: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "places are in numbers of f32")]
    let value = value as f32;
    let (plain, short) = (value.to_string(), format!("{value:e}"));
    if short.len() < plain.len() { short } else { plain }
}

/// A point in text: the values of the formulas' symbols.
fn told(arena: &Arena, exprs: &[Expr], place: &Place) -> String {
    let symbols = arena.symbols_of(exprs);
    let values = place.iter().filter(|(symbol, _)| symbols.contains(symbol));
    let values: Vec<String> =
        values.map(|(symbol, value)| format!("{} = {}", arena.name(*symbol), number(*value))).collect();
    values.join(", ")
}
