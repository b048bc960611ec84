//! How many digits the emitted functions keep, in `f32` and `f64`.
//!
//! In: the programs that are emitted and the formulas that they must compute. Out: for each function the
//! largest error over places of the domain, in units of what rounding of its arguments alone would cause:
//! the change of the exact value when each argument and parameter moves by a relative unit roundoff, and
//! the rounding of the result. Exact values are enclosures. Holds after: a function that loses more than
//! [`MOST`] units, or is not finite where the exact value exists, is found out at the places looked at.

mod cause;
mod core;
mod exact;
mod moved;
mod own;
mod places;
mod rounded;

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::definition::{Argument, Definitions, Group, VELOCITY};
use super::literal::Scalar;
use super::prose::section;
use super::tasks::varying;
use crate::analysis::Derivation;
use crate::cas::interval::{Interval, Precision};
use crate::cas::rational::Rational;
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;
use crate::program::{Program, Staged};
pub use cause::Cause;
use exact::{MOST, exact};
use moved::BITS;
use own::Own;
use places::{Place, places};
use rounded::{round, run};

/// Steps of work that a measurement may take: beyond, fewer places are looked at.
const MOST_VALUES: usize = 100_000;

/// The accuracy of all functions.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Accuracy {
    /// How many places were looked at.
    pub places: usize,
    /// The functions.
    pub losses: Vec<Loss>,
}

/// What one function loses.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
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
#[cfg_attr(feature = "yaml", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Worst {
    /// The error, in units of what rounding of the arguments causes; infinite if the value was not finite, which is
    /// null in JSON.
    pub units: f64,
    /// Where, as `y2 = 0.01, z1 = 0.5`.
    pub place: String,
    /// Whose loss it is.
    pub cause: Cause,
}

impl Accuracy {
    /// What the author's formulas lose in this scalar wherever they are computed, worst first.
    pub fn cautions(&self, scalar: Scalar) -> Vec<(&'static str, &Worst)> {
        let mut found: Vec<(&'static str, &Worst)> =
            self.of(scalar).filter(|(_, worst)| worst.is_loss() && worst.cause == Cause::Model).collect();
        found.sort_by(|(_, a), (_, b)| b.units.total_cmp(&a.units));
        found
    }

    /// What is lost in this scalar.
    pub fn of(&self, scalar: Scalar) -> impl Iterator<Item = (&'static str, &Worst)> {
        self.losses.iter().map(move |loss| (loss.function, loss.worst(scalar)))
    }
}

impl Worst {
    /// Whether the value itself is a number there.
    pub fn is_finite(&self) -> bool {
        self.units.is_finite()
    }

    /// The error as a reader takes it.
    pub fn told(&self) -> String {
        if self.is_finite() { told_units(self.units) } else { "not finite".to_owned() }
    }

    /// Whether digits are lost that no author expects to lose.
    pub(super) fn is_loss(&self) -> bool {
        self.units > MOST
    }

    /// What is told before what: a refusal before the author's loss, that before one that does not matter.
    fn rank(&self) -> (u8, f64) {
        let cause = match self.cause {
            _ if !self.is_loss() => 0,
            Cause::Small => 1,
            Cause::Model => 2,
            Cause::Form => 3,
        };
        (cause, self.units)
    }

    /// Whether the emission is refused for it.
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

/// Where the functions of a plant are measured.
pub(super) struct Ground<'a> {
    plant: &'a Plant,
    places: Vec<Place>,
}

impl<'a> Ground<'a> {
    /// Places of the plant's domain.
    pub(super) fn of(plant: &'a Plant, derivation: &Derivation) -> Self {
        Self { plant, places: places(plant, derivation) }
    }

    /// The functions that lose digits somewhere in this scalar, the author's losses among them.
    pub(super) fn losing(&self, definitions: &Definitions, staged: &Staged, scalar: Scalar) -> Vec<&'static str> {
        let groups = definitions.groups();
        let mut losing: Vec<&'static str> = Vec::new();
        for place in self.places(definitions, &groups) {
            let there = in_all_digits(scalar, &place);
            let computed = computed(self.plant, definitions, staged, scalar, &there);
            for (group, found) in groups.iter().zip(computed).filter(|(group, _)| is_measured(group)) {
                let is_new = !losing.contains(&group.name);
                if is_new
                    && exact(&self.plant.arena, &values(group), &there).units(&found, scalar).iter().any(|u| *u > MOST)
                {
                    losing.push(group.name);
                }
            }
        }
        losing
    }

