//! The regression that equations make.
//!
//! In: equations `d/dt P(z, y) = R(z, y, u)`. Out: one regression of all, in theta itself where all are affine in z, else
//! in functions of theta; or with the slopes at the estimate. It is static where no equation has a primitive, dynamic where each
//! primitive is an output, else implicit: the filter is linear, so that an equation without a derivative goes through it
//! as any other does.

use std::collections::BTreeSet;

use super::equation::Equation;
use super::premises::Premises;
use super::recovery::recoverable;
use super::separation::{absorb_constants, separate};
use super::steps::steps;
use crate::analysis::design::{AtEstimate, Regression, RegressionKind, Verdict};
use crate::source::Diagnostic;
use pebo_cas::forms::tidy::{proved_shortest, shortest_equal};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Symbol};

/// A reason for which equations make no regression.
pub(super) enum Obstruction {
    /// Not affine in z, under a generalised cascade or without a left inverse: functions of theta are not searched for.
    NotAffine,
    /// No sum of known signals times functions of theta.
    Inseparable,
    /// Undecided.
    Open(Obstacle),
    /// Linear in these functions, from which theta was not recovered.
    Unrecovered(Vec<Expr>),
    /// A claim on it is not proved.
    Refused(Verdict, Vec<Diagnostic>),
}

/// The regression of the equations, with warnings.
pub(super) fn regression(
    premises: &Premises<'_>,
    equations: &[Equation],
    found: &mut Vec<Diagnostic>,
) -> Result<Regression, Obstruction> {
    let (kind, equations) = in_order(premises, equations);
    let result = if equations.iter().all(|equation| equation.is_linear()) {
        in_theta(premises, kind, &equations)
    } else {
        in_functions(premises, kind, &equations, found)?
    };
    Ok(with_unknowns_apart(premises, result))
}

/// The regression of the equations at the estimate: each where the extension is z, with its slopes by theta there.
pub(super) fn at_estimate(
    premises: &Premises<'_>,
    equations: &[Equation],
    sense: AtEstimate,
) -> Result<Regression, Obstruction> {
    let (arena, plant) = (premises.arena(), premises.plant);
    let (kind, equations) = in_order(premises, equations);
    let theta = plant.theta.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let mut result = Regression { at_estimate: Some(sense), ..empty(premises, kind, &equations, (theta, None)) };
    for equation in equations {
        // A primitive with an unknown would have a slope under the derivative, which moves with the estimate.
        if premises.is_hidden(equation.rate) || arena.depends_on(equation.primitive, &premises.unknown()) {
            return Err(Obstruction::NotAffine);
        }
        let slope = |z: &Symbol| premises.at_extension(premises.shortest(arena.derivative(equation.rate, *z)));
        result.phi_0.push(premises.at_extension(equation.rate));
        result.phi_1.push(premises.of_theta(&plant.z.iter().map(slope).collect::<Vec<Expr>>()));
        if kind == RegressionKind::Implicit {
            result.primitive_0.push(equation.primitive);
            result.primitive_1.push(vec![arena.zero(); plant.theta.len()]);
        }
    }
    Ok(with_unknowns_apart(premises, result))
}

/// The kind of regression that equations make, with the equations in its order: those of rates first.
fn in_order<'a>(premises: &Premises<'_>, equations: &'a [Equation]) -> (RegressionKind, Vec<&'a Equation>) {
    let (instants, rates): (Vec<&Equation>, Vec<&Equation>) = equations.iter().partition(|e| e.is_instant(premises));
    let kind = match (rates.as_slice(), instants.as_slice()) {
        ([], _) => RegressionKind::Static,
        (rates, []) if are_rates(premises, rates) => RegressionKind::Dynamic,
        _ => RegressionKind::Implicit,
    };
    let mut equations = [rates, instants].concat();
    if kind == RegressionKind::Dynamic {
        equations.sort_by(|a, b| a.outputs.cmp(&b.outputs));
    }
    (kind, equations)
}

/// The regression with its sides as its kind has them: of a static one `known + factors eta = 0` is `known = -factors eta`.
fn with_unknowns_apart(premises: &Premises<'_>, mut regression: Regression) -> Regression {
    if regression.kind == RegressionKind::Static {
        let negated = |e: &mut Expr| *e = premises.shortest(premises.arena().neg(*e));
        regression.phi_1.iter_mut().flatten().for_each(negated);
    }
    regression
}

