//! Domain conditions of formulas as written: arguments of roots and logarithms, denominators, and differentiability.
//!
//! In: formulas as written. Out: the conditions of each operation on its operands, by the algebra's tables. They are
//! read off the text because construction simplifies (`x/x` is 1) and would forget them.

use crate::model::formula::{Formula, Operator, Term};
use crate::source::Diagnostic;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Expr, Relation};

use super::formula::lower;
use super::parts::Assumption;
use super::scope::Scope;

/// Adds the domain conditions of the formula.
pub(super) fn collect(
    arena: &Arena,
    scope: &Scope,
    formula: &Formula,
    want: Regularity,
    found: &mut Vec<Assumption>,
) -> Result<(), Diagnostic> {
    let mut add = |part: &Formula, conditions: Vec<(Expr, Relation)>| {
        let open = conditions.into_iter().filter(|condition| !arena.holds_of_number(*condition));
        found.extend(open.map(|(expr, relation)| Assumption { expr, relation, span: part.span }));
    };
    match &formula.term {
        Term::Binary(Operator::Divide, _, below) => {
            add(below, arena.division_conditions(lower(arena, scope, below)?));
        }
        Term::Binary(Operator::Power, base, exponent) => {
            let (value, exponent) = (lower(arena, scope, base)?, lower(arena, scope, exponent)?);
            let conditions = match arena.as_number(exponent) {
                Some(power) => arena.power_condition(value, &power, want),
                None => Some(arena.symbolic_power_condition(value)),
            };
            add(base, conditions.into_iter().collect());
        }
        Term::Call(function, arguments) => {
            let values = arguments.iter().map(|a| lower(arena, scope, a)).collect::<Result<Vec<_>, _>>()?;
            add(&arguments[0], arena.call_conditions(*function, &values, want));
        }
        _ => {}
    }
    // The parser bounds the depth, so recursion is safe here.
    formula.parts().into_iter().try_for_each(|part| collect(arena, scope, part, want, found))
}

/// Tests whether the formula uses the name.
pub(super) fn uses(formula: &Formula, name: &str) -> bool {
    match &formula.term {
        Term::Name(used) => used == name,
        _ => formula.parts().into_iter().any(|part| uses(part, name)),
    }
}
