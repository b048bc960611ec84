//! Claim 3, the regression: the unknowns enter linearly.
//!
//! In: the plant and its proved cascade. Out: a dynamic regression y' = `Phi_0` + `Phi_1` theta from the
//! decomposition `f_y = A(y, u) + B(y, u) phi` (which needs no left inverse and finds the linear form
//! where substituting the left inverse would hide it), else one in functions of theta
//! ([`super::separation`]), else a static one from an identity (Ortega et al. 2015, eqs. 16 and 28).

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::combination::combine;
use crate::cas::domain::Domain;
use crate::cas::field::{Field, Obstacle};
use crate::cas::rational::Rational;
use crate::cas::zero::{Answer, decide, refute};
use crate::cas::{Expr, Symbol};
use crate::plant::matrix::dot;
use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic, Span};

use super::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict, Witness};
use super::left_inverse::is_whole_turns;
use super::separation::{self, Recovered, Separated};
use super::tidy::{shortest, shortest_equal};
use super::{blame, implicit, relations};

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
    let mut rows: Vec<(usize, Expr, Span)> =
        plant.y.iter().enumerate().filter_map(|(i, o)| o.rate.map(|rate| (i, rate.expr, rate.span))).collect();
    if rows.is_empty() {
        return from_identities(plant, domain, left_inverse, found);
    }
    let unmeasured: BTreeSet<Symbol> = plant.w.iter().copied().collect();
    let mut affine = Vec::new();
    let mut obstacles = Vec::new();
    let mut veiled = Vec::new();
    for (index, rate, span) in &rows {
        match decompose(plant, domain, *index, *rate) {
            Ok(Some(row)) => affine.push(row),
            Ok(None) | Err(_) if plant.arena.depends_on(*rate, &unmeasured) => veiled.push((*index, *rate, *span)),
            Ok(None) => obstacles.push((*index, *rate, *span, None)),
            Err(obstacle) => obstacles.push((*index, *rate, *span, Some(obstacle))),
        }
    }
    // Nothing can be learnt from a rate that an unmeasured signal moves; the others have to do.
    rows.retain(|row| !veiled.contains(row));
    if rows.is_empty() {
        if plant.identities.is_empty() {
            return from_relations(plant, domain, left_inverse, found)
                .unwrap_or_else(|| hidden_by_signals(plant, domain, &veiled, found));
        }
        return from_identities(plant, domain, left_inverse, found);
    }
    if obstacles.is_empty() {
        let regression = linear(plant, domain, cascade, left_inverse, rows.iter().map(|r| r.0).collect(), &affine);
        return Claim { verdict: Verdict::Proved, result: Some(regression) };
    }
    // In functions of theta: only where z = chi + theta, the extension being an integrator.
    let mut stands_against = NO_SEPARATION.to_owned();
    let mut unsought = false;
    if let Some(left_inverse) = left_inverse {
        let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
        let rates: Vec<Expr> = rows.iter().map(|(_, rate, _)| plant.arena.substitute(*rate, &inverse)).collect();
        match separation::separate(plant, domain, &rates) {
            Ok(Some(_)) if cascade.lambda.is_some() => unsought = true,
            Ok(Some(separated)) => {
                let eta: Vec<String> = separated.eta.iter().map(|e| plant.arena.print(*e)).collect();
                let outputs = rows.iter().map(|r| r.0).collect();
                if let Some(claim) = over_parameterised(plant, domain, left_inverse, outputs, separated, found) {
                    return claim;
                }
                stands_against =
                    format!("it is linear in {}, but theta could not be recovered from these", eta.join(", "));
            }
            Ok(None) if cascade.lambda.is_none() => {
                let outputs: Vec<usize> = rows.iter().map(|r| r.0).collect();
                let claim = implicit(plant, domain, cascade, left_inverse, &outputs, &rates, found);
                if let Some(claim) = claim {
                    return claim;
                }
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
        if unsought {
            verdict = Verdict::Undecided;
            found.push(not_sought(plant, index, span));
            continue;
        }
        // What was given up is not refuted: it may be linear in functions of theta all the same.
        let bend = if obstacle.is_none() { nonlinear(plant, domain, rate, left_inverse) } else { None };
        if let Some(witness) = bend {
            let bends = |term| nonlinear(plant, domain, term, left_inverse).is_some();
            let places = blame::summands(plant, index, bends);
            found.push(refuted(plant, index, &places, &witness, &stands_against));
        } else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, index, span, &obstacle.unwrap_or(Obstacle::NoWitness)));
        }
    }
    Claim { verdict, result: None }
}

