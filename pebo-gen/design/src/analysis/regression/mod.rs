//! Claims 3 and 4, the regression and its identifiability: the unknowns enter linearly, and the outputs determine them.
//!
//! In: the plant and its proved cascade. Out: of the selections from the pool of the plant's equations the first that
//! makes a regression which identifies the unknowns, with all outputs that say something of them; else the refusal that
//! says what the pool lacks. Rates come first (`f_y = A(y, u) + B(y, u) phi`, or functions of theta), then relations at
//! every instant (Ortega et al. 2015, eqs. 16 and 28), then what can be combined. Without such a regression there may be
//! one that is monotone in theta; where the model asks for it, all equations are taken to first order instead.

mod affine_rate;
mod build;
mod cancelling;
mod cleared;
mod diagnostics;
mod differentiated;
mod equation;
mod forms;
mod implicit;
mod local;
mod monotone;
mod outputs;
mod pool;
mod premises;
mod recovery;
mod refusal;
mod relations;
mod selection;
mod separation;
mod steps;
mod trial;

use std::cell::OnceCell;

use super::design::{Claim, Verdict};
use super::identifiability::undecided::not_all_used;
use super::limited::limited;
use crate::plant::{Plant, TransformOrigin};
use crate::source::Diagnostic;
use build::Obstruction;
use pool::{Pool, Rest};
pub(super) use premises::Premises;
use selection::{Part, Selection, Source};
pub(super) use trial::Claims;
use trial::Trial;

/// What was tried without success.
#[derive(Default)]
struct Tried {
    /// The first proved regression.
    given: Option<Trial>,
    /// The last one with further equations.
    strengthened: Option<Trial>,
    rest: OnceCell<Rest>,
    failures: Vec<(Selection, Obstruction)>,
}

/// Proves or refutes both claims: by the outputs, or else by these and the known start of the plant.
pub(super) fn prove(premises: Premises<'_>, found: &mut Vec<Diagnostic>) -> Claims {
    if premises.plant.known_components().is_empty() {
        return prove_from(premises, found);
    }
    let unknown_start = Plant { known: Vec::new(), ..premises.plant.clone() };
    let mut reported = Vec::new();
    let claims = prove_from(Premises { plant: &unknown_start, ..premises }, &mut reported);
    if claims.identifiability.verdict != Verdict::Proved {
        return prove_from(premises, found);
    }
    found.append(&mut reported);
    claims
}

fn prove_from(premises: Premises<'_>, found: &mut Vec<Diagnostic>) -> Claims {
    let pool = Pool::of(premises);
    if premises.plant.local_regression.is_some()
        && let Some(local) = local::decided(&pool)
    {
        return local.claims(found);
    }
    let mut tried = Tried::default();
    if let Some(linear) = linear(&pool, &mut tried) {
        return linear.claims(found);
    }
    // What a linear regression lacks, as the period of an angle, is worth more than one with fewer outputs.
    let is_refused = |failure: &(Selection, Obstruction)| matches!(failure.1, Obstruction::Refused(..));
    let is_beyond = !tried.failures.iter().any(is_refused);
    match is_beyond.then(|| monotone::decided(&pool)).flatten() {
        Some(monotone) => monotone.claims(found),
        None => tried.conclude(&pool, found).beyond_linear(premises.plant, found),
    }
}

/// The first regression that is linear in functions of theta and identifies them; what was tried without success is noted.
fn linear(pool: &Pool<'_>, tried: &mut Tried) -> Option<Trial> {
    let premises = pool.premises;
    let (first, others) = selection::order(premises.plant);
    for (is_first, selection) in first.iter().map(|s| (true, *s)).chain(others.iter().map(|s| (false, *s))) {
        let is_failed = tried.failures.iter().any(|(failed, _)| *failed == selection);
        if premises.plant.arena.budget().is_exhausted() {
            break;
        }
        if is_failed || is_first && tried.given.is_some() {
            continue;
        }
        let equations = selection::equations(selection, pool, tried.given.as_ref(), &tried.rest);
        if equations.is_empty() {
            continue;
        }
        let trial = match Trial::of(&premises, equations) {
            Ok(trial) if trial.is_identified() => outputs::completed(pool, forms::preferred(pool, trial)),
            Ok(trial) => trial,
            Err(obstruction) => {
                tried.failures.push((selection, obstruction));
                continue;
            }
        };
        if trial.is_identified() && forms::is_chosen(pool, &trial) {
            return Some(trial);
        }
        match selection {
            (Source::More, _) => tried.strengthened = Some(trial),
            _ if is_first => tried.given = Some(trial),
            _ => {}
        }
    }
    None
}

impl Claims {
    /// The same, where a monotone regression is asked for: that there is no linear one refutes none of these.
    fn beyond_linear(mut self, plant: &Plant, found: &mut Vec<Diagnostic>) -> Self {
        let is_asked = plant.monotone_regression && plant.origin == TransformOrigin::Given;
        if is_asked && self.regression.verdict == Verdict::Refuted {
            self.regression.verdict = Verdict::Undecided;
            found.insert(0, diagnostics::no_monotone_one(plant));
        }
        self
    }
}

impl Tried {
    /// The claims where no selection identifies the unknowns.
    fn conclude(self, pool: &Pool<'_>, found: &mut Vec<Diagnostic>) -> Claims {
        let plant = pool.premises.plant;
        let chosen = plant.relation_form.filter(|_| !plant.arena.budget().is_exhausted());
        let is_complete = self.is_complete();
        let Self { given, strengthened, failures, rest } = self;
        if let Some(form) = chosen.filter(|_| !given.as_ref().is_some_and(|given| forms::is_chosen(pool, given))) {
            found.push(diagnostics::no_such_form(plant, form));
            return Claims::without_unknowns(Claim { verdict: Verdict::Undecided, result: None });
        }
        let Some(mut given) = given else {
            let refuse = |found: &mut Vec<Diagnostic>| refusal::refused(pool, &failures, found);
            let refused = limited(plant, "the regression", found, refuse);
            found.extend(plant.local_regression.map(diagnostics::no_local_one));
            return Claims::without_unknowns(refused);
        };
        let is_refuted = given.identifiability.verdict == Verdict::Refuted;
        let says_more =
            |trial: &Trial| is_refuted && (is_complete || trial.identifiability.verdict == Verdict::Undecided);
        if let Some(strengthened) = strengthened.filter(says_more) {
            given = strengthened;
        } else if is_refuted && !is_complete && rest.get().is_some() {
            given.open = vec![not_all_used(plant, &given.regression.sources)];
            given.identifiability = Claim { verdict: Verdict::Undecided, result: None };
        }
        given.claims(found)
    }

    /// Tests whether no equation was left out that could say more of the unknowns.
    fn is_complete(&self) -> bool {
        let is_whole = |failure: &(Selection, Obstruction)| failure.0 == (Source::More, Part::Whole);
        self.rest.get().is_some_and(|rest| rest.complete) && !self.failures.iter().any(is_whole)
    }
}
