//! How many digits the emitted functions keep, in `f32` and `f64`.
//!
//! In: the programs that are emitted and the formulas that they must compute. Out: for each function the
//! largest error over places of the domain, in units of what rounding of its arguments alone would cause:
//! the change of the exact value when each argument and parameter moves by a relative unit roundoff, and
//! the rounding of the result. Exact values are enclosures. Holds after: a function that loses more than
//! [`MOST`] units, or is not finite where the exact value exists, is found out at the places looked at.

mod places;
mod rounded;

use std::collections::{BTreeMap, BTreeSet};

use super::definition::{Argument, Definitions, Group, VELOCITY};
use super::literal::Scalar;
use super::prose::section;
use super::tasks::varying;
use crate::analysis::Derivation;
use crate::cas::interval::{Interval, Precision};
use crate::cas::rational::Rational;
use crate::cas::{Arena, Expr, Node, Symbol};
use crate::plant::Plant;
use crate::program::{Program, Staged, lower};
use places::{Place, places};
use rounded::{round, run};

/// More units are a loss that no author expects.
pub(super) const MOST: f64 = 100.0;

/// A loss up to so many times that of the author's formulas is theirs: a function that is made of several of them, as the
/// rate of phi, adds up a few.
const LIKE: f64 = 4.0;

/// Bits of the enclosures: those of `f64`, and as many to be lost.
const BITS: u32 = 128;

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
    /// Whether the author's own formulas, computed so, lose as much there.
    pub as_written: bool,
}

impl Accuracy {
    /// What is lost in this scalar.
    pub fn of(&self, scalar: Scalar) -> impl Iterator<Item = (&'static str, &Worst)> {
        self.losses.iter().map(move |loss| (loss.function, loss.worst(scalar)))
    }
}

impl Worst {
    /// The error as a reader takes it.
    pub fn told(&self) -> String {
        if self.units.is_finite() { told_units(self.units) } else { "not finite".to_owned() }
    }

