//! The author's identities: consistency, and invariance along the plant.
//!
//! In: the plant. Out: the verdict. All other claims are made on the manifold of the identities, so they are void if it
//! has no point, and do not concern the plant if its trajectories leave it.

use std::collections::BTreeSet;

use crate::plant::{Formula, Output, Plant};
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::zero::{Answer, decide, is_zero};
use pebo_cas::linear::rank::null_vectors;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::design::{Verdict, Witness};

/// Proves or refutes that the identities have a common point and are invariant.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Verdict {
    let arena = &plant.arena;
    let Some(first) = plant.identities.first() else { return Verdict::Proved };
    let everywhere = domain.without_equations();
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
                "check that they do not exclude one another, that none follows from the others, and that each changes \
                 its sign where it holds, as `a - b` does and its square does not",
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
    if verdict == Verdict::Proved {
        let (answer, refusal) = jointly_kept(plant, domain);
        found.extend(refusal);
        verdict = answer;
    }
    verdict
}

/// The signals without a rate on which an identity depends on its manifold: their rates follow from the identities.
fn unruled(plant: &Plant, domain: &Domain, identity: &Formula) -> BTreeSet<Symbol> {
    let arena = &plant.arena;
    let rates = plant.rates();
    let is_unruled = |symbol: &Symbol| {
        let constant = plant.parameters.iter().any(|parameter| parameter.symbol == *symbol);
        // A signal on which the identity does not depend on its manifold may have any rate.
        !constant && !rates.contains_key(symbol) && !is_zero(arena, arena.derivative(identity.expr, *symbol), domain)
    };
    arena.symbols_of(&[identity.expr]).into_iter().filter(is_unruled).collect()
}

/// The derivative of an identity along the plant; none where it takes the rate of a signal that has none.
fn derivative(plant: &Plant, domain: &Domain, identity: &Formula) -> Option<Expr> {
    unruled(plant, domain, identity).is_empty().then(|| plant.arena.directional(identity.expr, &plant.rates()))
}

/// Decides whether there are rates of the signals without a rate under which all identities are invariant: `a = b + p`
/// and `b = a + s` bind the rates of a and b to one another twice, and leave p' = -s'.
fn jointly_kept(plant: &Plant, domain: &Domain) -> (Verdict, Option<Diagnostic>) {
    let arena = &plant.arena;
    let bound: Vec<(&Formula, BTreeSet<Symbol>)> = plant
        .identities
        .iter()
        .map(|identity| (identity, unruled(plant, domain, identity)))
        .filter(|(_, signals)| !signals.is_empty())
        .collect();
    let signals: BTreeSet<Symbol> = bound.iter().flat_map(|(_, signals)| signals.iter().copied()).collect();
    if bound.len() < 2 {
        return (Verdict::Proved, None);
    }
    let slopes: Vec<Vec<Expr>> = signals
        .iter()
        .map(|signal| bound.iter().map(|(identity, _)| arena.derivative(identity.expr, *signal)).collect())
        .collect();
    let rates = plant.rates();
    let first = bound[0].0;
    let undecided = |obstacle: &Obstacle| {
        Diagnostic::error(
            Code::IdentityUndecided,
            first.span,
            "it could not be decided whether the identities are invariant together along the trajectories of the plant",
        )
        .note(format!("obstacle: {obstacle}"))
        .help("give the rates of the signals in them under `f_y`, or solve the identities for these signals")
    };
    let combinations = match null_vectors(arena, domain, &slopes, bound.len()) {
        Ok(combinations) => combinations,
        Err(obstacle) => return (Verdict::Undecided, Some(undecided(&obstacle))),
    };
    for combination in combinations {
        let known = bound.iter().map(|(identity, _)| arena.directional(identity.expr, &rates));
        let rate = arena.sum(combination.iter().zip(known).map(|(factor, known)| arena.mul(*factor, known)));
        match decide(arena, rate, domain) {
            Answer::Zero => {}
            Answer::Open(obstacle) => return (Verdict::Undecided, Some(undecided(&obstacle))),
            Answer::NonZero(point) => {
                let among = bound.iter().zip(&combination).filter(|(_, factor)| !arena.is_zero(**factor));
                let mut spans = among.map(|((identity, _), _)| identity.span);
                let refusal = Diagnostic::error(
                    Code::IdentityRefuted,
                    spans.next().unwrap_or(first.span),
                    "these identities exclude one another along the trajectories of the plant",
                )
                .label(format!("together they ask that `{}` be zero at all times", arena.print(rate)));
                let refusal = spans.fold(refusal, |refusal, span| refusal.also(span, "with this one"));
                let refusal = refusal
                    .note(Witness::of(rate, &point).sentence(arena))
                    .help("correct one of them: two values of outputs must not define each other");
                return (Verdict::Refuted, Some(refusal));
            }
        }
    }
    (Verdict::Proved, None)
}

