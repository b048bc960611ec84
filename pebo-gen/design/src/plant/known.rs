//! Resolves the values at which states start.
//!
//! In: values in parameters, and the assumptions. Out: the values, or a diagnostic for one at which an assumption fails, as
//! the plant would start where nothing is claimed.

use std::collections::BTreeMap;

use crate::model::{self, Model};
use crate::source::{Code, Diagnostic, Diagnostics};
use pebo_cas::{Arena, Expr, Symbol};

use super::parts::{Assumption, Formula, Parameter};

/// The states with the values at which they start.
pub(super) fn starts(
    arena: &Arena,
    model: &Model,
    (assumptions, parameters): (&[Assumption], &[Parameter]),
    constant: impl Fn(&model::Formula) -> Result<Formula, Diagnostic>,
    problems: &mut Diagnostics,
) -> Vec<(Symbol, Formula)> {
    let value = |entry: &model::Entry<model::Formula>| Ok((arena.symbol(&entry.name.value), constant(&entry.value)?));
    let known = problems.all(model.known.iter().map(value));
    check(arena, &known, assumptions, parameters, problems);
    known
}

/// Reports values outside the assumed domain.
fn check(
    arena: &Arena,
    known: &[(Symbol, Formula)],
    assumptions: &[Assumption],
    parameters: &[Parameter],
    problems: &mut Diagnostics,
) {
    let given = parameters.iter().filter_map(|p| Some((p.symbol, arena.number(p.value.clone()?))));
    let given: BTreeMap<Symbol, Expr> = given.collect();
    let states: BTreeMap<Symbol, Expr> = known.iter().map(|(state, value)| (*state, value.expr)).collect();
    for assumption in assumptions {
        let Some((_, value)) = known.iter().find(|(state, _)| arena.symbols_of(&[assumption.expr]).contains(state))
        else {
            continue;
        };
        let at_start = arena.substitute(arena.substitute(assumption.expr, &states), &given);
        if arena.symbols_of(&[at_start]).is_empty() && arena.fails_of_number((at_start, assumption.relation)) {
            let message = format!("the plant does not start where it is assumed to be: {}", what(arena, assumption));
            problems.push(
                Diagnostic::error(Code::ContradictoryAssumptions, value.span, message)
                    .also(assumption.span, "the assumption is here")
                    .help("write a value under `known` that meets it, or a weaker assumption"),
            );
        }
    }
}

fn what(arena: &Arena, assumption: &Assumption) -> String {
    format!("`{} {}` fails there", arena.print(assumption.expr), assumption.relation.sign())
}
