//! Claim 2, the left inverse: x from z = phi(x, y) and y.
//!
//! In: the plant. Out: `phi_left` with `phi_left(phi(x, y), y) = x` proved for each state that it
//! recovers, modulo the period for declared angles; the author's formula where there is one, else one
//! that solves the transform (Ortega et al. 2015, Assumption 1 (i), with `n_x` components).

mod cellwise;
pub(super) mod checking;
mod equations;
mod overdetermined;
mod solving;
mod words;

use std::collections::BTreeMap;

use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::domain::injectivity::Collision;
use pebo_cas::domain::zero::{self, Answer, is_zero, refute};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{self, Domain, Expr, Rational, Relation, Symbol};

use super::design::{Claim, Comparison, LeftInverse, Origin, Verdict, Witness};
use checking::{check, open_conditions};
use pebo_cas::linear::rank::null_vectors;
use words::{degenerate, not_injective, not_one_to_one, refuted, undecided, underivable};

/// Proves or refutes the left inverse.
pub(super) fn prove(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Claim<LeftInverse> {
    let (candidates, origin) = match &plant.phi_left {
        Some(given) => (given.iter().map(|(s, f)| (*s, f.expr, f.span)).collect::<Vec<_>>(), Origin::Given),
        None => match solving::formulas(plant, domain) {
            Ok(formulas) => {
                let spanned = formulas.into_iter().map(|(state, formula)| (state.symbol, formula, state.rate.span));
                (spanned.collect(), Origin::Derived)
            }
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
            Answer::NonZero(_) => {
                // A derived candidate that fails but has the same transform is a second state with the same z; any
                // other was a wrong branch, which says nothing about the claim.
                let Some(point) = same_transform(plant, domain, state, formula, tested) else { continue };
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
            Answer::Open(_) => {}
        }
    }
    let recovered: Vec<Symbol> = result.x.iter().map(|(s, _)| *s).collect();
    let missing: Vec<Symbol> =
        plant.x.iter().map(|s| s.symbol).filter(|s| !recovered.contains(s) && !ambiguous.contains(s)).collect();
    if origin == Origin::Derived && !missing.is_empty() {
        if let Some(direction) = unobservable_direction(plant, domain) {
            found.push(degenerate(plant, &direction));
            verdict = Verdict::Refuted;
        } else if let Some((state, witness)) = missing.iter().find_map(|s| Some((*s, taken_twice(plant, domain, *s)?)))
        {
            found.push(not_one_to_one(plant, state, &witness));
            result.witness.get_or_insert(witness);
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

/// Tests whether the formula provably has a value wherever the plant has, up to listed conditions that something does
/// not vanish; reports it if not.
fn defined(
    plant: &Plant,
    domain: &Domain,
    state: Symbol,
    formula: Expr,
    span: Span,
    found: &mut Vec<Diagnostic>,
) -> bool {
    let arena = &plant.arena;
    let unproved =
        open_conditions(plant, domain, formula).into_iter().find(|(_, condition)| condition.1 != Relation::NonZero);
    let Some(((part, relation), (at_phi, _))) = unproved else { return true };
    let (sign, at_phi) = (relation.sign(), arena.print(at_phi));
    found.push(
        Diagnostic::error(
            Code::LeftInverseUndecided,
            span,
            format!(
                "phi_left, which recovers {}, was not shown to have a value throughout the domain",
                arena.name(state)
            ),
        )
        .label(format!("it needs `{} {sign}`", arena.print(part)))
        .note(format!(
            "at z = phi(x, y) this condition is `{at_phi} {sign}`, which does not follow from the assumptions"
        ))
        .help(format!("if it holds, write `{at_phi} {sign}` under `assume`")),
    );
    false
}

/// A point of the domain at which another state of the domain has the same transform: the candidate, with y, u,
/// parameters and the other states as they are.
fn same_transform(plant: &Plant, domain: &Domain, state: Symbol, formula: Expr, tested: Expr) -> Option<zero::Witness> {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let other = BTreeMap::from([(state, arena.substitute(formula, &transform))]);
    // Both states are in the domain.
    let mut both = domain.clone();
    for (fact, relation) in domain.facts.iter().filter(|(fact, _)| arena.symbols_of(&[*fact]).contains(&state)) {
        both.facts.assume(arena.substitute(fact, &other), relation);
    }
    let same = |phi: &Expr| is_zero(arena, arena.sub(arena.substitute(*phi, &other), *phi), &both);
    let holds = |identity: &Formula| is_zero(arena, arena.substitute(identity.expr, &other), &both);
    if !plant.transform().iter().all(same) || !plant.identities.iter().all(holds) {
        return None;
    }
    refute(arena, tested, &both)
}

/// A point of the domain beside which another state of the domain has the same transform, where one state alone differs
/// and one component alone depends on it.
fn taken_twice(plant: &Plant, domain: &Domain, state: Symbol) -> Option<Witness> {
    const POINTS: usize = 6;
    let arena = &plant.arena;
    let hidden = [state].into();
    let transform = plant.transform();
    let mut own = transform.iter().filter(|component| arena.depends_on(**component, &hidden));
    let (component, None) = (*own.next()?, own.next()) else { return None };
    let bound = plant.identities.iter().any(|identity| arena.depends_on(identity.expr, &hidden));
    if bound || plant.period(state).is_some() {
        return None;
    }
    // The domain is where the plant and the transform have values and derivatives.
    let formulas: Vec<Expr> = transform.iter().copied().chain(plant.rates().into_values()).collect();
    let conditions = arena.domain_conditions(&formulas, Regularity::Differentiable);
    let points = domain.points(arena, &formulas).take(POINTS);
    points.into_iter().find_map(|point| {
        let Collision { at, between, values } =
            pebo_cas::domain::injectivity::collision(arena, domain, &conditions, component, state, &point)?;
        let difference = arena.sub(arena.of_symbol(state), arena.number(at.clone()));
        let ends = [&between[0] - &at, &between[1] - &at].map(|end| end.to_f64());
        let place = |value: &Rational| vec![(state, arena.number(value.clone()))];
        let symbols = arena.symbols_of(&[component]);
        let known: Vec<(Symbol, Expr)> =
            point.into_iter().filter(|(symbol, _)| *symbol != state && symbols.contains(symbol)).collect();
        let places = if between[0] == between[1] { 2 } else { 3 };
        let compared = Comparison {
            expr: component,
            read: component,
            points: [&at, &between[0], &between[1]].into_iter().map(place).take(places).collect(),
            known: known.clone(),
            values: values.iter().map(|value| (value.lo(), value.hi())).take(places).collect(),
        };
        let bounds = (ends[0].next_down(), ends[1].next_up());
        Some(Witness { expr: difference, point: known, bounds, compared: Some(compared) })
    })
}

/// A direction of x that the transform does not see anywhere, if there is one.
fn unobservable_direction(plant: &Plant, domain: &Domain) -> Option<Vec<Expr>> {
    let arena = &plant.arena;
    // A symbol fixed by an identity is no direction of the domain.
    let functions = plant.phi.iter().chain(&plant.identities);
    let slopes: Vec<Vec<Expr>> =
        functions.map(|function| plant.x.iter().map(|s| arena.derivative(function.expr, s.symbol)).collect()).collect();
    null_vectors(arena, domain, &slopes, plant.x.len()).ok()?.into_iter().next()
}