/// Decides whether the identity is invariant. Where it binds a signal without a rate, it determines that rate.
fn kept(plant: &Plant, domain: &Domain, identity: &Formula) -> (Verdict, Option<Diagnostic>) {
    let arena = &plant.arena;
    let Some(rate) = derivative(plant, domain, identity) else { return (Verdict::Proved, None) };
    match decide(arena, rate, domain) {
        Answer::Zero => (Verdict::Proved, None),
        Answer::NonZero(point) => (Verdict::Refuted, Some(refused(plant, identity, rate, &Witness::of(rate, &point)))),
        Answer::Open(obstacle) => {
            let message =
                "it could not be decided whether this identity is invariant along the trajectories of the plant";
            let refusal = Diagnostic::error(Code::IdentityUndecided, identity.span, message)
                .label(along(arena, rate))
                .note(format!("obstacle: {obstacle}"))
                .help(if plant.parameters.iter().all(|parameter| parameter.value.is_some()) {
                    "write the identity so that it can be solved for one of its names"
                } else {
                    "write the identity so that it can be solved for one of its names, or give the parameters values"
                });
            (Verdict::Undecided, Some(refusal))
        }
    }
}

/// Refuses an identity that is not invariant, in the author's terms: the value of an output is an identity too.
fn refused(plant: &Plant, identity: &Formula, rate: Expr, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let by_value = |output: &&Output| output.value.is_some_and(|value| value.span == identity.span);
    let Some((output, given)) = plant.y.iter().find(by_value).and_then(|output| Some((output, output.rate?))) else {
        return Diagnostic::error(
            Code::IdentityRefuted,
            identity.span,
            "this identity is not invariant along the trajectories of the plant",
        )
        .label(along(arena, rate))
        .note(witness.sentence(arena))
        .note("the identities hold at this point, but this one is not invariant along the trajectory")
        .help("correct the identity, or the rates under `f_x` and `f_y`");
    };
    let name = arena.name(output.symbol);
    let given_twice = output.value.is_some_and(|value| value.expr == given.expr);
    let (message, help) = if given_twice {
        (
            format!("`g_y` and `f_y` have the same formula for `{name}`, which cannot be both its value and its rate"),
            format!(
                "`g_y` takes the value of an output, `f_y` its time derivative: take `{name}` out of the wrong one"
            ),
        )
    } else {
        (
            format!("the value of `{name}` under `g_y` does not have the rate that `f_y` gives"),
            format!("correct one of the two, or take `{name}` out of `f_y`: its rate follows from its value"),
        )
    };
    Diagnostic::error(Code::IdentityRefuted, identity.span, message)
        .label(format!("the rate less the derivative of this value is `{}`", arena.print(rate)))
        .also(given.span, "the rate")
        .note(witness.sentence(arena))
        .help(help)
}

fn along(arena: &Arena, rate: Expr) -> String {
    format!("its derivative along the plant is `{}`", arena.print(rate))
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use crate::analysis::{Derivation, Outcome};
    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::{Code, Source};

    /// The help of the diagnostic that refuses a plant's one identity, after the message.
    fn said(lines: &str) -> [String; 2] {
        let text = format!("model: m\nx: [a]\ny: [p]\nf_x: {{a: -a}}\nphi: [a]\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        assert_eq!(derivation.outcome, Outcome::Rejected, "{lines}");
        let refused = derivation.diagnostics.iter().find(|found| found.code == Code::IdentityRefuted).expect(lines);
        [refused.message.to_string(), refused.help.clone().unwrap_or_default().to_string()]
    }

    #[test]
    fn outputs_that_define_each_other_are_held_against_the_rates_of_the_states() {
        let derived = |lines: &str| {
            let text = format!("model: m\nx: [p, s]\ny: [a, b]\nu: [v]\nphi: [p, s]\n{lines}\n");
            let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
            Derivation::derive(&plant)
        };
        let refused = derived("f_x: {p: v, s: 0}\ng_y: {a: b + p, b: a + s}");
        assert_eq!(refused.outcome, Outcome::Rejected);
        assert_eq!(refused.diagnostics[0].code, Code::IdentityRefuted);
        let message = &refused.diagnostics[0].message;
        assert!(message.contains("exclude one another"), "{message}");
        assert_eq!(derived("f_x: {p: v, s: 0}\ng_y: {a: b + p, b: s}").outcome, Outcome::Accepted);
    }

    #[test]
    fn a_value_with_another_rate_differs_from_an_identity_that_is_not_invariant() {
        let [message, help] = said("g_y: {p: 2*a}\nf_y: {p: 2*a}");
        assert!(message.starts_with("`g_y` and `f_y` have the same formula for `p`"), "{message}");
        assert!(help.contains("`f_y` its time derivative"), "{help}");
        let [message, help] = said("g_y: {p: 2*a}\nf_y: {p: 2 - a}");
        assert_eq!(message, "the value of `p` under `g_y` does not have the rate that `f_y` gives");
        assert!(help.contains("take `p` out of `f_y`"), "{help}");
        let [message, _] = said("identities: [p - 2*a]\nf_y: {p: a}");
        assert!(message.starts_with("this identity is not invariant"), "{message}");
    }
}
