//! Periods of angles: positive constants.
//!
//! A period that is zero is no ambiguity, and a period without a sign is meaningless: both are refused.

use crate::source::{Code, Diagnostic};
use pebo_cas::{Arena, Domain, Relation};

use super::parts::Formula;

/// Refuses a period that is not provably positive by the values and assumptions.
pub(super) fn positive(arena: &Arena, domain: &Domain, period: Formula) -> Result<(), Diagnostic> {
    let shows = |expr, relation| domain.implies(arena, expr, relation);
    if shows(period.expr, Relation::Positive) {
        return Ok(());
    }
    let refuse = |message: &str| Diagnostic::error(Code::PeriodNotPositive, period.span, message);
    if arena.is_zero(period.expr) {
        return Err(refuse("the period of an angle is zero").help("write the angle of a whole turn, as `2*pi`"));
    }
    let opposite = arena.neg(period.expr);
    if shows(opposite, Relation::Positive) {
        return Err(refuse("the period of an angle is negative").help(format!("write `{}`", arena.print(opposite))));
    }
    let parameters: Vec<String> = arena.symbols_of(&[period.expr]).iter().map(|s| arena.name(*s)).collect();
    let help = match parameters.as_slice() {
        [] => "write the angle of a whole turn, as `2*pi`".to_owned(),
        [one] => format!("give `{one}` a positive value, or write `{} > 0` under `assume`", arena.print(period.expr)),
        _ => format!("write `{} > 0` under `assume`", arena.print(period.expr)),
    };
    Err(refuse("the period of an angle is not known to be positive").help(help))
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::Source;

    fn resolved(parameters: &str, assume: &str, period: &str) -> Result<Plant, Vec<Diagnostic>> {
        let text = format!(
            "model: m\nparameters: {{{parameters}}}\nassume: [{assume}]\nx: [q]\ny: [s]\nf_x: {{q: s}}\n\
             f_y: {{s: sin(q)}}\nphi: [q]\nangles: {{q: {period}}}\n"
        );
        Plant::resolve(&Model::parse(&Source::new("m", text.as_str()).unwrap()).unwrap())
    }

    #[test]
    fn a_period_is_provably_positive() {
        for (parameters, assume, period) in [
            ("", "", "2*pi"),
            ("", "", "360"),
            ("n: 3", "", "2*pi/n"),
            ("n: null", "n > 0", "2*pi/n"),
            ("a: 3, b: 2", "a > b", "a - b"),
            ("n: -3", "", "n^2"),
        ] {
            assert!(resolved(parameters, assume, period).is_ok(), "{period}");
        }
    }

    #[test]
    fn any_other_is_refused() {
        for (parameters, assume, period, message, help) in [
            ("", "", "0", "is zero", "as `2*pi`"),
            ("", "", "pi - pi", "is zero", "as `2*pi`"),
            ("", "", "-2*pi", "is negative", "write `2*pi`"),
            ("n: -3", "", "2*pi/n", "is negative", "write `-2*pi/n`"),
            ("n: null", "", "2*pi/n", "is not known to be positive", "write `2*pi/n > 0` under `assume`"),
            ("n: 0", "", "n", "", ""),
            ("a: 3, b: 2", "", "a - b", "is not known to be positive", "write `a - b > 0` under `assume`"),
        ] {
            let refused = resolved(parameters, assume, period).expect_err(period);
            assert_eq!((refused.len(), refused[0].code), (1, Code::PeriodNotPositive), "{period}");
            assert!(refused[0].message.ends_with(message), "{period}: {}", refused[0].message);
            assert!(refused[0].help.as_ref().is_some_and(|h| h.ends_with(help)), "{period}: {:?}", refused[0].help);
        }
    }
}
