//! Upper bounds on the number of a transform's components, whatever functions it is made of.
//!
//! ```text
//! f at a rational point -> power series -> linear equations for the Taylor coefficients of phi -> rank, certificate
//! ```
//!
//! If the rate of phi is free of x, so are all coefficients of its power series around a point: the coefficients of
//! `L_f phi` whose monomials hold x vanish, for every value of the inputs. These are linear equations A c = 0 for the
//! Taylor coefficients c of phi. A combination of the rows that is a combination of the columns of dphi/dx alone is a
//! relation that the gradient of every smooth phi satisfies there. So if there are r independent ones, no phi, of any
//! number of components, has a larger rank than n - r at that point, and none with n > n - r has a differentiable left
//! inverse around it. The rows are found modulo a prime, and the combination is then solved for in rational numbers,
//! which is the certificate: a proof by exact arithmetic for the point and the values of the parameters that are named
//! with it.

mod driven;
pub(crate) mod largest;
mod series;

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::linear::null_space_of_numbers;
use pebo_cas::linear::residues::ResidueRows;
use pebo_cas::poly::{PrimeField, Residue};
use pebo_cas::{Expr, Rational, Symbol};

use super::problem::Problem;
use driven::driven;
use series::{Jets, Monomial};

/// The largest order of the series.
pub(super) const LARGEST_ORDER: usize = 4;

/// More unknowns than this are not solved for.
const MOST_UNKNOWNS: usize = 700;

/// An upper bound of the rank of dphi/dx.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The unmeasured states.
    pub states: usize,
    /// No transform of the class has a larger rank there.
    pub rank: usize,
    /// The class of transforms that it bounds.
    pub class: BoundClass,
    /// True if the certificate was worked out in rational numbers.
    pub proved: bool,
    /// The point and the values of the parameters for which it is said.
    pub point: Vec<(Symbol, Expr)>,
    /// The states by which the gradient is taken.
    pub x: Vec<Symbol>,
    /// The coefficients of each relation among the entries of a gradient there.
    pub relations: Vec<Vec<Expr>>,
    /// The evidence.
    pub evidence: Evidence,
}

/// The evidence for a bound.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Evidence {
    /// By power series around the point.
    Series {
        /// Most equations that one relation combines.
        equations: usize,
        /// The order of the series.
        order: usize,
    },
    /// By completing the equations for transforms affine in x: for every y but for single ones.
    Completion {
        /// The number of independent transforms up to functions of y, where that is decided.
        transforms: Option<usize>,
    },
}

impl Bound {
    /// Tests whether it is proved that no transform of the class has a differentiable left inverse around the point.
    pub fn excludes(&self) -> bool {
        self.proved && self.rank < self.states
    }

    /// The number of independent transforms of the class up to functions of y, where that is decided.
    pub fn transforms(&self) -> Option<usize> {
        match self.evidence {
            Evidence::Completion { transforms } => transforms,
            Evidence::Series { .. } => None,
        }
    }
}

/// A class of transforms with a plain cascade.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BoundClass {
    /// All that are smooth around the point.
    Smooth,
    /// `T(y) x + s(y)` with T and s smooth around the point.
    Affine,
    /// The same, with a rate that is affine in x: of a plain cascade, and of a generalised one.
    AffineRate,
}

/// The bound of the transforms affine in x with a plain or generalised cascade, at a point that is found after so many.
pub(super) fn affine_rates(problem: &Problem<'_>, others: usize) -> Option<Bound> {
    bound(problem, BoundClass::AffineRate, (LARGEST_ORDER, others))
}

/// Bounds the rank of transforms of one class by series to this order, at the first point that is found or after so
/// many others; none where no point was found, or the equations are too many. Where identities hold, a rate has to be
/// free of x on them alone, and nothing is said.
pub(super) fn bound(problem: &Problem<'_>, class: BoundClass, (largest, others): (usize, usize)) -> Option<Bound> {
    if !problem.plant.identities.is_empty() {
        return None;
    }
    let states = problem.x.len();
    let jets = Jets::of(problem, others)?;
    let unknowns = Unknowns::of(problem, class);
    let mut best: Option<Bound> = None;
    for order in 1..=largest {
        if !problem.goes_on() || unknowns.monomials(order + 1).len() > MOST_UNKNOWNS {
            break;
        }
        let Some(found) = at(problem, &unknowns, &jets, order) else { break };
        if best.as_ref().is_none_or(|best| (found.rank, !found.proved) < (best.rank, !best.proved)) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|best| best.rank < states && best.proved) {
            break;
        }
    }
    best
}

