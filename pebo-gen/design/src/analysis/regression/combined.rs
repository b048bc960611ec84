//! Regressions that combine several kinds of equations.
//!
//! In: equations `d/dt P(y) = R(z, y, u)`: rates of outputs, rates of combinations of outputs from which unmeasured
//! signals cancel, and, with P = 0, relations between z, y and u at every instant. Out: one regression of all. The
//! filter is linear, so that an equation without a derivative goes through it as any other does.

use std::collections::{BTreeMap, BTreeSet};

use super::{cleared, implicit, relations, separation};
use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::plant::matrix::dot;
use crate::plant::{Formula, Plant};
use crate::source::Diagnostic;
use pebo_cas::domain::zero::{decide, point_of};
use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Domain, Expr, Symbol};

use super::cancelling::{Combination, combinations, moved_freely, outputs_but};
use super::equation::{Equation, outputs_of};
use super::functions::over_parameterised;
use super::linear::decompose;

/// Regressions with more of a plant's equations, and their completeness.
pub(in crate::analysis) struct CombinedRegressions {
    /// The regressions: with equations linear in z, then with all.
    pub(in crate::analysis) regressions: Vec<Claim<Regression>>,
    /// True if no equation is left that could say more of the unknowns.
    pub(in crate::analysis) complete: bool,
}

/// Adds to a regression the equations that it leaves out: combinations of outputs, relations among z, y and u,
/// identities.
pub(in crate::analysis) fn combined(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    regression: &Regression,
    found: &mut Vec<Diagnostic>,
) -> CombinedRegressions {
    let unused = outputs_but(plant, &regression.rows());
    let combined = combinations(plant, domain, &unused);
    let mut complete = moved_freely(plant, domain, &unused, combined.len());
    let mut more = Vec::new();
    for combination in combined.iter().filter(|c| !regression.primitive_0.contains(&c.output)) {
        match in_z(plant, domain, left_inverse, combination) {
            Some(equation) => more.push(equation),
            None => complete = false,
        }
    }
    // A static regression is made of these.
    let static_equations = if regression.kind == RegressionKind::Static {
        (Vec::new(), plant.identities.is_empty() || !relations::possible(plant, domain))
    } else {
        static_equations(plant, domain, left_inverse)
    };
    complete &= static_equations.1;
    more.extend(static_equations.0);
    if more.is_empty() {
        return CombinedRegressions { regressions: Vec::new(), complete };
    }
    let mut regressions = Vec::new();
    if let Some(base) = of_regression(plant, domain, cascade, regression) {
        let (linear, curved): (Vec<Equation>, Vec<Equation>) =
            more.into_iter().partition(|equation| affine(plant, domain, equation.rate).is_some());
        let mut equations = base;
        equations.extend(linear);
        let first = joined(plant, domain, cascade, left_inverse, &equations, found);
        let whole = if curved.is_empty() {
            complete &= first.is_some();
            None
        } else {
            equations.extend(curved);
            let whole = joined(plant, domain, cascade, left_inverse, &equations, found);
            complete &= whole.is_some();
            whole
        };
        regressions.extend(first.into_iter().chain(whole));
    } else {
        complete = false;
    }
    CombinedRegressions { regressions, complete }
}

/// A regression from combinations of outputs alone.
pub(super) fn of_combinations(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    combined: &[Combination],
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let equations: Option<Vec<Equation>> =
        combined.iter().map(|combination| in_z(plant, domain, left_inverse, combination)).collect();
    joined(plant, domain, cascade, left_inverse, &equations?, found)
}

/// The equation of a combination of outputs, by its decomposition over phi or else by the left inverse.
fn in_z(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    combination: &Combination,
) -> Option<Equation> {
    let arena = &plant.arena;
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let rate = match decompose(plant, domain, left_inverse, (*combination.outputs.first()?, combination.rate)) {
        Ok(Some(row)) => arena.add(row.known, dot(arena, &row.factors, &z)),
        _ => arena.substitute(combination.rate, &left_inverse?.x.iter().copied().collect()),
    };
    (!arena.depends_on(rate, &plant.hidden())).then(|| Equation {
        primitive: combination.output,
        rate,
        outputs: combination.outputs.clone(),
    })
}

