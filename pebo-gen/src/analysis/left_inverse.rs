//! Claim 2, the left inverse: x from z = phi(x, y) and y.
//!
//! In: the plant. Out: `phi_left` with `phi_left(phi(x, y), y) = x` proved for each state that it
//! recovers, modulo the period for declared angles; the author's formula where there is one, else one
//! that solves the transform (Ortega et al. 2015, Assumption 1 (i), with `n_x` components).

use std::collections::BTreeMap;

use crate::cas::domain::Domain;
use crate::cas::field::Obstacle;
use crate::cas::interval::{Interval, Precision};
use crate::cas::zero::{Answer, decide};
use crate::cas::{Arena, Expr, Function, Node, Symbol};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};

use super::design::{Claim, LeftInverse, Origin, Verdict, Witness};
use super::identifiability::null_vectors;
use super::solve::{Equation, solve};
use super::tidy::shortest;

/// Proves or refutes the left inverse.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Claim<LeftInverse> {
    let (candidates, origin) = match &plant.phi_left {
        Some(given) => (given.iter().map(|(s, f)| (*s, f.expr, f.span)).collect::<Vec<_>>(), Origin::Given),
        None => match derived(plant, domain) {
            Ok(candidates) => (candidates, Origin::Derived),
            Err(obstacle) => {
                found.push(underivable(plant, &[], Some(&obstacle)));
                return Claim { verdict: Verdict::Undecided, result: None };
            }
        },
    };
    let mut result = LeftInverse { x: Vec::new(), modulo: Vec::new(), origin, witness: None };
    let mut verdict = Verdict::Proved;
    let mut ambiguous = Vec::new();
    for (state, formula, span) in candidates {
        let (tested, answer) = check(plant, domain, state, formula);
        match answer {
            Answer::Zero if !defined(plant, domain, state, formula, span, found) => {
                result.x.push((state, formula));
                verdict = verdict.max_doubt();
            }
            Answer::Zero => {
                result.x.push((state, formula));
                result.modulo.extend(plant.period(state).map(|period| (state, period)));
            }
            Answer::NonZero(point) if origin == Origin::Given => {
                let witness = Witness::of(tested, &point);
                found.push(refuted(plant, domain, state, span, &witness));
                result.x.push((state, formula));
                result.witness.get_or_insert(witness);
                verdict = Verdict::Refuted;
            }
            // A derived candidate that fails but has the same transform is a second state with the same z.
            Answer::NonZero(point) if same_transform(plant, domain, state, formula) => {
                let witness = Witness::of(tested, &point);
                found.push(not_injective(plant, state, formula, &witness));
                result.witness.get_or_insert(witness);
                verdict = Verdict::Refuted;
                ambiguous.push(state);
            }
            Answer::Open(obstacle) if origin == Origin::Given => {
                found.push(undecided(plant, state, span, &obstacle));
                result.x.push((state, formula));
                verdict = verdict.max_doubt();
            }
            // Any other candidate was a wrong branch, which says nothing about the claim.
            Answer::NonZero(_) | Answer::Open(_) => {}
        }
    }
    let recovered: Vec<Symbol> = result.x.iter().map(|(s, _)| *s).collect();
    let missing: Vec<Symbol> =
        plant.x.iter().map(|s| s.symbol).filter(|s| !recovered.contains(s) && !ambiguous.contains(s)).collect();
    if origin == Origin::Derived && !missing.is_empty() {
        if let Some(direction) = unseen_direction(plant, domain) {
            found.push(degenerate(plant, &direction));
            verdict = Verdict::Refuted;
        } else {
            found.push(underivable(plant, &missing, None));
            verdict = verdict.max_doubt();
        }
    }
    Claim { verdict, result: Some(result) }
}

impl Verdict {
    /// Undecided, unless it is worse already.
    fn max_doubt(self) -> Self {
        if self == Self::Proved { Self::Undecided } else { self }
    }
}

