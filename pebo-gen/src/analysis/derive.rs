//! The order of the claims: what each builds on.

use crate::cas::Expr;
use crate::cas::facts::Relation;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};

use super::design::{Claim, Derivation, Outcome, Verdict};
use super::{cascade, conditions, identifiability, known, left_inverse, regression};

impl Derivation {
    /// Derives the observer of a plant: every claim with its verdict.
    pub fn derive(plant: &Plant) -> Self {
        let domain = plant.domain();
        let mut found: Vec<Diagnostic> = nothing_assumed(plant).into_iter().collect();
        let (class, cascade) = cascade::prove(plant, &domain, &mut found);
        let cascade = known::cascade(plant, cascade, &mut found);
        let left_inverse = left_inverse::prove(plant, &domain, &mut found);
        let left_inverse = known::left_inverse(plant, left_inverse, &mut found);
        let inverse = left_inverse.result.as_ref().filter(|_| left_inverse.verdict == Verdict::Proved);
        let regression = match &cascade.result {
            Some(result) if cascade.verdict == Verdict::Proved => {
                let claim = regression::prove(plant, &domain, result, inverse, &mut found);
                known::regression(plant, class, claim, &mut found)
            }
            _ => Claim::skipped(),
        };
        let identifiability = match (&cascade.result, &regression.result) {
            (Some(cascade), Some(result)) if regression.verdict == Verdict::Proved => {
                identifiability::prove(plant, &domain, cascade, result, inverse, &mut found)
            }
            _ => Claim::skipped(),
        };
        let (regression, identifiability) = match &cascade.result {
            // What the outputs' rates do not show, an identity may.
            Some(result) if identifiability.verdict == Verdict::Refuted && !plant.identities.is_empty() => {
                let mut others = Vec::new();
                let other = regression::from_identities(plant, &domain, result, inverse, &mut others);
                let other = known::regression(plant, class, other, &mut others);
                let seen = other
                    .result
                    .as_ref()
                    .map(|r| identifiability::prove(plant, &domain, result, r, inverse, &mut others))
                    .filter(|seen| seen.verdict == Verdict::Proved);
                match seen {
                    Some(seen) => {
                        found.retain(|d| d.code != Code::NeverIdentifiable);
                        found.extend(others);
                        (other, seen)
                    }
                    None => (regression, identifiability),
                }
            }
            _ => (regression, identifiability),
        };
        let verdicts = [cascade.verdict, left_inverse.verdict, regression.verdict, identifiability.verdict];
        let mut conditions = conditions::remaining(plant, &plant.assumed());
        for constant in identifiability.result.iter().flat_map(|result| &result.constants) {
            let known = conditions.iter().any(|(expr, _)| expr == constant);
            conditions.extend((!known).then_some((*constant, Relation::NonZero)));
        }
        Self {
            outcome: outcome(&verdicts),
            class,
            cascade,
            left_inverse,
            regression,
            identifiability,
            conditions,
            diagnostics: found,
        }
    }

    /// The derivation, if every claim is proved; else what to tell the author.
    pub fn admit(&self) -> Result<&Self, &[Diagnostic]> {
        if self.outcome == Outcome::Accepted { Ok(self) } else { Err(&self.diagnostics) }
    }
}

impl<T> Claim<T> {
    fn skipped() -> Self {
        Self { verdict: Verdict::Skipped, result: None }
    }
}

fn outcome(verdicts: &[Verdict]) -> Outcome {
    if verdicts.contains(&Verdict::Refuted) {
        Outcome::Rejected
    } else if verdicts.iter().all(|v| *v == Verdict::Proved) {
        Outcome::Accepted
    } else {
        Outcome::Undecided
    }
}

/// A claim about no values at all is true: that no point satisfies the assumptions is worth knowing.
fn nothing_assumed(plant: &Plant) -> Option<Diagnostic> {
    let (first, last) = (plant.assumptions.first()?, plant.assumptions.last()?);
    let assumed: Vec<Expr> = plant.assumptions.iter().map(|assumption| assumption.expr).collect();
    plant.assumed().points(&plant.arena, &assumed).next().is_none().then(|| {
        let message = "no values were found that satisfy all assumptions together";
        Diagnostic::warning(Code::ContradictoryAssumptions, first.span.to(last.span), message)
            .note("if there are none, the claims say nothing")
            .help("see that the assumptions do not exclude one another")
    })
}
