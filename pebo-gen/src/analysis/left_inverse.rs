//! Claim 2, the left inverse: x from z = phi(x, y) and y.
//!
//! In: the plant. Out: `phi_left` with `phi_left(phi(x, y), y) = x` proved for each state that it
//! recovers, modulo the period for declared angles; the author's formula where there is one, else one
//! that solves the transform (Ortega et al. 2015, Assumption 1 (i), with `n_x` components).

use std::cell::OnceCell;
use std::collections::BTreeMap;

use crate::cas::asks::Want;
use crate::cas::domain::Domain;
use crate::cas::facts::Relation;
use crate::cas::field::Obstacle;
use crate::cas::frozen::Frozen;
use crate::cas::rational::Rational;
use crate::cas::twice::Twice;
use crate::cas::zero::{self, Answer, decide, refute};
use crate::cas::{self, Arena, Expr, Function, Symbol};
use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic, Span};

use crate::analysis::design::{Claim, Comparison, LeftInverse, Origin, Verdict, Witness};
use crate::cas::rank::null_vectors;
use crate::cas::solve::{Equation, solve};
use crate::cas::tidy::{functions, operations, root_differences, shortest};

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
        if let Some(direction) = unseen_direction(plant, domain) {
            found.push(degenerate(plant, &direction));
            verdict = Verdict::Refuted;
        } else if let Some((state, witness)) = missing.iter().find_map(|s| Some((*s, taken_twice(plant, domain, *s)?)))
        {
            found.push(takes_twice(plant, state, &witness));
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

/// What a formula for a state asks at z = phi(x, y) that the domain does not show: the ask, and the ask there.
///
/// What stands under roots and logarithms and below fraction bars is read off the formula as it stands, since
/// substituting would simplify its domain away.
fn unshown(plant: &Plant, domain: &Domain, formula: Expr) -> Vec<((Expr, Relation), (Expr, Relation))> {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let asked = arena.asks(&[formula], Want::Value).into_iter();
    let there = asked.map(|(part, relation)| ((part, relation), (arena.substitute(part, &transform), relation)));
    there.filter(|(_, ask)| !arena.holds_of_number(*ask) && !domain.implies(arena, ask.0, ask.1)).collect()
}

/// Whether the formula provably has a value wherever the plant has, but for what must only not vanish and is listed
/// among the conditions; where not, says so.
fn defined(
    plant: &Plant,
    domain: &Domain,
    state: Symbol,
    formula: Expr,
    span: Span,
    found: &mut Vec<Diagnostic>,
) -> bool {
    let arena = &plant.arena;
    let unproved = unshown(plant, domain, formula).into_iter().find(|(_, ask)| ask.1 != Relation::NonZero);
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
    // Where both states are in the domain.
    let mut both = domain.clone();
    for (fact, relation) in domain.facts.iter().filter(|(fact, _)| arena.symbols_of(&[*fact]).contains(&state)) {
        both.facts.assume(arena.substitute(fact, &other), relation);
    }
    let same = |phi: &Expr| decide(arena, arena.sub(arena.substitute(*phi, &other), *phi), &both).is_zero();
    let stands = |identity: &Formula| decide(arena, arena.substitute(identity.expr, &other), &both).is_zero();
    if !plant.transform().iter().all(same) || !plant.identities.iter().all(stands) {
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
    let asks = arena.asks(&formulas, Want::Slope);
    let points = domain.points(arena, &formulas).take(POINTS);
    points.into_iter().find_map(|point| {
        let Twice { at, between, values } = cas::twice::taken_twice(arena, domain, &asks, component, state, &point)?;
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
fn unseen_direction(plant: &Plant, domain: &Domain) -> Option<Vec<Expr>> {
    let arena = &plant.arena;
    // What an identity holds fixed is no direction of the domain.
    let seen = plant.phi.iter().chain(&plant.identities);
    let slopes: Vec<Vec<Expr>> =
        seen.map(|seen| plant.x.iter().map(|s| arena.derivative(seen.expr, s.symbol)).collect()).collect();
    null_vectors(arena, domain, &slopes, plant.x.len()).ok()?.into_iter().next()
}

/// Solves the transform for the states.
fn derived(plant: &Plant, domain: &Domain) -> Result<Vec<(Symbol, Expr, Span)>, Obstacle> {
    let arena = &plant.arena;
    let equations = equations_of(plant, plant.transform());
    let states: Vec<Symbol> = plant.x.iter().map(|s| s.symbol).collect();
    // Where a class proposes a formula for every state, nothing is solved for.
    let proposed = |state: &Symbol| plant.proposal.phi_left.iter().any(|(own, _)| own == state);
    let solved = if states.iter().all(proposed) { BTreeMap::new() } else { solve(arena, domain, &equations, &states)? };
    // Of several the one that has a value wherever the plant has.
    // Then the one in which no root is taken from what is near it, and the shortest.
    let by_worth = |candidates: &mut Vec<Expr>| {
        if candidates.len() > 1 {
            candidates.sort_by_cached_key(|formula| {
                let cancelling = root_differences(arena, *formula).len();
                (unshown(plant, domain, *formula).len(), cancelling, operations(arena, *formula))
            });
        }
    };
    let told = OnceCell::new();
    let by_identities = |state: &Symbol| {
        let told: &BTreeMap<_, _> = told.get_or_init(|| with_identities(plant, domain, &states).unwrap_or_default());
        let mut candidates = told.get(state).cloned().unwrap_or_default();
        by_worth(&mut candidates);
        candidates
    };
    // What is known of the functions of y alone is known of the equations above; as they are written they compute better.
    let known = plant.hidden();
    let mut frozen = Frozen::new(arena, &known);
    let kept = frozen.freeze(&plant.transform());
    let as_written = if solved.is_empty() || frozen.is_empty() {
        BTreeMap::new()
    } else {
        let equations = equations_of(plant, kept);
        solve(arena, domain, &equations, &states).unwrap_or_default()
    };
    let own = functions(arena, &plant.transform());
    Ok(plant
        .x
        .iter()
        .filter_map(|state| {
            let proposed =
                plant.proposal.phi_left.iter().filter(|(s, _)| *s == state.symbol).map(|(_, formula)| *formula);
            // Of proposals for the same state the shortest; what is solved for comes with the likelier first.
            let mut candidates: Vec<Expr> = proposed.map(|formula| shortest(arena, domain, formula)).collect();
            candidates.sort_by_cached_key(|formula| operations(arena, *formula));
            candidates.extend(solved.get(&state.symbol).into_iter().flatten());
            let likeliest = candidates.first().copied();
            by_worth(&mut candidates);
            let right = |formula: &Expr| check(plant, domain, state.symbol, *formula).1.is_zero();
            // What outputs measure comes with their noise: it serves where the transform alone is not solved.
            let found = candidates.iter().copied().find(right);
            let found = found.or_else(|| by_identities(&state.symbol).iter().copied().find(right));
            let written = as_written.get(&state.symbol).into_iter().flatten().map(|formula| frozen.thaw(*formula));
            let forms = found.into_iter().chain(written.filter(right)).map(|formula| shortest(arena, domain, formula));
            // Then the one in the author's functions: `z/tanh(y)`, and nothing in exponentials.
            let merit = |formula: &Expr| {
                let foreign = functions(arena, &[*formula]).into_iter().filter(|call| {
                    !own.contains(call) && arena.symbols_of(&[*call]).is_disjoint(&plant.z.iter().copied().collect())
                });
                let cancelling = root_differences(arena, *formula).len();
                (unshown(plant, domain, *formula).len(), foreign.count(), cancelling, operations(arena, *formula))
            };
            // A candidate that is wrong may still show that the transform is not one-to-one.
            let likeliest = || likeliest.or_else(|| by_identities(&state.symbol).first().copied());
            let formula = forms.min_by_key(merit).or_else(likeliest)?;
            Some((state.symbol, shortest(arena, domain, formula), state.rate.span))
        })
        .collect())
}

/// The transform, in these formulas, equal to z.
fn equations_of(plant: &Plant, transform: Vec<Expr>) -> Vec<Equation> {
    let values = plant.z.iter().map(|z| plant.arena.of_symbol(*z));
    transform.into_iter().zip(values).map(|(formula, value)| Equation { formula, value }).collect()
}

/// Solves the transform together with the identities; of what comes out, what is a function of z and y.
fn with_identities(plant: &Plant, domain: &Domain, states: &[Symbol]) -> Result<BTreeMap<Symbol, Vec<Expr>>, Obstacle> {
    if plant.identities.is_empty() {
        return Ok(BTreeMap::new());
    }
    let arena = &plant.arena;
    let zero = arena.zero();
    let mut equations = equations_of(plant, plant.transform());
    equations.extend(plant.identities.iter().map(|identity| Equation { formula: identity.expr, value: zero }));
    let mut foreign = plant.hidden();
    foreign.extend(&plant.u);
    let mut solved = solve(arena, domain, &equations, states)?;
    for candidates in solved.values_mut() {
        candidates.retain(|formula| !arena.depends_on(*formula, &foreign));
    }
    solved.retain(|_, candidates| !candidates.is_empty());
    Ok(solved)
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
    let unlike = unlike_after(plant, domain, state, period);
    if let Some(answer) = unlike {
        return answer;
    }
    let turn = arena.div(arena.turn(), period);
    turns(arena, domain, arena.mul(difference, turn))
}

/// A rate that is not the same a period further on: then the state is no angle of that period, and
/// knowing it up to the period is not knowing it.
fn unlike_after(plant: &Plant, domain: &Domain, state: Symbol, period: Expr) -> Option<(Expr, Answer)> {
    let arena = &plant.arena;
    let turned = BTreeMap::from([(state, arena.add(arena.of_symbol(state), period))]);
    plant.rates().into_values().find_map(|rate| {
        let change = arena.sub(arena.substitute(rate, &turned), rate);
        let answer = decide(arena, change, domain);
        (!answer.is_zero()).then_some((change, answer))
    })
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
    let mut diagnostic = Diagnostic::error(Code::LeftInverseRefuted, span, format!("phi_left does not recover {name}"))
        .label(format!("at z = phi(x, y) this formula is not equal to {name}"))
        .note(witness.sentence(arena));
    if let Some(period) = plant.period(state) {
        let shown = arena.print(period);
        if unlike_after(plant, domain, state, period).is_some() {
            return diagnostic
                .note(format!(
                    "this is how a rate of the plant differs between {name} + {shown} and {name}: {shown} is no period of \
                     {name}, and to know {name} up to multiples of it is not to know {name}"
                ))
                .help(format!("declare a period of {name} under `angles` with which all rates repeat"));
        }
        diagnostic =
            diagnostic.note(format!("this is not zero, so the two differ by more than whole periods of {shown}"));
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
        .label(format!("the states {name} and {other} give the same z"))
        .note(format!("they differ: {}", witness.sentence(arena)))
        .help(format!("state the sign of {name} under `assume`, or choose a phi that is one-to-one in {name}"))
}

fn takes_twice(plant: &Plant, state: Symbol, witness: &Witness) -> Diagnostic {
    let arena = &plant.arena;
    let name = arena.name(state);
    let mut diagnostic =
        Diagnostic::error(Code::LeftInverseRefuted, at_phi(plant), format!("phi does not determine {name}"))
            .label(format!("two values of {name} give the same z"));
    if let Some(compared) = &witness.compared {
        let what = format!("`{}`", arena.print(compared.expr));
        diagnostic = diagnostic.note(compared.sentence(arena, &what));
        if compared.points.len() > 2 {
            diagnostic = diagnostic
                .note("it is continuous between the last two, so somewhere there it has the first value once more");
        }
    }
    diagnostic.help(format!("bound {name} under `assume`, or choose a phi that is one-to-one in {name}"))
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
        .label(format!("z does not change along the direction {}", entries.join(", ")))
        .help("add components to phi, or give `phi_left` for the states that it determines: a partial observer")
}

/// Where the transform stands.
pub(super) fn at_phi(plant: &Plant) -> Span {
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
        format!("it could not be decided whether phi_left recovers {name}"),
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
    diagnostic.help("give the left inverse under `phi_left`, or state the signs of states under `assume`")
}
