//! The author's identities: whether they can hold, and keep holding along the plant.
//!
//! In: the plant. Out: the verdict. All other claims are made on the manifold of the identities, so they say nothing if it
//! has no point, and nothing of the plant if its trajectories leave it.

use std::collections::BTreeSet;

use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::zero::{Answer, decide};
use crate::cas::{Expr, Symbol};
use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic};

use crate::analysis::design::{Verdict, Witness};

/// Proves or refutes that the identities have a common point, and that the plant stays where they hold.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Verdict {
    let arena = &plant.arena;
    let Some(first) = plant.identities.first() else { return Verdict::Proved };
    let everywhere = domain.everywhere();
    let signed = |identity: &&Formula| {
        let opposite = arena.neg(identity.expr);
        [identity.expr, opposite].iter().any(|side| everywhere.implies(arena, *side, Relation::Positive))
    };
    if let Some(identity) = plant.identities.iter().find(signed) {
        found.push(
            Diagnostic::error(Code::IdentityRefuted, identity.span, "this identity holds nowhere")
                .label("this expression is never zero")
                .help("correct the identity: it has to be an expression that is zero by physics"),
        );
        return Verdict::Refuted;
    }
    let all: Vec<_> = plant.identities.iter().map(|identity| identity.expr).collect();
    if domain.points(arena, &all).next().is_none() {
        let last = plant.identities.last().unwrap_or(first);
        found.push(
            Diagnostic::error(
                Code::IdentityUndecided,
                first.span.to(last.span),
                "no values were found that satisfy the identities and the assumptions",
            )
            .note("claims about an empty set of values say nothing")
            .help(
                "check that they do not exclude one another, and that each identity can be solved for one of its names",
            ),
        );
        return Verdict::Undecided;
    }
    let mut verdict = Verdict::Proved;
    for identity in &plant.identities {
        let (answer, refusal) = kept(plant, domain, identity);
        found.extend(refusal);
        if verdict != Verdict::Refuted && answer != Verdict::Proved {
            verdict = answer;
        }
    }
    verdict
}

/// The derivative of an identity along the plant; none where it takes the rate of a signal that has none.
fn derivative(plant: &Plant, domain: &Domain, identity: &Formula) -> Option<Expr> {
    let arena = &plant.arena;
    let rates = plant.rates();
    let unruled = |symbol: &Symbol| {
        let constant = plant.parameters.iter().any(|parameter| parameter.symbol == *symbol);
        // What the identity does not vary with on its manifold may have any rate.
        !constant
            && !rates.contains_key(symbol)
            && !decide(arena, arena.derivative(identity.expr, *symbol), domain).is_zero()
    };
    let symbols: BTreeSet<Symbol> = arena.symbols_of(&[identity.expr]);
    (!symbols.iter().any(unruled)).then(|| arena.directional(identity.expr, &rates))
}

/// Whether the identity keeps holding. Where it binds a signal without a rate, it says what that rate is.
fn kept(plant: &Plant, domain: &Domain, identity: &Formula) -> (Verdict, Option<Diagnostic>) {
    let arena = &plant.arena;
    let Some(rate) = derivative(plant, domain, identity) else { return (Verdict::Proved, None) };
    let along = format!("its derivative along the plant is `{}`", arena.print(rate));
    match decide(arena, rate, domain) {
        Answer::Zero => (Verdict::Proved, None),
        Answer::NonZero(point) => {
            let refusal = Diagnostic::error(
                Code::IdentityRefuted,
                identity.span,
                "this identity is not invariant along the trajectories of the plant",
            )
            .label(along)
            .note(Witness::of(rate, &point).sentence(arena))
            .note("the identities hold at this point, but this one does not stay true along the trajectory")
            .help("correct the identity, or the rates under `f_x` and `f_y`");
            (Verdict::Refuted, Some(refusal))
        }
        Answer::Open(obstacle) => {
            let message =
                "it could not be decided whether this identity is invariant along the trajectories of the plant";
            let refusal = Diagnostic::error(Code::IdentityUndecided, identity.span, message)
                .label(along)
                .note(format!("obstacle: {obstacle}"))
                .help(
                    "write the identity so that it can be solved for one of its names, or give the parameters values",
                );
            (Verdict::Undecided, Some(refusal))
        }
    }
}
