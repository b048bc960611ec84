//! Where a formula has a value at all: what its author wrote under roots and logarithms and below
//! fraction bars.
//!
//! In: formulas as written. Out: what each division, root, logarithm and inverse function asks of its
//! operand. They are read off the text because construction simplifies (`x/x` is 1) and would forget.

use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr};
use crate::model::formula::{Formula, Operator, Term};
use crate::source::Diagnostic;

use super::{Assumption, Scope, lower};

/// Adds what the formula asks of its parts.
pub(super) fn collect(
    arena: &Arena,
    scope: &Scope,
    formula: &Formula,
    found: &mut Vec<Assumption>,
) -> Result<(), Diagnostic> {
    let mut ask = |part: &Formula, expr: Expr, relation: Relation| {
        if arena.as_number(expr).is_none() {
            found.push(Assumption { expr, relation, span: part.span });
        }
    };
    match &formula.term {
        Term::Binary(Operator::Divide, _, below) => ask(below, lower(arena, scope, below)?, Relation::NonZero),
        Term::Binary(Operator::Power, base, exponent) => {
            let (base_value, exponent) = (lower(arena, scope, base)?, lower(arena, scope, exponent)?);
            match arena.as_number(exponent) {
                Some(power) if !power.is_integer() && power.is_negative() => ask(base, base_value, Relation::Positive),
                Some(power) if !power.is_integer() => ask(base, base_value, Relation::NonNegative),
                Some(power) if power.is_negative() => ask(base, base_value, Relation::NonZero),
                Some(_) => {}
                None => ask(base, base_value, Relation::Positive),
            }
        }
        Term::Call(function, arguments) => {
            let inside = &arguments[0];
            let value = lower(arena, scope, inside)?;
            match function.name {
                "sqrt" => ask(inside, value, Relation::NonNegative),
                "log" => ask(inside, value, Relation::Positive),
                "asin" | "acos" => {
                    let room = arena.sub(arena.one(), arena.mul(value, value));
                    ask(inside, room, Relation::NonNegative);
                }
                "tan" => ask(inside, arena.call(crate::cas::Function::Cos, &[value]), Relation::NonZero),
                _ => {}
            }
        }
        _ => {}
    }
    // The parser bounds the depth, so recursion is safe here.
    formula.parts().into_iter().try_for_each(|part| collect(arena, scope, part, found))
}
