//! Whether the assumptions tell how an expression compares with zero.
//!
//! In: a domain and an expression. Out: yes, where a fact, algebra over the facts and the equations, or an enclosure over
//! the box that they state shows it; what cannot be decided is not shown.

use super::arena::Arena;
use super::domain::Domain;
use super::expr::Expr;
use super::facts::Relation;
use super::field::{Field, Obstacle};

/// Signs that a value has somewhere.
#[derive(Default)]
struct Signs {
    positive: bool,
    negative: bool,
}

impl Domain {
    /// Whether the facts show that the expression compares so with zero, wherever it has a value.
    pub(crate) fn implies(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        if self.facts.iter().any(|fact| fact == (expr, relation)) {
            return true;
        }
        // A proof of a sign takes algebra; that there is none, often one point tells.
        let seen = self.signs_seen(arena, expr);
        let signed = match relation {
            Relation::Positive | Relation::NonNegative => !seen.negative,
            Relation::NonZero => !(seen.negative && seen.positive),
        };
        let shown = |field: Result<Field<'_>, Obstacle>| {
            let field = field?;
            let fraction = field.fraction(expr)?;
            match relation {
                Relation::Positive => field.signs().is_positive(&fraction),
                Relation::NonNegative => field.signs().is_not_negative(&fraction),
                Relation::NonZero => Ok((!seen.negative && field.signs().is_positive(&fraction)?)
                    || (!seen.positive && field.signs().is_positive(&fraction.opposite())?)),
            }
        };
        let divides = || relation == Relation::NonZero && self.divides(arena, expr).unwrap_or(false);
        (signed && shown(Field::over(arena, &self.facts, &[expr])).unwrap_or(false))
            || (signed && !self.manifold.is_empty() && shown(Field::on(arena, self, &[expr])).unwrap_or(false))
            || divides()
            || (signed && self.sign_over_box(arena, expr).is_some_and(|is| is || relation == Relation::NonZero))
    }

    /// The signs that the expression provably has at some points of the domain.
    fn signs_seen(&self, arena: &Arena, expr: Expr) -> Signs {
        let mut seen = Signs::default();
        for value in self.glimpses(arena, &[expr]).filter_map(|point| arena.separated_from_zero(expr, &point)) {
            *(if value.is_positive() { &mut seen.positive } else { &mut seen.negative }) = true;
            if seen.positive && seen.negative {
                break;
            }
        }
        seen
    }

    /// Whether the expression vanishes only where something does that is assumed not to: its factors are among those
    /// of the facts, as `d - 1` is of `L*(1 - d) != 0`.
    fn divides(&self, arena: &Arena, expr: Expr) -> Result<bool, Obstacle> {
        let symbols = arena.symbols_of(&[expr]);
        let facts = self.facts.iter().filter(|(fact, relation)| {
            *relation != Relation::NonNegative && !arena.symbols_of(&[*fact]).is_disjoint(&symbols)
        });
        let facts: Vec<Expr> = facts.map(|(fact, _)| fact).collect();
        if facts.is_empty() {
            return Ok(false);
        }
        let field = Field::over(arena, &self.facts, &[facts.as_slice(), &[expr]].concat())?;
        let mut rest = field.fraction(expr)?.numerator().clone();
        if rest.is_zero() {
            return Ok(false);
        }
        for fact in facts {
            let fact = field.fraction(fact)?;
            // Where the denominator of the normal form vanishes the fact may hold and its numerator be zero all the same.
            let below = field.of_polynomial(fact.denominator())?;
            if below.to_constant().is_none()
                && !field.signs().is_positive(&below)?
                && !field.signs().is_positive(&below.opposite())?
            {
                continue;
            }
            loop {
                let common = rest.gcd(fact.numerator(), field.limit())?;
                if common.is_constant() {
                    break;
                }
                let Some(quotient) = rest.div_exact(&common, field.limit())? else { break };
                rest = quotient;
            }
        }
        let rest = field.of_polynomial(&rest)?;
        Ok(rest.to_constant().is_some()
            || field.signs().is_positive(&rest)?
            || field.signs().is_positive(&rest.opposite())?)
    }
}