/// Writes an output's rate over {1, phi}, and proves it.
fn decompose(plant: &Plant, domain: &Domain, index: usize, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let arena = &plant.arena;
    let phi = plant.transform();
    if let Some((known, factors)) = plant.proposal.rates.get(&plant.y[index].symbol) {
        let rebuilt = arena.add(*known, dot(arena, factors, &phi));
        if decide(arena, arena.sub(rate, rebuilt), domain).is_zero() {
            return Ok(Some(Row { known: *known, factors: factors.clone() }));
        }
    }
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
        primitive_0: Vec::new(),
        primitive_1: Vec::new(),
        eta: theta.clone(),
        theta: plant.eta(theta.len()).iter().map(|s| arena.of_symbol(*s)).collect(),
        eta_symbols: plant.eta(theta.len()),
    }
}

/// A regression in functions of theta, if theta can be recovered from them: a dynamic one with a row for each
/// output, an implicit one with the rows of the primitives before these.
fn over_parameterised(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    rows: Vec<usize>,
    separated: Separated,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    // The fewer functions, if they are enough.
    let joined = separation::join_proportional(plant, domain, &separated).ok().and_then(|joined| {
        let recovered = separation::recover(plant, domain, &joined.eta)?;
        Some((joined, recovered))
    });
    let (separated, recovered) = if let Some(both) = joined {
        both
    } else {
        let recovered = separation::recover(plant, domain, &separated.eta)?;
        (separated, recovered)
    };
    if let Some(refusal) = turned_away(plant, domain, left_inverse, &separated.eta, &recovered, found) {
        return Some(refusal);
    }
    // With sides of a primitive first, these are the first half of the rows.
    let (mut phi_0, mut phi_1) = (separated.known, separated.factors);
    let held = phi_0.len() - rows.len();
    let primitive_0: Vec<Expr> = phi_0.drain(..held).collect();
    let primitive_1: Vec<Vec<Expr>> = phi_1.drain(..held).collect();
    let result = Regression {
        kind: if held == 0 { RegressionKind::Dynamic } else { RegressionKind::Implicit },
        rows,
        phi_0,
        phi_1,
        primitive_0,
        primitive_1,
        eta_symbols: plant.eta(separated.eta.len()),
        eta: separated.eta,
        theta: recovered.theta,
    };
    Some(Claim { verdict: Verdict::Proved, result: Some(result) })
}

/// A regression with the unknowns under the derivative, where the rates have that form.
fn implicit(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: &LeftInverse,
    outputs: &[usize],
    rates: &[Expr],
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let (mut primitives, mut rights) = (Vec::new(), Vec::new());
    for (output, rate) in outputs.iter().zip(rates) {
        let sides = implicit::sides(plant, domain, &cascade.h, (*output, *rate)).ok()??;
        primitives.push(sides.primitive);
        rights.push(sides.rate);
    }
    let separated = separation::separate(plant, domain, &[primitives, rights].concat()).ok()??;
    over_parameterised(plant, domain, left_inverse, outputs.to_vec(), separated, found)
}

