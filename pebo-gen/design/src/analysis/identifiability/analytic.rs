//! Identifiability where all formulas are analytic: the rank at a point holds almost everywhere.

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::zero::is_zero;
use pebo_cas::linear::rank::{full_rank, null_vectors};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::excitation;
use super::flow::{Flow, effective, without_psi};
use super::never::never;
use super::observation::Observation;
use super::problem::{ObservabilityProblem, SHARE_OF_REMARKS};
use super::singular::{Volume, ZeroSet};
use super::trajectory;
use super::undecided::open;
use crate::analysis::design::{Cascade, Claim, Excitation, Identifiability, Verdict};
use crate::analysis::left_inverse::checking::at_phi;

/// An answer where all formulas are analytic.
pub(super) struct AnalyticDecision {
    /// The verdict.
    pub(super) claim: Claim<Identifiability>,
    /// The observations over time, if they do not identify all unknowns.
    pub(super) observed: Option<Observation>,
}

impl From<Claim<Identifiability>> for AnalyticDecision {
    fn from(claim: Claim<Identifiability>) -> Self {
        Self { claim, observed: None }
    }
}

/// Decides it for formulas that are analytic on the domain.
pub(super) fn where_analytic(problem: &ObservabilityProblem<'_>, found: &mut Vec<Diagnostic>) -> AnalyticDecision {
    let &ObservabilityProblem { plant, domain, cascade, regression, left_inverse } = problem;
    let arena = &plant.arena;
    // In an implicit regression the rates are among the factors of the unknowns.
    let by_rates = regression.primitive_1.iter().flatten().any(|factor| !arena.is_zero(*factor));
    let rows = match Flow::new(plant, domain, cascade) {
        Ok(flow) => effective(arena, domain, &flow, &regression.phi_1, &regression.primitive_1),
        Err(_) if !by_rates => regression.phi_1.clone(),
        Err(obstacle) => return open(plant, &obstacle, found).into(),
    };
    let proved = |result| Claim { verdict: Verdict::Proved, result: Some(result) }.into();
    if full_rank(arena, domain, &rows, problem.unknowns()) {
        let phi_1 = without_psi(plant, &rows);
        let (zero_set, gram) =
            if by_rates { (of_rates(plant, domain, &phi_1), None) } else { excitation::of(plant, domain, &phi_1) };
        return proved(Identifiability {
            singular_where: zero_set.signals,
            everywhere_else: zero_set.all,
            constants: zero_set.constants,
            gram,
            ..Identifiability::new(Excitation::Instant)
        });
    }
    let observed = match problem.solve() {
        Ok(observed) => observed,
        Err(obstacle) => return open(plant, &obstacle, found).into(),
    };
    let Some(direction) = observed.hidden.first() else {
        let (trajectories, constants) = arena.budget().share(SHARE_OF_REMARKS, || trajectory::of(problem));
        let trajectories = Some(trajectories);
        return proved(Identifiability { constants, trajectories, ..Identifiability::new(Excitation::Excitation) });
    };
    // A direction that is constant along every trajectory but depends on signals may be another constant elsewhere if
    // it is non-smooth: the quotient of v and |v|.
    let is_non_smooth = !arena.dividers(direction).is_empty() || !arena.branched(direction).is_empty();
    if is_non_smooth && cascade.lambda.is_none() && moves(plant, domain, cascade, direction) {
        return open(plant, &Obstacle::NoWitness, found).into();
    }
    // A regression that does not identify functions of theta may identify theta.
    if !regression.is_linear(plant)
        && let Some(doubt) = of_theta(problem, &observed.stack, direction)
    {
        found.push(doubt);
        return Claim { verdict: Verdict::Undecided, result: None }.into();
    }
    let refusal = never(plant, domain, &observed.hidden, regression, left_inverse);
    let special = "this holds for the given values of the parameters, not for general values";
    found.push(if observed.is_special { refusal.note(special) } else { refusal });
    let never = Identifiability { direction: Some(direction.clone()), ..Identifiability::new(Excitation::Never) };
    AnalyticDecision { claim: Claim { verdict: Verdict::Refuted, result: Some(never) }, observed: Some(observed) }
}

/// The reason why theta itself may be identifiable although its functions are not; none where a direction of theta is
/// provably unobservable in the rows, which determine all derivatives.
fn of_theta(problem: &ObservabilityProblem<'_>, stack: &[Vec<Expr>], direction: &[Expr]) -> Option<Diagnostic> {
    let &ObservabilityProblem { plant, domain, regression, .. } = problem;
    let arena = &plant.arena;
    let rows = problem.rows_of_theta(stack);
    let apart = full_rank(arena, domain, &rows, plant.theta.len());
    if !apart && null_vectors(arena, domain, &rows, plant.theta.len()).is_ok_and(|vectors| !vectors.is_empty()) {
        return None;
    }
    let eta: Vec<String> = regression.eta.iter().map(|e| arena.print(*e)).collect();
    let entries: Vec<String> = direction.iter().map(|e| arena.print(*e)).collect();
    let doubt = Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "no linear regression was found that identifies the unknowns",
    )
    .label(format!("the outputs do not change when ({}) moves along ({})", eta.join(", "), entries.join(", ")));
    let doubt = if apart {
        doubt.note(
            "theta itself can be identified near almost every value, but not by a linear estimator of these functions",
        )
    } else {
        doubt.note("it could not be decided whether theta itself can be identified")
    };
    Some(doubt.help(
        "take the products of states that occur in the rates as components of phi: if their own rates are linear in phi \
         again, the cascade is a generalised one and the regression is linear",
    ))
}

/// The conditions under which a regressor with the rates of outputs loses rank: zeros of parameters and signals alone.
/// An observer cannot know a zero of states.
fn of_rates(plant: &Plant, domain: &Domain, rows: &[Vec<Expr>]) -> ZeroSet {
    let arena = &plant.arena;
    let found = || Volume::of(arena, domain, rows)?.zero_set(plant, domain);
    let ZeroSet { signals, zeros, constants, all, joint } =
        arena.budget().share(SHARE_OF_REMARKS, found).unwrap_or_default();
    let hidden = plant.hidden();
    let (known, other): (Vec<_>, Vec<_>) =
        signals.into_iter().zip(zeros).partition(|(_, zero)| !arena.depends_on(*zero, &hidden));
    let (signals, zeros) = known.into_iter().unzip();
    ZeroSet { signals, zeros, constants, all: all && other.is_empty(), joint }
}

/// Tests whether formulas depend on moving signals: all but the parameters and signals whose rate is zero.
fn moves(plant: &Plant, domain: &Domain, cascade: &Cascade, formulas: &[Expr]) -> bool {
    let arena = &plant.arena;
    let Ok(flow) = Flow::new(plant, domain, cascade) else { return true };
    let is_constant = |symbol: Symbol| is_zero(arena, flow.rate(arena, arena.of_symbol(symbol)), domain);
    arena.symbols_of(formulas).into_iter().any(|symbol| !is_constant(symbol))
}
