//! Claim 4, identifiability: the unknowns are identifiable.
//!
//! In: the regression. Out: `instant` where `Phi_1` has full column rank at almost every point (proved by a point at
//! which a rigorous elimination finds it), `excitation` where it has only with its time derivatives along the plant,
//! `never` where a direction of the unknowns is unobservable in every derivative (proved by exact linear algebra).
//! Inputs, and signals without an equation, are free functions of time up to the identities: their derivatives are new
//! symbols (Ortega et al. 2015, remark R3).

pub(in crate::analysis) mod trajectory;

mod components;
mod crossing;
mod divided;
mod excitation;
mod flow;
mod joined;
mod never;
mod regimes;
mod singular;
mod special;

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::reducible::reducible;
use pebo_cas::domain::zero::decide;
use pebo_cas::linear::rank::{full_rank, full_rank_throughout, null_vectors, proved_rank};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Symbol};

use self::components::on_components;
use self::divided::{AnalyticDecision, Formulas};
use self::flow::{Flow, effective, without_psi};
use self::never::never;
use self::singular::{Volume, ZeroSet};
use self::trajectory::SHARE_OF_REMARKS;
use super::design::{Cascade, Claim, Excitation, Identifiability, LeftInverse, Regression, Verdict};
use super::left_inverse::checking::at_phi;