/// The refusal, where theta is determined only up to whole turns and a state is lost by that: one that does
/// not move by a constant, or an angle that moves by a part of its period. Else at most a warning.
fn turned_away(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    eta: &[Expr],
    recovered: &Recovered,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let arena = &plant.arena;
    let turn = arena.mul(arena.number(2), arena.pi());
    let mut ambiguous = false;
    for &index in &recovered.turning {
        let turned = |expr: Expr, symbol: Symbol| {
            let moved = BTreeMap::from([(symbol, arena.add(arena.of_symbol(symbol), turn))]);
            shortest(arena, domain, arena.sub(arena.substitute(expr, &moved), expr))
        };
        for &(state, formula) in &left_inverse.x {
            let shift = turned(formula, plant.z[index]);
            let kept = match plant.period(state) {
                Some(period) => is_whole_turns(arena, domain, arena.div(arena.mul(shift, turn), period)),
                None => arena.symbols_of(&[shift]).iter().all(|s| plant.parameters.iter().any(|p| p.symbol == *s)),
            };
            if kept {
                // What a turn moves is an angle; one that was declared as such needs no warning.
                ambiguous |= plant.period(state).is_none() && !arena.is_zero(shift);
                continue;
            }
            // Whether the outputs themselves are blind to the turn, or only the formula for theta.
            let blind = eta.iter().all(|e| decide(arena, turned(*e, plant.theta[index]), domain).is_zero());
            found.push(lost_by_turns(plant, index, state, shift));
            let verdict = if blind { Verdict::Refuted } else { Verdict::Undecided };
            return Some(Claim { verdict, result: None });
        }
    }
    found.extend(ambiguous.then(|| up_to_turns(plant)));
    None
}

/// What a turn of an unknown does to a state.
fn lost_by_turns(plant: &Plant, index: usize, state: Symbol, shift: Expr) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let diagnostic = Diagnostic::error(
        Code::UnknownUpToTurns,
        plant.phi[index].span,
        format!("{name} is not determined: theta{} is known only up to whole turns", index + 1),
    )
    .label(format!("a turn of this component moves {name} by `{}`", arena.print(shift)))
    .note("the outputs see this component through its sine and cosine alone");
    match plant.period(state) {
        Some(period) => diagnostic.help(format!(
            "declare a period under `angles` that divides this, instead of `{}`, or measure another output",
            arena.print(period)
        )),
        None => diagnostic
            .help("choose a phi in which the other states do not need this component, or measure another output"),
    }
}

/// Every rate that is given depends on a signal that nobody knows.
fn hidden_by_signals(
    plant: &Plant,
    domain: &Domain,
    veiled: &[(usize, Expr, Span)],
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let mut verdict = Verdict::Refuted;
    for (index, rate, span) in veiled {
        let seen = plant.w.iter().find_map(|w| {
            let slope = arena.derivative(*rate, *w);
            refute(arena, slope, domain).map(|point| (*w, Witness::of(slope, &point)))
        });
        let Some((signal, witness)) = seen else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, *index, *span, &Obstacle::NoWitness));
            continue;
        };
        let places = blame::summands(plant, *index, |term| arena.depends_on(term, &BTreeSet::from([signal])));
        let (output, signal) = (arena.name(plant.y[*index].symbol), arena.name(signal));
        found.push(
            Diagnostic::error(
                Code::RegressionNonlinear,
                places.first().map_or(*span, |place| place.span),
                format!("the rate of {output} depends on the unmeasured signal {signal}"),
            )
            .label(format!("nothing can be learnt from {output} while {signal} is unknown"))
            .note(format!("its derivative in {signal}: {}", witness.sentence(arena)))
            .help(format!(
                "declare {signal} under `u` if it is measured, give `f_y` for an output whose rate is free of it, or an \
                 identity under `identities`"
            )),
        );
    }
    Claim { verdict, result: None }
}

/// A generalised cascade whose outputs may be linear in functions of theta.
fn not_sought(plant: &Plant, index: usize, span: Span) -> Diagnostic {
    let output = plant.arena.name(plant.y[index].symbol);
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("it could not be decided whether the rate of {output} is linear in functions of theta"),
    )
    .label("not an affine function of phi with coefficients in y and u")
    .note("obstacle: functions of theta are not sought for a generalised cascade, z = xi + Psi theta")
    .help("choose a phi whose derivative is free of x, or one in which this rate is affine")
}