    /// Measures the functions that run with every sample.
    pub(super) fn measure(&self, definitions: &Definitions, staged: &Staged) -> Accuracy {
        let Self { plant, .. } = *self;
        let groups = definitions.groups();
        let places = self.places(definitions, &groups);
        let functions = groups.iter().filter(|group| is_measured(group));
        let mut losses: Vec<Loss> = functions
            .map(|group| Loss { function: group.name, single: Worst::default(), double: Worst::default() })
            .collect();
        let own = OnceCell::new();
        let cause = |value: Expr, place: &Place, scalar: Scalar, units: f64| {
            own.get_or_init(|| Own::of(plant, definitions, &places)).cause(value, place, scalar, units)
        };
        for place in &places {
            for scalar in [Scalar::F32, Scalar::F64] {
                let there = &in_all_digits(scalar, place);
                let computed = computed(plant, definitions, staged, scalar, there);
                for (group, found) in groups.iter().zip(computed).filter(|(group, _)| is_measured(group)) {
                    let values = values(group);
                    let Some(loss) = losses.iter_mut().find(|loss| loss.function == group.name) else { continue };
                    let worst = loss.worst_mut(scalar);
                    for (&value, units) in values.iter().zip(exact(&plant.arena, &values, there).units(&found, scalar))
                    {
                        // A loss that the author does not have is not to hide behind a larger one that he has.
                        let cause = if units > MOST { cause(value, there, scalar, units) } else { Cause::Form };
                        let place = || told(&plant.arena, &values, place);
                        let found = Worst { units, place: String::new(), cause };
                        if found.rank() > worst.rank() {
                            *worst = Worst { place: place(), ..found };
                        }
                    }
                }
            }
        }
        Accuracy { places: places.len(), losses }
    }

    /// The places with values of all arguments; the fewer, the longer the formulas are.
    fn places(&self, definitions: &Definitions, groups: &[Group]) -> Vec<Place> {
        let exprs: Vec<Expr> = groups.iter().filter(|group| is_measured(group)).flat_map(values).collect();
        let size = self.plant.arena.postorder(&exprs).len().max(1);
        let places = self.places.iter().take((MOST_VALUES / size).max(4));
        places.filter_map(|place| extended(self.plant, definitions, place)).collect()
    }
}

/// Whether a function runs with every sample.
fn is_measured(group: &Group) -> bool {
    group.name != VELOCITY && group.name != "theta"
}

/// The formulas of a group.
fn values(group: &Group) -> Vec<Expr> {
    group.members.iter().flat_map(|member| member.rows.concat()).collect()
}

/// A place with values of the transform, the extension and the fundamental matrix.
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

/// The place in numbers with all digits of the scalar, but for 0, 1 and -1: sums and products of numbers of `f32` are exact
/// in `f64`, so that these would hide what is lost there.
fn in_all_digits(scalar: Scalar, place: &Place) -> Place {
    /// Beyond the last digit of `f32`.
    const BEYOND: f64 = 1.0 / 33_554_432.0;
    /// No two numbers move alike.
    const TURN: f64 = 0.618_033_988_749_894_9;
    if scalar == Scalar::F32 {
        return place.clone();
    }
    let mut part = 0.0;
    let moved = place.iter().map(|(&symbol, &value)| {
        part = (part + TURN) % 1.0;
        (symbol, if [1.0, -1.0].contains(&value) { value } else { value * (1.0 + BEYOND * part) })
    });
    moved.collect()
}

/// What the programs give at a place, group by group.
fn computed(plant: &Plant, definitions: &Definitions, staged: &Staged, scalar: Scalar, place: &Place) -> Vec<Vec<f64>> {
    let of = |symbols: &[Symbol]| symbols.iter().map(|symbol| place.get(symbol).copied().unwrap_or(1.0)).collect();
    let parameters: Vec<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let parameters: Vec<f64> = of(&parameters);
    let mut inputs = run(&staged.setup, scalar, &parameters);
    let outputs: Vec<f64> = of(&definitions.symbols(Argument::Y));
    inputs.extend(outputs);
    let terms = run(&staged.sample, scalar, &inputs);
    inputs.extend(terms);
    let program = |(group, program): (&Group, &Program)| {
        let symbols: Vec<Symbol> = varying(&group.arguments).flat_map(|a| definitions.symbols(a)).collect();
        let arguments: Vec<f64> = of(&symbols);
        run(program, scalar, &[inputs.as_slice(), &arguments].concat())
    };
    definitions.groups().iter().zip(&staged.programs).map(program).collect()
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

/// A place as a reader takes it: what the formulas depend on.
fn told(arena: &Arena, exprs: &[Expr], place: &Place) -> String {
    let symbols = arena.symbols_of(exprs);
    let values = place.iter().filter(|(symbol, _)| symbols.contains(symbol));
    let values: Vec<String> =
        values.map(|(symbol, value)| format!("{} = {}", arena.name(*symbol), number(*value))).collect();
    values.join(", ")
}
