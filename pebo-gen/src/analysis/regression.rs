//! Claim 3, the regression: the unknowns enter linearly.
//!
//! In: the plant and its proved cascade. Out: a dynamic regression y' = `Phi_0` + `Phi_1` theta from the
//! decomposition `f_y = A(y, u) + B(y, u) phi` (which needs no left inverse and finds the linear form
//! where substituting the left inverse would hide it), else one in functions of theta
//! ([`super::separation`]), else a static one from an identity (Ortega et al. 2015, eqs. 16 and 28).

use std::collections::BTreeMap;

use crate::cas::combination::combine;
use crate::cas::domain::Domain;
use crate::cas::field::{Field, Obstacle};
use crate::cas::rational::Rational;
use crate::cas::zero::{Answer, decide, refute};
use crate::cas::{Expr, Symbol};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};

use super::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict, Witness};
use super::separation::{self, Separated};
use super::tidy::{shortest, shortest_equal};

const NO_SEPARATION: &str = "it is no sum of products of functions of theta with known signals either, as far as \
    polynomials, exponentials, sines and cosines of z go";

/// One output as an affine function of the transform.
struct Row {
    /// The part free of x.
    known: Expr,
    /// The coefficients of the components of the transform, free of x.
    factors: Vec<Expr>,
}

/// Proves or refutes the regression.
pub(super) fn prove(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let rows: Vec<(usize, Expr, Span)> =
        plant.y.iter().enumerate().filter_map(|(i, o)| o.rate.map(|rate| (i, rate.expr, rate.span))).collect();
    if rows.is_empty() {
        return from_identities(plant, domain, left_inverse, found);
    }
    let mut affine = Vec::new();
    let mut obstacles = Vec::new();
    for (index, rate, span) in &rows {
        match decompose(plant, domain, *rate) {
            Ok(Some(row)) => affine.push(row),
            Ok(None) => obstacles.push((*index, *rate, *span, None)),
            Err(obstacle) => obstacles.push((*index, *rate, *span, Some(obstacle))),
        }
    }
    if obstacles.is_empty() {
        let regression = linear(plant, domain, cascade, left_inverse, rows.iter().map(|r| r.0).collect(), &affine);
        return Claim { verdict: Verdict::Proved, result: Some(regression) };
    }
    // In functions of theta: only where z = chi + theta, the extension being an integrator.
    let mut stands_against = NO_SEPARATION.to_owned();
    if cascade.lambda.is_none()
        && let Some(left_inverse) = left_inverse
    {
        let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
        let rates: Vec<Expr> = rows.iter().map(|(_, rate, _)| plant.arena.substitute(*rate, &inverse)).collect();
        match separation::separate(plant, domain, &rates) {
            Ok(Some(separated)) => {
                let eta: Vec<String> = separated.eta.iter().map(|e| plant.arena.print(*e)).collect();
                let outputs = rows.iter().map(|r| r.0).collect();
                if let Some(result) = over_parameterised(plant, domain, outputs, separated, found) {
                    return Claim { verdict: Verdict::Proved, result: Some(result) };
                }
                stands_against =
                    format!("it is linear in {}, but theta could not be recovered from these", eta.join(", "));
            }
            Ok(None) => {}
            Err(obstacle) => obstacles.iter_mut().for_each(|o| o.3 = Some(obstacle.clone())),
        }
    }
    if !plant.identities.is_empty() {
        let claim = from_identities(plant, domain, left_inverse, &mut Vec::new());
        if claim.verdict == Verdict::Proved {
            return claim;
        }
    }
    let mut verdict = Verdict::Refuted;
    for (index, rate, span, obstacle) in obstacles {
        // What was given up is not refuted: it may be linear in functions of theta all the same.
        let bend = if obstacle.is_none() { nonlinear(plant, domain, rate, left_inverse) } else { None };
        if let Some(witness) = bend {
            found.push(refuted(plant, index, span, &witness, &stands_against));
        } else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, index, span, &obstacle.unwrap_or(Obstacle::NoWitness)));
        }
    }
    Claim { verdict, result: None }
}

