//! Lowers written formulas to expressions.
//!
//! In: a formula of the model and the names it may use. Out: the expression, or one diagnostic at the subformula that
//! has no meaning: an unknown name, a division by zero, an exponent out of range.

use crate::model::formula::{Decimal, EXPONENT_LIMIT, Formula, Operator, PI, Term};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Expr, Function, Rational};

use super::Scope;

/// The expression of a formula.
pub fn lower(arena: &Arena, scope: &Scope, formula: &Formula) -> Result<Expr, Diagnostic> {
    // The parser bounds the depth, so recursion is safe here.
    match &formula.term {
        Term::Number(decimal) => {
            let value = exact(decimal, formula.span)?;
            arena.notation().keep(&value, decimal.text());
            Ok(arena.number(value))
        }
        Term::Name(name) => match scope.look_up(name, formula.span) {
            Err(_) if name == PI => Ok(arena.pi()),
            found => found,
        },
        Term::Estimate(name) => scope.look_up_estimate(name, formula.span),
        Term::Negative(operand) => Ok(arena.neg(lower(arena, scope, operand)?)),
        Term::Binary(operator, left, right) => {
            let (a, b) = (lower(arena, scope, left)?, lower(arena, scope, right)?);
            binary(arena, *operator, (a, left.span), (b, right.span))
        }
        Term::Table(table, order, argument) => {
            let pieces = Pieces { order: *order, ..table.pieces.clone() };
            arena.name_table(&table.pieces, &table.name);
            for decimal in table.points.iter().flat_map(|(at, value)| [at, value]) {
                arena.notation().keep(&exact(decimal, formula.span)?, decimal.text());
            }
            Ok(pieces.call(arena, lower(arena, scope, argument)?))
        }
        Term::Call(function, arguments) => {
            let lowered = arguments.iter().map(|a| lower(arena, scope, a)).collect::<Result<Vec<_>, _>>()?;
            in_domain(arena, *function, &lowered, arguments[0].span)?;
            Ok(arena.call(*function, &lowered))
        }
    }
}

/// The exact value of a decimal.
pub(super) fn exact(decimal: &Decimal, span: Span) -> Result<Rational, Diagnostic> {
    Rational::from_decimal(decimal.text()).map_err(|_| {
        Diagnostic::error(Code::NumberTooLarge, span, format!("`{}` is out of range", decimal.text()))
            .help("keep the exponent between -308 and 308")
    })
}

fn binary(
    arena: &Arena,
    operator: Operator,
    (a, left): (Expr, Span),
    (b, right): (Expr, Span),
) -> Result<Expr, Diagnostic> {
    match operator {
        Operator::Add => Ok(arena.add(a, b)),
        Operator::Subtract => Ok(arena.sub(a, b)),
        Operator::Multiply => Ok(arena.mul(a, b)),
        Operator::Divide if arena.is_zero(b) => Err(division_by_zero(right)),
        Operator::Divide => Ok(arena.div(a, b)),
        Operator::Power => {
            let Some(exponent) = arena.as_number(b) else {
                if arena.fails_of_number(arena.symbolic_power_condition(a)) {
                    return Err(Diagnostic::error(Code::NoRealValue, left, "this power needs a base above zero")
                        .label("its exponent is not a number, so it is read as `exp(exponent*log(base))`")
                        .help("correct the base, or write the exponent as a number"));
                }
                return Ok(arena.raise(a, b));
            };
            if exponent.is_negative() && arena.is_zero(a) {
                return Err(division_by_zero(left));
            }
            if exponent.to_f64().abs() > EXPONENT_LIMIT {
                return Err(Diagnostic::error(Code::ExponentTooLarge, right, "this exponent is out of range")
                    .help(format!("keep exponents between -{EXPONENT_LIMIT} and {EXPONENT_LIMIT}")));
            }
            if arena.power_condition(a, &exponent, Regularity::Defined).is_some_and(|ask| arena.fails_of_number(ask)) {
                return Err(Diagnostic::error(Code::NoRealValue, left, "a root of a negative number is not real")
                    .help("change the sign of what is under the root"));
            }
            Ok(arena.power(a, &exponent))
        }
    }
}

fn division_by_zero(span: Span) -> Diagnostic {
    Diagnostic::error(Code::DivisionByZero, span, "division by zero")
        .label("this is zero whatever the states and inputs are")
        .help("correct the denominator")
}

/// Checks that constant arguments are where the function has a real value.
fn in_domain(arena: &Arena, function: Function, arguments: &[Expr], span: Span) -> Result<(), Diagnostic> {
    let conditions = arena.call_conditions(function, arguments, Regularity::Defined);
    if conditions.into_iter().any(|ask| arena.fails_of_number(ask)) {
        let name = function.row().name;
        let values: Vec<String> = arguments.iter().map(|argument| arena.print(*argument)).collect();
        return Err(Diagnostic::error(
            Code::NoRealValue,
            span,
            format!("{name} has no real value at {}", values.join(", ")),
        )
        .help("correct the argument"));
    }
    Ok(())
}
