//! The claims in the order of their dependence.

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::zero::MOST_POINTS;
use pebo_cas::{Domain, Expr, Relation};

use super::advice::remark::Remarks;
use super::conditions::{Conditions, DomainCondition};
use super::design::{Cascade, Claim, Class, Derivation, Outcome, Regression, Verdict};
use super::left_inverse::checking::at_phi;
use super::limited::{ended, limited, unfinished};
use super::regression::{self, Claims, Premises};
use super::{cascade, identities, left_inverse, permitted, turns};

impl Derivation {
    /// Derives the observer of a plant: every claim with its verdict.
    pub fn derive(plant: &Plant) -> Self {
        let domain = plant.domain();
        let mut found: Vec<Diagnostic> = Vec::new();
        let verdict = identities::prove(plant, &domain, &mut found);
        if verdict != Verdict::Proved {
            return Self::without_claims(verdict, found);
        }
        let mut class = Class::Pebo;
        let mut cascade = limited(plant, "the cascade", &mut found, |found| {
            let (kind, claim) = cascade::prove(plant, &domain, found);
            class = kind;
            permitted::cascade(plant, claim, found)
        });
        let mut left_inverse = limited(plant, "the left inverse", &mut found, |found| {
            let claim = left_inverse::prove(plant, &domain, found);
            permitted::left_inverse(plant, claim, found)
        });
        let inverse = left_inverse.result.as_ref().filter(|_| left_inverse.verdict == Verdict::Proved);
        let Claims { mut regression, mut identifiability, open: mut unidentified } = match &cascade.result {
            Some(result) if cascade.verdict == Verdict::Proved => {
                let premises = Premises { plant, domain: &domain, class, cascade: result, left_inverse: inverse };
                regression::prove(premises, &mut found)
            }
            _ => Claims::without_unknowns(Claim::skipped()),
        };
        // What the conditions leave open.
        let mut unsettled = Vec::new();
        if let (Some(cascade), Some(regression), Some(inverse)) = (&cascade.result, &regression.result, inverse) {
            let refused = turns::refused(plant, &domain, &turns::Computed { cascade, regression, inverse });
            if !refused.is_empty() {
                left_inverse.doubt();
                unsettled.extend(refused);
            }
        }
        let mut conditions = Conditions::of(plant);
        for constant in identifiability.result.iter().flat_map(|result| &result.constants) {
            conditions.list(&plant.arena, (*constant, Relation::NonZero));
        }
        for positive in identifiability.result.iter().flat_map(|result| &result.positive) {
            conditions.list(&plant.arena, (*positive, Relation::Positive));
        }
        let unmet = [
            (Code::CascadeUndecided, "h", cascade.settle(|result| conditions.list_cascade(plant, result))),
            (Code::LeftInverseUndecided, "phi_left", left_inverse.settle(|r| conditions.list_left_inverse(plant, r))),
            (Code::RegressionUndecided, "the regression", regression.settle(|r| conditions.list_regression(plant, r))),
        ];
        unsettled.extend(
            unmet.into_iter().filter_map(|(code, what, condition)| Some(without_value(plant, code, what, condition?))),
        );
        if let Some(diagnostic) = start_without_value(plant, &conditions.listed()) {
            unsettled.push(diagnostic);
            left_inverse.doubt();
        }
        // Without a budget no point is looked for: that takes nothing back.
        let is_found = || is_somewhere(plant, conditions.domain(), cascade.result.as_ref(), regression.result.as_ref());
        if !plant.arena.budget().is_exhausted() && !is_found() {
            unsettled.push(nowhere(plant));
            cascade.doubt();
            left_inverse.doubt();
            regression.doubt();
            identifiability.doubt();
        }
        if ended(plant, &found) && ended(plant, &unidentified) {
            unidentified = Vec::new();
            identifiability = unfinished(plant, "the conditions", &mut unidentified);
        }
        found.extend(unidentified);
        // Out of budget, nothing of these is known to be wrong.
        found.extend(unsettled.into_iter().filter(|_| !plant.arena.budget().is_exhausted()));
        let verdicts = [cascade.verdict, left_inverse.verdict, regression.verdict, identifiability.verdict];
        Self {
            outcome: outcome(&verdicts),
            class,
            cascade,
            left_inverse,
            regression,
            identifiability,
            conditions: conditions.listed(),
            diagnostics: found,
            remarks: Remarks::default(),
        }
    }

    /// The refusal of a plant whose identities contradict it, whatever its transform is; none if they do not, or that
    /// is undecided.
    pub fn of_contradiction(plant: &Plant) -> Option<Self> {
        let mut found = Vec::new();
        let verdict = identities::prove(plant, &plant.domain(), &mut found);
        (verdict == Verdict::Refuted).then(|| Self::without_claims(verdict, found))
    }

    /// The empty derivation of a plant without a transform: refuted where it is proved that no observer recovers its
    /// states, else undecided.
    pub fn without_transform(diagnostics: Vec<Diagnostic>, refuted: bool) -> Self {
        Self::without_claims(if refuted { Verdict::Refuted } else { Verdict::Undecided }, diagnostics)
    }

