//! Exact points of the assumed domain, for existence and for refutation.
//!
//! In: facts, and values that are given. Out: points at which every fact provably holds, simple ones
//! first, the same ones every time.

mod analytic;
pub mod bounds;
pub mod cells;
mod certified;
mod components;
mod implied;
pub mod injectivity;
mod jump;
pub mod manifold;
pub mod reducible;
pub(crate) mod solution;
mod solving;
pub mod zero;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Node, Symbol};
use crate::number::interval::Precision;
use crate::{Facts, Rational, Relation};
use manifold::Manifold;
use solution::Choice;

/// The greatest number of points that a search examines.
const MOST_TRIALS: u64 = 400;

/// The same for a search whose result is optional.
const FEW_TRIALS: u64 = 4;

/// Starts from which no solution of the equations was found one after the other, after which none is expected: where
/// solutions are regular, most starts lead to one.
const MOST_FAILURES: usize = 12;

/// Trials with small integers and random signs.
const PLAIN_TRIALS: u64 = 8;

/// The greatest number of times a value is shrunk to satisfy a fact: down to some 1e-10 of the drawn value.
const MOST_SHRINKS: usize = 8;

/// Steps that drawing a value takes.
const STEPS_OF_A_VALUE: u64 = 50;

/// The assumed domain of a problem: inequalities, equations, and symbols whose values are given.
#[derive(Clone, Debug, Default)]
pub struct Domain {
    /// Inequalities that hold.
    pub facts: Facts,
    /// Given values.
    pub fixed: Point,
    /// Equations that hold.
    pub manifold: Manifold,
    /// Rational values near which, or at which, points that satisfy the equations are looked for first.
    pub start: Point,
    /// Calls and roots that the author writes: results may be printed with them.
    pub written: Rc<BTreeSet<Expr>>,
}

/// A closed range for each symbol.
pub type Ranges = BTreeMap<Symbol, (Rational, Rational)>;

/// Bounds of one symbol that the facts state directly.
#[derive(Clone, Debug, Default)]
struct Bounds {
    low: Option<Rational>,
    high: Option<Rational>,
}

impl Domain {
    /// Points of the domain over the given symbols and those of the facts and equations that involve them.
    pub fn points<'a>(&'a self, arena: &'a Arena, exprs: &[Expr]) -> impl Iterator<Item = Point> + 'a {
        self.points_within(arena, exprs, MOST_TRIALS)
    }

    /// As [`Self::points`], limited to a few trials: cheap, and possibly empty.
    pub(super) fn glimpses<'a>(&'a self, arena: &'a Arena, exprs: &[Expr]) -> impl Iterator<Item = Point> + 'a {
        self.points_within(arena, exprs, FEW_TRIALS)
    }

