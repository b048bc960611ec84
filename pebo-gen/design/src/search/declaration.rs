//! Declarations with which a transform is accepted, found by trying them.
//!
//! In: a search without a transform that is accepted. Out: signs and an order of states, angles among them, bounds of
//! these, any class of cascade, the plant without states that no output depends on, or with states among its unmeasured signals or
//! its outputs, where with it all claims of a transform are proved. Whether the plant has the property only its author knows.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use crate::analysis::{Class, Verdict};
use crate::plant::Plant;
use crate::source;
use pebo_cas::forms::tidy;
use pebo_cas::{Arena, Expr, Function, Node, Rational, Relation, Symbol};

use super::at_estimate;
use super::candidate::Candidate;
use super::problem::Problem;
use super::symmetry::Symmetry;

/// The share of the remaining budget for each declaration.
const SHARE: u64 = 2;

/// A declaration that a model lacks.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Declaration {
    /// These states are positive.
    Positive(Vec<Symbol>),
    /// The first state is larger than the second.
    Larger(Symbol, Symbol),
    /// These states are angles of the period.
    Angles(Vec<(Symbol, Expr)>),
    /// These states are angles within a quarter of the period to either side of zero.
    Bounded(Vec<(Symbol, Expr)>),
    /// These expressions are positive.
    Assumed(Vec<Expr>),
    /// No class of cascade is asked for.
    AnyClass,
    /// The regression may be monotone in the unknowns.
    Monotone,
    /// The regression may be one to first order.
    Local,
    /// These states are left out: no output depends on them.
    Without(Vec<Symbol>),
    /// These states are unmeasured signals with an unknown rate, and are not recovered.
    Unmeasured(Vec<Symbol>),
    /// This state is measured.
    Measured(Symbol),
}

impl Declaration {
    /// True if it is a smaller domain of the same plant.
    pub(super) fn is_of_domain(&self) -> bool {
        matches!(self, Self::Positive(_) | Self::Larger(..) | Self::Angles(_) | Self::Bounded(_) | Self::Assumed(_))
    }

    /// The lines of the model file of the plant with it.
    pub fn lines(&self, plant: &Plant) -> String {
        let arena = &plant.arena;
        let listed = |entries: Vec<String>| entries.join(", ");
        match self {
            Self::Positive(_) | Self::Larger(..) | Self::Bounded(_) | Self::Assumed(_) => {
                format!("`assume: [{}]`", listed(self.assumed(arena)))
            }
            Self::Angles(angles) => {
                let entry =
                    |(state, period): &(Symbol, Expr)| format!("{}: {}", arena.name(*state), arena.print(*period));
                format!("`angles: {{{}}}`", listed(angles.iter().map(entry).collect()))
            }
            Self::AnyClass => "no `class`".to_owned(),
            Self::Monotone => "`regression: monotone`".to_owned(),
            Self::Local => "`regression: local`".to_owned(),
            Self::Without(states) => {
                let names: Vec<String> = states.iter().map(|state| format!("`{}`", arena.name(*state))).collect();
                format!("no {}", listed(names))
            }
            Self::Unmeasured(_) | Self::Measured(_) => {
                let names =
                    |symbols: Vec<Symbol>| listed(symbols.into_iter().map(|symbol| arena.name(symbol)).collect());
                let (key, others) = match self {
                    Self::Unmeasured(_) => ("w", plant.w.clone()),
                    _ => ("y", plant.y.iter().map(|output| output.symbol).collect()),
                };
                let states = plant.x.iter().map(|state| state.symbol).collect();
                format!("`x: [{}]`, `{key}: [{}]`", names(states), names(others))
            }
        }
    }

    /// The advice to write it, for the plant with it.
    pub fn help(&self, plant: &Plant) -> String {
        let arena = &plant.arena;
        match self {
            Self::Positive(_) | Self::Larger(..) | Self::Angles(_) | Self::Bounded(_) | Self::Assumed(_) => {
                format!("write {}, if that holds of the plant", self.lines(plant))
            }
            Self::Unmeasured(states) => {
                let names = |symbols: Vec<Symbol>| {
                    let names: Vec<String> = symbols.into_iter().map(|symbol| arena.name(symbol)).collect();
                    source::listed(names.iter().map(String::as_str))
                };
                let recovered = names(plant.x.iter().map(|state| state.symbol).collect());
                let (lines, left_out) = (self.lines(plant), names(states.clone()));
                format!(
                    "for {recovered} alone write {lines} and leave out what `f_x`, `g_y` and `identities` say of {left_out}"
                )
            }
            Self::Measured(state) => {
                let state = arena.name(*state);
                format!("measure `{state}` too: write {}, and the rate of `{state}` under `f_y`", self.lines(plant))
            }
            Self::AnyClass => "leave out `class`".to_owned(),
            Self::Monotone => {
                "write `regression: monotone`: a gradient then leads to the state from every start within the assumptions"
                    .to_owned()
            }
            Self::Local => {
                "write `regression: local`: estimates then converge from a neighbourhood of the state, whose \
                            size no proof gives"
                    .to_owned()
            }
            Self::Without(states) => {
                let names: Vec<String> = states.iter().map(|state| format!("`{}`", arena.name(*state))).collect();
                let (names, them) = (names.join(", "), if states.len() == 1 { "it" } else { "them" });
                format!("measure an output that depends on {names}, or leave {them} out under `x` and `f_x`")
            }
        }
    }

