//! Power series of a plant's right side around a point, with rational coefficients.
//!
//! In: a point whose coordinates are rational, or angles with rational sine and cosine. Out: the series of the rates up
//! to an order, for a few values of the inputs; none where a value is not rational.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::graph::enclosure::Point;
use pebo_cas::{Arena, Expr, Function, Node, Rational, Symbol};

use crate::search::problem::Problem;

/// A monomial in the coordinates, as exponents.
pub(in crate::search) type Monomial = Vec<u8>;

/// A truncated power series; the constant term may hold multiples of the angle whose sine is 3/5 and cosine 4/5.
#[derive(Clone, Debug)]
pub(in crate::search) struct Jet {
    terms: BTreeMap<Monomial, Rational>,
    angle: Rational,
}

impl Default for Jet {
    fn default() -> Self {
        Self { terms: BTreeMap::new(), angle: Rational::ZERO }
    }
}

impl Jet {
    /// The terms of the series.
    pub(in crate::search) fn terms(&self) -> impl Iterator<Item = (&Monomial, &Rational)> {
        self.terms.iter()
    }
}

/// The points at which series are taken: they differ in the inputs alone.
#[derive(Debug)]
pub(in crate::search) struct Jets {
    points: Vec<Point>,
    /// The coordinates: states, then outputs that have a rate.
    coordinates: Vec<Symbol>,
}

/// Steps of a product of two terms: one of rational numbers, and an index among the terms.
const STEPS_OF_A_PAIR: u64 = 30;

/// `atan(3/4)`, whose sine and cosine are rational.
fn angle(arena: &Arena) -> Expr {
    arena.call(Function::Atan, &[arena.number(Rational::new(3, 4).unwrap_or(Rational::ONE))])
}

impl Jets {
    /// At a point of the domain that is found after so many others, where all rates have rational series.
    pub(in crate::search) fn of(problem: &Problem<'_>, mut others: usize) -> Option<Self> {
        const MOST_POINTS: usize = 12;
        // The first point has the file's own values of the parameters, which decide for the file. Small values may be
        // exceptional, as a = 1 and b = 2 are where b - 2*a divides.
        let other_parameters = others > 0;
        let arena = problem.arena;
        let formulas: Vec<Expr> = problem.rates.values().copied().collect();
        let (angles, zeros) = special(arena, &formulas);
        let coordinates: Vec<Symbol> = problem.x.iter().chain(&problem.y).copied().collect();
        for turned in [true, false] {
            let mut domain = problem.domain.clone();
            if other_parameters {
                domain.fixed.clear();
            }
            for symbol in zeros.iter().chain(angles.iter().filter(|_| !turned)) {
                domain.fixed.entry(*symbol).or_insert(arena.zero());
            }
            for symbol in angles.iter().filter(|_| turned) {
                domain.fixed.entry(*symbol).or_insert(angle(arena));
            }
            for point in domain.points(arena, &formulas).take(MOST_POINTS) {
                let free = problem.plant.u.iter().chain(&problem.plant.w).copied().collect();
                let beside = domain.beside(&point, &free);
                let mut points = vec![point];
                if points[0].keys().any(|symbol| free.contains(symbol)) {
                    points.extend(beside.points(arena, &formulas).take(free.len() + 2));
                }
                let jets = Self { points, coordinates: coordinates.clone() };
                if jets.fields(problem, 1).is_some() {
                    if others == 0 {
                        return Some(jets);
                    }
                    others -= 1;
                }
            }
        }
        None
    }

    /// The point, without inputs.
    pub(in crate::search) fn point(&self, problem: &Problem<'_>) -> Vec<(Symbol, Expr)> {
        let given = |symbol: &Symbol| !problem.plant.u.contains(symbol);
        self.points.first().into_iter().flatten().filter(|(s, _)| given(s)).map(|(s, e)| (*s, *e)).collect()
    }

    /// The series of the rates, in the order of the coordinates, for each of the points.
    pub(in crate::search) fn fields(&self, problem: &Problem<'_>, order: usize) -> Option<Vec<Vec<Jet>>> {
        let rates: Vec<Expr> =
            self.coordinates.iter().map(|symbol| problem.rates.get(symbol).copied()).collect::<Option<_>>()?;
        let field = |point: &Point| {
            let series = Series { arena: problem.arena, point, coordinates: &self.coordinates, order };
            series.of_all(&rates)
        };
        self.points.iter().map(field).collect()
    }
}

/// Symbols that occur in sines and cosines alone, with rational factors, and symbols that occur in other functions.
fn special(arena: &Arena, formulas: &[Expr]) -> (Vec<Symbol>, Vec<Symbol>) {
    let (mut within, mut others) = (Vec::new(), Vec::new());
    let mut plain: BTreeSet<Symbol> = BTreeSet::new();
    let mut open = formulas.to_vec();
    let mut visited = BTreeSet::new();
    while let Some(expr) = open.pop() {
        if !visited.insert(expr) {
            continue;
        }
        match arena.node(expr) {
            Node::Symbol(symbol) => {
                plain.insert(symbol);
            }
            Node::Call(Function::Sin | Function::Cos | Function::Tan, arguments) => {
                within.extend(arena.symbols_of(&arguments));
            }
            Node::Call(_, arguments) => others.extend(arena.symbols_of(&arguments)),
            _ => open.extend(arena.operands(expr)),
        }
    }
    let angles = within.iter().filter(|s| !plain.contains(s) && !others.contains(s)).copied().collect();
    others.extend(within.iter().filter(|s| plain.contains(s)));
    (angles, others)
}