/// Decides how the unknowns are identified.
pub(super) fn prove(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Identifiability> {
    // In an implicit regression the rates of outputs are among the factors of the unknowns.
    let effective = match Flow::new(plant, domain, cascade) {
        Ok(flow) => effective(&plant.arena, domain, &flow, &regression.phi_1, &regression.primitive_1),
        Err(_) => regression.phi_1.clone(),
    };
    let regressor: Vec<Expr> = effective.iter().chain(&regression.primitive_1).flatten().copied().collect();
    let identities: Vec<Expr> = plant.identities.iter().map(|identity| identity.expr).collect();
    let formulas = Formulas { rates: moving(plant, cascade, &regressor, &identities), regressor, identities };
    let hidden = plant.hidden();
    let holds_states = depends_on_states(plant, &formulas, cascade);
    let held = held_by(plant, domain, cascade, &formulas.regressor);
    let concerns =
        |equation| (holds_states || !plant.arena.depends_on(equation, &hidden)) && binds(plant, equation, &held);
    let decide = |domain: &Domain, found: &mut Vec<Diagnostic>| {
        let on = |domain: &Domain, found: &mut Vec<Diagnostic>| {
            where_analytic(plant, domain, cascade, regression, left_inverse, found)
        };
        regimes::decide(plant, domain, (cascade, regression), &formulas, found, on)
    };
    let mut claim = match reducible(&plant.arena, domain, concerns) {
        // A rank that nothing lowers needs no point.
        Some(_) if is_instant_throughout(plant, domain, &effective, regression) => {
            let result = Identifiability { everywhere_else: true, ..Identifiability::new(Excitation::Instant) };
            Claim { verdict: Verdict::Proved, result: Some(result) }
        }
        Some(equation) => on_components(plant, domain, &formulas, decide).unwrap_or_else(|| {
            found.push(falls_apart(plant, equation));
            Claim { verdict: Verdict::Undecided, result: None }
        }),
        None => decide(domain, found).unwrap_or_else(|obstacle| open(plant, &obstacle, found)),
    };
    if let Some(result) = claim.result.as_mut()
        && let Some(trajectories) = &mut result.trajectories
    {
        let domain = trajectory::assuming(domain, &result.constants, &result.positive);
        trajectory::rest::add(trajectories, plant, &domain, cascade, regression);
    }
    claim
}

/// Tests whether the regressor provably has full column rank at every point.
fn is_instant_throughout(plant: &Plant, domain: &Domain, rows: &[Vec<Expr>], regression: &Regression) -> bool {
    let rows = without_psi(plant, rows);
    // A share: the components are examined otherwise.
    let decide = || full_rank_throughout(&plant.arena, domain, &rows, regression.eta.len());
    plant.arena.budget().share(4, decide).unwrap_or(false)
}

/// The rates in the regressor's derivatives; all of them if these hold inputs, which the rates may restrict.
fn moving(plant: &Plant, cascade: &Cascade, regressor: &[Expr], identities: &[Expr]) -> Vec<Expr> {
    let arena = &plant.arena;
    let mut rates = plant.rates();
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    rates.extend(extension.iter().copied().zip(cascade.h.iter().copied()));
    let lambda: Vec<Expr> = cascade.lambda.iter().flatten().flatten().copied().collect();
    let held = [regressor, identities, &lambda].concat();
    let mut reached = arena.symbols_of(&held);
    let mut open: Vec<Symbol> = reached.iter().copied().collect();
    while let Some(rate) = open.pop().map(|symbol| rates.get(&symbol)) {
        let symbols = rate.map(|rate| arena.symbols_of(&[*rate])).unwrap_or_default();
        open.extend(symbols.into_iter().filter(|symbol| reached.insert(*symbol)));
    }
    let needs_all = plant.commanded().any(|input| reached.contains(&input));
    let own = rates.into_iter().filter(|(symbol, _)| needs_all || reached.contains(symbol)).map(|(_, rate)| rate);
    own.chain(lambda).collect()
}

/// The symbols of the regressor and its derivatives, and those that equations bind to them: equations in others do not
/// restrict its arguments.
fn held_by(plant: &Plant, domain: &Domain, cascade: &Cascade, regressor: &[Expr]) -> BTreeSet<Symbol> {
    let arena = &plant.arena;
    let mut rates = plant.rates();
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    rates.extend(extension.iter().copied().zip(cascade.h.iter().copied()));
    let lambda = cascade.lambda.iter().flatten().flatten().copied();
    let mut held = arena.symbols_of(&lambda.chain(regressor.iter().copied()).collect::<Vec<_>>());
    loop {
        let moving = held.iter().filter_map(|symbol| rates.get(symbol).copied());
        let bound = domain.manifold.equations().iter().copied().filter(|equation| binds(plant, *equation, &held));
        let more = arena.symbols_of(&moving.chain(bound).collect::<Vec<_>>());
        if more.is_subset(&held) {
            return held;
        }
        held.extend(more);
    }
}

/// Tests whether an equation binds one of the symbols: a constant that it shares binds nothing, unless it holds no other
/// symbols.
fn binds(plant: &Plant, equation: Expr, symbols: &BTreeSet<Symbol>) -> bool {
    let arena = &plant.arena;
    let mut varying = arena.symbols_of(&[equation]);
    varying.retain(|symbol| plant.parameters.iter().all(|parameter| parameter.symbol != *symbol));
    if varying.is_empty() { arena.depends_on(equation, symbols) } else { !varying.is_disjoint(symbols) }
}

/// Tests whether the regressor or a derivative of it along the plant depends on the unmeasured states, through the
/// rates of outputs in it. If not, equations with states do not restrict its arguments.
fn depends_on_states(plant: &Plant, formulas: &Formulas, cascade: &Cascade) -> bool {
    let arena = &plant.arena;
    let moves = cascade.h.iter().chain(cascade.lambda.iter().flatten().flatten());
    let mut held: Vec<Expr> = formulas.regressor.iter().chain(moves).copied().collect();
    for _ in 0..=plant.y.len() {
        let symbols = arena.symbols_of(&held);
        let rates =
            plant.y.iter().filter(|output| symbols.contains(&output.symbol)).filter_map(|output| output.rate.as_ref());
        held.extend(rates.map(|rate| rate.expr));
    }
    !arena.symbols_of(&held).is_disjoint(&plant.hidden())
}

/// A domain of several components, on one of which a plant may remain.
fn falls_apart(plant: &Plant, equation: Expr) -> Diagnostic {
    let zero = plant.arena.print(equation);
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        plant.identities.first().map_or_else(|| at_phi(plant), |identity| identity.span),
        "the identities hold on several components of the domain, and a rank at a point of one says nothing of the others",
    )
    .label(format!("`{zero} = 0` holds in several ways"))
    .help("write the factor that is zero under `identities`, or exclude the others under `assume`")
}