    /// The inequalities that it assumes.
    pub fn assumed(&self, arena: &Arena) -> Vec<String> {
        match self {
            Self::Positive(states) => signs(arena, states),
            Self::Larger(larger, smaller) => vec![format!("{} > {}", arena.name(*larger), arena.name(*smaller))],
            Self::Bounded(angles) => bounds(arena, angles),
            Self::Assumed(positive) => positive.iter().map(|expr| format!("{} > 0", arena.print(*expr))).collect(),
            Self::Angles(_)
            | Self::AnyClass
            | Self::Monotone
            | Self::Local
            | Self::Without(_)
            | Self::Unmeasured(_)
            | Self::Measured(_) => Vec::new(),
        }
    }
}

fn signs(arena: &Arena, states: &[Symbol]) -> Vec<String> {
    states.iter().map(|state| format!("{} > 0", arena.name(*state))).collect()
}

fn bounds(arena: &Arena, angles: &[(Symbol, Expr)]) -> Vec<String> {
    let bound = |(state, most): &(Symbol, Expr)| {
        let most = arena.print(*most);
        format!("-{most} < {} < {most}", arena.name(*state))
    };
    angles.iter().map(bound).collect()
}

/// The search for the best transform of a plant, if one is accepted.
pub(super) type Accepted<'a> = &'a dyn Fn(&Plant, Option<Class>) -> Option<Candidate>;

/// The first declaration with which a transform recovers all states.
pub(super) fn helpful(
    problem: &Problem<'_>,
    candidates: &[Candidate],
    symmetry: Option<&Symmetry>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    with_signs(problem, candidates)
        .or_else(|| with_order(problem, symmetry?, class, accepted))
        .or_else(|| with_smooth_formulas(problem, class, accepted))
        .or_else(|| with_angles(problem, class, accepted))
        .or_else(|| with_bounds(problem, class, accepted))
        .or_else(|| with_any_class(problem, class, accepted))
}

/// The transform of the plant in which one of two states that may be exchanged is the larger.
fn with_order(
    problem: &Problem<'_>,
    symmetry: &Symmetry,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let (larger, smaller) = symmetry.exchanged(problem.arena).filter(|_| problem.goes_on())?;
    let plant = problem.plant.with_larger(larger, smaller);
    let candidate = problem.arena.budget().share(SHARE, || accepted(&plant, class))?;
    Some((candidate, Declaration::Larger(larger, smaller)))
}

/// The transform of the plant on one side of the walls that divide its formulas: friction while an axis turns one way, a
/// spring while it is in contact. A single wall has two sides.
fn with_smooth_formulas(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let (plant, arena) = (problem.plant, problem.arena);
    let values = plant.y.iter().filter_map(|output| output.value).map(|value| value.expr);
    let hidden: BTreeSet<Symbol> = problem.x.iter().copied().collect();
    let is_signed = |expr: Expr| problem.domain.implies(arena, expr, Relation::Positive);
    let is_open =
        |expr: &Expr| arena.depends_on(*expr, &hidden) && ![*expr, arena.neg(*expr)].into_iter().any(is_signed);
    let dividers = arena.dividers(&plant.rates().into_values().chain(values).collect::<Vec<Expr>>());
    let walls: BTreeSet<Expr> = dividers.into_iter().filter(is_open).collect();
    let walls: Vec<Expr> = walls.into_iter().collect();
    let sides = match walls[..] {
        [] => return None,
        [wall] => vec![vec![wall], vec![arena.neg(wall)]],
        _ => vec![walls],
    };
    sides.into_iter().take_while(|_| problem.goes_on()).find_map(|side| {
        let there = plant.with_positive_expressions(side.iter().copied());
        let candidate = arena.budget().share(SHARE, || accepted(&there, class))?;
        Some((candidate, Declaration::Assumed(side)))
    })
}

