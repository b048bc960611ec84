//! Polynomials in the states that divide their own rates: Darboux polynomials.
//!
//! In: a plant whose rates are polynomials, or quotients of them, in hidden symbols. Out: polynomials q of the first
//! and second degree in states and outputs, with constant coefficients, for which q = 0 is invariant under every input.
//! The rate of `log(q)` is then a polynomial, and that of a sum of such logarithms may be free of x (Darboux 1878;
//! Prelle and Singer 1983).
//!
//! The coefficients are undetermined: q = 0 is solved for a state, or the square of one, and put into the rate of q,
//! which has to vanish whatever the other signals are. That gives equations for the coefficients alone.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::solve::elimination::Elimination;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

use crate::search::problem::Problem;

/// Polynomials of the second degree in more symbols have more coefficients than are solved for.
const MOST_OF_SECOND_DEGREE: usize = 3;

/// Most symbols of polynomials of the first degree.
const MOST_SYMBOLS: usize = 6;

/// A polynomial with undetermined coefficients: `lead * x^power + rest`.
struct Shape {
    state: Symbol,
    power: i64,
    lead: Expr,
    rest: Expr,
    coefficients: BTreeSet<Symbol>,
}

/// The polynomials, taken apart into factors as far as factors are found.
pub(in crate::search) fn invariant(problem: &Problem<'_>) -> Result<Vec<Expr>, Obstacle> {
    let arena = problem.arena;
    let symbols: Vec<Symbol> = problem.x.iter().chain(&problem.y).copied().collect();
    let rates: Vec<Expr> = symbols.iter().map(|symbol| problem.rates[symbol]).collect();
    let field = Field::over(arena, &problem.domain.facts, &rates)?;
    let are_symbols = field.kernels_of(&problem.hidden).iter().all(|k| arena.as_symbol(field.kernel(*k)).is_some());
    let mut found: Vec<Expr> = Vec::new();
    if !are_symbols || symbols.len() > MOST_SYMBOLS {
        return Ok(found);
    }
    for shape in shapes(problem, &symbols) {
        for polynomial in solved(problem, &shape)? {
            for factor in factors(problem, polynomial)? {
                if !found.contains(&factor) {
                    found.push(factor);
                }
            }
        }
    }
    Ok(found)
}

/// The polynomials with undetermined coefficients, those of the first degree first.
fn shapes(problem: &Problem<'_>, symbols: &[Symbol]) -> Vec<Shape> {
    let arena = problem.arena;
    let mut first = Vec::new();
    let mut second = Vec::new();
    for (index, state) in problem.x.iter().enumerate() {
        let later: Vec<Expr> = symbols[index + 1..].iter().map(|symbol| arena.of_symbol(*symbol)).collect();
        let others: Vec<Expr> =
            symbols.iter().filter(|symbol| *symbol != state).map(|symbol| arena.of_symbol(*symbol)).collect();
        let shape = |power, leads: Vec<Expr>, remainders: &[Expr]| {
            let mut unknown = Unknown::default();
            // The first coefficient is 1.
            let lead = leads.split_first().map(|(first, more)| arena.add(*first, unknown.combination(problem, more)));
            let rest = unknown.combination(problem, remainders);
            Shape { state: *state, power, lead: lead.unwrap_or(arena.one()), rest, coefficients: unknown.0 }
        };
        first.push(shape(1, Vec::new(), &[&[arena.one()], later.as_slice()].concat()));
        if symbols.len() > MOST_OF_SECOND_DEGREE {
            continue;
        }
        let one = [arena.one()];
        let affine = [one.as_slice(), &others].concat();
        let quadratic: Vec<Expr> = affine
            .iter()
            .enumerate()
            .flat_map(|(index, a)| affine[index..].iter().map(|b| arena.mul(*a, *b)))
            .collect();
        let of_state: Vec<Expr> = affine.iter().map(|factor| arena.mul(*factor, arena.of_symbol(*state))).collect();
        second.push(shape(1, Vec::new(), &quadratic));
        for (index, other) in others.iter().enumerate() {
            let leads = [&[*other], &others[index + 1..], one.as_slice()].concat();
            second.push(shape(1, leads, &quadratic));
        }
        second.push(shape(2, Vec::new(), &[of_state, quadratic].concat()));
    }
    first.into_iter().chain(second).collect()
}