struct Series<'a> {
    arena: &'a Arena,
    point: &'a Point,
    coordinates: &'a [Symbol],
    order: usize,
}

impl Series<'_> {
    fn of_all(&self, exprs: &[Expr]) -> Option<Vec<Jet>> {
        let mut known: BTreeMap<Expr, Jet> = BTreeMap::new();
        for expr in self.arena.postorder(exprs) {
            let jet = self.of(expr, &known)?;
            known.insert(expr, jet);
        }
        Some(exprs.iter().map(|expr| known[expr].clone()).collect())
    }

    fn constant(&self, value: Rational) -> Jet {
        let mut terms = BTreeMap::new();
        if !value.is_zero() {
            terms.insert(vec![0; self.coordinates.len()], value);
        }
        Jet { terms, angle: Rational::ZERO }
    }

    fn of(&self, expr: Expr, known: &BTreeMap<Expr, Jet>) -> Option<Jet> {
        match self.arena.node(expr) {
            Node::Number(value) => Some(self.constant(value)),
            Node::Pi => None,
            Node::Symbol(symbol) => {
                let value = *self.point.get(&symbol)?;
                let mut jet = match self.arena.as_number(value) {
                    Some(number) => self.constant(number),
                    None if value == angle(self.arena) => Jet { angle: Rational::ONE, ..Jet::default() },
                    None => return None,
                };
                let index = self.coordinates.iter().position(|coordinate| *coordinate == symbol);
                if let Some(index) = index.filter(|_| self.order > 0) {
                    let mut unit = vec![0; self.coordinates.len()];
                    unit[index] = 1;
                    jet.terms.insert(unit, Rational::ONE);
                }
                Some(jet)
            }
            Node::Sum(sum) => {
                let mut total = self.constant(sum.constant.clone());
                for (term, factor) in &sum.terms {
                    add(&mut total, &known[term], factor);
                }
                Some(total)
            }
            Node::Product(product) => {
                let mut total = self.constant(product.coefficient.clone());
                for (base, exponent) in &product.factors {
                    let factor =
                        if exponent.is_one() { known[base].clone() } else { self.power(&known[base], exponent)? };
                    total = self.product(&total, &factor)?;
                }
                Some(total)
            }
            Node::Call(function, arguments) => self.call(function, &known[&arguments[0]], arguments.len()),
        }
    }

    fn product(&self, a: &Jet, b: &Jet) -> Option<Jet> {
        // An angle may be multiplied by a number.
        for (angle, other) in [(a, b), (b, a)] {
            if !angle.angle.is_zero() {
                let [(monomial, factor)] = other.terms.iter().collect::<Vec<_>>()[..] else { return None };
                if monomial.iter().any(|e| *e > 0) || !other.angle.is_zero() {
                    return None;
                }
                let mut scaled = Jet::default();
                add(&mut scaled, angle, factor);
                return Some(scaled);
            }
        }
        let mut of_degree: Vec<Vec<(&Monomial, &Rational)>> = vec![Vec::new(); self.order + 1];
        for (monomial, factor) in &b.terms {
            of_degree[degree(monomial)].push((monomial, factor));
        }
        let mut terms: BTreeMap<Monomial, Rational> = BTreeMap::new();
        for (first, c) in &a.terms {
            let beside = &of_degree[..=self.order - degree(first)];
            let pairs: usize = beside.iter().map(Vec::len).sum();
            if !self.arena.budget().take(STEPS_OF_A_PAIR * pairs as u64) {
                return None;
            }
            for (second, d) in beside.iter().flatten() {
                let monomial: Monomial = first.iter().zip(*second).map(|(a, b)| a + b).collect();
                let entry = terms.entry(monomial).or_insert(Rational::ZERO);
                *entry = &*entry + &(c * *d);
            }
        }
        terms.retain(|_, c| !c.is_zero());
        Some(Jet { terms, angle: Rational::ZERO })
    }

    /// The value at the point, and the rest of the series.
    fn split(&self, jet: &Jet) -> (Rational, Jet) {
        let mut rest = jet.clone();
        let value = rest.terms.remove(&vec![0; self.coordinates.len()]).unwrap_or(Rational::ZERO);
        rest.angle = Rational::ZERO;
        (value, rest)
    }

    /// The sum of coefficients times powers of a series without a constant.
    fn compose(&self, inner: &Jet, coefficients: impl Iterator<Item = Rational>) -> Option<Jet> {
        let (mut total, mut power) = (Jet::default(), self.constant(Rational::ONE));
        for coefficient in coefficients.take(self.order + 1) {
            add(&mut total, &power, &coefficient);
            power = self.product(&power, inner)?;
        }
        Some(total)
    }

    /// `jet ^ exponent`: the binomial series around the value, whose power has to be rational.
    fn power(&self, jet: &Jet, exponent: &Rational) -> Option<Jet> {
        if !jet.angle.is_zero() {
            return None;
        }
        let (value, rest) = self.split(jet);
        if let Some(whole) = exponent.to_i64().filter(|_| exponent.is_integer() && !exponent.is_negative()) {
            let mut total = self.constant(Rational::ONE);
            for _ in 0..whole.min(64) {
                total = self.product(&total, jet)?;
            }
            return (whole <= 64).then_some(total);
        }
        let leading = self.arena.as_number(self.arena.power(self.arena.number(value.clone()), exponent))?;
        let mut coefficient = leading;
        let mut step = Rational::ZERO;
        let next = std::iter::from_fn(|| {
            let current = coefficient.clone();
            let factor = exponent - &step;
            step = &step + &Rational::ONE;
            coefficient = (&coefficient * &factor).checked_div(&(&value * &step)).unwrap_or(Rational::ZERO);
            Some(current)
        });
        if value.is_zero() {
            return None;
        }
        self.compose(&rest, next)
    }

    fn call(&self, function: Function, argument: &Jet, arity: usize) -> Option<Jet> {
        if arity != 1 {
            return None;
        }
        let (value, rest) = self.split(argument);
        let factorials = || {
            let mut state = (Rational::ONE, Rational::ZERO);
            std::iter::from_fn(move || {
                let current = state.0.clone();
                state.1 = &state.1 + &Rational::ONE;
                state.0 = state.0.checked_div(&state.1)?;
                Some(current)
            })
        };
        let wave = |turn: usize| {
            let (sine, cosine) = circle(&argument.angle)?;
            if !value.is_zero() {
                return None;
            }
            // sin, cos, -sin, -cos are the derivatives of sin.
            let cycle = [sine.clone(), cosine.clone(), -&sine, -&cosine];
            self.compose(&rest, factorials().enumerate().map(|(k, c)| &c * &cycle[(k + turn) % 4]))
        };
        match function {
            Function::Sin => wave(0),
            Function::Cos => wave(1),
            Function::Tan => {
                let below = self.power(&wave(1)?, &Rational::from(-1))?;
                self.product(&wave(0)?, &below)
            }
            _ if !argument.angle.is_zero() => None,
            Function::Exp if value.is_zero() => self.compose(&rest, factorials()),
            Function::Sinh | Function::Cosh | Function::Tanh if value.is_zero() => {
                let (odd, even) = (|k: usize| k % 2 == 1, |k: usize| k.is_multiple_of(2));
                let part = |kept: fn(usize) -> bool| {
                    let terms = factorials().enumerate().map(move |(k, c)| if kept(k) { c } else { Rational::ZERO });
                    self.compose(&rest, terms)
                };
                match function {
                    Function::Sinh => part(odd),
                    Function::Cosh => part(even),
                    _ => self.product(&part(odd)?, &self.power(&part(even)?, &Rational::from(-1))?),
                }
            }
            Function::Log if value.is_one() => {
                let terms = (0..).map(|k: i64| match k {
                    0 => Rational::ZERO,
                    k => Rational::new(if k % 2 == 1 { 1 } else { -1 }, k).unwrap_or(Rational::ZERO),
                });
                self.compose(&rest, terms)
            }
            Function::Abs if !value.is_zero() => {
                let mut total = Jet::default();
                add(&mut total, argument, &Rational::from(value.signum()));
                Some(total)
            }
            _ => None,
        }
    }
}