/// The states of which the assumptions do not say that they are positive, or negative.
fn without_sign(problem: &Problem<'_>) -> Vec<Symbol> {
    let arena = problem.arena;
    let is_unknown = |state: &Symbol| {
        let state = arena.of_symbol(*state);
        ![state, arena.neg(state)].iter().any(|e| problem.domain.implies(arena, *e, Relation::Positive))
    };
    problem.x.iter().copied().filter(is_unknown).collect()
}

/// The first transform that recovers the states if a state without a known sign is positive, or all of them are: unknown
/// constants first, which keep theirs.
fn with_signs(problem: &Problem<'_>, candidates: &[Candidate]) -> Option<(Candidate, Declaration)> {
    let arena = problem.arena;
    let is_lost = |c: &&Candidate| {
        c.derivation.cascade.verdict == Verdict::Proved && c.derivation.left_inverse.verdict != Verdict::Proved
    };
    let lost = candidates.iter().find(is_lost)?;
    let mut signs = without_sign(problem);
    let is_constant = |state: &Symbol| problem.rates.get(state).is_some_and(|rate| arena.is_zero(*rate));
    signs.sort_by_key(|state| !is_constant(state));
    let alone = signs.iter().map(|state| vec![*state]);
    let together = (signs.len() > 1).then(|| problem.x.iter().copied().filter(|state| signs.contains(state)).collect());
    for positive in alone.chain(together) {
        if !problem.goes_on() {
            return None;
        }
        let plant = problem.plant.with_positive(&positive);
        let with_sign = Problem::of(&plant);
        let candidate = arena.budget().share(SHARE, || Candidate::of(&with_sign, &lost.plant.transform()));
        let full = if candidate.is_full() {
            Some(candidate)
        } else {
            let lifted = || super::lifted::lifted(&with_sign, &candidate.plant, &candidate.derivation);
            arena.budget().share(SHARE, lifted)
        };
        if let Some(full) = full {
            return Some((full, Declaration::Positive(positive)));
        }
    }
    None
}

/// The transform of the plant in which the states that it holds in sines and cosines alone are angles.
fn with_angles(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let plant = problem.plant;
    let states = problem.x.iter().filter(|state| plant.period(**state).is_none());
    let angles: Vec<(Symbol, Expr)> = states.filter_map(|state| Some((*state, period(plant, *state)?))).collect();
    if angles.is_empty() || !problem.goes_on() {
        return None;
    }
    let plant = plant.with_angles(&angles);
    let candidate = problem.arena.budget().share(SHARE, || accepted(&plant, class))?;
    Some((candidate, Declaration::Angles(angles)))
}

/// The transform of the plant in which these states are within the range where their sines or tangents tell them apart.
fn with_bounds(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let (plant, arena) = (problem.plant, problem.arena);
    let angle = |state: &Symbol| Some((*state, arena.scale(period(plant, *state)?, &Rational::new(1, 4)?)));
    // What is declared to be an angle turns.
    let open = problem.x.iter().filter(|state| plant.period(**state).is_none());
    let angles: Vec<(Symbol, Expr)> = open.filter_map(angle).collect();
    if angles.is_empty() || !problem.goes_on() {
        return None;
    }
    let plant = plant.within_bounds(&angles);
    let candidate = arena.budget().share(SHARE, || accepted(&plant, class))?;
    Some((candidate, Declaration::Bounded(angles)))
}

/// The transform of the plant without the states that no output depends on.
pub(super) fn without_unseen(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    let plant = problem.plant;
    let unseen = unseen(plant);
    if unseen.is_empty() || unseen.len() == plant.x.len() || !problem.goes_on() {
        return None;
    }
    let plant = plant.without_states(&unseen);
    let candidate = problem.arena.budget().share(SHARE, || accepted(&plant, class))?;
    Some((candidate, Declaration::Without(unseen)))
}

/// The states on which no output depends, by its rate, its value or an identity, directly or through other states.
pub(super) fn unseen(plant: &Plant) -> Vec<Symbol> {
    let arena = &plant.arena;
    let rates = plant.rates();
    let of_outputs = plant.y.iter().flat_map(|output| output.rate.iter().chain(&output.value)).map(|f| f.expr);
    let identities = plant.identities.iter().map(|identity| identity.expr);
    let mut seen = arena.symbols_of(&of_outputs.chain(identities).collect::<Vec<Expr>>());
    loop {
        let moving: Vec<Expr> = seen.iter().filter_map(|symbol| rates.get(symbol).copied()).collect();
        let more = arena.symbols_of(&moving);
        if more.is_subset(&seen) {
            break;
        }
        seen.extend(more);
    }
    plant.x.iter().map(|state| state.symbol).filter(|state| !seen.contains(state)).collect()
}