/// The relations at every instant: of the components of the transform with measured signals, and identities; and true
/// if these are all.
fn static_equations(plant: &Plant, domain: &Domain, left_inverse: Option<&LeftInverse>) -> (Vec<Equation>, bool) {
    let arena = &plant.arena;
    let as_written = |identity: &Formula| Equation::instant(arena, identity.expr, outputs_of(plant, identity));
    let identities = left_inverse.map_or_else(
        || plant.identities.iter().map(as_written).collect(),
        |left_inverse| cleared::in_z(plant, domain, left_inverse),
    );
    let unknown: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let (identities, open): (Vec<Equation>, Vec<Equation>) = identities
        .into_iter()
        .filter(|e| arena.depends_on(e.rate, &unknown) || arena.depends_on(e.rate, &plant.hidden()))
        .partition(|e| !arena.depends_on(e.rate, &plant.hidden()));
    let mut complete = open.is_empty();
    let mut relations = Vec::new();
    if relations::possible(plant, domain) {
        relations = relations::among(plant, domain).unwrap_or_default();
        complete &= relations::are_all(plant, domain, &relations);
        relations.retain(|relation| is_informative(plant, domain, *relation));
    }
    let relations = relations.into_iter().map(|rate| Equation::relation(plant, rate));
    (relations.chain(identities).collect(), complete)
}

/// Tests whether a relation restricts the unknowns for every choice of phi: one that is linear with constant
/// coefficients and a constant right side only makes a component of phi redundant.
fn is_informative(plant: &Plant, domain: &Domain, relation: Expr) -> bool {
    let arena = &plant.arena;
    let signals: BTreeSet<Symbol> = plant.y.iter().map(|o| o.symbol).chain(plant.u.iter().copied()).collect();
    arena.depends_on(relation, &signals) || affine(plant, domain, relation).is_none()
}

/// An expression in z as `known + factors z`, with coefficients free of z; none if it is not affine.
pub(super) fn affine(plant: &Plant, domain: &Domain, rate: Expr) -> Option<(Expr, Vec<Expr>)> {
    let arena = &plant.arena;
    let unknown: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let factors: Vec<Expr> = plant.z.iter().map(|z| shortest(arena, domain, arena.derivative(rate, *z))).collect();
    let known = shortest(arena, domain, arena.sub(rate, dot(arena, &factors, &z)));
    let free = !factors.iter().chain([&known]).any(|e| arena.depends_on(*e, &unknown));
    let rebuilt = arena.add(known, dot(arena, &factors, &z));
    (free && decide(arena, arena.sub(rate, rebuilt), domain).is_zero()).then_some((known, factors))
}

/// The equations of a regression: z = chi + theta at theta = 0, with z for chi. None if a function of theta has no value
/// there.
pub(super) fn of_regression(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    regression: &Regression,
) -> Option<Vec<Equation>> {
    let arena = &plant.arena;
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    let z = |s: &Symbol| arena.of_symbol(*s);
    let at_z: BTreeMap<Symbol, Expr> = extension.iter().copied().zip(plant.z.iter().map(z)).collect();
    let origin: BTreeMap<Symbol, Expr> = plant.theta.iter().map(|s| (*s, arena.zero())).collect();
    let eta = arena.substitute_all(&regression.eta, &origin);
    if eta.iter().any(|eta| point_of(arena, *eta, domain).is_none()) {
        return None;
    }
    let side = |known: Expr, factor: &[Expr]| arena.substitute(arena.add(known, dot(arena, factor, &eta)), &at_z);
    let equation = |(row, outputs): (usize, &Vec<usize>)| {
        let (phi_0, phi_1) = (regression.phi_0[row], &regression.phi_1[row]);
        let (primitive, rate) = match regression.kind {
            RegressionKind::Dynamic => (arena.of_symbol(plant.y[outputs[0]].symbol), side(phi_0, phi_1)),
            RegressionKind::Implicit => {
                (side(regression.primitive_0[row], &regression.primitive_1[row]), side(phi_0, phi_1))
            }
            RegressionKind::Static => (arena.zero(), arena.neg(side(arena.neg(phi_0), phi_1))),
        };
        Equation { primitive, rate, outputs: outputs.clone() }
    };
    Some(regression.sources.iter().enumerate().map(equation).collect())
}

