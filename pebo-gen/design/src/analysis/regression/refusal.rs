//! Refuses a regression: names what the pool of equations lacks, with the point that shows it.

use std::collections::BTreeSet;

use super::build::Obstruction;
use super::cancelling::moved_freely;
use super::diagnostics::{
    OtherForm, in_functions, maybe_hidden, not_in_identity, not_in_other_forms, refuted, undecided, without_equations,
};
use super::pool::{Pool, Rate};
use super::premises::Premises;
use super::selection::{Part, Selection, Source};
use super::separation::is_separable;
use super::{cleared, implicit, separation};
use crate::analysis::design::{Claim, Comparison, Regression, Verdict, Witness};
use crate::analysis::{affine, blame};
use crate::plant::Formula;
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::domain::zero::refute;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Symbol};

/// The verdict without a regression, by the selections that failed.
pub(super) fn refused(
    pool: &Pool<'_>,
    failures: &[(Selection, Obstruction)],
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let failure = |of: Source| Some(&failures.iter().find(|(selection, _)| *selection == (of, Part::Whole))?.1);
    let has_rates = pool.unmoved().next().is_some();
    let by_claim = failures.iter().find_map(|(selection, obstruction)| match obstruction {
        Obstruction::Refused(verdict, said) if !has_rates || selection.0 != Source::OfStates => Some((verdict, said)),
        _ => None,
    });
    let verdict = if let Some((verdict, said)) = by_claim {
        found.extend(said.iter().cloned());
        *verdict
    } else if has_rates {
        of_rates(pool, failure(Source::Rates), found)
    } else if !pool.premises.plant.identities.is_empty() {
        of_identities(&pool.premises, failure(Source::OfStates), found)
    } else if pool.rates.is_empty() {
        found.push(without_equations(pool.premises.plant));
        Verdict::Refuted
    } else {
        of_moved_rates(pool, found)
    };
    Claim { verdict, result: None }
}

/// The identities make no regression.
fn of_identities(premises: &Premises<'_>, failure: Option<&Obstruction>, found: &mut Vec<Diagnostic>) -> Verdict {
    let plant = premises.plant;
    let span = plant.identities[0].span;
    let is_generalised = premises.cascade.lambda.is_some();
    if !is_generalised && premises.left_inverse.is_none() {
        return Verdict::Skipped;
    }
    let unreadable = || plant.identities.iter().find_map(|identity| cleared::rows(premises, identity.expr).err());
    found.push(match failure {
        Some(Obstruction::Unrecovered(_)) => undecided(plant, 0, span, &Obstacle::NoWitness),
        Some(Obstruction::Open(obstacle)) => undecided(plant, 0, span, obstacle),
        _ => match unreadable().filter(|_| is_generalised) {
            Some(obstacle) => undecided(plant, plant.y.len(), span, &obstacle),
            None => not_in_identity(span, is_generalised),
        },
    });
    Verdict::Undecided
}

/// Every given rate depends on an unmeasured signal, and no combination gave a regression.
fn of_moved_rates(pool: &Pool<'_>, found: &mut Vec<Diagnostic>) -> Verdict {
    let (premises, plant, arena) = (&pool.premises, pool.premises.plant, pool.premises.arena());
    let outputs: Vec<usize> = pool.rates.iter().map(|rate| rate.output).collect();
    if !pool.combinations(&outputs).is_empty() || !moved_freely(premises, &outputs, 0) {
        found.push(maybe_hidden(plant, &outputs, pool.rates.first().map_or(Span::point(0), |rate| rate.formula.span)));
        return Verdict::Undecided;
    }
    let mut verdict = Verdict::Refuted;
    for Rate { output: index, formula: Formula { expr: rate, span }, .. } in &pool.rates {
        let witness = plant.w.iter().find_map(|w| {
            let slope = arena.derivative(*rate, *w);
            refute(arena, slope, premises.domain).map(|point| (*w, Witness::of(slope, &point)))
        });
        let Some((signal, witness)) = witness else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, *index, *span, &Obstacle::NoWitness));
            continue;
        };
        let summands = blame::summands(plant, *index, |term| arena.depends_on(term, &BTreeSet::from([signal])));
        let (output, signal) = (arena.name(plant.y[*index].symbol), arena.name(signal));
        found.push(
            Diagnostic::error(
                Code::RegressionNonlinear,
                summands.first().map_or(*span, |summand| summand.span),
                format!("the rate of {output} depends on the unmeasured signal {signal}"),
            )
            .label(format!("{output} gives no information while {signal} is unknown"))
            .note(format!("the derivative of this rate with respect to {signal}: {}", witness.sentence(arena)))
            .help(format!(
                "declare {signal} under `u` if it is measured, give `f_y` for an output whose rate is free of it, or an \
                 identity under `identities`"
            )),
        );
    }
    verdict
}

