//! Functions of x whose rates are affine in themselves: an immersion into a plant that is linear in z.
//!
//! In: formulas, those of the outputs' rates or the states. Out: their functions of x, with those in the rates of
//! these, and so on until nothing is added; none if that does not end soon. Coefficients are functions of y and u, so
//! that the cascade is a generalised one, and the given formulas are affine in the functions.
//!
//! A function is the coefficient of one function of y and u in a formula: `2*v*p + 2*s - p^2` consists of p and `2*s -
//! p^2`, as nothing else of it is observable. Functions that are combinations of others with constant coefficients are
//! left out, so that of a closure that begins with the outputs nothing stays hidden because of its size.

pub(super) mod by_parts;
pub(super) mod constants;
pub(super) mod coordinates;
pub(crate) mod darboux;
pub(super) mod extended;
pub(crate) mod observable;
pub(super) mod products;

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::linear::comparison::equations;
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::poly::{Monomial, Poly};
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

use super::problem::Problem;
use super::sample::is_affine_in;
use products::apart;

/// More functions than this make no observer that anybody would run.
const MOST: usize = 12;

/// Most nodes of the functions: rates of rates that do not close grow with every step.
const MOST_PARTS: usize = 3_000;

/// The closure of the functions of x in these formulas; none if it is larger than that, or the rates leave this form.
pub(super) fn closure(problem: &Problem<'_>, start: &[Expr]) -> Result<Option<Vec<Expr>>, Obstacle> {
    closed(problem, start, Ok)
}

/// The same, where in the rates the values of outputs stand for the functions that they show.
pub(super) fn closure_of_values(problem: &Problem<'_>, start: &[Expr]) -> Result<Option<Vec<Expr>>, Obstacle> {
    closed(problem, start, |rate| problem.plant.shown(&problem.domain, rate))
}

fn closed(
    problem: &Problem<'_>,
    start: &[Expr],
    reduced: impl Fn(Expr) -> Result<Expr, Obstacle>,
) -> Result<Option<Vec<Expr>>, Obstacle> {
    let mut found: Vec<Expr> = Vec::new();
    let mut open: Vec<Expr> = start.to_vec();
    while let Some(formula) = open.pop() {
        let Some(functions) = functions_of(problem, formula)? else { return Ok(None) };
        for function in functions {
            if !is_new(problem, &found, function)? {
                continue;
            }
            if found.len() == MOST
                || is_long(problem, function)
                || problem.is_non_smooth_in_states(function)
                || problem.arena.depends_on(function, &problem.plant.w.iter().copied().collect())
            {
                return Ok(None);
            }
            found.push(function);
            open.push(reduced(problem.rate(function))?);
        }
    }
    let mut found = plainest(problem, &found)?;
    found.sort_by_key(|e| (problem.arena.print(*e).len(), *e));
    Ok(Some(found))
}

/// The outputs' rates that hold states and no input, and their rates, and so on until those are affine in earlier ones;
/// none if they hold an input before, or there are more than that.
pub(super) fn of_rows(problem: &Problem<'_>) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let others: BTreeSet<Symbol> = problem.plant.u.iter().chain(&problem.plant.w).copied().collect();
    let is_of_states = |row: &Expr| {
        arena.depends_on(*row, &problem.states())
            && !arena.depends_on(*row, &others)
            && !problem.is_non_smooth_in_states(*row)
    };
    let mut found: Vec<Expr> = problem.output_rates().into_iter().filter(is_of_states).collect();
    let mut next = 0;
    while next < found.len() {
        let rate = problem.rate(found[next]);
        next += 1;
        if is_long(problem, rate) {
            return Ok(None);
        }
        if is_affine_in(problem, &[rate], &found)? {
            continue;
        }
        if found.len() == MOST || !is_of_states(&rate) {
            return Ok(None);
        }
        found.push(rate);
    }
    Ok((!found.is_empty()).then_some(found))
}

fn is_long(problem: &Problem<'_>, function: Expr) -> bool {
    problem.arena.postorder(&[function]).len() > MOST_PARTS
}

