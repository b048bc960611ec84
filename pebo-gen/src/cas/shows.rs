//! Whether the assumptions tell how an expression compares with zero.
//!
//! In: a domain and an expression. Out: yes, where a fact, algebra over the facts, or an enclosure over the box that
//! they state shows it; what cannot be decided is not shown.

use super::arena::Arena;
use super::domain::Domain;
use super::expr::Expr;
use super::facts::Relation;
use super::field::Field;

impl Domain {
    /// Whether the facts show that the expression compares so with zero, wherever it has a value.
    pub(crate) fn shows(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        let shown = || {
            let field = Field::over(arena, &self.facts, &[expr])?;
            let fraction = field.fraction(expr)?;
            match relation {
                Relation::Positive => field.is_positive(&fraction),
                Relation::NonNegative => field.is_not_negative(&fraction),
                Relation::NonZero => Ok(field.is_positive(&fraction)? || field.is_positive(&fraction.opposite())?),
            }
        };
        self.facts.iter().any(|fact| fact == (expr, relation))
            || shown().unwrap_or(false)
            || self.sign_over_box(arena, expr).is_some_and(|positive| positive || relation == Relation::NonZero)
    }
}