/// Writes an output's rate over {1, phi}, and proves it.
fn decompose(plant: &Plant, domain: &Domain, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let arena = &plant.arena;
    let phi = plant.transform();
    let mut roots = phi.clone();
    roots.push(rate);
    let field = Field::over(arena, &domain.facts, &roots)?;
    let mut basis = vec![arena.one()];
    basis.extend(&phi);
    let Some(coefficients) = combine(&field, rate, &basis, &plant.hidden())? else { return Ok(None) };
    let coefficients: Vec<Expr> = coefficients.iter().map(|c| field.show(c)).collect();
    let rebuilt = arena.sum(coefficients.iter().zip(&basis).map(|(c, b)| arena.mul(*c, *b)));
    match decide(arena, arena.sub(rate, rebuilt), domain) {
        Answer::Zero => {}
        Answer::Open(obstacle) => return Err(obstacle),
        Answer::NonZero(_) => return Err(Obstacle::NoWitness),
    }
    let mut parts = coefficients.into_iter();
    let known = parts.next().unwrap_or_else(|| arena.zero());
    // Where the transform is the state itself, the author's own coefficients may be shorter.
    let factors = parts
        .zip(&phi)
        .map(|(factor, component)| match arena.as_symbol(*component) {
            Some(state) => shortest_equal(arena, domain, factor, &[arena.derivative(rate, state)]),
            None => factor,
        })
        .collect();
    Ok(Some(Row { known, factors }))
}

/// `Phi_0` and `Phi_1` of affine rows.
fn linear(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    rows: Vec<usize>,
    affine: &[Row],
) -> Regression {
    let arena = &plant.arena;
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    let chi: Vec<Expr> = extension.iter().map(|s| arena.of_symbol(*s)).collect();
    let theta: Vec<Expr> = plant.theta.iter().map(|s| arena.of_symbol(*s)).collect();
    // The left inverse at chi: where the rate is affine in z, the author's formula there is `Phi_0`.
    let at_chi: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(chi.iter().copied()).collect();
    let states: BTreeMap<Symbol, Expr> =
        left_inverse.iter().flat_map(|l| &l.x).map(|(s, formula)| (*s, arena.substitute(*formula, &at_chi))).collect();
    let mut phi_0 = Vec::new();
    let mut phi_1 = Vec::new();
    for (row, output) in affine.iter().zip(&rows) {
        let known =
            arena.add(row.known, arena.sum(row.factors.iter().zip(&chi).map(|(factor, chi)| arena.mul(*factor, *chi))));
        let written = plant.y[*output].rate.map(|rate| arena.substitute(rate.expr, &states));
        let candidates: Vec<Expr> = written
            .into_iter()
            .filter(|w| !arena.depends_on(*w, &plant.hidden()))
            .chain([shortest(arena, domain, known)])
            .collect();
        phi_0.push(shortest_equal(arena, domain, known, &candidates));
        phi_1.push(match &cascade.lambda {
            None => row.factors.clone(),
            Some(_) => (0..theta.len())
                .map(|column| {
                    let terms = row.factors.iter().zip(&plant.psi);
                    arena.sum(terms.map(|(factor, psi)| arena.mul(*factor, arena.of_symbol(psi[column]))))
                })
                .collect(),
        });
    }
    Regression {
        kind: RegressionKind::Dynamic,
        rows,
        phi_0,
        phi_1,
        eta: theta.clone(),
        theta: plant.eta(theta.len()).iter().map(|s| arena.of_symbol(*s)).collect(),
        eta_symbols: plant.eta(theta.len()),
    }
}

/// A dynamic regression in functions of theta, if theta can be recovered from them.
fn over_parameterised(
    plant: &Plant,
    domain: &Domain,
    rows: Vec<usize>,
    separated: Separated,
    found: &mut Vec<Diagnostic>,
) -> Option<Regression> {
    let (theta, turns) = separation::recover(plant, domain, &separated.eta)?;
    found.extend(turns.then(|| up_to_turns(plant)));
    Some(Regression {
        kind: RegressionKind::Dynamic,
        rows,
        phi_0: separated.known,
        phi_1: separated.factors,
        eta_symbols: plant.eta(separated.eta.len()),
        eta: separated.eta,
        theta,
    })
}

/// What to know where theta enters through sine and cosine alone.
fn up_to_turns(plant: &Plant) -> Diagnostic {
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    Diagnostic::warning(Code::UnknownUpToTurns, span, "theta is determined only up to whole turns")
        .label("the outputs see this transform through its sine and cosine")
        .help("read what is recovered from it as an angle: declare the state under `angles`")
}