    fn points_within<'a>(&'a self, arena: &'a Arena, exprs: &[Expr], most: u64) -> impl Iterator<Item = Point> + 'a {
        let mut symbols = arena.symbols_of(exprs);
        let (facts, equations) = self.relevant(arena, &mut symbols);
        let facts: Vec<(Expr, Relation)> =
            facts.into_iter().map(|(fact, relation)| (arena.substitute(fact, &self.fixed), relation)).collect();
        let between =
            |(symbol, range): (Symbol, Bounds)| (range.low.is_some() && range.high.is_some()).then_some(symbol);
        let confined = ranges(arena, &facts).into_iter().filter_map(between).collect();
        let plan = self.manifold.plan(arena, &equations, &self.fixed, &confined);
        let trials = if plan.is_some() { most } else { 0 };
        let plan = plan.unwrap_or_default();
        let solved = plan.symbols();
        let free: Vec<(usize, Symbol)> = symbols
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, symbol)| !solved.contains(symbol) && !self.fixed.contains_key(symbol))
            .collect();
        let confined = Confinement::new(arena, &facts, free.iter().map(|(_, symbol)| *symbol));
        let failures = Rc::new(Cell::new(0));
        let counted = Rc::clone(&failures);
        let goes_on = move || !arena.budget().is_exhausted() && counted.get() < MOST_FAILURES;
        let is_started = !equations.is_empty() && trials > 0 && symbols.iter().any(|s| self.start.contains_key(s));
        let started = is_started.then_some((0, true)).into_iter();
        let trials = started.chain((0..trials).map(|trial| (trial, false)));
        trials.take_while(move |_| goes_on()).filter_map(move |(trial, is_start)| {
            arena.budget().take(STEPS_OF_A_VALUE * symbols.len() as u64);
            let mut draw = RationalGenerator::new(trial);
            let given = |symbol: &Symbol| Some((*symbol, *self.fixed.get(symbol)?));
            let mut point: Point = symbols.iter().filter(|symbol| !solved.contains(symbol)).filter_map(given).collect();
            for (index, symbol) in &free {
                let started = self.start.get(symbol).copied().filter(|_| is_start);
                let drawn = || confined.draw(arena, *symbol, &point, |range| draw.value(range, *index));
                let value = started.unwrap_or_else(drawn);
                point.insert(*symbol, value);
            }
            let at_start = if is_start { plan.at(arena, &point, &self.start) } else { None };
            let completed = match at_start {
                Some(values) => {
                    point.extend(values);
                    Some(())
                }
                None => plan.complete(arena, &mut point, || draw.choice()),
            };
            if plan.is_search() {
                failures.set(if completed.is_none() { failures.get() + 1 } else { 0 });
            }
            completed?;
            facts.iter().all(|fact| holds(arena, *fact, &point)).then_some(point)
        })
    }

    /// The same without its equations.
    #[must_use]
    pub fn without_equations(&self) -> Self {
        Self { manifold: Manifold::default(), ..self.clone() }
    }

    /// The same with the given values in the facts and equations, as formulas have them after substitution.
    #[must_use]
    pub fn at_given_values(&self, arena: &Arena) -> Self {
        let mut facts = Facts::new();
        for (fact, relation) in self.facts.iter() {
            let fact = arena.substitute(fact, &self.fixed);
            if !arena.symbols_of(&[fact]).is_empty() {
                facts.assume(fact, relation);
            }
        }
        let manifold = self.manifold.substituted(arena, &facts, &self.fixed);
        Self { facts, manifold, ..self.clone() }
    }

    /// True if every fact and equation that concerns the point's symbols provably holds there.
    pub fn contains(&self, arena: &Arena, point: &Point) -> bool {
        let concerned = |expr: Expr| arena.symbols_of(&[expr]).iter().any(|symbol| point.contains_key(symbol));
        let given = |(symbol, value): (&Symbol, &Expr)| self.fixed.get(symbol).is_none_or(|fixed| fixed == value);
        point.iter().all(given)
            && self.facts.iter().all(|fact| !concerned(fact.0) || holds(arena, fact, point))
            && self.manifold.contains(arena, point)
    }

    /// The part of the domain that agrees with a point in all but the free symbols.
    #[must_use]
    pub fn beside(&self, point: &Point, free: &BTreeSet<Symbol>) -> Self {
        let mut fixed = self.fixed.clone();
        fixed.extend(point.iter().filter(|(s, _)| !free.contains(s)).map(|(s, value)| (*s, *value)));
        Self { fixed, ..self.clone() }
    }

    /// The bounds of symbols that the facts state directly, rounded outward.
    pub fn bounds(&self, arena: &Arena, symbols: &BTreeSet<Symbol>) -> Ranges {
        let facts: Vec<_> = self.facts.iter().collect();
        let ranges = ranges(arena, &facts);
        let both = |(symbol, range): (Symbol, Bounds)| Some((symbol, (range.low?, range.high?)));
        ranges.into_iter().filter(|(symbol, _)| symbols.contains(symbol)).filter_map(both).collect()
    }

    /// The domain of the symbols that remain free; none unless a point of it is found.
    pub fn restricted(&self, arena: &Arena, values: &BTreeMap<Symbol, Expr>) -> Option<Self> {
        let mut there = Self { fixed: self.fixed.clone(), written: Rc::clone(&self.written), ..Self::default() };
        let mut constant = Vec::new();
        for (fact, relation) in self.facts.iter() {
            let fact = arena.substitute(fact, values);
            if relation == Relation::NonNegative && arena.is_zero(fact) {
                continue;
            }
            if arena.symbols_of(&[fact]).is_empty() {
                constant.push((fact, relation));
            } else {
                there.facts.assume(fact, relation);
            }
        }
        let holds = |(fact, relation): &(Expr, Relation)| {
            let value = arena.separated_from_zero(*fact, &BTreeMap::new());
            value.is_some_and(|value| *relation == Relation::NonZero || value.is_positive())
        };
        let mut all: Vec<Expr> = values.values().copied().collect();
        all.extend(there.facts.iter().map(|(fact, _)| fact));
        let exists = |point: &Point| values.values().all(|value| arena.exists_at(*value, point));
        (constant.iter().all(holds) && there.points(arena, &all).any(|point| exists(&point))).then_some(there)
    }

    /// The facts and equations that share a symbol with the given ones, directly or through others.
    fn relevant(&self, arena: &Arena, symbols: &mut BTreeSet<Symbol>) -> (Vec<(Expr, Relation)>, Vec<Expr>) {
        let (mut facts, mut equations) = (Vec::new(), Vec::new());
        // An equation is a fact without a relation.
        let inequalities = self.facts.iter().map(|(expr, relation)| (expr, Some(relation)));
        let mut rest: Vec<_> = inequalities.chain(self.manifold.equations().iter().map(|e| (*e, None))).collect();
        loop {
            let (touching, apart): (Vec<_>, Vec<_>) =
                rest.into_iter().partition(|(expr, _)| !arena.symbols_of(&[*expr]).is_disjoint(symbols));
            if touching.is_empty() {
                return (facts, equations);
            }
            for (expr, relation) in touching {
                symbols.extend(arena.symbols_of(&[expr]));
                match relation {
                    Some(relation) => facts.push((expr, relation)),
                    None => equations.push(expr),
                }
            }
            rest = apart;
        }
    }
}