/// Reports the obstacle of each nonlinear rate; the verdict is the firmest that is left.
fn of_rates(pool: &Pool<'_>, failure: Option<&Obstruction>, found: &mut Vec<Diagnostic>) -> Verdict {
    let premises = &pool.premises;
    let has_form = |rate: &Rate| rate.equation.iter().any(|equation| is_separable(premises, equation.rate));
    let mut curved: Vec<&Rate> = pool.curved().collect();
    // Rates that are no sums of functions of theta are the obstacles, if there are such.
    if matches!(failure, Some(Obstruction::Inseparable)) && curved.iter().any(|rate| !has_form(rate)) {
        curved.retain(|rate| !has_form(rate));
    }
    let in_z: Vec<Expr> = pool.unmoved().map(|equation| equation.rate).collect();
    let is_generalised = premises.cascade.lambda.is_some();
    let untried = if is_generalised { separation::separate(premises, &in_z) } else { Ok(None) };
    // An identity may serve in place of the rates, in a form that was not found, or a combination that was not tried.
    let (combined, moving) = pool.affine_combinations();
    let is_refuted = premises.plant.identities.is_empty() && combined.len() <= pool.affine().count() && !moving;
    let mut verdict = if is_refuted { Verdict::Refuted } else { Verdict::Undecided };
    for rate in curved {
        let obstacle = match (failure, &untried) {
            (Some(Obstruction::Open(obstacle)), _) | (_, Err(obstacle)) => Some(obstacle),
            _ => rate.obstacle.as_ref(),
        };
        let diagnostic = match failure {
            _ if matches!(untried, Ok(Some(_))) => in_functions(premises.plant, rate, None),
            Some(Obstruction::Unrecovered(eta)) => in_functions(premises.plant, rate, Some(eta)),
            _ => of_rate(premises, rate, obstacle),
        };
        if diagnostic.code == Code::RegressionUndecided {
            verdict = Verdict::Undecided;
        }
        found.push(diagnostic);
    }
    verdict
}

/// A rate that is not affine, with the obstacle to a decision.
fn of_rate(premises: &Premises<'_>, rate: &Rate, obstacle: Option<&Obstacle>) -> Diagnostic {
    let (plant, index, span) = (premises.plant, rate.output, rate.formula.span);
    // A rate that was given up is not refuted: it may be linear in functions of theta all the same.
    let point = if obstacle.is_none() { nonlinear(premises, rate.formula.expr) } else { None };
    let Some(point) = point else { return undecided(plant, index, span, obstacle.unwrap_or(&Obstacle::NoWitness)) };
    let form = match &rate.equation {
        Some(equation) if premises.left_inverse.is_some() => other_form(premises, equation.rate),
        // The rate as a function of z is unknown: it may be linear with functions of z as factors or as unknowns.
        _ => Some(constant_components(premises).next().map_or(OtherForm::Unknown, OtherForm::Function)),
    };
    let Some(form) = form else {
        let summands = blame::summands(plant, index, |term| nonlinear(premises, term).is_some());
        return refuted(plant, index, &summands, &point);
    };
    not_in_other_forms(plant, rate, &point, form)
}

