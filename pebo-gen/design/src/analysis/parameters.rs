//! The assumptions of the proofs on the parameters alone, for users who give them other values.
//!
//! In: a plant, and the conditions that its derivation lists. Out: comparisons with zero over parameters: a row for
//! each parameter in their order, then assumptions on several parameters that do not follow from these rows.

use crate::plant::Plant;
use pebo_cas::{Arena, Domain, Expr, Relation};

use super::Derivation;

/// The comparison of a value with zero in the domain of the proofs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Sign {
    /// In any way.
    Any,
    /// It is zero: the model gives the value 0.
    Zero,
    /// As the relation says.
    Is(Relation),
    /// The negative of the value compares as the relation says.
    Opposite(Relation),
}

impl Derivation {
    /// The conditions on the parameters' values under which the proofs hold.
    pub fn conditions_on_parameters(&self, plant: &Plant) -> Vec<(Expr, Sign)> {
        let arena = &plant.arena;
        let constants: Vec<_> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let assumed = plant.assumptions.iter().map(|assumption| (assumption.expr, assumption.relation));
        let mut facts: Vec<(Expr, Relation)> = assumed.chain(self.conditions.iter().copied()).collect();
        facts.retain(|(expr, _)| {
            let symbols = arena.symbols_of(&[*expr]);
            !symbols.is_empty() && symbols.iter().all(|symbol| constants.contains(symbol))
        });

        let mut conditions = Vec::new();
        let mut domain = Domain::default();
        for parameter in &plant.parameters {
            let symbol = arena.of_symbol(parameter.symbol);
            let of_value = parameter.value.as_ref().map(|value| match value.signum() {
                1 => Sign::Is(Relation::Positive),
                -1 => Sign::Opposite(Relation::Positive),
                _ => Sign::Zero,
            });
            let sign = of_value.unwrap_or_else(|| strongest(arena, symbol, &facts));
            match sign {
                Sign::Is(relation) => domain.facts.assume(symbol, relation),
                Sign::Opposite(relation) => domain.facts.assume(arena.neg(symbol), relation),
                Sign::Any | Sign::Zero => {}
            }
            conditions.push((symbol, sign));
        }
        for (expr, relation) in facts {
            if !domain.implies(arena, expr, relation) {
                domain.facts.assume(expr, relation);
                conditions.push((expr, Sign::Is(relation)));
            }
        }
        conditions
    }
}

/// The strongest of the facts that compare the parameter itself with zero.
fn strongest(arena: &Arena, symbol: Expr, facts: &[(Expr, Relation)]) -> Sign {
    for relation in [Relation::Positive, Relation::NonNegative, Relation::NonZero] {
        for (expr, stated) in facts {
            if *stated == relation && *expr == symbol {
                return Sign::Is(relation);
            }
            if *stated == relation && *expr == arena.neg(symbol) {
                return Sign::Opposite(relation);
            }
        }
    }
    Sign::Any
}