/// True if the fact provably holds at the point.
fn holds(arena: &Arena, (expr, relation): (Expr, Relation), point: &Point) -> bool {
    match arena.separated_from_zero(expr, point) {
        Some(value) => relation == Relation::NonZero || value.is_positive(),
        // An enclosure of zero does not exclude negative values; zero itself does.
        None => relation == Relation::NonNegative && arena.is_zero(arena.substitute(expr, point)),
    }
}

/// Bounds of each symbol by facts in it and in symbols that are drawn before it.
struct Confinement {
    /// By facts in the symbol alone.
    ranges: BTreeMap<Symbol, Bounds>,
    /// Facts in others as well, and those that are not affine in the symbol.
    others: BTreeMap<Symbol, Vec<(Expr, Relation)>>,
}

impl Confinement {
    /// For symbols that are drawn in this order.
    fn new(arena: &Arena, facts: &[(Expr, Relation)], order: impl Iterator<Item = Symbol>) -> Self {
        let place: BTreeMap<Symbol, usize> = order.enumerate().map(|(place, symbol)| (symbol, place)).collect();
        let mut others: BTreeMap<Symbol, Vec<(Expr, Relation)>> = BTreeMap::new();
        for fact in facts.iter().filter(|(fact, _)| affine(arena, *fact).is_none()) {
            let symbols = arena.symbols_of(&[fact.0]);
            // A fact with a symbol that an equation gives is checked when the point is complete.
            if !symbols.iter().all(|symbol| place.contains_key(symbol)) {
                continue;
            }
            if let Some(last) = symbols.into_iter().max_by_key(|symbol| place[symbol]) {
                others.entry(last).or_default().push(*fact);
            }
        }
        Self { ranges: ranges(arena, facts), others }
    }

    /// A value of the symbol, given those already drawn: within the bounds of facts that are affine in it, and shrunk
    /// until the others hold, as `i^2 < 1e-6`.
    fn draw(
        &self,
        arena: &Arena,
        symbol: Symbol,
        point: &Point,
        mut value: impl FnMut(Option<&Bounds>) -> Rational,
    ) -> Expr {
        let mut range = self.ranges.get(&symbol).cloned();
        let mut bent = Vec::new();
        for (fact, relation) in self.others.get(&symbol).into_iter().flatten() {
            let there = (arena.substitute(*fact, point), *relation);
            match ranges(arena, &[there]).remove(&symbol) {
                Some(bounds) => range.get_or_insert_default().narrow(bounds),
                None => bent.push(there),
            }
        }
        let drawn = value(range.as_ref());
        let holds_at = |value: &Rational| {
            let at = Point::from([(symbol, arena.number(value.clone()))]);
            bent.iter().all(|fact| holds(arena, *fact, &at))
        };
        let mut smaller = drawn.clone();
        let share = Rational::new(1, 16).unwrap_or(Rational::ONE);
        for _ in 0..MOST_SHRINKS {
            if holds_at(&smaller) {
                return arena.number(smaller);
            }
            smaller = &smaller * &share;
            if range.as_ref().is_some_and(|range| !range.contains(&smaller)) {
                break;
            }
        }
        arena.number(drawn)
    }
}

impl Bounds {
    /// Intersects with another range.
    fn narrow(&mut self, other: Self) {
        if let Some(low) = other.low {
            self.low = Some(self.low.take().map_or(low.clone(), |known| known.max(low)));
        }
        if let Some(high) = other.high {
            self.high = Some(self.high.take().map_or(high.clone(), |known| known.min(high)));
        }
    }

    fn contains(&self, value: &Rational) -> bool {
        self.low.as_ref().is_none_or(|low| low < value) && self.high.as_ref().is_none_or(|high| value < high)
    }
}

