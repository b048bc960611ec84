//! Claim 4, identifiability: the unknowns are identifiable.
//!
//! In: the regression. Out: `instant` where `Phi_1` has full column rank at almost every point (proved by a point at
//! which a rigorous elimination finds it), `excitation` where it has only with its time derivatives along the plant,
//! `never` where a direction of the unknowns is unobservable in every derivative (proved by exact linear algebra).
//! Inputs, and signals without an equation, are free functions of time up to the identities: their derivatives are new
//! symbols (Ortega et al. 2015, remark R3).

pub(in crate::analysis) mod trajectory;

mod analytic;
mod by_start;
mod components;
mod crossing;
mod divided;
mod excitation;
mod flow;
mod identified;
mod joined;
mod never;
mod observation;
mod problem;
mod regimes;
mod singular;
mod special;
pub(in crate::analysis) mod undecided;

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::Diagnostic;
use pebo_cas::domain::reducible::reducible;
use pebo_cas::linear::rank::full_rank_throughout;
use pebo_cas::{Domain, Expr, Symbol};

use self::components::on_components;
use self::divided::Formulas;
use self::flow::{Flow, effective, without_psi};
use self::problem::ObservabilityProblem;
use self::undecided::{falls_apart, open};
use super::design::{Cascade, Claim, Excitation, Identifiability, LeftInverse, Regression, Verdict};

/// Decides how the unknowns are identified: by the outputs, or else by these and the known start.
pub(super) fn prove(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Identifiability> {
    let mut reported = Vec::new();
    let claim = by_outputs(plant, domain, cascade, regression, left_inverse, &mut reported);
    let with_start = || {
        let problem = ObservabilityProblem { plant, domain, cascade, regression, left_inverse };
        by_start::decided(&problem, &|problem, found| {
            by_outputs(plant, domain, cascade, problem.regression, left_inverse, found)
        })
    };
    match if claim.verdict == Verdict::Proved { None } else { with_start() } {
        // What the start does not mend is said of the outputs.
        Some((claim, open)) if claim.verdict != Verdict::Refuted => {
            found.extend(open);
            claim
        }
        _ => {
            found.append(&mut reported);
            claim
        }
    }
}

/// Decides how the outputs identify the unknowns.
fn by_outputs(
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
    let problem = ObservabilityProblem { plant, domain, cascade, regression, left_inverse };
    let mut claim = match reducible(&plant.arena, domain, concerns) {
        // A rank that nothing lowers needs no point.
        Some(_) if is_instant_throughout(plant, domain, &effective, regression) => {
            let result = Identifiability { everywhere_else: true, ..Identifiability::new(Excitation::Instant) };
            Claim { verdict: Verdict::Proved, result: Some(result) }
        }
        Some(equation) => on_components(&problem, &formulas).unwrap_or_else(|| {
            found.push(falls_apart(plant, equation));
            Claim { verdict: Verdict::Undecided, result: None }
        }),
        None => regimes::decide(&problem, &formulas, found).unwrap_or_else(|obstacle| open(plant, &obstacle, found)),
    };
    if let Some(result) = claim.result.as_mut()
        && let Some(trajectories) = &mut result.trajectories
    {
        let domain = trajectory::assuming(domain, &result.constants, &result.positive);
        trajectory::rest::add(trajectories, &problem.on(&domain));
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
