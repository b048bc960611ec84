//! The steps that solve equations for symbols, and the points that they complete.
//!
//! In: a point with the values of all other symbols, and the choice of a trial. Out: the same with the values that the
//! steps give, or none where one of them has no value.

use std::collections::BTreeSet;

use super::certified::System;
use crate::Rational;
use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Symbol};

/// Steps, and the equations that remain.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solution {
    pub steps: Vec<Step>,
    pub open: Vec<Expr>,
    /// Equations that are solved from a start, before the steps.
    pub(super) system: System,
}

/// The value of a symbol on the manifold.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    pub symbol: Symbol,
    pub middle: Expr,
    pub root: Option<Root>,
}

/// `(symbol - middle)^degree = radicand`
#[derive(Clone, Debug)]
pub(crate) struct Root {
    pub degree: u32,
    pub radicand: Expr,
    pub(super) partner: Option<Partner>,
}

/// A symbol in which the radicand is quadratic, with its coefficients, the constant first.
#[derive(Clone, Debug)]
pub(super) struct Partner {
    pub(super) symbol: Symbol,
    pub(super) coefficients: [Expr; 3],
}

/// The choice of a trial: a rational number, and a sign.
pub(crate) type Choice = (Rational, bool);

impl Step {
    /// The expression that vanishes where the symbol has this value: `symbol - middle`, or
    /// `(symbol - middle)^degree - radicand`.
    pub(crate) fn equation(&self, arena: &Arena) -> Expr {
        let distance = arena.sub(arena.of_symbol(self.symbol), self.middle);
        match &self.root {
            None => distance,
            Some(root) => arena.sub(arena.power(distance, &i64::from(root.degree).into()), root.radicand),
        }
    }

    pub(super) fn needs(&self, arena: &Arena) -> BTreeSet<Symbol> {
        let radicand = self.root.as_ref().map(|root| root.radicand);
        arena.symbols_of(&[Some(self.middle), radicand].into_iter().flatten().collect::<Vec<_>>())
    }

    /// The symbol's value, if the point has those of all others; none if there is no value.
    fn take(&self, arena: &Arena, point: &mut Point, (share, negative): Choice) -> Option<()> {
        let offset = match &self.root {
            None => arena.zero(),
            Some(root) => root.at(arena, point, &share, negative)?,
        };
        let value = arena.add(arena.substitute(self.middle, point), offset);
        arena.exists_at(value, &Point::new()).then(|| point.insert(self.symbol, value))?;
        Some(())
    }
}

impl Root {
    /// The root, if not zero: there the manifold is a graph over the other symbols.
    fn at(&self, arena: &Arena, point: &mut Point, share: &Rational, negative: bool) -> Option<Expr> {
        if let Some(offset) = self.partner.as_ref().and_then(|partner| partner.turn(arena, point, share)) {
            return Some(if negative { arena.neg(offset) } else { offset });
        }
        let radicand = arena.substitute(self.radicand, point);
        let positive = arena.separated_from_zero(radicand, &Point::new())?.is_positive();
        let exponent = Rational::new(1, i64::from(self.degree))?;
        if self.degree % 2 == 1 {
            let size = arena.power(if positive { radicand } else { arena.neg(radicand) }, &exponent);
            return Some(if positive { size } else { arena.neg(size) });
        }
        let root = positive.then(|| arena.power(radicand, &exponent))?;
        Some(if negative { arena.neg(root) } else { root })
    }
}

impl Partner {
    /// Parametrizes a radicand `height - slope (t - top)^2` with both positive: t and the root run over an ellipse,
    /// whose points are rational functions of one number q:
    ///
    /// ```text
    /// t = top + sqrt(height/slope) 2 q/(1 + q^2)      root = sqrt(height) (1 - q^2)/(1 + q^2)
    /// ```
    fn turn(&self, arena: &Arena, point: &mut Point, share: &Rational) -> Option<Expr> {
        let [constant, linear, square] = self.coefficients.map(|e| arena.substitute(e, point));
        let positive = |e: Expr| arena.separated_from_zero(e, &Point::new()).is_some_and(|value| value.is_positive());
        let slope = arena.neg(square);
        if share.abs().is_one() || !positive(slope) {
            return None;
        }
        let top = arena.div(linear, arena.scale(slope, &Rational::from(2)));
        let height = arena.add(constant, arena.product([slope, top, top]));
        if !positive(height) {
            return None;
        }
        let squared = share * share;
        let scale = (&Rational::ONE + &squared).recip()?;
        let sine = &(share * &Rational::from(2)) * &scale;
        let cosine = &(&Rational::ONE - &squared) * &scale;
        let across = arena.scale(arena.sqrt(arena.div(height, slope)), &sine);
        point.insert(self.symbol, arena.add(top, across));
        Some(arena.scale(arena.sqrt(height), &cosine))
    }
}

impl Solution {
    /// True if points are found near drawn ones: a search, which may fail.
    pub(crate) fn is_search(&self) -> bool {
        !self.system.is_empty()
    }

    /// The symbols that the steps give.
    pub(crate) fn symbols(&self) -> BTreeSet<Symbol> {
        self.steps.iter().map(|step| step.symbol).collect()
    }

    /// Completes a point that has the values of all other symbols; none if a step has no value there.
    pub(crate) fn complete(&self, arena: &Arena, point: &mut Point, mut choose: impl FnMut() -> Choice) -> Option<()> {
        if !self.system.is_empty() {
            self.system.complete(arena, point)?;
        }
        let mut waiting: Vec<&Step> = self.steps.iter().collect();
        while !waiting.is_empty() {
            let ready = |step: &&Step| step.needs(arena).iter().all(|symbol| point.contains_key(symbol));
            let step = waiting.remove(waiting.iter().position(ready)?);
            step.take(arena, point, choose())?;
        }
        Some(())
    }
}