/// The bounds that facts of the form `c*s + d > 0` state.
fn ranges(arena: &Arena, facts: &[(Expr, Relation)]) -> BTreeMap<Symbol, Bounds> {
    let mut ranges: BTreeMap<Symbol, Bounds> = BTreeMap::new();
    for (expr, relation) in facts {
        if *relation == Relation::NonZero {
            continue;
        }
        let Some((symbol, slope, constant)) = affine(arena, *expr) else { continue };
        // An irrational constant gives its greater end, which only widens the range.
        let Some(bound) = (-&constant).checked_div(&slope) else { continue };
        let bounds = if slope.is_negative() {
            Bounds { low: None, high: Some(bound) }
        } else {
            Bounds { low: Some(bound), high: None }
        };
        ranges.entry(symbol).or_default().narrow(bounds);
    }
    ranges
}

/// `slope * symbol + constant`, if the expression is at most that, up to rounding.
fn affine(arena: &Arena, expr: Expr) -> Option<(Symbol, Rational, Rational)> {
    let unit = |e: Expr| arena.as_symbol(e);
    match arena.node(expr) {
        Node::Symbol(symbol) => Some((symbol, Rational::ONE, Rational::ZERO)),
        Node::Product(product) => match product.factors.as_slice() {
            [(base, exponent)] if exponent.is_one() => {
                Some((unit(*base)?, product.coefficient.clone(), Rational::ZERO))
            }
            _ => None,
        },
        Node::Sum(sum) => {
            let mut constant = sum.constant.clone();
            let mut found = None;
            for (term, slope) in &sum.terms {
                match unit(*term) {
                    Some(symbol) if found.is_none() => found = Some((symbol, slope.clone())),
                    Some(_) => return None,
                    None => {
                        let value = arena.enclose(*term, &Point::new(), Precision::new(64))?;
                        constant = &constant + &value.above_multiples(slope)?;
                    }
                }
            }
            found.map(|(symbol, slope)| (symbol, slope, constant))
        }
        _ => None,
    }
}

/// A reproducible sequence of simple rationals (`SplitMix64`, Steele, Lea and Flood 2014).
struct RationalGenerator {
    trial: u64,
    state: u64,
}

impl RationalGenerator {
    fn new(trial: u64) -> Self {
        Self { trial, state: trial.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1 }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer from `low` to `high`.
    fn integer(&mut self, low: i64, high: i64) -> i64 {
        let span = u64::try_from(high - low + 1).unwrap_or(1);
        low + i64::try_from(self.next() % span).unwrap_or(0)
    }

    /// The free choice of a manifold's step.
    fn choice(&mut self) -> Choice {
        let ratio = Rational::new(self.integer(1, 7), self.integer(2, 8)).unwrap_or(Rational::ONE);
        let share = if self.integer(0, 1) == 0 { -&ratio } else { ratio };
        (share, self.integer(0, 1) == 0)
    }

    /// A value within the range; small integers in the first trials, fractions later.
    ///
    /// After the first trials, the signs of five symbols go through all patterns: an expression that is non-zero only
    /// if several of them are negative would be rarely so among random signs.
    fn value(&mut self, range: Option<&Bounds>, index: usize) -> Rational {
        let (low, high) = range.map_or((None, None), |range| (range.low.as_ref(), range.high.as_ref()));
        let size = 3 + i64::try_from(self.trial / 8).unwrap_or(0);
        let parts = if self.trial < PLAIN_TRIALS { 1 } else { 1 + i64::try_from(self.trial % 7).unwrap_or(0) };
        let ratio = |n: i64, d: i64| Rational::new(n, d).unwrap_or(Rational::ONE);
        // Now and then near zero, or near the only bound: there inverse functions have values. Now and then at the
        // magnitudes of temperatures and pressures: `exp(-5000/T)` is next to nothing at small ones.
        let distance = match self.trial % 16 {
            3 | 11 => ratio(self.integer(1, 8), 9),
            7 | 15 => ratio(self.integer(1, 8), 90),
            13 => ratio(100 * self.integer(1, 8), 1),
            _ => ratio(self.integer(1, size * parts), parts),
        };
        match (low, high) {
            (Some(low), Some(high)) => {
                let share = ratio(self.integer(1, 8 + self.trial.cast_signed()), 9 + self.trial.cast_signed());
                low + &(&(high - low) * &share)
            }
            (Some(low), None) => low + &distance,
            (None, Some(high)) => high - &distance,
            (None, None) => {
                let drawn = self.integer(0, 2) == 0;
                let negative = match self.trial.checked_sub(PLAIN_TRIALS) {
                    Some(pattern) if pattern < 32 && index < 5 => pattern >> index & 1 == 1,
                    _ => drawn,
                };
                if negative { -&distance } else { distance }
            }
        }
    }
}