    /// The empty derivation of a plant whose identities are not proved.
    fn without_claims(verdict: Verdict, diagnostics: Vec<Diagnostic>) -> Self {
        Self {
            outcome: outcome(&[verdict]),
            class: Class::Pebo,
            cascade: Claim::skipped(),
            left_inverse: Claim::skipped(),
            regression: Claim::skipped(),
            identifiability: Claim::skipped(),
            conditions: Vec::new(),
            diagnostics,
            remarks: Remarks::default(),
        }
    }

    /// The derivation, if every claim is proved; else its diagnostics.
    pub fn admit(&self) -> Result<&Self, &[Diagnostic]> {
        if self.outcome == Outcome::Accepted { Ok(self) } else { Err(&self.diagnostics) }
    }
}

impl Outcome {
    /// The verdict on a model without a plant: undecided if every diagnostic says that something could not be worked
    /// out.
    pub fn of_unread(diagnostics: &[Diagnostic]) -> Self {
        if diagnostics.iter().all(|diagnostic| diagnostic.code.is_open()) { Self::Undecided } else { Self::Rejected }
    }
}

impl<T> Claim<T> {
    pub(super) fn skipped() -> Self {
        Self { verdict: Verdict::Skipped, result: None }
    }

    /// Makes a proved claim undecided if a domain condition of its formulas is neither implied nor listed; returns the
    /// condition.
    fn settle(&mut self, condition: impl FnOnce(&T) -> Option<DomainCondition>) -> Option<DomainCondition> {
        let result = self.result.as_ref().filter(|_| self.verdict == Verdict::Proved)?;
        let unmet = condition(result)?;
        self.doubt();
        Some(unmet)
    }

    /// Makes a proved claim undecided.
    fn doubt(&mut self) {
        if self.verdict == Verdict::Proved {
            self.verdict = Verdict::Undecided;
        }
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

/// Formulas that have no value where the claim is made.
fn without_value(plant: &Plant, code: Code, what: &str, (part, relation): DomainCondition) -> Diagnostic {
    let arena = &plant.arena;
    let condition = format!("{} {}", arena.print(part), relation.sign());
    let diagnostic =
        Diagnostic::error(code, at_phi(plant), format!("{what} was not shown to have a value throughout the domain"))
            .label(format!("this needs `{condition}`"));
    if arena.symbols_of(&[part]).iter().any(|symbol| plant.is_of_extension(*symbol)) {
        return diagnostic
            .note(
                "the states of the extension and theta may have any values: they are not confined to the range of phi",
            )
            .help("choose a phi in which the rates of the outputs are polynomials, exponentials, sines and cosines");
    }
    diagnostic.help(format!("if it holds, write `{condition}` under `assume`"))
}

/// The diagnostic of a known start at which a condition of the proofs fails.
fn start_without_value(plant: &Plant, conditions: &[DomainCondition]) -> Option<Diagnostic> {
    let arena = &plant.arena;
    let values = plant.known.iter().map(|(state, value)| (*state, value.expr)).collect();
    let fails = |(part, relation): &&DomainCondition| {
        let at_start = arena.substitute(arena.substitute(*part, &values), &plant.domain().fixed);
        arena.symbols_of(&[at_start]).is_empty() && arena.fails_of_number((at_start, *relation))
    };
    let assumed = plant.assumptions.iter().map(|assumption| (assumption.expr, assumption.relation));
    let needed: Vec<DomainCondition> = conditions.iter().copied().chain(assumed).collect();
    let (part, relation) = needed.iter().find(fails)?;
    let held = arena.symbols_of(&[*part]);
    let (state, value) = plant.known.iter().find(|(state, _)| held.contains(state))?;
    let message =
        format!("the proofs need `{} {}`, which fails where the plant starts", arena.print(*part), relation.sign());
    let state = arena.name(*state);
    let help = format!("leave `{state}` out of `known`, or choose a phi that does without the condition");
    Some(Diagnostic::error(Code::LeftInverseUndecided, value.span, message).help(help))
}

/// Tests whether a point of the domain was found at which all formulas have values.
fn is_somewhere(plant: &Plant, domain: &Domain, cascade: Option<&Cascade>, regression: Option<&Regression>) -> bool {
    let arena = &plant.arena;
    let mut formulas: Vec<Expr> = plant.transform();
    formulas.extend(plant.rates().into_values());
    formulas.extend(plant.assumptions.iter().map(|assumption| assumption.expr));
    formulas.extend(cascade.iter().flat_map(|c| c.h.iter().chain(c.lambda.iter().flatten().flatten())));
    formulas.extend(regression.iter().flat_map(|r| r.phi_0.iter().chain(r.phi_1.iter().flatten())));
    let exist = |point: &_| formulas.iter().all(|formula| arena.exists_at(*formula, point));
    domain.points(arena, &formulas).take(MOST_POINTS).any(|point| exist(&point))
}

/// A claim about no values at all is true, and worth nothing.
fn nowhere(plant: &Plant) -> Diagnostic {
    let span = match (plant.assumptions.first(), plant.assumptions.last()) {
        (Some(first), Some(last)) => first.span.to(last.span),
        _ => at_phi(plant),
    };
    let message = "no values were found at which all assumptions hold and all formulas have values";
    Diagnostic::error(Code::ContradictoryAssumptions, span, message)
        .note("claims about an empty domain say nothing, so no claim is called proved")
        .help("check that the assumptions do not exclude one another, or give numeric bounds for each symbol")
}