/// Undetermined coefficients.
#[derive(Default)]
struct Unknown(BTreeSet<Symbol>);

impl Unknown {
    /// A combination of the terms with coefficients of its own.
    fn combination(&mut self, problem: &Problem<'_>, terms: &[Expr]) -> Expr {
        let arena = problem.arena;
        let term = |term: &Expr| {
            let coefficient = arena.generated(&format!("coefficient{}", self.0.len() + 1));
            self.0.insert(coefficient);
            arena.mul(arena.of_symbol(coefficient), *term)
        };
        arena.sum(terms.iter().map(term).collect::<Vec<Expr>>())
    }
}

/// The polynomials of a shape that divide their own rates, as far as equation after equation gives the coefficients.
fn solved(problem: &Problem<'_>, shape: &Shape) -> Result<Vec<Expr>, Obstacle> {
    let arena = problem.arena;
    let state = arena.of_symbol(shape.state);
    let whole = arena.add(arena.mul(shape.lead, arena.power(state, &shape.power.into())), shape.rest);
    let field = Field::over(arena, &problem.domain.facts, &[problem.rate(whole), shape.lead, shape.rest])?;
    let work = field.limit();
    let mut rate = field.fraction(problem.rate(whole))?;
    // On q = 0.
    if let Some(kernel) = field.kernels_of(&BTreeSet::from([shape.state])).first() {
        let value = field.fraction(arena.neg(arena.div(shape.rest, shape.lead)))?;
        rate = if shape.power == 1 {
            let mut sum = Fraction::zero();
            for (power, coefficient) in rate.numerator().coefficients_in(*kernel) {
                let term = field.mul(&field.of_polynomial(&coefficient)?, &field.pow(&value, i64::from(power))?)?;
                sum = field.add(&sum, &term)?;
            }
            sum
        } else {
            field.of_polynomial(&rate.numerator().reduce_power(*kernel, 2, value.numerator(), work)?)?
        };
    }
    let moving: Vec<u32> = field.kernels_of(&problem.signals).into_iter().collect();
    let mut equations = Vec::new();
    for (_, equation) in rate.numerator().collect(&moving) {
        equations.push(field.show(&field.of_polynomial(&equation)?));
    }
    let elimination =
        Elimination { arena, domain: &problem.domain, states: shape.coefficients.clone(), inputs: BTreeSet::new() };
    let mut found = Vec::new();
    let mut accept = |values: &BTreeMap<Symbol, Expr>| -> Option<()> {
        let free = shape.coefficients.iter().filter(|c| !values.contains_key(c));
        let zero: BTreeMap<Symbol, Expr> = free.map(|c| (*c, arena.zero())).collect();
        found.push(arena.substitute(arena.substitute(whole, values), &zero));
        None
    };
    // A polynomial that is not solved for is not found.
    let _ended = elimination.run(&equations, &[BTreeMap::new()], &mut accept);
    Ok(found)
}

/// The factors with states in them that divide their own rates: coefficients that stay free may leave another.
fn factors(problem: &Problem<'_>, polynomial: Expr) -> Result<Vec<Expr>, Obstacle> {
    let (arena, facts) = (problem.arena, &problem.domain.facts);
    let field = Field::over(arena, facts, &[polynomial])?;
    let fraction = field.fraction(polynomial)?;
    let mut found = Vec::new();
    for (factor, _) in fraction.numerator().factored(field.limit())?.factors {
        let factor = field.show(&field.of_polynomial(&factor)?);
        if arena.depends_on(factor, &problem.hidden) && divides(problem, factor)? {
            found.push(factor);
        }
    }
    Ok(found)
}

/// Tests whether a polynomial divides its own rate.
fn divides(problem: &Problem<'_>, polynomial: Expr) -> Result<bool, Obstacle> {
    let rate = problem.rate(polynomial);
    let field = Field::over(problem.arena, &problem.domain.facts, &[polynomial, rate])?;
    let [polynomial, rate] = [field.fraction(polynomial)?, field.fraction(rate)?];
    Ok(rate.numerator().div_exact(polynomial.numerator(), field.limit())?.is_some())
}