/// Sine and cosine of a whole multiple of the angle.
fn circle(multiple: &Rational) -> Option<(Rational, Rational)> {
    let turns = multiple.to_i64().filter(|_| multiple.is_integer()).filter(|turns| turns.abs() <= 16)?;
    let unit = [Rational::new(3, 5)?, Rational::new(4, 5)?];
    let (mut sine, mut cosine) = (Rational::ZERO, Rational::ONE);
    for _ in 0..turns.abs() {
        let next = &(&sine * &unit[1]) + &(&cosine * &unit[0]);
        cosine = &(&cosine * &unit[1]) - &(&sine * &unit[0]);
        sine = next;
    }
    Some((if turns < 0 { -&sine } else { sine }, cosine))
}

/// `total += factor * jet`
fn add(total: &mut Jet, jet: &Jet, factor: &Rational) {
    total.angle = &total.angle + &(&jet.angle * factor);
    for (monomial, coefficient) in &jet.terms {
        let entry = total.terms.entry(monomial.clone()).or_insert(Rational::ZERO);
        *entry = &*entry + &(coefficient * factor);
    }
    total.terms.retain(|_, c| !c.is_zero());
}

fn degree(monomial: &Monomial) -> usize {
    monomial.iter().map(|e| usize::from(*e)).sum()
}
