//! Sums of many terms.
//!
//! In: terms with the signs between them. Out: their sum as a tree that is not as deep as they are many: a short sum groups to
//! the left, as it is read; a long one is runs of terms that do, added in pairs.

use super::Operator;
use super::bounds::SizedFormula;
use crate::source::Diagnostic;

/// Terms from which on a sum is long. It takes fewer levels than a sum of as many.
const LONG: usize = 64;

/// Terms of a run.
const RUN: usize = 16;

/// The sum.
pub(super) fn sum(first: SizedFormula, rest: Vec<(Operator, SizedFormula)>) -> Result<SizedFormula, Diagnostic> {
    if rest.len() < LONG {
        return run(first, rest);
    }
    let mut rest = rest.into_iter();
    let mut runs = Vec::new();
    let mut next = Some(first);
    while let Some(start) = next {
        runs.push(run(start, rest.by_ref().take(RUN - 1).collect())?);
        next = match rest.next() {
            Some((Operator::Subtract, term)) => {
                let span = term.formula.span;
                Some(SizedFormula::negative(term, span)?)
            }
            other => other.map(|(_, term)| term),
        };
    }
    while runs.len() > 1 {
        let mut pairs = Vec::with_capacity(runs.len().div_ceil(2));
        let mut waiting = runs.into_iter();
        while let Some(left) = waiting.next() {
            pairs.push(run(left, waiting.next().map(|right| (Operator::Add, right)).into_iter().collect())?);
        }
        runs = pairs;
    }
    Ok(runs.swap_remove(0))
}

/// Terms grouped to the left.
fn run(first: SizedFormula, rest: Vec<(Operator, SizedFormula)>) -> Result<SizedFormula, Diagnostic> {
    rest.into_iter().try_fold(first, |left, (operator, right)| {
        let span = left.formula.span.to(right.formula.span);
        SizedFormula::binary(operator, left, right, span)
    })
}