/// The Taylor coefficients of the bounded transforms.
struct Unknowns {
    class: BoundClass,
    /// The coordinates: states, then outputs.
    width: usize,
    /// For each state, true if a monomial that holds it may hold a state besides.
    mixed: Vec<bool>,
}

impl Unknowns {
    fn of(problem: &Problem<'_>, class: BoundClass) -> Self {
        let mixed = match class {
            BoundClass::Smooth => driven(problem).into_iter().map(|driven| !driven).collect(),
            BoundClass::Affine | BoundClass::AffineRate => vec![false; problem.x.len()],
        };
        Self { class, width: problem.x.len() + problem.y.len(), mixed }
    }

    /// The monomials of phi up to that degree, but for 1.
    fn monomials(&self, degree: usize) -> Vec<Monomial> {
        let mut found: Vec<Monomial> = vec![vec![0; self.width]];
        let mut last = found.clone();
        for _ in 0..degree {
            let mut next = BTreeSet::new();
            for monomial in &last {
                for index in 0..self.width {
                    let mut more = monomial.clone();
                    more[index] += 1;
                    if self.admits(&more) {
                        next.insert(more);
                    }
                }
            }
            last = next.into_iter().collect();
            found.extend(last.iter().cloned());
        }
        found.split_off(1)
    }

    fn admits(&self, monomial: &Monomial) -> bool {
        let powers = || monomial.iter().zip(&self.mixed).filter(|(power, _)| **power > 0);
        let in_x: usize = powers().map(|(power, _)| usize::from(*power)).sum();
        in_x <= 1 || powers().all(|(_, mixed)| *mixed)
    }
}

/// The equations, a row for each, with an entry for each monomial of phi; the gradient's columns come last.
struct Equations {
    rows: Vec<Vec<Rational>>,
    /// The monomials in the order of the columns.
    columns: Vec<Monomial>,
}

fn equations(problem: &Problem<'_>, unknowns: &Unknowns, jets: &Jets, order: usize) -> Option<Equations> {
    let states = problem.x.len();
    let mut columns = unknowns.monomials(order + 1);
    let is_gradient = |m: &Monomial| {
        m[..states].iter().map(|e| usize::from(*e)).sum::<usize>() == 1 && m[states..].iter().all(|e| *e == 0)
    };
    // The gradient's columns in the order of the states.
    let state = |m: &Monomial| if is_gradient(m) { m.iter().position(|e| *e == 1) } else { None };
    columns.sort_by_key(|m| (state(m), m.iter().map(|e| usize::from(*e)).sum::<usize>(), m.clone()));
    // The least degree in x that a rate must not have.
    let known = if unknowns.class == BoundClass::AffineRate { 2 } else { 1 };
    let mut rows = Vec::new();
    for field in jets.fields(problem, order)? {
        // The rate of each monomial, term by term.
        let mut equations: BTreeMap<Monomial, Vec<Rational>> = BTreeMap::new();
        for (column, monomial) in columns.iter().enumerate() {
            for (index, rate) in field.iter().enumerate().filter(|(index, _)| monomial[*index] > 0) {
                let factor = Rational::from(i64::from(monomial[index]));
                let mut rest = monomial.clone();
                rest[index] -= 1;
                for (term, coefficient) in rate.terms() {
                    let product: Monomial = rest.iter().zip(term).map(|(a, b)| a + b).collect();
                    let degree: usize = product.iter().map(|e| usize::from(*e)).sum();
                    let in_x: usize = product[..states].iter().map(|e| usize::from(*e)).sum();
                    if degree > order || in_x < known {
                        continue;
                    }
                    let row = equations.entry(product).or_insert_with(|| vec![Rational::ZERO; columns.len()]);
                    row[column] = &row[column] + &(&factor * coefficient);
                }
            }
        }
        if !problem.arena.budget().take((columns.len() * equations.len()) as u64) {
            return None;
        }
        rows.extend(equations.into_values());
    }
    Some(Equations { rows, columns })
}