/// A form in which the unknowns of a rate that is not affine, a function of z, may be linear all the same, if not all
/// such forms were tried on each cell.
fn other_form(premises: &Premises<'_>, rate: Expr) -> Option<OtherForm> {
    let (arena, unknown) = (premises.arena(), premises.unknown());
    let Ok(cells) = premises.domain.cells(arena, &[rate], |divider| arena.depends_on(divider, &unknown)) else {
        return Some(OtherForm::Unknown);
    };
    cells.iter().find_map(|cell| {
        let branch = cell.domain.analytic(arena, &[rate])[0];
        other_form_on_cell(&Premises { domain: &cell.domain, ..*premises }, branch)
    })
}

fn other_form_on_cell(premises: &Premises<'_>, rate: Expr) -> Option<OtherForm> {
    let (arena, plant, unknown) = (premises.arena(), premises.plant, premises.unknown());
    let Ok(below) = implicit::factor(premises, rate) else { return Some(OtherForm::Unknown) };
    if let Some(below) = below.filter(|below| arena.depends_on(*below, &unknown)) {
        let both = [below, arena.mul(below, rate)];
        if !matches!(separation::separate(premises, &both), Ok(None)) {
            return Some(OtherForm::Multiplied);
        }
    }
    // A component without a rate of its own is a constant, and so is each of its functions.
    let is_curved = |z: Symbol| arena.depends_on(arena.derivative(rate, z), &BTreeSet::from([z]));
    constant_components(premises).find(|index| is_curved(plant.z[*index])).map(OtherForm::Function)
}

/// The components of the transform without a rate.
fn constant_components(premises: &Premises<'_>) -> impl Iterator<Item = usize> {
    let cascade = premises.cascade;
    let is_constant = move |index: &usize| cascade.lambda.is_none() && premises.arena().is_zero(cascade.h[*index]);
    (0..cascade.h.len()).filter(is_constant)
}

/// The reason why a rate is no affine function of the transform, by points of the domain.
///
/// A second derivative, where the transform has as many components as there are states: it is then one-to-one on a
/// neighbourhood of each point of the domain, so that z moves freely there. Else points with the same y, u and
/// parameters at which no affine function takes the rate's values.
fn nonlinear(premises: &Premises<'_>, rate: Expr) -> Option<String> {
    let (arena, plant) = (premises.arena(), premises.plant);
    if let Some(witness) = curvature(premises, rate) {
        return Some(format!(
            "as a function of z, this rate has a second derivative that is not zero: {}",
            witness.sentence(arena)
        ));
    }
    let points = affine::refuted(plant, premises.domain, rate)?;
    let compared = Comparison::of([rate, rate], &points, &plant.hidden());
    Some(format!("no affine function of phi has the values of this rate: {}", compared.sentence(arena, "the rate")))
}

/// A point of the domain at which the rate, as a function of z, has a second derivative.
fn curvature(premises: &Premises<'_>, rate: Expr) -> Option<Witness> {
    let (arena, plant) = (premises.arena(), premises.plant);
    let in_z = premises.at_left_inverse(rate)?;
    // On a manifold of the states z does not move freely.
    let bound = plant.identities.iter().any(|identity| premises.is_hidden(identity.expr));
    let states = premises.left_inverse.map_or(0, |inverse| inverse.x.len());
    if bound || plant.phi.len() != states || premises.is_hidden(in_z) {
        return None;
    }
    // Back at z = phi(x, y), so that the domain of x is the one that is searched.
    let pairs =
        plant.z.iter().enumerate().flat_map(|(i, first)| plant.z[i..].iter().map(move |second| (first, second)));
    pairs.into_iter().find_map(|(first, second)| {
        let curvature = premises.at_phi(arena.derivative(arena.derivative(in_z, *first), *second));
        refute(arena, curvature, premises.domain).map(|point| Witness::of(curvature, &point))
    })
}