    /// Whether the emission is refused for it.
    pub(super) fn is_refused(&self) -> bool {
        self.units > MOST && !self.as_written
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

/// Measures the functions that run with every sample.
pub(super) fn measure(plant: &Plant, derivation: &Derivation, definitions: &Definitions, staged: &Staged) -> Accuracy {
    let arena = &plant.arena;
    let groups = definitions.groups();
    let measured = |group: &Group| group.name != VELOCITY && group.name != "theta";
    let exprs: Vec<Expr> = groups.iter().filter(|group| measured(group)).flat_map(values).collect();
    let size = arena.postorder(&exprs).len().max(1);
    let mut places = places(plant, derivation);
    places.truncate((MOST_VALUES / size).max(4));
    let functions = groups.iter().filter(|group| measured(group));
    let mut losses: Vec<Loss> = functions
        .map(|group| Loss { function: group.name, single: Worst::default(), double: Worst::default() })
        .collect();
    let mut looked_at = 0;
    for place in &places {
        let Some(place) = extended(plant, definitions, place) else { continue };
        looked_at += 1;
        for scalar in [Scalar::F32, Scalar::F64] {
            let computed = computed(plant, definitions, staged, scalar, &place);
            for (group, found) in groups.iter().zip(computed).filter(|(group, _)| measured(group)) {
                let units = exact(arena, &values(group), &place).units(&found, scalar);
                let Some(loss) = losses.iter_mut().find(|loss| loss.function == group.name) else { continue };
                let worst = loss.worst_mut(scalar);
                let as_written = units > MOST && LIKE * own_units(plant, &values(group), &place, scalar) >= units;
                let found = Worst { units, place: told(arena, &values(group), &place), as_written };
                // A loss that the author does not have is not to hide behind a larger one that he has.
                if (found.is_refused(), units) > (worst.is_refused(), worst.units) {
                    *worst = found;
                }
            }
        }
    }
    Accuracy { places: looked_at, losses }
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

/// The most units that the author's own formulas lose at a place, and those of their sums that the values hold: a factor
/// `exp(u) - 1` loses digits that nobody misses in the rate which the author has it in.
fn own_units(plant: &Plant, values: &[Expr], place: &Place, scalar: Scalar) -> f64 {
    let arena = &plant.arena;
    let mut own: Vec<Expr> = plant.rates().into_values().chain(plant.transform()).collect();
    let written: BTreeSet<Expr> = arena.postorder(&own).into_iter().collect();
    let is_written = |part: &Expr| written.contains(part) || written.contains(&arena.neg(*part));
    let sums = arena.postorder(values).into_iter().filter(|part| matches!(arena.node(*part), Node::Sum(_)));
    own.extend(sums.filter(is_written));
    let symbols: Vec<Symbol> = arena.symbols_of(&own).into_iter().collect();
    let inputs: Option<Vec<f64>> = symbols.iter().map(|symbol| place.get(symbol).copied()).collect();
    let (Some(inputs), Ok(program)) = (inputs, lower(arena, &symbols, &own)) else { return 0.0 };
    exact(arena, &own, place).units(&run(&program, scalar, &inputs), scalar)
}

/// Exact values at a place, and how much they move when all that they depend on is rounded.
struct Exact {
    values: Vec<Option<(Interval, f64)>>,
}

/// The relative move of the arguments by which their effect is found.
const MOVE: f64 = 1.0 / 1_073_741_824.0;

fn exact(arena: &Arena, exprs: &[Expr], place: &Place) -> Exact {
    let symbols: Vec<Symbol> = arena.symbols_of(exprs).into_iter().collect();
    let at = |moved: Option<Symbol>| {
        let entry = |symbol: &Symbol| {
            // In full: value (1 + part) has more digits than a number of f64.
            let value = Rational::from_f64_exact(place.get(symbol).copied().unwrap_or(1.0))?;
            let part = Rational::from_f64_exact(if moved == Some(*symbol) { MOVE } else { 0.0 })?;
            let moved = &value + &(&value * &part);
            Some((*symbol, Interval::from_rational(&moved, Precision::new(BITS))?))
        };
        symbols.iter().map(entry).collect::<Option<BTreeMap<_, _>>>()
    };
    let values = |exprs: &[Expr], moved| -> Vec<Option<Interval>> {
        let Some(exact) = at(moved) else { return vec![None; exprs.len()] };
        match arena.enclose_over(exprs, &exact, Precision::new(BITS)) {
            Some(values) => values.into_iter().map(Some).collect(),
            None => {
                exprs.iter().map(|&expr| arena.enclose_over(&[expr], &exact, Precision::new(BITS))?.pop()).collect()
            }
        }
    };
    let still = values(exprs, None);
    // One at a time: together the effects of some would cancel, as those of b and c in a*b - c where that is small.
    let mut conditions = vec![0.0; exprs.len()];
    for symbol in &symbols {
        let moved: BTreeSet<Symbol> = [*symbol].into();
        let reached: Vec<usize> = (0..exprs.len()).filter(|index| arena.depends_on(exprs[*index], &moved)).collect();
        let there: Vec<Expr> = reached.iter().map(|index| exprs[*index]).collect();
        for (index, value) in reached.iter().zip(values(&there, Some(*symbol))) {
            let difference = still[*index].as_ref().and_then(|still| value?.sub(still, Precision::new(BITS)));
            let size = difference.map_or(0.0, |difference| difference.lo().abs().max(difference.hi().abs()));
            conditions[*index] += size / MOVE;
        }
    }
    Exact { values: still.into_iter().zip(conditions).map(|(value, condition)| Some((value?, condition))).collect() }
}

impl Exact {
    /// The largest error of computed values, in units of what rounding causes.
    fn units(&self, computed: &[f64], scalar: Scalar) -> f64 {
        // Half the distance from 1 to the next number, and the least number with all digits.
        let (roundoff, least) = match scalar {
            Scalar::F32 => (f64::from(f32::EPSILON) / 2.0, f64::from(f32::MIN_POSITIVE)),
            Scalar::F64 => (f64::EPSILON / 2.0, f64::MIN_POSITIVE),
        };
        let largest = match scalar {
            Scalar::F32 => f64::from(f32::MAX),
            Scalar::F64 => f64::MAX,
        };
        let mut worst: f64 = 0.0;
        for (exact, &found) in self.values.iter().zip(computed) {
            let Some((value, condition)) = exact else { continue };
            if value.hi().abs().max(value.lo().abs()) > largest / 4.0 {
                // Nothing that the scalar could hold.
                continue;
            }
            let Some(found) = Rational::from_f64_exact(found) else { return f64::INFINITY };
            let error = Interval::from_rational(&found, Precision::new(BITS))
                .and_then(|found| found.sub(value, Precision::new(BITS)))
                .map_or(f64::INFINITY, |error| error.lo().abs().max(error.hi().abs()));
            let unit = roundoff * (condition + value.hi().abs().max(value.lo().abs()));
            // Without a unit the value is 0 and stays so, whatever the arguments: what is left is the rounding of numbers
            // in the formula.
            if error > least && unit > 0.0 {
                worst = worst.max(error / unit);
            }
        }
        worst
    }
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
            if worst.units > MOST {
                let author = if worst.as_written { ", as the model's own formulas do" } else { "" };
                let (function, scalar, place) = (loss.function, scalar.name(), &worst.place);
                lines.extend([String::new(), format!("`{function}` loses digits in `{scalar}` at {place}{author}.")]);
            }
        }
    }
    lines
}

/// The next power of two: the last digits of a largest error are those of the host's functions.
pub(super) fn told_units(units: f64) -> String {
    units.max(1.0).log2().ceil().exp2().to_string()
}

/// A place as a reader takes it: what the formulas depend on.
fn told(arena: &Arena, exprs: &[Expr], place: &Place) -> String {
    let symbols = arena.symbols_of(exprs);
    let values = place.iter().filter(|(symbol, _)| symbols.contains(symbol));
    let values: Vec<String> = values.map(|(symbol, value)| format!("{} = {value}", arena.name(*symbol))).collect();
    values.join(", ")
}
