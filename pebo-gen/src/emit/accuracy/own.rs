//! Compares a loss of digits with that of the author's own formulas.
//!
//! In: an entry of a function, and a point at which it loses digits. Out: the cause of the loss. Its culprits are the
//! subexpressions that lose digits while their own operands do not. The loss is the author's if they are subexpressions
//! of the author's formulas, and these lose as much there, or hide a value, by adding it to a large one, that is small
//! beside the entry's size elsewhere. Without culprits in the entry as it is written, its sums are compared as the
//! author wrote them. A loss that is not the author's is nobody's if it is a rounding of the entry's size elsewhere.

use std::collections::{BTreeMap, BTreeSet};

use super::super::definition::{Argument, Definitions};
use super::super::literal::Scalar;
use super::cause::Cause;
use super::core::cores;
use super::exact::{Exact, MOST, exact};
use super::points::Place;
use super::rounded::{round, run};
use super::spot::Spot;
use pebo_cas::{Arena, Expr, Node, Symbol};
use pebo_design::plant::Plant;
use pebo_design::program::lower;

/// A loss up to so many times that of the author's formulas is theirs: a function that is made of several of them, as
/// the rate of phi, adds up a few.
const LIKE: f64 = 4.0;

/// The error of a form that is not the author's may be so many roundings of the value's size elsewhere: as much as a
/// few operations cause there.
const ROUNDINGS: f64 = 4.0;

/// At one point the roundings of a formula may happen to cancel: so many points beside it are measured too,
const BESIDE: u32 = 6;

/// this far from each other, which is little beside the distance to the limits near the points.
const APART: f64 = 1.0 / 262_144.0;

/// The author's formulas.
pub(super) struct Own<'a> {
    arena: &'a Arena,
    formulas: Vec<(Expr, BTreeSet<Expr>)>,
    /// The rates and the transform, and all parts of these.
    equations: Vec<Expr>,
    written: BTreeSet<Expr>,
    spots: &'a [Spot],
}

impl<'a> Own<'a> {
    /// The plant's equations and its transform, their slopes in the states, which they lose the digits of where the
    /// other terms are small, and the equations at the states that the coordinates give.
    pub(super) fn of(plant: &'a Plant, definitions: &Definitions, spots: &'a [Spot]) -> Self {
        let arena = &plant.arena;
        let mut formulas: Vec<Expr> = plant.rates().into_values().chain(plant.transform()).collect();
        let equations = formulas.clone();
        let written = arena.postorder(&equations).into_iter().collect();
        let slopes = |formula: &Expr| {
            let formula = *formula;
            let slopes = plant.x.iter().map(move |state| arena.derivative(formula, state.symbol));
            slopes.filter(|slope| arena.as_number(*slope).is_none()).collect::<Vec<Expr>>()
        };
        let slopes: Vec<Expr> = formulas.iter().flat_map(slopes).collect();
        formulas.extend(plant.y.iter().filter_map(|output| output.value).map(|value| value.expr));
        formulas.extend(plant.identities.iter().map(|identity| identity.expr));
        let states: BTreeMap<Symbol, Expr> = definitions.left_inverse.x.iter().copied().collect();
        let at = |symbols: &[Symbol]| -> BTreeMap<Symbol, Expr> {
            let coordinates: BTreeMap<Symbol, Expr> =
                plant.z.iter().copied().zip(symbols.iter().map(|&symbol| arena.of_symbol(symbol))).collect();
            states.iter().map(|(&state, &value)| (state, arena.substitute(value, &coordinates))).collect()
        };
        let parts = |formulas: &[Expr]| cores(arena, formulas).into_values().collect::<BTreeSet<Expr>>();
        for coordinates in [&definitions.symbols(Argument::Z), &definitions.chi] {
            let there = arena.substitute_all(&equations[..plant.rates().len()], &at(coordinates));
            formulas.extend(there);
        }
        formulas.extend(slopes);
        formulas.extend(plant.phi_left.iter().flatten().map(|(_, formula)| formula.expr));
        let formulas = formulas.into_iter().map(|formula| (formula, parts(&[formula])));
        Self { arena, formulas: formulas.collect(), equations, written, spots }
    }

    /// The cause of a loss of so many units.
    pub(super) fn cause(&self, value: Expr, place: &Place, scalar: Scalar, units: f64) -> Cause {
        if self.is_authors(value, place, scalar, units) {
            Cause::Model
        } else if self.is_within(value, (place, scalar), units, ROUNDINGS) {
            Cause::Small
        } else {
            Cause::Form
        }
    }

