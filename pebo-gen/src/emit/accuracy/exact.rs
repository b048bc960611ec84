//! Exact values, and errors beside them.
//!
//! In: formulas and a place. Out: an enclosure of each value, and how much the value moves when all that it depends on is
//! rounded; of computed values, their errors in units of what rounding causes.

use std::collections::{BTreeMap, BTreeSet};

use super::super::literal::Scalar;
use super::places::Place;
use crate::cas::interval::{Interval, Precision};
use crate::cas::rational::Rational;
use crate::cas::{Arena, Expr, Symbol};

/// More units are a loss that no author expects.
pub(super) const MOST: f64 = 100.0;

/// Bits of the enclosures: those of `f64`, and as many to be lost.
pub(super) const BITS: u32 = 128;

/// Exact values at a place, and how much they move when all that they depend on is rounded.
pub(super) struct Exact {
    values: Vec<Option<(Interval, f64)>>,
}

/// The relative move of the arguments by which their effect is found.
const MOVE: f64 = 1.0 / 1_073_741_824.0;

pub(super) fn exact(arena: &Arena, exprs: &[Expr], place: &Place) -> Exact {
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
            let size = difference.map_or(0.0, |difference| magnitude(&difference));
            conditions[*index] += size / MOVE;
        }
    }
    Exact { values: still.into_iter().zip(conditions).map(|(value, condition)| Some((value?, condition))).collect() }
}

impl Exact {
    /// The errors of computed values, in units of what rounding causes.
    pub(super) fn units(&self, computed: &[f64], scalar: Scalar) -> Vec<f64> {
        // Half the distance from 1 to the next number, and the least number with all digits.
        let (roundoff, least) = match scalar {
            Scalar::F32 => (f64::from(f32::EPSILON) / 2.0, f64::from(f32::MIN_POSITIVE)),
            Scalar::F64 => (f64::EPSILON / 2.0, f64::MIN_POSITIVE),
        };
        let largest = match scalar {
            Scalar::F32 => f64::from(f32::MAX),
            Scalar::F64 => f64::MAX,
        };
        let units = |(exact, &found): (&Option<(Interval, f64)>, &f64)| {
            let Some((value, condition)) = exact else { return 0.0 };
            if magnitude(value) > largest / 4.0 {
                // Nothing that the scalar could hold.
                return 0.0;
            }
            let Some(found) = Rational::from_f64_exact(found) else { return f64::INFINITY };
            let error = Interval::from_rational(&found, Precision::new(BITS))
                .and_then(|found| found.sub(value, Precision::new(BITS)))
                .map_or(f64::INFINITY, |error| magnitude(&error));
            let unit = roundoff * (condition + magnitude(value));
            // Without a unit the value is 0 and stays so, whatever the arguments: what is left is the rounding of numbers
            // in the formula.
            if error > least && unit > 0.0 { error / unit } else { 0.0 }
        };
        self.values.iter().zip(computed).map(units).collect()
    }

    /// What the units are parts of, for each value that exists: its magnitude, and how much it moves.
    pub(super) fn sizes(&self) -> impl Iterator<Item = Option<f64>> {
        self.values.iter().map(|exact| exact.as_ref().map(|(value, condition)| condition + magnitude(value)))
    }
}

fn magnitude(value: &Interval) -> f64 {
    value.hi().abs().max(value.lo().abs())
}