/// Whether the formula has a value wherever the plant has; where not, says so.
fn defined(
    plant: &Plant,
    domain: &Domain,
    state: Symbol,
    formula: Expr,
    span: Span,
    found: &mut Vec<Diagnostic>,
) -> bool {
    /// Points that are looked at: a root or logarithm of something of changing sign shows in a few.
    const POINTS: usize = 24;
    /// Enough that an enclosure next to the end of a domain is the exception.
    const PRECISION: Precision = Precision::new(256);
    let arena = &plant.arena;
    if arena.postorder(&[formula]).iter().all(|part| is_total(arena, *part)) {
        return true;
    }
    let mut given = plant.transform();
    given.extend(plant.rates().into_values());
    // The formula as it stands, over enclosures of z: substituting would simplify its domain away.
    let missing = domain.points(arena, &given).take(POINTS).find(|point| {
        let Some(mut values) = arena.enclose_all(&given, point, PRECISION) else { return false };
        values.truncate(plant.z.len());
        let mut known: BTreeMap<Symbol, Interval> = plant.z.iter().copied().zip(values).collect();
        known.extend(point.iter().filter_map(|(s, v)| Some((*s, Interval::from_rational(v, PRECISION)?))));
        arena.enclose_over(&[formula], &known, PRECISION).is_none()
    });
    let Some(point) = missing else { return true };
    let place: Vec<String> = arena
        .symbols_of(&given[..plant.z.len()])
        .iter()
        .filter_map(|s| Some(format!("{} = {}", arena.name(*s), arena.print(arena.number(point.get(s)?.clone())))))
        .collect();
    found.push(
        Diagnostic::error(
            Code::LeftInverseUndecided,
            span,
            format!("phi_left gives back {} only where it has a value", arena.name(state)),
        )
        .label("this state is recovered only in a part of the assumed domain")
        .note(format!("`{}` has no real value that could be enclosed where {}", arena.print(formula), place.join(", ")))
        .help("state the domain under `assume`, as `x > 0`"),
    );
    false
}

/// Whether an operation has a value at almost all operands: all but roots, logarithms and the like.
fn is_total(arena: &Arena, part: Expr) -> bool {
    match arena.node(part) {
        Node::Product(product) => product.factors.iter().all(|(_, exponent)| exponent.is_integer()),
        Node::Call(function, _) => !matches!(function, Function::Log | Function::Asin | Function::Acos),
        _ => true,
    }
}

/// Whether the candidate state has the same transform as the true one, identically.
fn same_transform(plant: &Plant, domain: &Domain, state: Symbol, formula: Expr) -> bool {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let other = BTreeMap::from([(state, arena.substitute(formula, &transform))]);
    let facts = domain.facts.iter().all(|(fact, _)| !arena.symbols_of(&[fact]).contains(&state));
    facts
        && plant
            .transform()
            .iter()
            .all(|phi| decide(arena, arena.sub(arena.substitute(*phi, &other), *phi), domain).is_zero())
}

/// A direction of x that the transform does not see anywhere, if there is one.
fn unseen_direction(plant: &Plant, domain: &Domain) -> Option<Vec<Expr>> {
    let arena = &plant.arena;
    let slopes: Vec<Vec<Expr>> =
        plant.phi.iter().map(|phi| plant.x.iter().map(|s| arena.derivative(phi.expr, s.symbol)).collect()).collect();
    null_vectors(arena, domain, &slopes, plant.x.len()).ok()?.into_iter().next()
}

/// Solves the transform for the states.
fn derived(plant: &Plant, domain: &Domain) -> Result<Vec<(Symbol, Expr, Span)>, Obstacle> {
    let arena = &plant.arena;
    let equations: Vec<Equation> = plant
        .phi
        .iter()
        .zip(&plant.z)
        .map(|(phi, z)| Equation { formula: phi.expr, value: arena.of_symbol(*z) })
        .collect();
    let states: Vec<Symbol> = plant.x.iter().map(|s| s.symbol).collect();
    let solved = solve(arena, domain, &equations, &states)?;
    Ok(plant
        .x
        .iter()
        .filter_map(|state| {
            let candidates = solved.get(&state.symbol)?;
            let right = |formula: &&Expr| check(plant, domain, state.symbol, **formula).1.is_zero();
            // A candidate that is wrong may still show that the transform is not one-to-one.
            let formula = candidates.iter().find(right).or(candidates.first())?;
            Some((state.symbol, shortest(arena, domain, *formula), state.rate.span))
        })
        .collect())
}

/// What must vanish, for an angle up to periods: `phi_left(phi(x, y), y) - x`.
fn residual(plant: &Plant, state: Symbol, formula: Expr) -> Expr {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    arena.sub(arena.substitute(formula, &transform), arena.of_symbol(state))
}

