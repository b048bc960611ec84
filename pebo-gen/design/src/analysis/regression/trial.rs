//! A regression of selected equations, with its identifiability.

use super::build::{self, Obstruction};
use super::equation::Equation;
use super::premises::Premises;
use crate::analysis::conditions::where_valued;
use crate::analysis::design::{AtEstimate, Claim, Excitation, Identifiability, Regression, Verdict};
use crate::analysis::limited::limited;
use crate::analysis::{identifiability, permitted};
use crate::source::Diagnostic;

/// The claims on the regression and its unknowns.
pub(in crate::analysis) struct Claims {
    pub(in crate::analysis) regression: Claim<Regression>,
    pub(in crate::analysis) identifiability: Claim<Identifiability>,
    /// The diagnostics of the identifiability, which a derivation without time to settle it leaves out.
    pub(in crate::analysis) open: Vec<Diagnostic>,
}

impl Claims {
    /// Those without a regression.
    pub(in crate::analysis) fn without_unknowns(regression: Claim<Regression>) -> Self {
        Self { regression, identifiability: Claim::skipped(), open: Vec::new() }
    }
}

/// A proved regression, with the verdict on its identifiability.
pub(super) struct Trial {
    pub(super) equations: Vec<Equation>,
    pub(super) regression: Regression,
    pub(super) identifiability: Claim<Identifiability>,
    /// The diagnostics of the regression.
    pub(super) said: Vec<Diagnostic>,
    /// Those of the identifiability.
    pub(super) open: Vec<Diagnostic>,
}

impl Trial {
    /// The regression of equations in theta, or in functions of theta.
    pub(super) fn of(premises: &Premises<'_>, equations: Vec<Equation>) -> Result<Self, Obstruction> {
        let mut said = Vec::new();
        let built = build::regression(premises, &equations, &mut said)?;
        Self::on(premises, equations, built, said)
    }

    /// The regression of equations with their slopes at the estimate.
    pub(super) fn at_estimate(
        premises: &Premises<'_>,
        equations: Vec<Equation>,
        sense: AtEstimate,
    ) -> Result<Self, Obstruction> {
        let built = build::at_estimate(premises, &equations, sense)?;
        Self::on(premises, equations, built, Vec::new())
    }

    fn on(
        premises: &Premises<'_>,
        equations: Vec<Equation>,
        built: Regression,
        mut said: Vec<Diagnostic>,
    ) -> Result<Self, Obstruction> {
        let Premises { plant, domain, class, cascade, left_inverse } = *premises;
        let claim = limited(plant, "the regression", &mut said, |said| {
            let claim = Claim { verdict: Verdict::Proved, result: Some(built) };
            permitted::regression(plant, class, claim, said)
        });
        let Some(regression) = claim.result.filter(|_| claim.verdict == Verdict::Proved) else {
            return Err(Obstruction::Refused(claim.verdict, said));
        };
        let mut open = Vec::new();
        let identifiability = limited(plant, "identifiability", &mut open, |open| {
            let regression = &regression.with_extension(plant, &plant.transform());
            let domain = where_valued(plant, domain, (cascade, left_inverse, regression));
            identifiability::prove(plant, &domain, cascade, regression, left_inverse, open)
        });
        Ok(Self { equations, regression, identifiability, said, open })
    }

    pub(super) fn is_identified(&self) -> bool {
        self.identifiability.verdict == Verdict::Proved
    }

    /// Tests whether one instant identifies all unknowns.
    pub(super) fn is_at_once(&self) -> bool {
        let result = self.identifiability.result.as_ref();
        self.is_identified() && result.is_some_and(|result| result.kind == Excitation::Instant)
    }

    /// Tests whether all unknowns are identified without a movement of the inputs.
    pub(super) fn is_by_itself(&self) -> bool {
        let trajectories = self.identifiability.result.iter().find_map(|result| result.trajectories.as_ref());
        self.is_at_once() || self.is_identified() && trajectories.is_some_and(|t| t.by_itself == Some(true))
    }

    /// The claims; `found` gets the diagnostics of the regression.
    pub(super) fn claims(mut self, found: &mut Vec<Diagnostic>) -> Claims {
        found.append(&mut self.said);
        let regression = Claim { verdict: Verdict::Proved, result: Some(self.regression) };
        Claims { regression, identifiability: self.identifiability, open: self.open }
    }
}
