//! Points of the domain for the measurement of accuracy, in numbers that every target holds.
//!
//! In: plant and derivation. Out: values of states, outputs, inputs and parameters: points spread over the domain, the
//! values 0, 1 and -1, and both sides of 0 and of every limit of an assumption or a condition, as far as they are in
//! the domain.

use std::collections::BTreeMap;

use super::super::literal::Scalar;
use super::rounded::round;
use pebo_cas::number::interval::Precision;
use pebo_cas::{Arena, Domain, Expr, Rational, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::program::{Interpreter, lower};

/// Values of symbols.
pub(super) type Place = BTreeMap<Symbol, f64>;

/// Points spread over the domain.
const SPREAD: usize = 12;

/// All points.
const MOST: usize = 72;

/// Distances of values from a limit, in parts of it: no powers of two, with which sums and squares would be exact in
/// `f32` and hide losses.
const BESIDE: [f64; 2] = [1.0 / 129.0, 1.0 / 16389.0];

/// The points, the spread ones first.
pub(super) fn places(plant: &Plant, derivation: &Derivation) -> Vec<Place> {
    let arena = &plant.arena;
    let domain = derivation.domain(plant);
    let formulas: Vec<Expr> = plant.rates().into_values().chain(plant.transform()).collect();
    let signals: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).chain(plant.u.iter().copied()).collect();
    let all: Vec<Expr> = formulas.iter().copied().chain(signals.iter().map(|&s| arena.of_symbol(s))).collect();
    let inside = Inside::of(arena, &domain);
    let mut places: Vec<Place> = Vec::new();
    let spread = domain.points(arena, &all).take(SPREAD).filter_map(|point| {
        let value = |value: Expr| Some(arena.enclose(value, &BTreeMap::new(), Precision::new(64))?.lo());
        let place: Option<Place> =
            point.into_iter().map(|(symbol, constant)| Some((symbol, round(Scalar::F32, value(constant)?)))).collect();
        place.filter(|place| inside.holds(place))
    });
    places.extend(spread);
    let Some(base) = places.first().cloned() else { return places };
    let mut beside = |symbol: Symbol, value: f64| {
        let value = round(Scalar::F32, value);
        let place: Place = base.iter().map(|(&s, &v)| (s, if s == symbol { value } else { v })).collect();
        if places.len() < MOST && place.get(&symbol) == Some(&value) && !places.contains(&place) && inside.holds(&place)
        {
            places.push(place);
        }
    };
    let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    for &symbol in signals.iter().chain(&states) {
        for limit in inside.limits(arena, symbol, &base) {
            let size = if limit == 0.0 { 1.0 } else { limit.abs() };
            for part in BESIDE {
                beside(symbol, limit + part * size);
                beside(symbol, limit - part * size);
            }
        }
    }
    for &symbol in signals.iter().chain(&states) {
        for value in [0.0, 1.0, -1.0] {
            beside(symbol, value);
        }
    }
    // Equilibria of plants: `1 - cos(q)` has lost its digits beside 0, and has them at 0.
    for &symbol in signals.iter().chain(&states) {
        for part in BESIDE {
            beside(symbol, part);
            beside(symbol, -part);
        }
    }
    // All of them at once, no two alike: `sqrt(q^2 + 1) - sqrt(r^2 + 1)` loses digits where both are small.
    let moving: Vec<Symbol> = signals.iter().chain(&states).copied().collect();
    for part in BESIDE {
        let near = |symbol: &Symbol| {
            let index = moving.iter().position(|other| other == symbol)?;
            // No two are the same part of each other.
            let turn = (0.618_034 * f64::from(u32::try_from(index).ok()?)).fract();
            Some(round(Scalar::F32, part * (1.0 + turn)))
        };
        let place: Place = base.iter().map(|(symbol, &value)| (*symbol, near(symbol).unwrap_or(value))).collect();
        if inside.holds(&place) {
            places.push(place);
        }
    }
    places
}

/// The facts of the domain, to be tested in numbers.
struct Inside<'a> {
    arena: &'a Arena,
    domain: Domain,
}

impl<'a> Inside<'a> {
    fn of(arena: &'a Arena, domain: &Domain) -> Self {
        // Values that are given are rounded, and equations hold up to rounding.
        let domain = Domain { fixed: BTreeMap::new(), ..domain.without_equations() };
        Self { arena, domain }
    }

    fn holds(&self, place: &Place) -> bool {
        let number = |value: f64| Some(self.arena.number(Rational::from_f64_exact(value)?));
        let point: Option<_> = place.iter().map(|(&symbol, &value)| Some((symbol, number(value)?))).collect();
        point.is_some_and(|point| self.domain.contains(self.arena, &point))
    }

    /// Values of the symbol at the limit of a fact, all others as at the point.
    fn limits(&self, arena: &Arena, symbol: Symbol, place: &Place) -> Vec<f64> {
        /// Angles and duty cycles are in this range, and so are values near 1.
        const WIDEST: f64 = 8.0;
        const STEPS: u32 = 64;
        let mut limits = Vec::new();
        for fact in self.domain.facts.iter() {
            let symbols: Vec<Symbol> = arena.symbols_of(&[fact.0]).into_iter().collect();
            if !symbols.contains(&symbol) || symbols.iter().any(|other| !place.contains_key(other)) {
                continue;
            }
            let Ok(program) = lower(arena, &symbols, &[fact.0]) else { continue };
            let mut interpreter = Interpreter::new(&program);
            let mut value = |at: f64| {
                let inputs: Vec<f64> =
                    symbols.iter().map(|other| if *other == symbol { at } else { place[other] }).collect();
                let mut outputs = [0.0];
                interpreter.run(&inputs, &mut outputs);
                outputs[0]
            };
            let grid = |k: u32| WIDEST * (2.0 * f64::from(k) / f64::from(STEPS) - 1.0);
            for k in 0..STEPS {
                let (mut low, mut high) = (grid(k), grid(k + 1));
                let (first, last) = (value(low), value(high));
                if first == 0.0 {
                    limits.push(low);
                } else if first * last < 0.0 {
                    for _ in 0..50 {
                        let middle = f64::midpoint(low, high);
                        if value(middle) * first > 0.0 { low = middle } else { high = middle }
                    }
                    limits.push(high);
                }
            }
        }
        limits.dedup();
        limits
    }
}