/// The states of the plant in which outputs are monotone in them: where a factor of a slope has one sign.
pub(super) fn with_monotone_rates(problem: &Problem<'_>) -> Option<(Candidate, Declaration)> {
    let (plant, arena) = (problem.plant, problem.arena);
    let hidden: BTreeSet<Symbol> = problem.x.iter().copied().collect();
    let formulas =
        plant.y.iter().flat_map(|output| output.rate.iter().chain(&output.value)).map(|formula| formula.expr);
    let shortest = |expr: Expr| tidy::shortest(arena, &problem.domain, expr);
    let slopes =
        formulas.flat_map(|formula| hidden.iter().map(move |state| shortest(arena.derivative(formula, *state))));
    let parts = |slope: Expr| match arena.node(slope) {
        Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
        _ => vec![slope],
    };
    let is_plane = |expr: &Expr| {
        let moves = |state: &Symbol| arena.depends_on(shortest(arena.derivative(*expr, *state)), &hidden);
        arena.depends_on(*expr, &hidden) && !hidden.iter().any(moves)
    };
    let is_signed = |expr: Expr| problem.domain.implies(arena, expr, Relation::Positive);
    let is_open = |expr: &Expr| is_plane(expr) && !is_signed(*expr) && !is_signed(arena.neg(*expr));
    let open: BTreeSet<Expr> = slopes.flat_map(parts).filter(is_open).collect();
    // Of more, no one sign is likely.
    let open: Vec<Expr> = open.into_iter().collect();
    let [factor] = open[..] else { return None };
    [factor, arena.neg(factor)].into_iter().take_while(|_| problem.goes_on()).find_map(|positive| {
        let there = plant.with_positive_expressions([positive]);
        let candidate = at_estimate::monotone(&Problem::of(&there), &[])?;
        Some((candidate, Declaration::Assumed(vec![positive])))
    })
}

/// The transform of any class, where one is asked for.
fn with_any_class(
    problem: &Problem<'_>,
    class: Option<Class>,
    accepted: Accepted<'_>,
) -> Option<(Candidate, Declaration)> {
    class.filter(|_| problem.plant.cascade_class.is_some() && problem.goes_on())?;
    let plant = Plant { cascade_class: None, ..problem.plant.clone() };
    let candidate = problem.arena.budget().share(SHARE, || accepted(&plant, None))?;
    Some((candidate, Declaration::AnyClass))
}

/// The period of a state that the plant holds in sines and cosines alone, as the same multiple in each.
fn period(plant: &Plant, state: Symbol) -> Option<Expr> {
    let arena = &plant.arena;
    let values = plant.y.iter().filter_map(|output| output.value);
    let identities = plant.identities.iter().copied();
    let formulas: Vec<Expr> =
        plant.rates().into_values().chain(values.chain(identities).map(|formula| formula.expr)).collect();
    let is_turned = |expr: &Expr| matches!(arena.node(*expr), Node::Call(Function::Sin | Function::Cos, _));
    let calls: Vec<Expr> = arena.postorder(&formulas).into_iter().filter(is_turned).collect();
    let domain = plant.domain();
    let mut periods = BTreeSet::new();
    for call in &calls {
        let Node::Call(_, arguments) = arena.node(*call) else { continue };
        let multiple = arena.derivative(arguments[0], state);
        if !arena.is_zero(multiple) {
            // A model file asks for a period that is known to be positive.
            let turned = arena.div(arena.turn(), multiple);
            let is_positive = |period: &Expr| domain.implies(arena, *period, Relation::Positive);
            periods.insert([turned, arena.neg(turned)].into_iter().find(is_positive)?);
        }
    }
    let (Some(period), 1) = (periods.first().copied(), periods.len()) else { return None };
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    // With a symbol in the place of its sines and cosines nothing else may hold the state.
    let symbol = arena.of_symbol(arena.generated("turned"));
    let replaced: FxHashMap<Expr, Expr> = calls.iter().map(|call| (*call, symbol)).collect();
    let holds_state = |formula: &Expr| arena.depends_on(arena.replace(*formula, &replaced), &BTreeSet::from([state]));
    let only_turned = !formulas.iter().any(holds_state);
    (only_turned && arena.symbols_of(&[period]).is_subset(&constants)).then_some(period)
}