/// Decides whether a formula gives the state back; returns what was tested for zero as well.
fn check(plant: &Plant, domain: &Domain, state: Symbol, formula: Expr) -> (Expr, Answer) {
    let arena = &plant.arena;
    let difference = residual(plant, state, formula);
    let plain = decide(arena, difference, domain);
    let Some(period) = plant.period(state) else { return (difference, plain) };
    if plain.is_zero() {
        return (difference, plain);
    }
    let turn = arena.div(arena.mul(arena.number(2), arena.pi()), period);
    turns(arena, domain, arena.mul(difference, turn))
}

/// Decides whether an angle is a whole number of turns: its sine is 0 and its cosine 1.
fn turns(arena: &Arena, domain: &Domain, angle: Expr) -> (Expr, Answer) {
    let sin = arena.call(Function::Sin, &[angle]);
    let answer = decide(arena, sin, domain);
    if !answer.is_zero() {
        return (sin, answer);
    }
    let cos = arena.sub(arena.call(Function::Cos, &[angle]), arena.one());
    (cos, decide(arena, cos, domain))
}

/// Whether an angle is provably a whole number of turns.
pub(super) fn is_whole_turns(arena: &Arena, domain: &Domain, angle: Expr) -> bool {
    turns(arena, domain, angle).1.is_zero()
}

fn refuted(plant: &Plant, domain: &Domain, state: Symbol, span: Span, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseRefuted, span, format!("phi_left does not give back {name}"))
            .label(format!("with z = phi(x, y) this is not {name}"))
            .note(witness.sentence(arena));
    if let Some(period) = plant.period(state) {
        diagnostic = diagnostic
            .note(format!("that is not zero, so it fails also up to whole periods of {}", arena.print(period)));
    }
    let mend = derived(plant, domain).ok().and_then(|all| {
        let (_, formula, _) = all.into_iter().find(|(s, ..)| *s == state)?;
        check(plant, domain, state, formula).1.is_zero().then_some(formula)
    });
    match mend {
        Some(formula) => diagnostic.help(format!("use `{name}: {}`", arena.print(formula))),
        None => diagnostic.help("leave phi_left out to have it derived, or state the domain under `assume`"),
    }
}

fn not_injective(plant: &Plant, state: Symbol, formula: Expr, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let other = arena.print(arena.substitute(formula, &transform));
    Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), format!("phi does not determine {name}"))
        .label(format!("{name} and {other} have the same z"))
        .note(format!("they differ: {}", witness.sentence(arena)))
        .help(format!("state the sign of {name} under `assume`, or choose a phi that is one-to-one in {name}"))
}

fn degenerate(plant: &Plant, direction: &[Expr]) -> Diagnostic {
    let arena = &plant.arena;
    let entries: Vec<String> = plant
        .x
        .iter()
        .zip(direction)
        .map(|(s, d)| format!("{}' = {}", arena.name(s.symbol), arena.print(*d)))
        .collect();
    Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), "phi does not determine x")
        .label(format!("z does not change along {}", entries.join(", ")))
        .help("add components to phi, or give `phi_left` for the states that it determines: a partial observer")
}

fn at_phi(plant: &Plant) -> Span {
    match (plant.phi.first(), plant.phi.last()) {
        (Some(first), Some(last)) => first.span.to(last.span),
        _ => Span::point(0),
    }
}

fn undecided(plant: &Plant, state: Symbol, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let name = plant.arena.name(state);
    Diagnostic::error(
        Code::LeftInverseUndecided,
        span,
        format!("it could not be decided whether phi_left gives back {name}"),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("state the signs of the quantities under roots and logarithms under `assume`")
}

fn underivable(plant: &Plant, missing: &[Symbol], obstacle: Option<&Obstacle>) -> Diagnostic {
    let names: Vec<String> = missing.iter().map(|s| plant.arena.name(*s)).collect();
    let of = if names.is_empty() { String::new() } else { format!(" for {}", names.join(", ")) };
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseUnderivable, span, format!("no left inverse was found{of}"))
            .label("this transform could not be solved for the states");
    if let Some(obstacle) = obstacle {
        diagnostic = diagnostic.note(format!("obstacle: {obstacle}"));
    }
    diagnostic.help("give it under `phi_left`, or state signs of states under `assume`")
}
