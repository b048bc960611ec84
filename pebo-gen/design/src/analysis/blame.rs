//! Finds the summands of the author's rates that cause a refusal.
//!
//! In: the plant and the refused expression. Out: spans. Nothing here decides a claim: the refusal was proved before,
//! and without a distinct summand it points at the whole formula.

use crate::plant::{Formula, Plant};
use crate::source::Diagnostic;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Domain, Expr, Symbol};

use pebo_cas::forms::tidy::shortest;

/// More spans than this do not help.
const MOST_SPANS: usize = 3;

/// A summand of a rate, as it enters the derivative of a component of the transform.
struct Share {
    of: Symbol,
    term: Formula,
    slope: Expr,
    whole: Expr,
}

/// Adds the summands of rates that keep the derivative of a component from being free of x.
pub(super) fn cascade(plant: &Plant, domain: &Domain, index: usize, refusal: Diagnostic) -> Diagnostic {
    let arena = &plant.arena;
    let hidden = plant.hidden();
    let mut shares = Vec::new();
    for (of, terms) in &plant.terms {
        let slope = arena.derivative(plant.phi[index].expr, *of);
        if arena.is_zero(slope) {
            continue;
        }
        for term in terms {
            let whole = shortest(arena, domain, arena.mul(slope, term.expr));
            if arena.depends_on(whole, &hidden) {
                shares.push(Share { of: *of, term: *term, slope, whole });
            }
        }
    }
    // Two that cancel are not to blame.
    let cancels = |one: &Share| {
        shares
            .iter()
            .any(|other| other.term.span != one.term.span && is_zero(arena, arena.add(one.whole, other.whole), domain))
    };
    let left: Vec<&Share> = shares.iter().filter(|share| !cancels(share)).collect();
    if left.len() > MOST_SPANS {
        return refusal;
    }
    left.into_iter().fold(refusal, |refusal, share| {
        let (rate, slope) = (arena.name(share.of), arena.print(share.slope));
        let factor = if share.slope == arena.one() { String::new() } else { format!(", times `{slope}` from phi") };
        refusal.also(share.term.span, format!("it comes from this term of {rate}'{factor}"))
    })
}

/// The summands of an output's rate that satisfy a predicate; the whole rate if none or all of them do.
pub(super) fn summands(plant: &Plant, output: usize, holds: impl Fn(Expr) -> bool) -> Vec<Formula> {
    let output = &plant.y[output];
    let terms = plant.terms.get(&output.symbol).map_or(&[][..], Vec::as_slice);
    let found: Vec<Formula> = terms.iter().copied().filter(|term| holds(term.expr)).collect();
    let whole = || output.rate.into_iter().collect();
    if found.is_empty() || found.len() > MOST_SPANS { whole() } else { found }
}