/// The bound at a point, from series of that order.
fn at(problem: &Problem<'_>, unknowns: &Unknowns, jets: &Jets, order: usize) -> Option<Bound> {
    let states = problem.x.len();
    let Equations { rows, columns } = equations(problem, unknowns, jets, order)?;
    let split = columns.len() - states;
    let prime = PrimeField::below(1 << 31)?;
    let images: Option<Vec<Vec<Residue>>> =
        rows.iter().map(|row| row.iter().map(|e| prime.from_rational(e)).collect()).collect();
    let images = images?;
    // Rows that are zero but for the gradient's columns, after elimination.
    let mut echelon = ResidueRows::new(&prime, columns.len());
    for row in images.iter().cloned() {
        if !problem.arena.budget().take((columns.len() * (echelon.rank() + 1) / 8) as u64) {
            return None;
        }
        echelon.insert(row);
    }
    let pivots = echelon.pivots().filter(|pivot| *pivot >= split).count();
    let mut bound = Bound {
        states,
        rank: states - pivots,
        class: unknowns.class,
        proved: pivots == 0,
        point: jets.point(problem),
        x: problem.x.clone(),
        relations: Vec::new(),
        evidence: Evidence::Series { equations: 0, order },
    };
    if pivots > 0 {
        let relations = certificate(problem, &prime, (&rows, &images), (split, pivots))?;
        let equations = relations.iter().map(|(_, equations)| *equations).max().unwrap_or(0);
        bound.evidence = Evidence::Series { equations, order };
        let relations = reduced(problem, relations.into_iter().map(|(relation, _)| relation).collect())?;
        let number = |value: &Rational| problem.arena.number(value.clone());
        bound.relations = relations.iter().map(|relation| relation.iter().map(number).collect()).collect();
        bound.proved = bound.relations.len() == pivots;
    }
    Some(bound)
}

/// Combinations of the rows that vanish but for the last columns, in rational numbers and checked; as many as wanted,
/// or none.
fn certificate(
    problem: &Problem<'_>,
    prime: &PrimeField,
    (rows, images): (&[Vec<Rational>], &[Vec<Residue>]),
    (split, wanted): (usize, usize),
) -> Option<Vec<(Vec<Rational>, usize)>> {
    // Combinations of rows: those in the null space of the transposed left block that are not zero on the right.
    let mut transposed = ResidueRows::new(prime, rows.len());
    for column in 0..split {
        if !problem.arena.budget().take((rows.len() * (transposed.rank() + 1) / 8) as u64) {
            return None;
        }
        transposed.insert(images.iter().map(|row| row[column]).collect());
    }
    let width = rows.first()?.len() - split;
    let mut independent = ResidueRows::new(prime, width);
    let mut found = Vec::new();
    let mut vectors = transposed.null_space();
    vectors.sort_by_key(|(_, vector)| vector.iter().filter(|e| !e.is_zero()).count());
    for (_, vector) in vectors {
        let image = |column: usize| {
            vector
                .iter()
                .zip(images)
                .fold(Residue::ZERO, |sum, (factor, row)| prime.add(sum, prime.mul(*factor, row[column])))
        };
        if !independent.insert((split..split + width).map(image).collect()) {
            continue;
        }
        let support: Vec<usize> = (0..rows.len()).filter(|row| !vector[*row].is_zero()).collect();
        let chosen: Vec<&Vec<Rational>> = support.iter().map(|row| &rows[*row]).collect();
        let combination = combination(problem, &chosen, split)?;
        // The check of the certificate: c A = (0 | relation), every entry in rational numbers.
        let total = |column: usize| {
            combination.iter().zip(&chosen).fold(Rational::ZERO, |sum, (factor, row)| &sum + &(factor * &row[column]))
        };
        let is_exact = (0..split).all(|column| total(column).is_zero());
        let relation: Vec<Rational> = (split..split + width).map(total).collect();
        if !is_exact || relation.iter().all(Rational::is_zero) {
            return None;
        }
        found.push((relation, support.len()));
        if found.len() == wanted {
            break;
        }
    }
    // Independent modulo the prime, hence independent.
    Some(found)
}

/// The same relations in their simplest form: the annihilator of their annihilator.
fn reduced(problem: &Problem<'_>, relations: Vec<Vec<Rational>>) -> Option<Vec<Vec<Rational>>> {
    let (width, budget) = (problem.x.len(), problem.arena.budget());
    let gradients = null_space_of_numbers(relations, width, budget)?;
    null_space_of_numbers(gradients, width, budget)
}

/// The combination of these rows that vanishes left of the split, if it is the only one.
fn combination(problem: &Problem<'_>, rows: &[&Vec<Rational>], split: usize) -> Option<Vec<Rational>> {
    let transposed: Vec<Vec<Rational>> = (0..split)
        .map(|column| rows.iter().map(|row| row[column].clone()).collect::<Vec<Rational>>())
        .filter(|row| row.iter().any(|entry| !entry.is_zero()))
        .collect();
    let vectors = null_space_of_numbers(transposed, rows.len(), problem.arena.budget())?;
    let [vector] = vectors.as_slice() else { return None };
    Some(vector.clone())
}