/// A regression with the unknowns under the derivative of outputs whose rates hold them in a denominator, beside
/// outputs whose rates are affine in z. Others are left unused; none where no rate has such a denominator.
pub(super) fn under_derivative(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: &LeftInverse,
    rates: &[(usize, Expr)],
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let hidden = plant.hidden();
    if rates.iter().any(|(_, rate)| plant.arena.depends_on(*rate, &hidden)) {
        return None;
    }
    let arena = &plant.arena;
    let (mut straight, mut linear, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for &(output, rate) in rates {
        if affine(plant, domain, rate).is_some() {
            let primitive = arena.of_symbol(plant.y[output].symbol);
            straight.push(Equation { primitive, rate, outputs: vec![output] });
        } else if let Ok(Some(equation)) = implicit::affine_equation(plant, domain, (output, rate)) {
            linear.push(equation);
        } else if let Ok(Some(equation)) = implicit::equation(plant, domain, cascade, (output, rate), rates) {
            others.push(equation);
        }
    }
    let joined = |chosen: Vec<Equation>, found: &mut Vec<Diagnostic>| {
        if chosen.is_empty() {
            return None;
        }
        joined(plant, domain, cascade, Some(left_inverse), &[chosen, straight.clone()].concat(), found)
    };
    let whole = joined([linear.clone(), others.clone()].concat(), found);
    whole.or_else(|| if others.is_empty() { None } else { joined(linear, found) })
}

/// The regression of the equations: linear where all are affine in z, else in functions of theta. Relations of an instant
/// come last; alone they are a static regression.
pub(super) fn joined(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    equations: &[Equation],
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let arena = &plant.arena;
    let (instants, rates): (Vec<&Equation>, Vec<&Equation>) =
        equations.iter().partition(|equation| arena.is_zero(equation.primitive));
    let is_static = rates.is_empty();
    let equations = [rates, instants].concat();
    let sources: Vec<Vec<usize>> = equations.iter().map(|e| e.outputs.clone()).collect();
    let primitives: Vec<Expr> = equations.iter().map(|e| e.primitive).collect();
    let rates: Vec<Expr> = equations.iter().map(|e| e.rate).collect();
    let rows = |of: &[Expr]| of.iter().map(|expr| affine(plant, domain, *expr)).collect::<Option<Vec<_>>>();
    let (Some(held), Some(rows)) = (rows(&primitives), rows(&rates)) else {
        if cascade.lambda.is_some() {
            return None;
        }
        let separated = separation::separate(plant, domain, &[primitives, rates].concat()).ok()??;
        return over_parameterised(plant, domain, left_inverse?, (sources, equations.len()), separated, found);
    };
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    let chi = |s: &Symbol| arena.of_symbol(*s);
    let at_chi: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(extension.iter().map(chi)).collect();
    let theta: Vec<Expr> = plant.theta.iter().map(|s| arena.of_symbol(*s)).collect();
    let unknowns = theta.len();
    let moved = |factors: &[Expr]| -> Vec<Expr> {
        let column = |j: usize| -> Vec<Expr> { plant.psi.iter().map(|row| arena.of_symbol(row[j])).collect() };
        (0..unknowns).map(|j| dot(arena, factors, &column(j))).collect()
    };
    let of_theta = |(_, factors): (Expr, Vec<Expr>)| if cascade.lambda.is_some() { moved(&factors) } else { factors };
    let negated = |row: Vec<Expr>| row.into_iter().map(|e| shortest(arena, domain, arena.neg(e))).collect();
    let factors = rows.into_iter().map(of_theta);
    let (primitive_0, primitive_1) = if is_static {
        (Vec::new(), Vec::new())
    } else {
        (arena.substitute_all(&primitives, &at_chi), held.into_iter().map(of_theta).collect())
    };
    let result = Regression {
        kind: if is_static { RegressionKind::Static } else { RegressionKind::Implicit },
        sources,
        phi_0: arena.substitute_all(&rates, &at_chi),
        // known + factors theta = 0, so known = -factors theta
        phi_1: if is_static { factors.map(negated).collect() } else { factors.collect() },
        primitive_0,
        primitive_1,
        theta: plant.eta(unknowns).iter().map(|s| arena.of_symbol(*s)).collect(),
        eta_symbols: plant.eta(unknowns),
        steps: Vec::new(),
        alternative: None,
        unused: Vec::new(),
        eta: theta,
    };
    Some(Claim { verdict: Verdict::Proved, result: Some(result) })
}
