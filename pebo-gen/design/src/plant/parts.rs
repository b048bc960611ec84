//! The parts of a plant: constants, states, outputs, formulas and assumptions, each with its span.

use std::collections::BTreeSet;

use crate::source::{Code, Diagnostic, Span};
use pebo_cas::{Arena, Domain, Expr, Rational, Relation, Symbol};

/// A constant of the plant.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its symbol.
    pub symbol: Symbol,
    /// Its value, unless it is given later.
    pub value: Option<Rational>,
    /// The value as it is written in the model.
    pub text: Option<String>,
    /// The span of the declaration.
    pub span: Span,
}

/// An unmeasured state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its symbol.
    pub symbol: Symbol,
    /// Its time derivative `f_x`.
    pub rate: Formula,
}

/// A measured output.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its symbol.
    pub symbol: Symbol,
    /// Its time derivative: `f_y`, or that of its value along the plant; absent where nothing needs it, or where an
    /// input moves its value.
    pub rate: Option<Formula>,
    /// Its value `g_y` in the other signals, where it is given by that.
    pub value: Option<Formula>,
    /// The span of the declaration.
    pub span: Span,
}

impl Output {
    /// Tests whether its rate is that of its value, rather than one that its author gave.
    pub fn moves_with_value(&self) -> bool {
        self.rate.zip(self.value).is_some_and(|(rate, value)| rate.span == value.span)
    }
}

/// An expression and where its author wrote it.
#[derive(Clone, Copy, Debug)]
pub struct Formula {
    /// The expression.
    pub expr: Expr,
    /// The span.
    pub span: Span,
}

/// One inequality of the assumed domain: `expr > 0`, `>= 0` or `!= 0`.
#[derive(Clone, Copy, Debug)]
pub struct Assumption {
    /// The expression to compare with zero.
    pub expr: Expr,
    /// The comparison.
    pub relation: Relation,
    /// The span.
    pub span: Span,
}

/// The formula, if it depends only on the allowed symbols.
pub(super) fn confined(
    arena: &Arena,
    expr: Expr,
    span: Span,
    allowed: &BTreeSet<Symbol>,
    place: &str,
) -> Result<Formula, Diagnostic> {
    match arena.symbols_of(&[expr]).iter().find(|s| !allowed.contains(s)) {
        None => Ok(Formula { expr, span }),
        Some(stray) => {
            let names: Vec<String> = allowed.iter().map(|s| arena.name(*s)).collect();
            Err(Diagnostic::error(
                Code::MisplacedName,
                span,
                format!("{place} cannot depend on `{}`", arena.name(*stray)),
            )
            .help(format!("use only {}", names.join(", "))))
        }
    }
}

/// The domain of these inequalities and values.
pub(super) fn assumed(arena: &Arena, assumptions: &[Assumption], parameters: &[Parameter]) -> Domain {
    let mut domain = Domain::default();
    for assumption in assumptions {
        // Before it is a fact itself: a comparison of its branches with it needs none of what it says.
        let branches = match assumption.relation {
            Relation::NonZero => Vec::new(),
            Relation::Positive | Relation::NonNegative => domain.branches_above(arena, assumption.expr),
        };
        for fact in [assumption.expr].into_iter().chain(branches) {
            domain.facts.assume(fact, assumption.relation);
        }
    }
    for parameter in parameters {
        let Some(value) = &parameter.value else { continue };
        domain.fixed.insert(parameter.symbol, arena.number(value.clone()));
        let symbol = arena.of_symbol(parameter.symbol);
        match value.signum() {
            1 => domain.facts.assume(symbol, Relation::Positive),
            -1 => domain.facts.assume(arena.neg(symbol), Relation::Positive),
            _ => {}
        }
    }
    domain
}