/// Tests whether each equation is the rate of another output.
fn are_rates(premises: &Premises<'_>, equations: &[&Equation]) -> bool {
    let distinct: BTreeSet<Expr> = equations.iter().map(|equation| equation.primitive).collect();
    distinct.len() == equations.len() && equations.iter().all(|equation| equation.is_rate(premises))
}

/// Affine functions of `z = chi + theta`, or `z = xi + Psi theta`.
fn in_theta(premises: &Premises<'_>, kind: RegressionKind, equations: &[&Equation]) -> Regression {
    let (arena, plant) = (premises.arena(), premises.plant);
    let is_static = kind == RegressionKind::Static;
    let theta: Vec<Expr> = plant.theta.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let known = |expr: Expr| if is_static { proved_shortest(arena, premises.domain, expr) } else { expr };
    let mut result = empty(premises, kind, equations, (theta, None));
    for equation in equations {
        let Some([of_primitive, of_rate]) = &equation.factors else { continue };
        result.phi_0.push(known(premises.at_extension(equation.rate)));
        result.phi_1.push(premises.of_theta(of_rate));
        if kind == RegressionKind::Implicit {
            result.primitive_0.push(premises.at_extension(equation.primitive));
            result.primitive_1.push(premises.of_theta(of_primitive));
        }
    }
    result
}

/// Functions of `z = chi + theta`.
fn in_functions(
    premises: &Premises<'_>,
    kind: RegressionKind,
    equations: &[&Equation],
    found: &mut Vec<Diagnostic>,
) -> Result<Regression, Obstruction> {
    if premises.cascade.lambda.is_some() || premises.left_inverse.is_none() {
        return Err(Obstruction::NotAffine);
    }
    let held = if kind == RegressionKind::Implicit { equations.len() } else { 0 };
    let primitives = equations[..held].iter().map(|equation| equation.primitive);
    let in_z: Vec<Expr> = primitives.chain(equations.iter().map(|equation| equation.rate)).collect();
    let separated = separate(premises, &in_z).map_err(Obstruction::Open)?.ok_or(Obstruction::Inseparable)?;
    let separated = if kind == RegressionKind::Static { absorb_constants(premises, separated) } else { separated };
    let functions = separated.eta.clone();
    let recovered = recoverable(premises, separated);
    let (separated, recovered) = recovered.ok_or(Obstruction::Unrecovered(functions))?;
    let steps = steps(premises, &separated.eta, &recovered, found)
        .map_err(|verdict| Obstruction::Refused(verdict, std::mem::take(found)))?;
    let mut result = empty(premises, kind, equations, (separated.eta, Some(recovered.theta)));
    result.phi_0 = in_z.iter().zip(&separated.known).map(|(in_z, known)| as_written(premises, *in_z, *known)).collect();
    let short = |row: &Vec<Expr>| row.iter().map(|entry| premises.shortest(*entry)).collect();
    result.phi_1 = separated.factors.iter().map(short).collect();
    result.primitive_0 = result.phi_0.drain(..held).collect();
    result.primitive_1 = result.phi_1.drain(..held).collect();
    result.steps = steps;
    Ok(result)
}

/// A known term, as the expression itself at z = chi where that is shorter, without the constants that the unknowns have
/// absorbed.
fn as_written(premises: &Premises<'_>, in_z: Expr, known: Expr) -> Expr {
    let arena = premises.arena();
    let written = premises.at_extension(in_z);
    let short = premises.shortest(known);
    let constant = premises.shortest(arena.sub(known, written));
    shortest_equal(arena, premises.domain, short, &[arena.add(written, constant)])
}

/// A regression without rows in these unknowns, from which theta follows; they are theta itself where no formulas for it
/// are given.
fn empty(
    premises: &Premises<'_>,
    kind: RegressionKind,
    equations: &[&Equation],
    (eta, theta): (Vec<Expr>, Option<Vec<Expr>>),
) -> Regression {
    let eta_symbols = premises.plant.eta(eta.len());
    let itself = || eta_symbols.iter().map(|symbol| premises.arena().of_symbol(*symbol)).collect();
    Regression {
        kind,
        sources: equations.iter().map(|equation| equation.outputs.clone()).collect(),
        phi_0: Vec::new(),
        phi_1: Vec::new(),
        primitive_0: Vec::new(),
        primitive_1: Vec::new(),
        theta: theta.unwrap_or_else(itself),
        eta_symbols,
        at_estimate: None,
        eta,
        steps: Vec::new(),
        alternative: None,
        unused: Vec::new(),
    }
}