/// A static regression `Phi_0 = Phi_1 eta` from the identities.
fn from_identities(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let span = plant.y.first().map_or(Span::point(0), |output| output.span);
    if plant.identities.is_empty() {
        found.push(
            Diagnostic::error(Code::RegressionNonlinear, span, "there is nothing to estimate the unknowns from")
                .label("no output has a rate under `f_y`, and there are no `identities`")
                .help("give `f_y` for an output, or an expression in x and y that is zero under `identities`"),
        );
        return Claim { verdict: Verdict::Refuted, result: None };
    }
    let Some(left_inverse) = left_inverse else { return Claim { verdict: Verdict::Skipped, result: None } };
    let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
    let identities: Vec<Expr> = plant.identities.iter().map(|i| arena.substitute(i.expr, &inverse)).collect();
    match separation::separate(plant, domain, &identities) {
        Ok(Some(separated)) => {
            let separated = separation::absorb_constants(plant, domain, separated);
            if let Some((theta, turns)) = separation::recover(plant, domain, &separated.eta) {
                found.extend(turns.then(|| up_to_turns(plant)));
                // identity = known + factors eta = 0, so known = -factors eta
                let negated = |row: &Vec<Expr>| row.iter().map(|e| shortest(arena, domain, arena.neg(*e))).collect();
                let result = Regression {
                    kind: RegressionKind::Static,
                    rows: Vec::new(),
                    phi_1: separated.factors.iter().map(negated).collect(),
                    phi_0: separated.known,
                    eta_symbols: plant.eta(separated.eta.len()),
                    eta: separated.eta,
                    theta,
                };
                return Claim { verdict: Verdict::Proved, result: Some(result) };
            }
            found.push(undecided(plant, 0, plant.identities[0].span, &Obstacle::NoWitness));
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Ok(None) => {
            found.push(
                Diagnostic::error(
                    Code::RegressionUndecided,
                    plant.identities[0].span,
                    "no regression that is linear in functions of theta was found in this identity",
                )
                .help("write it as a polynomial in the components of phi, or give `f_y` for an output"),
            );
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Err(obstacle) => {
            found.push(undecided(plant, 0, plant.identities[0].span, &obstacle));
            Claim { verdict: Verdict::Undecided, result: None }
        }
    }
}

/// A point at which the rate, as a function of z, has a second derivative, or a bend.
fn nonlinear(plant: &Plant, domain: &Domain, rate: Expr, left_inverse: Option<&LeftInverse>) -> Option<Witness> {
    let arena = &plant.arena;
    let inverse: BTreeMap<Symbol, Expr> = left_inverse?.x.iter().copied().collect();
    let in_z = arena.substitute(rate, &inverse);
    if arena.depends_on(in_z, &plant.hidden()) {
        return None;
    }
    // Back at z = phi(x, y), so that the domain of x is the one that is searched.
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    for (index, first) in plant.z.iter().enumerate() {
        for second in &plant.z[index..] {
            let curvature = arena.derivative(arena.derivative(in_z, *first), *second);
            let curvature = arena.substitute(curvature, &transform);
            if let Some(point) = refute(arena, curvature, domain) {
                return Some(Witness::of(curvature, &point));
            }
        }
    }
    // Pieces of lines have no second derivative, but the middle of a chord shows the bend.
    plant.z.iter().find_map(|z| {
        let moved = |by: i64| {
            let place = arena.add(arena.of_symbol(*z), arena.number(by));
            arena.substitute(in_z, &BTreeMap::from([(*z, place)]))
        };
        let ends = arena.add(moved(4), moved(-4));
        let bend = arena.sub(ends, arena.scale(in_z, &Rational::from(2)));
        let bend = arena.substitute(bend, &transform);
        refute(arena, bend, domain).map(|point| Witness::of(bend, &point))
    })
}

fn refuted(plant: &Plant, index: usize, span: Span, witness: &Witness, stands_against: &str) -> Diagnostic {
    let arena = &plant.arena;
    let output = arena.name(plant.y[index].symbol);
    Diagnostic::error(
        Code::RegressionNonlinear,
        span,
        format!("the rate of {output} is not linear in the unknowns"),
    )
    .label("not an affine function of phi with coefficients in y and u")
    .note(format!("as a function of z it bends: {}", witness.sentence(arena)))
    .note(stands_against)
    .help("choose a phi in which this rate is affine, leave the output's rate out of `f_y` if others suffice, or give \
           an identity under `identities`")
}

fn undecided(plant: &Plant, index: usize, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let output = plant.y.get(index).map_or_else(String::new, |o| format!(" of {}", plant.arena.name(o.symbol)));
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("it could not be decided whether the rate{output} is linear in the unknowns"),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("simplify the formula, or state signs under `assume`")
}
