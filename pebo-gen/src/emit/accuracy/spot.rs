//! A point, and the exact values that are known there.
//!
//! In: formulas. Out: their exact values, each enclosed once: the forms of the functions that are tried one after the
//! other have most of their entries in common, and so have the measurements of these forms.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::super::literal::Scalar;
use super::exact::{Exact, Value, at_once, exact};
use super::points::Place;
use pebo_cas::{Arena, Expr};

/// A point in the numbers of each scalar.
pub(super) struct Spot {
    /// As it is reported.
    pub(super) place: Place,
    single: There,
    double: There,
}

/// A point in the numbers of one scalar.
pub(super) struct There {
    pub(super) place: Place,
    scalar: Scalar,
    known: RefCell<FxHashMap<Expr, Value>>,
}

impl Spot {
    pub(super) fn new(place: Place) -> Self {
        let there = |scalar| There { place: in_all_digits(scalar, &place), scalar, known: RefCell::default() };
        Self { single: there(Scalar::F32), double: there(Scalar::F64), place }
    }

    pub(super) fn there(&self, scalar: Scalar) -> &There {
        match scalar {
            Scalar::F32 => &self.single,
            Scalar::F64 => &self.double,
        }
    }
}

impl There {
    /// Exact values of the expressions.
    pub(super) fn exact(&self, arena: &Arena, exprs: &[Expr]) -> Exact {
        let missing = self.missing(exprs);
        self.know(&missing, exact(arena, &missing, &self.place, self.scalar).values);
        let known = self.known.borrow();
        Exact { values: exprs.iter().map(|expr| known.get(expr).cloned().flatten()).collect() }
    }

    /// Finds the values of expressions with common parts in one pass, if all of them have a value.
    pub(super) fn prepare(&self, arena: &Arena, exprs: &[Expr]) {
        let missing = self.missing(exprs);
        if let Some(values) = at_once(arena, &missing, &self.place, self.scalar) {
            self.know(&missing, values);
        }
    }

    fn missing(&self, exprs: &[Expr]) -> Vec<Expr> {
        let known = self.known.borrow();
        exprs.iter().copied().filter(|expr| !known.contains_key(expr)).collect()
    }

    fn know(&self, exprs: &[Expr], values: Vec<Value>) {
        self.known.borrow_mut().extend(exprs.iter().copied().zip(values));
    }
}

/// The point in numbers with all digits of the scalar, except for 0, 1 and -1: sums and products of numbers of `f32`
/// are exact in `f64`, so that these would hide losses there.
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