/// The functions of x of which a formula is a combination with coefficients that are free of x, independent of each
/// other; none where they are not separable, as x occurs with known signals in a factor of the denominator.
fn functions_of(problem: &Problem<'_>, formula: Expr) -> Result<Option<Vec<Expr>>, Obstacle> {
    let arena = problem.arena;
    let field = Field::over(arena, &problem.domain.facts, &[formula])?;
    let fraction = field.fraction(formula)?;
    let hidden = field.kernels_of(&problem.hidden);
    let known: BTreeSet<Symbol> = problem.signals.difference(&problem.hidden).copied().collect();
    let known = field.kernels_of(&known);
    let parts = apart(&field, fraction.denominator(), [&hidden, &known])?;
    let Some([divisor, _]) = parts else { return Ok(None) };
    // Kernels of both x and y may be coefficients times one another: only kernels of x alone are separable.
    let numerator = fraction.numerator();
    if numerator.variables().iter().any(|kernel| hidden.contains(kernel) && known.contains(kernel)) {
        return Ok(None);
    }
    let known: Vec<u32> = known.into_iter().collect();
    let parts = numerator.collect(&known).into_iter().map(|(_, part)| part);
    let mut found = combinations(&field, parts.into_iter(), (&hidden, &divisor))?;
    found.retain(|function| arena.depends_on(*function, &problem.hidden));
    Ok(Some(found))
}

/// The span of quotients of polynomials in hidden kernels with constant coefficients: where that is all of their
/// monomials, these. A sum is divided term by term where possible: `exp(p) + exp(-p)` rather than one fraction.
fn combinations(
    field: &Field<'_>,
    parts: impl Iterator<Item = Poly>,
    (hidden, divisor): (&BTreeSet<u32>, &Poly),
) -> Result<Vec<Expr>, Obstacle> {
    let arena = field.arena();
    let hidden: Vec<u32> = hidden.iter().copied().collect();
    // A constant is no part of a function, unless it is divided by a hidden kernel.
    let is_kept = |(monomial, _): &(Monomial, Poly)| !(divisor.is_one() && monomial.is_one());
    let parts: Vec<BTreeMap<Monomial, Poly>> =
        parts.map(|part| part.collect(&hidden).into_iter().filter(is_kept).collect()).collect();
    // Low ones first: they are pivots, and the others are reduced by them.
    let monomials: BTreeSet<&Monomial> = parts.iter().flat_map(BTreeMap::keys).collect();
    let mut monomials: Vec<&Monomial> = monomials.into_iter().collect();
    monomials.sort_by_key(|monomial| monomial.degree());
    let entry = |part: &BTreeMap<Monomial, Poly>, monomial: &Monomial| {
        part.get(monomial).map_or(Ok(Fraction::zero()), |coefficient| field.of_polynomial(coefficient))
    };
    let row = |part| monomials.iter().map(|monomial| entry(part, monomial)).collect::<Result<Vec<_>, _>>();
    let rows = parts.iter().map(row).collect::<Result<Vec<_>, Obstacle>>()?;
    let (echelon, _) = Echelon::of(field, Matrix::new(rows), monomials.len())?;
    let apart = divisor.term_count() == 1;
    let of_row = |(_, row): (usize, &[Fraction])| -> Result<Expr, Obstacle> {
        let mut terms = Vec::new();
        for (coefficient, monomial) in row.iter().zip(&monomials).filter(|(coefficient, _)| !coefficient.is_zero()) {
            let power = Poly::from_terms([((*monomial).clone(), 1.into())])?;
            terms.push(field.mul(coefficient, &field.quotient(&power, divisor)?)?);
        }
        if apart {
            return Ok(arena.sum(terms.iter().map(|term| field.show(term)).collect::<Vec<Expr>>()));
        }
        let whole = terms.iter().try_fold(Fraction::zero(), |sum, term| field.add(&sum, term))?;
        Ok(field.show(&whole))
    };
    echelon.rows().map(of_row).collect()
}

/// Tests whether a function is no combination of 1 and the known ones with constant coefficients.
fn is_new(problem: &Problem<'_>, found: &[Expr], function: Expr) -> Result<bool, Obstacle> {
    let arena = problem.arena;
    let all = [&[arena.one()], found, &[function]].concat();
    let field = Field::over(arena, &problem.domain.facts, &all)?;
    let matrix = equations(&field, &[all], &problem.signals)?;
    let (echelon, _) = Echelon::of(&field, matrix, found.len() + 2)?;
    Ok(echelon.rank() == found.len() + 2)
}

/// Functions with the same span, each as plain as it can be.
fn plainest(problem: &Problem<'_>, found: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
    let arena = problem.arena;
    let field = Field::over(arena, &problem.domain.facts, found)?;
    let fractions = found.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>()?;
    let (parts, common) = field.over_common_denominator(&fractions)?;
    let hidden = field.kernels_of(&problem.hidden);
    // A constant factor is not part of a function.
    let Some([divisor, _]) = apart(&field, &common, [&hidden, &BTreeSet::new()])? else { return Ok(found.to_vec()) };
    combinations(&field, parts.into_iter(), (&hidden, &divisor))
}
