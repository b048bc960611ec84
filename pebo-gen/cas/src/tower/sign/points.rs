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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tower::Field;
    use crate::{Arena, Expr, Facts};

    /// Points refute a sign only where the facts leave both: what a fact proves is not given up.
    #[test]
    fn points_have_both_signs_only_where_the_facts_do() {
        let arena = Arena::new();
        let [p, q, r] = ["p", "q", "r"].map(|name| arena.variable(name));
        let difference = arena.sub(p, q);
        let are_both = |fact: Option<Expr>, expr: Expr| {
            let mut facts = Facts::new();
            if let Some(fact) = fact {
                facts.assume(fact, Relation::Positive);
            }
            let roots = [&[expr], fact.as_slice()].concat();
            let field = Field::over(&arena, &facts, &roots).unwrap();
            let poly = field.fraction(expr).unwrap().num;
            field.signs().learn().unwrap();
            field.signs().are_both(&poly).unwrap()
        };
        assert!(are_both(None, difference) && are_both(Some(r), difference));
        assert!(!are_both(Some(difference), difference));
        assert!(!are_both(Some(p), arena.add(arena.mul(p, p), p)));
        assert!(!are_both(None, arena.add(arena.mul(p, p), arena.mul(q, q))));
        // A root is no free value.
        assert!(!are_both(None, arena.sub(arena.sqrt(arena.mul(p, p)), p)));
    }
}