/// Decides it for analytic formulas, where the rank at a point holds almost everywhere.
fn where_analytic(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> AnalyticDecision {
    let (arena, unknowns) = (&plant.arena, regression.eta.len());
    // In an implicit regression the rates are among the factors of the unknowns.
    let by_rates = regression.primitive_1.iter().flatten().any(|factor| !arena.is_zero(*factor));
    let flow = Flow::new(plant, domain, cascade);
    let mut stack = match &flow {
        Ok(flow) => effective(arena, domain, flow, &regression.phi_1, &regression.primitive_1),
        Err(_) if !by_rates => regression.phi_1.clone(),
        Err(obstacle) => return open(plant, obstacle, found).into(),
    };
    let answer = |kind, direction, verdict| Claim {
        verdict,
        result: Some(Identifiability { direction, ..Identifiability::new(kind) }),
    };
    if full_rank(arena, domain, &stack, unknowns) {
        let phi_1 = without_psi(plant, &stack);
        let (zero_set, gram) =
            if by_rates { (of_rates(plant, domain, &phi_1), None) } else { excitation::of(plant, domain, &phi_1) };
        let result = Identifiability {
            singular_where: zero_set.signals,
            everywhere_else: zero_set.all,
            constants: zero_set.constants,
            gram,
            ..Identifiability::new(Excitation::Instant)
        };
        return Claim { verdict: Verdict::Proved, result: Some(result) }.into();
    }
    let mut flow = match flow {
        Ok(flow) => flow,
        Err(obstacle) => return open(plant, &obstacle, found).into(),
    };
    let excited = || {
        let (trajectories, constants) =
            arena.budget().share(SHARE_OF_REMARKS, || trajectory::of(plant, domain, cascade, regression));
        let mut claim = answer(Excitation::Excitation, None, Verdict::Proved);
        if let Some(result) = &mut claim.result {
            result.trajectories = Some(trajectories);
            result.constants = constants;
        }
        claim
    };
    if excited_over_time(plant, domain, cascade, &stack, unknowns) {
        return excited().into();
    }
    let mut latest = stack.clone();
    let mut hidden = match hidden_from(arena, domain, &without_psi(plant, &stack), unknowns) {
        Ok(hidden) => hidden,
        Err(obstacle) => return open(plant, &obstacle, found).into(),
    };
    for _ in 1..unknowns {
        latest = match flow.rates(arena, &latest) {
            Ok(rates) => rates,
            Err(obstacle) => return open(plant, &obstacle, found).into(),
        };
        stack.extend(latest.iter().cloned());
        if full_rank(arena, domain, &stack, unknowns) {
            return excited().into();
        }
        flow.advance(plant);
        let next = match hidden_from(arena, domain, &without_psi(plant, &stack), unknowns) {
            Ok(next) => next,
            Err(obstacle) => return open(plant, &obstacle, found).into(),
        };
        // No derivative adds to a rank that one derivative did not raise.
        let settled = next.directions.len() == hidden.directions.len();
        hidden = next;
        if settled {
            break;
        }
    }
    let Some(direction) = hidden.directions.first().cloned() else {
        return open(plant, &Obstacle::NoWitness, found).into();
    };
    // A direction that is constant along every trajectory but depends on signals may be another constant elsewhere if
    // it is non-smooth: the quotient of v and |v|.
    let is_non_smooth = !arena.dividers(&direction).is_empty() || !arena.branched(&direction).is_empty();
    if is_non_smooth && cascade.lambda.is_none() && moves(plant, domain, cascade, &direction) {
        return open(plant, &Obstacle::NoWitness, found).into();
    }
    // A regression that does not identify functions of theta may identify theta.
    if !regression.is_linear(plant)
        && let Some(doubt) = of_theta(plant, domain, &stack, regression, &direction)
    {
        found.push(doubt);
        return Claim { verdict: Verdict::Undecided, result: None }.into();
    }
    let refusal = never(plant, domain, &hidden.directions, regression, left_inverse);
    found.push(if hidden.special_values {
        refusal.note("this holds for the given values of the parameters, not for general values")
    } else {
        refusal
    });
    AnalyticDecision {
        claim: answer(Excitation::Never, Some(direction), Verdict::Refuted),
        hidden: hidden.directions,
        rows: stack,
    }
}

/// The reason why theta itself may be identifiable although its functions are not; none where a direction of theta is
/// provably unobservable in the rows, which determine all derivatives.
fn of_theta(
    plant: &Plant,
    domain: &Domain,
    stack: &[Vec<Expr>],
    regression: &Regression,
    direction: &[Expr],
) -> Option<Diagnostic> {
    let arena = &plant.arena;
    let slope = |row: &Vec<Expr>, theta: Symbol| {
        arena
            .sum(row.iter().zip(&regression.eta).map(|(factor, eta)| arena.mul(*factor, arena.derivative(*eta, theta))))
    };
    let rows: Vec<Vec<Expr>> =
        stack.iter().map(|row| plant.theta.iter().map(|theta| slope(row, *theta)).collect()).collect();
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

/// Tests whether rows and their derivatives have full rank at points: exact algebra is for deficient ones.
fn excited_over_time(plant: &Plant, domain: &Domain, cascade: &Cascade, rows: &[Vec<Expr>], unknowns: usize) -> bool {
    let arena = &plant.arena;
    let Ok(mut flow) = Flow::new(plant, domain, cascade) else { return false };
    let (mut stack, mut latest) = (rows.to_vec(), rows.to_vec());
    let mut rank = proved_rank(arena, domain, &stack, unknowns);
    for _ in 1..unknowns {
        let Ok(rates) = flow.rates(arena, &latest) else { return false };
        latest = rates;
        stack.extend(latest.iter().cloned());
        let next = proved_rank(arena, domain, &stack, unknowns);
        // No derivative adds to a rank that one derivative did not raise.
        if next == rank || next == unknowns {
            return next == unknowns;
        }
        rank = next;
        flow.advance(plant);
    }
    false
}

/// Tests whether formulas depend on moving signals: all but the parameters and signals whose rate is zero.
fn moves(plant: &Plant, domain: &Domain, cascade: &Cascade, formulas: &[Expr]) -> bool {
    let arena = &plant.arena;
    let Ok(flow) = Flow::new(plant, domain, cascade) else { return true };
    let is_constant = |symbol: Symbol| decide(arena, flow.rate(arena, arena.of_symbol(symbol)), domain).is_zero();
    arena.symbols_of(formulas).into_iter().any(|symbol| !is_constant(symbol))
}

/// Vectors that every row provably annihilates at the given values of the parameters; as formulas in the
/// parameters where these values are nothing special.
fn hidden_from(
    arena: &Arena,
    domain: &Domain,
    rows: &[Vec<Expr>],
    columns: usize,
) -> Result<HiddenDirections, Obstacle> {
    let valued: Vec<Vec<Expr>> = rows.iter().map(|row| arena.substitute_all(row, &domain.fixed)).collect();
    let special = null_vectors(arena, &domain.at_given_values(arena), &valued, columns)?;
    let general = null_vectors(arena, domain, rows, columns)?;
    let special_values = special.len() > general.len();
    Ok(HiddenDirections { directions: if special_values { special } else { general }, special_values })
}

/// Directions of the unknowns that are unobservable in every row.
struct HiddenDirections {
    directions: Vec<Vec<Expr>>,
    /// True if other values of the parameters leave fewer.
    special_values: bool,
}

fn open(plant: &Plant, obstacle: &Obstacle, found: &mut Vec<Diagnostic>) -> Claim<Identifiability> {
    let lacks_values = plant.parameters.iter().any(|parameter| parameter.value.is_none());
    let values = if lacks_values { "give the parameters values, or " } else { "" };
    found.push(
        Diagnostic::error(
            Code::IdentifiabilityUndecided,
            at_phi(plant),
            "it could not be decided whether the unknowns can be identified",
        )
        .note(format!("obstacle: {obstacle}"))
        .help(format!("{values}state signs under `assume`")),
    );
    Claim { verdict: Verdict::Undecided, result: None }
}

/// The regression leaves unknowns unseen, but there are equations that it could not use.
pub(super) fn not_all_used(plant: &Plant) -> Diagnostic {
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "it could not be decided whether the unknowns can be identified",
    )
    .note("this regression does not identify all unknowns, but it leaves outputs or identities of the plant unused")
    .help("measure another output, or write what relates phi to the outputs under `identities`")
}