/// What to know where theta enters through sine and cosine alone.
fn up_to_turns(plant: &Plant) -> Diagnostic {
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    Diagnostic::warning(Code::UnknownUpToTurns, span, "theta is determined only up to whole turns")
        .label("the outputs see this transform through its sine and cosine")
        .help("read what is recovered from it as an angle: declare the state under `angles`")
}

/// A static regression `Phi_0 = Phi_1 eta` from the identities.
pub(super) fn from_identities(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let span = plant.y.first().map_or(Span::point(0), |output| output.span);
    if plant.identities.is_empty() {
        if let Some(claim) = from_relations(plant, domain, left_inverse, found) {
            return claim;
        }
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
    standing_still(plant, domain, left_inverse, (&identities, plant.identities[0].span), found)
}

/// A static regression from what the components of the transform have to do with each other; none if that
/// is nothing, or nothing that theta can be recovered from.
fn from_relations(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let relations = relations::among(plant, domain).ok().filter(|relations| !relations.is_empty())?;
    let mut own = Vec::new();
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let claim = standing_still(plant, domain, left_inverse?, (&relations, span), &mut own);
    // A claim that is undecided here is left to what the author can mend: the rates.
    if claim.verdict == Verdict::Undecided && own.iter().any(|d| d.code == Code::RegressionUndecided) {
        return None;
    }
    found.extend(own);
    Some(claim)
}

/// A static regression from expressions in z that vanish.
fn standing_still(
    plant: &Plant,
    domain: &Domain,
    left_inverse: &LeftInverse,
    (in_z, span): (&[Expr], Span),
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    match separation::separate(plant, domain, in_z) {
        Ok(Some(separated)) => {
            let separated = separation::absorb_constants(plant, domain, separated);
            if let Some(recovered) = separation::recover(plant, domain, &separated.eta) {
                if let Some(refusal) = turned_away(plant, domain, left_inverse, &separated.eta, &recovered, found) {
                    return refusal;
                }
                // identity = known + factors eta = 0, so known = -factors eta
                let negated = |row: &Vec<Expr>| row.iter().map(|e| shortest(arena, domain, arena.neg(*e))).collect();
                let result = Regression {
                    kind: RegressionKind::Static,
                    rows: Vec::new(),
                    phi_1: separated.factors.iter().map(negated).collect(),
                    phi_0: separated.known,
                    primitive_0: Vec::new(),
                    primitive_1: Vec::new(),
                    eta_symbols: plant.eta(separated.eta.len()),
                    eta: separated.eta,
                    theta: recovered.theta,
                };
                return Claim { verdict: Verdict::Proved, result: Some(result) };
            }
            found.push(undecided(plant, 0, span, &Obstacle::NoWitness));
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Ok(None) => {
            found.push(
                Diagnostic::error(
                    Code::RegressionUndecided,
                    span,
                    "no regression that is linear in functions of theta was found in this identity",
                )
                .help("write it as a polynomial in the components of phi, or give `f_y` for an output"),
            );
            Claim { verdict: Verdict::Undecided, result: None }
        }
        Err(obstacle) => {
            found.push(undecided(plant, 0, span, &obstacle));
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

fn refuted(plant: &Plant, index: usize, places: &[Formula], witness: &Witness, stands_against: &str) -> Diagnostic {
    let arena = &plant.arena;
    let output = arena.name(plant.y[index].symbol);
    let (first, others) = places.split_first().map_or((plant.y[index].span, &[][..]), |(f, rest)| (f.span, rest));
    let diagnostic = Diagnostic::error(
        Code::RegressionNonlinear,
        first,
        format!("the rate of {output} is not linear in the unknowns"),
    );
    let diagnostic = others.iter().fold(diagnostic, |diagnostic, other| diagnostic.also(other.span, "nor is this"));
    diagnostic
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
