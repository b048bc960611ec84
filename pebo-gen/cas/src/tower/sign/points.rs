//! Refutes signs by points.
//!
//! In: a polynomial over symbols. Out: yes, if it has both signs at points where the facts hold: then no rule proves
//! one. The rules cost far more than a few values.

use std::collections::BTreeSet;

use super::{Sign, Signs};
use crate::poly::Poly;
use crate::tower::Obstacle;
use crate::{Rational, Relation};

/// Points that are tried.
const MOST_POINTS: u64 = 8;

impl Signs<'_, '_> {
    /// True if the polynomial has both signs at points where the facts about its symbols hold.
    pub(super) fn are_both(&self, poly: &Poly) -> Result<bool, Obstacle> {
        let known = self.memory.round.facts.borrow();
        let mut symbols: BTreeSet<u32> = poly.variables().iter().copied().collect();
        let mut facts: Vec<&(Poly, Relation)> = Vec::new();
        // With the symbols of the facts about these, and so on.
        loop {
            let shares = |fact: &&(Poly, Relation)| fact.0.variables().iter().any(|v| symbols.contains(v));
            let more: Vec<_> = known.iter().filter(shares).collect();
            if more.len() == facts.len() {
                break;
            }
            symbols.extend(more.iter().flat_map(|fact| fact.0.variables()));
            facts = more;
        }
        // Values of functions, and those that equations tie, depend on one another.
        let is_free = |v: &u32| {
            let kernel = &self.field.round.kernels.borrow()[*v];
            kernel.relation.is_none() && self.field.arena.as_symbol(kernel.expr).is_some()
        };
        if !symbols.iter().all(is_free) {
            return Ok(false);
        }
        let limit = self.field.limit();
        let (mut positive, mut negative) = (false, false);
        for point in 0..MOST_POINTS {
            let value = |variable: u32| {
                let drawn = draw(point, variable);
                let is_negative = match self.of_kernel(variable) {
                    Some(sign) => sign == Sign::Negative,
                    None => drawn.is_negative(),
                };
                let size = Rational::new(drawn.abs() + 1, 16).unwrap_or(Rational::ONE);
                if is_negative { -size } else { size }
            };
            let mut holds = true;
            for (fact, relation) in &facts {
                let sign = fact.evaluate(value, limit)?.signum();
                holds &= match relation {
                    Relation::Positive => sign > 0,
                    Relation::NonNegative => sign >= 0,
                    Relation::NonZero => sign != 0,
                };
            }
            let sign = if holds { poly.evaluate(value, limit)?.signum() } else { 0 };
            positive |= sign > 0;
            negative |= sign < 0;
            if positive && negative {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// A number below 64 in size, the same in every run.
fn draw(point: u64, variable: u32) -> i64 {
    let mixed = (point + 1).wrapping_mul(u64::from(variable) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 57;
    i64::try_from(mixed).unwrap_or(0) - 64
}