    fn is_authors(&self, value: Expr, place: &Place, scalar: Scalar, units: f64) -> bool {
        let culprits = self.culprits(value, place, scalar);
        if culprits.is_empty() {
            // As it is written the value keeps its digits: it is the order of the program that adds up roundings.
            return LIKE * self.of_sums(value, place, scalar) >= units;
        }
        let holding = |culprit: &Expr| {
            let with = self.formulas.iter().filter(move |(_, parts)| parts.contains(culprit));
            with.map(|(formula, _)| *formula).collect::<Vec<Expr>>()
        };
        let formulas: Vec<Vec<Expr>> = culprits.iter().map(holding).collect();
        if formulas.iter().any(Vec::is_empty) {
            return false;
        }
        let lose_as_much = |formulas: &Vec<Expr>| {
            let mut places = (0..=BESIDE).map(|step| beside(scalar, place, step));
            places.any(|place| self.units(formulas, &place, scalar).iter().any(|lost| LIKE * lost >= units))
        };
        formulas.iter().any(lose_as_much) || self.is_within(value, (place, scalar), units, MOST)
    }

    /// The most units that the author's formulas and those of their sums in the value lose.
    fn of_sums(&self, value: Expr, place: &Place, scalar: Scalar) -> f64 {
        let arena = self.arena;
        let is_written = |part: &Expr| self.written.contains(part) || self.written.contains(&arena.neg(*part));
        let sums = arena.postorder(&[value]).into_iter().filter(|part| matches!(arena.node(*part), Node::Sum(_)));
        let own: Vec<Expr> = self.equations.iter().copied().chain(sums.filter(is_written)).collect();
        self.units(&own, place, scalar).into_iter().fold(0.0, f64::max)
    }

    /// The error is at most so many roundings of the value's size elsewhere.
    fn is_within(&self, value: Expr, (place, scalar): (&Place, Scalar), units: f64, roundings: f64) -> bool {
        let first = |exact: Exact| exact.sizes().next().flatten();
        let there = self.spots.iter().map(|spot| spot.there(Scalar::F32));
        let sizes = there.filter_map(|there| first(there.exact(self.arena, &[value])));
        let mut sizes: Vec<f64> = sizes.filter(|size| size.is_finite()).collect();
        sizes.sort_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        first(exact(self.arena, &[value], place, scalar)).is_some_and(|here| units * here <= roundings * usual)
    }

    /// The subexpressions of a value that lose digits although their own operands lose none, by their cores.
    fn culprits(&self, value: Expr, place: &Place, scalar: Scalar) -> Vec<Expr> {
        let arena = self.arena;
        let is_made = |part: &Expr| matches!(arena.node(*part), Node::Sum(_) | Node::Product(_) | Node::Call(..));
        let parts: Vec<Expr> = arena.postorder(&[value]).into_iter().filter(is_made).collect();
        let units = self.units(&parts, place, scalar);
        let losing: BTreeSet<Expr> =
            parts.iter().zip(units).filter(|(_, units)| *units > MOST / LIKE).map(|(part, _)| *part).collect();
        let first = losing.iter().filter(|part| !arena.operands(**part).iter().any(|operand| losing.contains(operand)));
        let cores = cores(arena, &[value]);
        first.map(|part| cores[part]).collect()
    }

    /// The losses of formulas that are computed as they are written.
    fn units(&self, formulas: &[Expr], place: &Place, scalar: Scalar) -> Vec<f64> {
        let symbols: Vec<Symbol> = self.arena.symbols_of(formulas).into_iter().collect();
        let inputs: Vec<f64> = symbols.iter().map(|symbol| place.get(symbol).copied().unwrap_or(1.0)).collect();
        let Ok(program) = lower(self.arena, &symbols, formulas) else { return Vec::new() };
        exact(self.arena, formulas, place, scalar).units(&run(&program, scalar, &inputs), scalar)
    }
}

/// A point a few steps away, each number in its own direction.
fn beside(scalar: Scalar, place: &Place, step: u32) -> Place {
    let moved = place.iter().enumerate().map(|(index, (&symbol, &value))| {
        let part = if index % 2 == 0 { APART } else { -APART };
        (symbol, round(scalar, value * (1.0 + f64::from(step) * part)))
    });
    moved.collect()
}
